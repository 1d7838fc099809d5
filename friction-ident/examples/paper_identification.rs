//! Figures 11 and 12 of the paper: training data of the simulated X-Y table and its identification.
//!
//! `cargo run --release -p friction-ident --example paper_identification -- 20`

use std::time::Instant;

use aep_core::{Aep, MetaEp, Method, Problem};
use friction_ident::{intervals, paper};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seeds: u64 = std::env::args().nth(1).map_or(Ok(3), |text| text.parse())?;
    let step: f64 = std::env::args().nth(2).map_or(Ok(5e-3), |text| text.parse())?;
    let table = paper::table()?;
    let data = paper::training_data(&table, step)?;
    let (position, reference) = (data.require("position")?, data.require("reference")?);
    for (b, segment) in data.segments().iter().enumerate() {
        let x = &position[segment.clone()];
        let still = x.windows(10).filter(|w| w[0] == w[9]).count() as f64 / x.len() as f64;
        let error =
            x.iter().zip(&reference[segment.clone()]).map(|(x, r)| (x - r).powi(2)).sum::<f64>();
        let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (x.min(l), x.max(h)));
        println!(
            "block {b}: {:.3} mm, standing {:.0} %, tracking error {:.1} um rms",
            (high - low) * 1e3,
            still * 100.0,
            (error / x.len() as f64).sqrt() * 1e6
        );
    }
    let task = paper::task(&data, step)?;
    println!("cost of the truth {:.3e}", task.evaluate(&task.start()));
    println!("intervals around the truth:");
    for (p, interval) in paper::PARAMETERS.iter().zip(intervals(&task, &task.start())) {
        println!(
            "  {:8} {:.4e} [{:.4e}, {:.4e}] {}",
            p.symbol, p.value, interval.low, interval.high, interval.identifiable
        );
    }
    let methods: [(&str, Box<dyn Method>); 3] = [
        ("AEP, practical", Box::new(Aep::practical())),
        ("AEP, paper", Box::new(Aep::paper())),
        ("MetaLN EP", Box::new(MetaEp::paper())),
    ];
    for (name, method) in methods.into_iter().take(1) {
        println!("{name}");
        for seed in 1..=seeds {
            let start = Instant::now();
            let found = paper::identify(&task, &*method, 250, seed)?;
            let ratios: Vec<String> = paper::PARAMETERS
                .iter()
                .zip(&found.position)
                .map(|(p, x)| format!("{} {:.3}", p.symbol, x / p.value))
                .collect();
            println!(
                "  {seed:2}: {:.2e}  {}  ({:.1} s)",
                found.cost,
                ratios.join("  "),
                start.elapsed().as_secs_f64()
            );
        }
    }
    Ok(())
}
