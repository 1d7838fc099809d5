//! Pages to look at: one made here, and one that was made before.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use aep_studio::Source;
use aep_studio::report::plain::{self, Figure, Part};
use aep_studio::report::{self, AxisPage};
use aep_studio::words::AxisResult;
use missing_physics::measurement::check::check;
use missing_physics::report::{Compared, Curve, Explained, Law, LawBin, Plot, Samples, Track};
use missing_physics::{Channel, Discovery, Recording};

/// A text that ends whatever it stands in, were it not escaped.
pub const EVIL: &str = "</script></td><img src=x onerror='window.hacked=1'>\"<!--";

/// The page at `AEP_PAGE`, where one is named.
pub fn given() -> Option<PathBuf> {
    std::env::var_os("AEP_PAGE").map(|path| Path::new(&path).canonicalize().unwrap())
}

/// A recording of a slide that swings to and fro; its base model lacks a hump at low speed.
pub fn made(folder: &Path, samples: usize, name: &str) -> PathBuf {
    let discovery: Discovery =
        serde_json::from_str(include_str!("../fixtures/discovery.json")).unwrap();
    let source = Source {
        name: name.to_owned(),
        samples: samples_of(samples, &discovery, name),
        ..Source::default()
    };
    let data = check(&recording());
    let mut discovery = discovery;
    if name == EVIL {
        discovery.plots =
            vec![
                Plot { title: EVIL.into(), x_label: EVIL.into(), ..discovery.plots[0].clone() };
                4
            ];
    }
    let page = report::html(&discovery, &source, &data);
    let path = folder.join(format!("page-{samples}.html"));
    std::fs::write(&path, page).unwrap();
    path
}

/// Two axes on one page.
pub fn two_axes(folder: &Path) -> PathBuf {
    let discovery: Discovery =
        serde_json::from_str(include_str!("../fixtures/discovery.json")).unwrap();
    let effects = discovery.ladder.last().map(|rung| rung.effects.clone()).unwrap_or_default();
    let explained = |name: &String| Explained { name: name.clone(), ..Explained::default() };
    let source = |name: &str| Source {
        name: name.to_owned(),
        samples: samples_of(4000, &discovery, name),
        effects: effects.iter().map(explained).collect(),
        ..Source::default()
    };
    let (shoulder, wrist) = (source("shoulder"), source("wrist"));
    let data = check(&recording());
    let axis = |name: &'static str, source| AxisPage {
        name,
        result: AxisResult::Found(&discovery),
        source,
        check: &data,
    };
    let page = report::axes("arm.csv", &[axis("shoulder", &shoulder), axis("wrist", &wrist)], "");
    let path = folder.join("axes.html");
    std::fs::write(&path, page).unwrap();
    path
}

/// A page of no discovery.
pub fn plain(folder: &Path) -> PathBuf {
    let curve = Curve { label: "a curve".into(), x: vec![0.0, 1.0], y: vec![1.0, 3.0] };
    let plot = Plot {
        title: "A plot".into(),
        x_label: "time / s".into(),
        y_label: "size".into(),
        curves: vec![curve],
    };
    let part = Part {
        id: "part".into(),
        title: "A comparison".into(),
        notes: vec!["What is to be known of it.".into()],
        headings: vec!["optimizer".into(), "#expected with restarts".into(), "#median cost".into()],
        rows: vec![vec!["accelerated-evolutionary".into(), "12345".into(), "1.0e-8".into()]],
        figures: vec![Figure { plot, bands: Vec::new() }],
    };
    let path = folder.join("plain.html");
    std::fs::write(&path, plain::page("Optimizers compared", "Five trials.", &[part], "aep"))
        .unwrap();
    path
}

fn recording() -> Recording {
    let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 1e-3).collect();
    let force = time.iter().map(|t| (TAU * t).sin()).collect();
    let position = time.iter().map(|t| (TAU * t).cos()).collect();
    let channels = vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
    Recording::new("run.csv", time, channels).unwrap()
}

fn samples_of(samples: usize, discovery: &Discovery, name: &str) -> Samples {
    let time: Vec<f64> = (0..samples)
        .map(|k| 1e-3 * k as f64 + if 3 * k > 2 * samples { 0.5 } else { 0.0 })
        .collect();
    let angle = |t: &f64| 1.3 * t + (0.7 * t).sin();
    let velocity: Vec<f64> = time.iter().map(|t| 0.05 * angle(t).cos()).collect();
    let position: Vec<f64> = time.iter().map(|t| 0.1 * (0.9 * t).sin()).collect();
    // A hump at low speed, and noise that is the same everywhere.
    let hump = |v: f64| 4.0 * v.signum() / (1.0 + (v / 5e-3).powi(2));
    let noise = |k: usize| 0.4 * ((k as f64 * 12.9898).sin() * 43_758.547).fract();
    let measured: Vec<f64> = velocity
        .iter()
        .enumerate()
        .map(|(k, v)| 10.0 * v.signum() + 100.0 * v + hump(*v) + noise(k))
        .collect();
    let predicted = |share: f64| {
        velocity.iter().map(|v| 10.0 * v.signum() + 100.0 * v + share * hump(*v)).collect()
    };
    let steps = (discovery.ladder.len() - 1).max(1) as f64;
    let track = |name: &str, unit: &str, values: &[f64]| Track {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: values.to_vec(),
        against_motion: false,
    };
    let effects = discovery.ladder.last().map(|rung| rung.effects.clone()).unwrap_or_default();
    let left_out: Vec<Option<usize>> =
        (0..samples).map(|k| (k % 5000 < 200).then_some(0)).collect();
    Samples {
        piece: (0..samples).map(|k| 1 + i64::from(3 * k > 2 * samples)).collect(),
        regimes: vec!["slow motion".into(), name.to_owned()],
        regime: velocity.iter().map(|v| usize::from(v.abs() > 0.01)).collect(),
        reasons: vec![name.to_owned()],
        coordinates: vec![track("velocity", "m/s", &velocity), track("position", "m", &position)],
        compared: vec![Compared {
            name: "force".into(),
            about: name.to_owned(),
            unit: "N".into(),
            measured,
            predicted: (0..discovery.ladder.len()).map(|k| predicted(k as f64 / steps)).collect(),
            left_out,
            decides: true,
        }],
        laws: effects
            .iter()
            .map(|effect| Law {
                effect: effect.clone(),
                along: "velocity".into(),
                unit: "m/s".into(),
                quantity: ["force".into(), "N".into()],
                against_motion: false,
                bins: (0..40)
                    .map(|k| {
                        let at = f64::from(k - 20) * 2e-3;
                        LawBin { at, law: hump(at), data: hump(at) }
                    })
                    .collect(),
            })
            .collect(),
        time,
    }
}
