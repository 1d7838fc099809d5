//! Figures 13 to 17: the X-Y table under PD with and without friction compensation.

use std::fmt::Write;
use std::path::Path;

use aep_problems::paper::{Claim, Verdict};
use friction_ident::control::paper::{self, GAIN, Shown};
use friction_ident::control::{Measures, Trial};
use missing_physics::measurement::quantity::{percent, quantity};

use super::reproduce_figure::{Conditions, Figure, Made};
use crate::curve_plot::{Axes, Curve};
use crate::failure::Failure;

/// The figures on control, one entry each.
pub const FIGURES: &[Figure] = &[
    Figure { name: "fig13", title: "ramp of 0.1 cm/s", make },
    Figure { name: "fig14", title: "ramp of 0.05 cm/s", make },
    Figure { name: "fig15", title: "ramp of 0.01 cm/s", make },
    Figure { name: "fig16", title: "velocity reversal under PD", make },
    Figure { name: "fig17", title: "velocity reversal with compensation", make },
];

/// Centimetres per metre: the paper's figures are in cm.
const CM: f64 = 100.0;
/// Share of the standstill that must be gone for "almost avoided".
const AVOIDED: f64 = 0.9;

fn make(name: &'static str, conditions: &Conditions) -> Result<Made, Failure> {
    let figure = paper::FIGURES.iter().find(|figure| figure.name == name);
    let figure = figure.ok_or_else(|| Failure::failed(format!("no figure {name}")))?;
    let shown = figure.show().map_err(|error| Failure::failed(error.to_string()))?;
    let mut made = Made::default();
    let path = |suffix: &str| conditions.directory.join(format!("{name}{suffix}"));
    made.keep(&path(".csv"), &csv(&shown))?;
    positions(&mut made, &path(".svg"), figure, &shown)?;
    errors(&mut made, &path("-error.svg"), figure, &shown)?;
    made.claims = match name {
        "fig16" | "fig17" => reversal(figure, &shown),
        "fig13" => [ramp(&shown), gains()?].concat(),
        _ => ramp(&shown),
    };
    Ok(made)
}

fn csv(shown: &Shown) -> String {
    let mut text = String::from(
        "time_s,reference_cm,pd_cm,compensated_cm,compensated_without_presliding_cm,pd_force_N,compensated_force_N,compensation_N\n",
    );
    let (pd, with, letter) = (&shown.pd, &shown.compensated, &shown.to_the_letter);
    for k in 0..shown.reference.position.len() {
        let _ = writeln!(
            text,
            "{:.3},{:.6},{:.6},{:.6},{:.6},{:.5},{:.5},{:.5}",
            k as f64 * shown.reference.sample_time,
            CM * shown.reference.position[k],
            CM * pd.run.position[k],
            CM * with.run.position[k],
            CM * letter.run.position[k],
            pd.run.command[k],
            with.run.command[k],
            with.compensation[k],
        );
    }
    text
}

fn positions(
    made: &mut Made,
    path: &Path,
    figure: &paper::Figure,
    shown: &Shown,
) -> Result<(), Failure> {
    let samples = (figure.drawn / shown.reference.sample_time) as usize;
    let points = |position: &[f64]| -> Vec<(f64, f64)> {
        let time = |k| k as f64 * shown.reference.sample_time;
        position.iter().take(samples).enumerate().map(|(k, x)| (time(k), CM * x)).collect()
    };
    let curve = |label: &str, position: &[f64]| Curve {
        label: label.to_owned(),
        points: points(position),
        band: Vec::new(),
    };
    let mut curves = Vec::new();
    if figure.pd {
        curves.push(curve("PD", &shown.pd.run.position));
    }
    if figure.compensated {
        curves.push(curve("PD + compensation", &shown.compensated.run.position));
    }
    let axes = Axes { title: figure.title, x: "time, s", y: "position, cm", logarithmic: false };
    let desired = curve("desired", &shown.reference.position);
    made.draw(path, axes, (&curves, &[desired]))
}

/// Tracking errors: what the width of the lines hides in the plot of positions.
fn errors(
    made: &mut Made,
    path: &Path,
    figure: &paper::Figure,
    shown: &Shown,
) -> Result<(), Failure> {
    let step = shown.reference.sample_time;
    let curve = |label: &str, trial: &Trial| Curve {
        label: label.to_owned(),
        points: (0..(figure.drawn / step) as usize)
            .map(|k| (k as f64 * step, 1e6 * (shown.reference.position[k] - trial.run.position[k])))
            .collect(),
        band: Vec::new(),
    };
    let curves = [curve("PD", &shown.pd), curve("PD + compensation", &shown.compensated)];
    let axes =
        Axes { title: figure.title, x: "time, s", y: "tracking error, µm", logarithmic: false };
    made.draw(path, axes, (&curves, &[]))
}

fn stick(measures: &Measures) -> String {
    format!(
        "{} stick episodes, {:.1} s of stick, RMS error {}",
        measures.stick_episodes,
        measures.stick_time,
        quantity(measures.rms_error, "m")
    )
}

fn ramp(shown: &Shown) -> Vec<Claim> {
    let sticks = |trial: &Trial| trial.measures.stick_episodes > 0;
    let letter = Claim::new(
        "compensation by the formula alone",
        "no stick-slip",
        stick(&shown.to_the_letter.measures),
        !sticks(&shown.to_the_letter),
    );
    let why = "static friction commanded all at once makes the simulated table break away faster than so \
               slow a reference, and it falls back into stick; following the elastic contact along the \
               desired path, as above, prevents that";
    vec![
        Claim::new("PD alone", "stick-slip", stick(&shown.pd.measures), sticks(&shown.pd)),
        Claim::new(
            "PD + compensation",
            "no stick-slip",
            stick(&shown.compensated.measures),
            !sticks(&shown.compensated),
        ),
        if sticks(&shown.to_the_letter) { letter.because(why) } else { letter },
    ]
}

/// What the printed gains can mean.
fn gains() -> Result<Vec<Claim>, Failure> {
    let table = friction_ident::paper::table()?;
    let sample_time = friction_ident::paper::SAMPLE_TIME;
    let mut linear = paper::servo(1.0).linear(&table, sample_time);
    let with = linear.spectral_radius();
    linear.damping = 0.0;
    let without = linear.spectral_radius();
    let ours = format!(
        "in kgf per count: spectral radius {with:.3} ({without:.3} without viscous friction); used: {GAIN} of it"
    );
    let why = "neither the unit nor the gain of D/A converter and amplifier is printed; per count and per \
               sample K_D/K_P is 5 ms whatever they are, and that is kept";
    let claim = Claim::new("gains", "K_P = 0.1, K_D = 0.1", ours, Verdict::CannotBeKnown);
    Ok(vec![claim.because(why)])
}

fn reversal(figure: &paper::Figure, shown: &Shown) -> Vec<Claim> {
    let (pd, with) = (&shown.pd.measures, &shown.compensated.measures);
    let mean = |measures: &Measures| measures.mean_standstill().unwrap_or(0.0);
    let reference = Claim::new(
        "reference",
        "not printed",
        "+-0.1 cm/s, reversed every 2 s",
        Verdict::CannotBeKnown,
    )
    .because("neither shape nor speed is given in the text");
    if figure.compensated {
        let cut = paper::standstill_cut(shown).unwrap_or(0.0);
        let ours = format!(
            "{} at each of {}, {} less than PD",
            quantity(mean(with), "s"),
            with.standstill.len(),
            percent(cut)
        );
        vec![Claim::new("PD + compensation", "standstill almost avoided", ours, cut >= AVOIDED)]
    } else {
        let ours = format!("{} at each of {}", quantity(mean(pd), "s"), pd.standstill.len());
        let all = pd.standstill.iter().all(|t| *t > 0.0);
        vec![Claim::new("PD alone", "standstill at each reversal", ours, all), reference]
    }
}
