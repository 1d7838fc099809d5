//! Cost of identification by simulation against samples, candidates and effects, on one core, with
//! the memory in use.
//!
//! `cargo run --release -p benches --bin scaling`

use std::time::Instant;

use aep_core::{Batch, Problem};
use friction_ident::{Axis, Free, Horizon, Identification, Input, Model, Start, simulate};
use missing_physics::{Channel, Hold, Recording};

type Failure = Box<dyn std::error::Error>;

fn model(effects: usize) -> Result<Model, Failure> {
    let names = [
        "coulomb",
        "viscous",
        "presliding",
        "stribeck",
        "offset",
        "asymmetry",
        "quadratic-drag",
        "spring",
    ];
    let model = Model::new(Axis::Linear, 30.0)?;
    Ok(names[..effects].iter().try_fold(model, |model, name| model.with(name, &[]))?)
}

fn recording(samples: usize) -> Result<Recording, Failure> {
    let time: Vec<f64> = (0..samples).map(|k| k as f64 * 1e-3).collect();
    let force: Vec<f64> = time.iter().map(|t| 30.0 * (5.0 * t).sin()).collect();
    let input = Input::new(&time, &force, Hold::ZeroOrder);
    let position = simulate(&model(4)?, &input, &Start::default())?.position;
    let channels = vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
    Ok(Recording::new("simulated", time, channels)?.with_hold(Hold::ZeroOrder))
}

/// Resident memory, MB, where the system tells.
fn memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|l| l.split_whitespace().next()?.parse::<f64>().ok())
        .map_or(f64::NAN, |kb| kb / 1e3)
}

fn measure(samples: usize, candidates: usize, effects: usize) -> Result<(), Failure> {
    let data = recording(samples)?;
    let free = [Free::linear("coulomb.F_C", 1.0, 20.0)];
    let horizon = Horizon::FreeRun { max_step: 1e-3 };
    let task = Identification::new(&model(effects)?, &data, &free, horizon)?;
    let points: Vec<f64> =
        (0..candidates).map(|k| 1.0 + 19.0 * k as f64 / candidates as f64).collect();
    let mut costs = vec![0.0; candidates];
    let start = Instant::now();
    task.evaluate_batch(Batch::new(1, &points), &mut costs);
    let took = start.elapsed().as_secs_f64();
    let each = took * 1e9 / (samples as f64 * candidates as f64);
    println!(
        "{samples:>9} {candidates:>10} {effects:>8} {took:>9.3} {each:>16.2} {:>8.0}",
        memory()
    );
    Ok(())
}

fn main() -> Result<(), Failure> {
    println!("  samples candidates  effects    time/s  ns/sample/cand.   MB");
    for samples in [1_000, 10_000, 100_000, 1_000_000] {
        measure(samples, 96, 4)?;
    }
    for candidates in [96, 1_000, 10_000] {
        measure(2_000, candidates, 4)?;
    }
    for effects in 1..=8 {
        measure(10_000, 96, effects)?;
    }
    Ok(())
}
