//! Figures 11 and 12 of the paper: training data of the simulated X-Y table and its identification.
//!
//! `cargo run --release -p friction-ident --example paper_identification -- [seeds] [step in s]
//! [generations] [population]`

use std::time::Instant;

use aep_core::{Aep, MetaEp, Method, Outcome, Problem};
use friction_ident::paper::{self, PARAMETERS};
use friction_ident::{Identification, intervals};
use missing_physics::Recording;

/// Argument `k`, or what is usual.
fn argument<T: std::str::FromStr>(k: usize, usual: T) -> Result<T, T::Err> {
    std::env::args().nth(k).map_or(Ok(usual), |text| text.parse())
}

fn describe(data: &Recording) -> Result<(), Box<dyn std::error::Error>> {
    let (position, reference) = (data.require("position")?, data.require("reference")?);
    for (b, segment) in data.segments().iter().enumerate() {
        let (x, wanted) = (&position[segment.clone()], &reference[segment.clone()]);
        let still = x.windows(10).filter(|w| w[0] == w[9]).count() as f64 / x.len() as f64;
        let error = x.iter().zip(wanted).map(|(x, r)| (x - r).powi(2)).sum::<f64>();
        let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (x.min(l), x.max(h)));
        println!(
            "block {b}: {:.3} mm, standing {:.0} %, tracking error {:.1} um rms",
            (high - low) * 1e3,
            still * 100.0,
            (error / x.len() as f64).sqrt() * 1e6
        );
    }
    Ok(())
}

/// Which parameters were found: within 2 %, the delay within 10 %.
fn hits(found: &Outcome) -> Vec<bool> {
    let tolerance = |symbol: &str| if symbol == "tau_L" { 0.1 } else { 0.02 };
    let ratios = PARAMETERS.iter().zip(&found.position);
    ratios.map(|(p, x)| (x / p.value - 1.0).abs() < tolerance(p.symbol)).collect()
}

fn run(
    name: &str,
    method: &dyn Method,
    task: &Identification<'_>,
    (seeds, generations): (u64, u64),
) -> Result<(), Box<dyn std::error::Error>> {
    println!("{name}");
    let (mut good, mut all) = ([0; 8], 0);
    for seed in 1..=seeds {
        let start = Instant::now();
        let mut found = paper::identify(task, method, generations, seed)?;
        let polished = task.refine(&found.position);
        (found.position, found.cost) = (polished.position, polished.cost);
        let ratios: Vec<String> = PARAMETERS
            .iter()
            .zip(&found.position)
            .map(|(p, x)| format!("{} {:.3}", p.symbol, x / p.value))
            .collect();
        let hits = hits(&found);
        good.iter_mut().zip(&hits).for_each(|(good, hit)| *good += u32::from(*hit));
        let needed =
            PARAMETERS.iter().zip(&hits).filter(|(p, _)| !matches!(p.symbol, "gamma" | "x'_s"));
        all += u32::from(needed.clone().all(|(_, hit)| *hit));
        let took = start.elapsed().as_secs_f64();
        println!("  {seed:2}: {:.2e}  {}  ({took:.1} s)", found.cost, ratios.join("  "));
    }
    println!("  found, of {seeds}: {good:?}; all but gamma and x'_s: {all}");
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (seeds, step) = (argument(1, 3)?, argument(2, 5e-3)?);
    let (generations, population) = (argument(3, 250)?, argument(4, 40)?);
    let data = paper::training_data(&paper::table()?, step)?;
    describe(&data)?;
    let task = paper::task(&data, step)?;
    println!("cost of the truth {:.3e}; intervals around it:", task.evaluate(&task.start()));
    for (p, interval) in PARAMETERS.iter().zip(intervals(&task, &task.start())) {
        let verdict = if interval.identifiable { "" } else { "not identifiable from this data" };
        println!(
            "  {:8} {:.4e} [{:.4e}, {:.4e}] {verdict}",
            p.symbol, p.value, interval.low, interval.high
        );
    }
    let budget = (seeds, generations);
    run("AEP, practical", &Aep::practical().with_population(population), &task, budget)?;
    run("AEP, the paper's rules", &Aep::paper().with_population(population), &task, budget)?;
    run("MetaLN EP", &MetaEp::paper().with_population(population), &task, budget)
}
