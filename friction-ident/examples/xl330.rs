//! A Dynamixel XL330 servo that lifts a pendulum (measured by Rhoban, Apache-2.0): gravity, motor and
//! friction identified from six runs, then simulated freely over two runs that were held out.
//!
//! `cargo run --release -p friction-ident --example xl330 -- ../shared/data/xl330`

use std::path::Path;

use aep_core::{Aep, Budget};
use friction_ident::{
    Axis, Free, Horizon, Identification, Input, Model, Start, WindowOptions, simulate,
    window_errors,
};
use missing_physics::{Channel, Hold, Recording};

type Failure = Box<dyn std::error::Error>;

/// Held out: one run of either gain.
const HELD_OUT: [&str; 2] = ["xl330_kp100_sin_sin.csv", "xl330_kp400_sin_time_square.csv"];

/// Time, voltage at the motor and angle while the motor is on.
#[derive(Default)]
struct Runs {
    time: Vec<f64>,
    voltage: Vec<f64>,
    angle: Vec<f64>,
    segment: Vec<i64>,
}

impl Runs {
    /// Adds a run up to where its motor is switched off.
    fn read(&mut self, path: &Path) -> Result<(), Failure> {
        let text = std::fs::read_to_string(path)?;
        let segment = self.segment.last().map_or(0, |last| last + 1);
        for line in text.lines().skip(1) {
            let row = line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;
            if row[7] == 0.0 {
                break;
            }
            self.time.push(row[0]);
            self.angle.push(row[2]);
            self.voltage.push(row[5] * row[6]);
            self.segment.push(segment);
        }
        Ok(())
    }

    fn recording(self) -> Result<Recording, Failure> {
        let channels = vec![
            Channel::new("force", "V", self.voltage),
            Channel::new("position", "rad", self.angle),
        ];
        let recording = Recording::with_segments("XL330", self.time, channels, self.segment)?;
        Ok(recording.with_hold(Hold::ZeroOrder))
    }
}

/// The motor turns volts into torque; its back-EMF is part of the viscous friction. The pendulum's
/// weight is known (0.49 kg at 0.10 m), so that the gain is not free to scale with all the rest.
fn model() -> Result<Model, Failure> {
    Ok(Model::new(Axis::Rotary, 6e-3)?
        .with("motor-gain", &[("g", 0.1)])?
        .with("gravity-pendulum", &[("M", 0.49 * 9.81 * 0.10), ("q_0", 0.0)])?
        .with("coulomb", &[("F_C", 0.03)])?
        .with("viscous", &[("F_v", 0.05)])?)
}

fn free() -> Vec<Free> {
    vec![
        Free::log("mass", 2e-3, 5e-2),
        Free::log("motor-gain.g", 0.02, 0.5),
        Free::linear("gravity-pendulum.q_0", -0.1, 0.1),
        Free::linear("coulomb.F_C", 0.0, 0.3),
        Free::linear("viscous.F_v", 0.0, 0.5),
    ]
}

/// Free-run error of each segment, rad rms.
fn free_run(model: &Model, data: &Recording) -> Result<Vec<f64>, Failure> {
    let (voltage, angle) = (data.require("force")?, data.require("position")?);
    let run = |s: &std::ops::Range<usize>| -> Result<f64, Failure> {
        let input = Input::new(&data.time()[s.clone()], &voltage[s.clone()], data.hold());
        let out = simulate(model, &input, &Start::at(angle[s.start], 0.0))?;
        let errors = out.position.iter().zip(&angle[s.clone()]).map(|(x, q)| (x - q).powi(2));
        Ok((errors.sum::<f64>() / s.len() as f64).sqrt())
    };
    data.segments().iter().map(run).collect()
}

/// Where the recordings lie beside a checkout, if they do.
const DEFAULT: &str = "../shared/data/xl330";

fn main() -> Result<(), Failure> {
    let folder = match std::env::args().nth(1) {
        Some(folder) => folder,
        None if Path::new(DEFAULT).is_dir() => DEFAULT.into(),
        None => {
            println!("skipped: the XL330 recordings are not at {DEFAULT}; give their folder");
            return Ok(());
        }
    };
    let mut files: Vec<_> = std::fs::read_dir(&folder)
        .map_err(|error| format!("{folder}: {error}; give the folder of the recordings"))?
        .collect::<Result<Vec<_>, _>>()?
        .into_iter()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "csv"))
        .collect();
    files.sort();
    let (mut train, mut held) = (Runs::default(), Runs::default());
    for path in &files {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if HELD_OUT.contains(&name) { held.read(path)? } else { train.read(path)? }
    }
    let (train, held) = (train.recording()?, held.recording()?);
    let with_load = model()?.with("load-friction", &[("mu", 0.05)])?;
    let mut free_load = free();
    free_load.push(Free::linear("load-friction.mu", 0.0, 0.6));
    let options = WindowOptions { max_step: 2.5e-3, iterations: 3, ..WindowOptions::new(0.4) };
    for (name, model, free) in [
        ("coulomb + viscous", model()?, free()),
        ("coulomb + viscous + load-friction", with_load, free_load),
    ] {
        let task = Identification::new(&model, &train, &free, Horizon::Windows(options))?;
        let aep = Aep::practical().with_population(24);
        let found = task.run(&aep, Budget::generations(80), 1)?;
        let fitted = task.model(&found.position)?;
        println!("{name}: cost {:.3e}", found.cost);
        for (free, value) in free.iter().zip(&found.position) {
            println!("  {} = {value:.4} {}", free.address, fitted.unit(&free.address)?);
        }
        for (which, data) in [("fitted", &train), ("held out", &held)] {
            let windows = window_errors(&fitted, data, &options)?;
            let runs = free_run(&fitted, data)?;
            let runs: Vec<String> = runs.iter().map(|e| format!("{e:.3}")).collect();
            println!(
                "  {which}: windows of 0.4 s {:.4} rad (robust), free runs {} rad",
                windows.robust_rms(),
                runs.join(", ")
            );
        }
    }
    Ok(())
}
