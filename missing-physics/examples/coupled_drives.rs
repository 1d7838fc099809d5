//! What does a linear model of two coupled electric drives lack? A subject without any friction.
//!
//! Two motors drive a pulley through a flexible belt; a sensor measures its speed. The engine is given a linear model
//! (a lag of the motors, a resonance of the belt) and what else could lie between input and sensor.
//!
//! Data: T. Wigren, M. Schoukens, Coupled electric drives data set and reference models, Uppsala University 2017, free for
//! benchmarking; their sensor returns |speed|. Such a drive is simulated, too, and draws of one whose sensor keeps the sign.
//!
//! `cargo run --release -p missing-physics --example coupled_drives [FILE.csv INPUT OUTPUT | DRAWS]`

use std::{error::Error, f64::consts::TAU};

use missing_physics::{Coordinate, FnFamily, Settings, Term, discover};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Sampling interval, s.
const INTERVAL: f64 = 0.02;

/// What a term adds at sample `k`, per unit of its amplitude: `x` is the speed of a drive of its own, `s` another shape.
type Law = fn(x: &[f64], s: f64, k: usize) -> f64;

/// Name, equation and law of the linear drive and of what may be added to it.
const LAWS: [(&str, &str, Law); 7] = [
    ("dynamics", "c x", |x, _, k| x[k]),
    ("rectifying-sensor", "c |x|", |x, _, k| x[k].abs()),
    ("curved-sensor", "c x^2", |x, _, k| x[k] * x[k]),
    ("dead-zone", "c sgn(x) max(|x| - s, 0)", |x, s, k| x[k].signum() * (x[k].abs() - s).max(0.0)),
    ("delay", "c x(t - s)", |x, s, k| k.checked_sub((s / INTERVAL) as usize).map_or(0.0, |k| x[k])),
    ("offset", "c", |_, _, _| 1.0),
    ("drift", "c t", |_, _, k| INTERVAL * k as f64),
];

/// A linear model of a signal without sign has no gain: what a sensor makes of *its* speed says nothing. With dynamics
/// as shapes of each candidate the engine profiles them together with what the sensor does.
fn term((name, equation, _): (&str, &str, Law)) -> Term {
    let lower = if name == "rectifying-sensor" { 0.0 } else { -20.0 };
    let term = Term::new(name, name, equation).amplitude("c", "V", (lower, 20.0), 1.0);
    let moving = term.clone().shape("tau", "s", (0.03, 1.0), 0.2);
    let moving = moving.shape("f", "Hz", (0.5, 10.0), 2.0).shape("zeta", "1", (0.05, 1.0), 0.3);
    match name {
        "offset" | "drift" => term,
        "dynamics" => moving.always(),
        "dead-zone" => moving.shape("s", "V", (0.05, 0.8), 0.2),
        "delay" => moving.shape("s", "s", (0.02, 0.4), 0.1),
        _ => moving,
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    if let [file, input, output] = args.as_slice() {
        let text = std::fs::read_to_string(file)?;
        let rows: Vec<Vec<&str>> = text.lines().map(|row| row.split(',').collect()).collect();
        let column = |name: &String| -> Result<Vec<f64>, Box<dyn Error>> {
            let place = rows[0].iter().position(|have| have == name).ok_or("no such column")?;
            rows[1..].iter().map(|row| Ok(row[place].parse()?)).collect()
        };
        tell(&column(input)?, column(output)?)?;
    }
    assert_eq!(tell_simulated(1, f64::abs)?, ["rectifying-sensor"]);
    let draws = if let [draws] = args.as_slice() { draws.parse()? } else { 1 };
    let found = (1..=draws).map(|k| tell_simulated(k, |speed| speed));
    let named = found.filter(|names| names.as_ref().is_ok_and(|names| !names.is_empty())).count();
    println!("a sensor that lacks nothing: names in {named} of {draws} draws");
    assert!(draws > 1 || named == 0);
    Ok(())
}

/// Prints what a discovery says; the effects that it added.
fn tell(input: &[f64], output: Vec<f64>) -> Result<Vec<String>, Box<dyn Error>> {
    let time = (0..input.len()).map(|k| INTERVAL * k as f64).collect();
    let family = FnFamily::new(LAWS.map(term).to_vec(), time, output, |given, out| {
        for (name, _, law) in LAWS {
            let Some(values) = given.of(name) else { continue };
            let x = values.get(1..4).map_or_else(Vec::new, |shape| speed(input, shape));
            let s = values.get(4).copied().unwrap_or_default();
            out.iter_mut().enumerate().for_each(|(k, out)| *out += values[0] * law(&x, s, k));
        }
    });
    let input = Coordinate::of_state("input", "V", input.to_vec());
    let found = discover(&family.along(input), &Settings::default(), &mut ())?;
    for one in found.ranking.first().into_iter().flatten() {
        println!("{:>18}  gain {:6.1} %  p {:.3}", one.effect, 100.0 * one.gain, one.p_value);
    }
    println!("{:?} in {:.1} s: {:?}\n", found.verdict, found.wall_s, found.added);
    Ok(found.added)
}

/// Speed of a drive of gain 1: `tau w' + w = u`, `x'' + 2 zeta omega x' + omega^2 x = omega^2 w`.
fn speed(input: &[f64], shape: &[f64]) -> Vec<f64> {
    let (tau, omega, zeta, step) = (shape[0], TAU * shape[1], shape[2], INTERVAL / 10.0);
    let (lag, mut motor, mut x, mut slope) = (1.0 - (-step / tau).exp(), 0.0, 0.0, 0.0);
    let advance = |u: &f64| -> f64 {
        let now = x;
        for _ in 0..10 {
            motor += lag * (u - motor);
            slope += step * omega * (omega * (motor - x) - 2.0 * zeta * slope);
            x += step * slope;
        }
        now
    };
    input.iter().map(advance).collect()
}

/// Of a drive under a random binary input, seen by `sensor` with noise of 0.05 V.
fn tell_simulated(seed: u64, sensor: fn(f64) -> f64) -> Result<Vec<String>, Box<dyn Error>> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut input = Vec::new();
    while input.len() < 500 {
        let level = if random.random_bool(0.5) { 1.0 } else { -1.0 };
        input.extend(vec![level; random.random_range(10..40)]);
    }
    input.truncate(500);
    let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
    let speeds = speed(&input, &[0.17, 3.2, 0.15]);
    tell(&input, speeds.iter().map(|x| sensor(1.9 * x) + 0.05 * noise()).collect())
}
