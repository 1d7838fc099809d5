//! What does a model of two cascaded tanks lack? A pump fills the upper tank; through a hole it runs out into the lower
//! one, and that through another; a sensor shows the lower level. The upper tank runs over, which the model lacks.
//!
//! `cargo run --release -p missing-physics --example cascaded_tanks`

use missing_physics::{Coordinate, FnFamily, Settings, Term, discover};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Sampling interval, s, and steps of the integration per sample.
const INTERVAL: (f64, usize) = (4.0, 8);

/// Level of the lower tank under a pump voltage, cm: Torricelli's square root of a level runs out of a hole. `brim` (cm)
/// is the height of the upper tank, `leak` (1/s) of the lower one, `lag` (s) of the pump.
fn level(input: &[f64], holes: [f64; 2], [brim, leak, lag]: [f64; 3], out: &mut [f64]) {
    let step = INTERVAL.0 / INTERVAL.1 as f64;
    let (mut flow, mut upper, mut lower) = (input[0], 6.0f64, 6.0f64);
    for (out, pump) in out.iter_mut().zip(input) {
        *out = lower;
        for _ in 0..INTERVAL.1 {
            flow += (pump - flow) * (1.0 - (-step / lag).exp());
            let through = holes[0] * upper.max(0.0).sqrt();
            upper += step * (0.05 * flow - through);
            let spilled = (upper - brim).max(0.0);
            upper -= spilled;
            let away = holes[1] * lower.max(0.0).sqrt() + leak * lower;
            lower += spilled + step * (through - away);
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut input: Vec<f64> = Vec::new();
    while input.len() < 1024 {
        let level = random.random_range(0.5..4.5);
        input.extend(vec![level; random.random_range(8..40)]);
    }
    let mut measured = vec![0.0; input.len()];
    level(&input, [0.05, 0.04], [10.0, 0.0, 1e-9], &mut measured);
    let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
    for y in &mut measured {
        *y = 1.02 * *y + 0.05 * noise();
    }

    let holes = Term::new("holes", "two holes", "g y").amplitude("g", "1", (0.5, 2.0), 1.0);
    let holes = holes.shape("a", "cm^0.5/s", (0.01, 0.2), 0.05);
    let terms = vec![
        holes.shape("b", "cm^0.5/s", (0.01, 0.2), 0.05).always(),
        Term::new("overflow", "it runs over", "x <= h").shape("h", "cm", (3.0, 30.0), 9.0),
        Term::new("leak", "the lower one leaks", "-l y").shape("l", "1/s", (1e-4, 0.02), 1e-3),
        Term::new("pump-lag", "a slow pump", "T q' = u - q").shape("T", "s", (0.5, 60.0), 5.0),
        Term::new("offset", "the sensor's zero", "o").amplitude("o", "cm", (-9.0, 9.0), 1.0),
    ];
    let time = (0..input.len()).map(|k| INTERVAL.0 * k as f64).collect();
    let family = FnFamily::new(terms, time, measured, |given, out| {
        let one = |name: &str, none: f64| given.of(name).map_or(none, |values| values[0]);
        let Some(&[gain, a, b]) = given.of("holes") else { return };
        let others = [one("overflow", f64::INFINITY), one("leak", 0.0), one("pump-lag", 1e-9)];
        level(&input, [a, b], others, out);
        for y in out {
            *y = gain * *y + one("offset", 0.0);
        }
    });
    let family = family.predicting("level", "cm");
    let family = family.along(Coordinate::of_state("pump", "V", input.clone()));
    let found = discover(&family, &Settings::default(), &mut ())?;
    println!("{:?} in {:.1} s: {:?}", found.verdict, found.wall_s, found.added);
    println!("{:#?}", found.ladder[found.ladder.len() - 1].parameters);
    assert_eq!(found.added, ["overflow"]);
    Ok(())
}
