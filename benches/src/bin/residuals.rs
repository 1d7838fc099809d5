//! How families that only give residuals are judged: what was hidden, what was named.
//!
//! Two families of which the engine knows nothing but what they predict: functions of a coordinate that wanders, and a
//! tank that is simulated freely. Noise is white, or each sample of it 0.9 of the one before.
//!
//! `cargo run --release -p benches --bin residuals [-- SEEDS [WHICH]]`

use missing_physics::report::Verdict;
use missing_physics::{Coordinate, Discovery, FnFamily, ModelFamily, Settings, Term, discover};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;

type Law = fn(f64) -> f64;

/// Candidates of the signal: functions of its coordinate.
const LAWS: [(&str, Law); 5] = [
    ("square", |x| x * x),
    ("cube", |x| x * x * x),
    ("sine", |x| (5.0 * x).sin()),
    ("cosine", |x| (9.0 * x).cos()),
    ("step", |x| f64::from(u8::from(x > 0.4))),
];
/// Samples of a recording.
const POINTS: usize = 900;
/// How much of a coloured sample is that of the one before.
const MEMORY: f64 = 0.9;

/// What is hidden.
#[derive(Clone, Copy)]
enum Hidden {
    /// Effects of the library, each of this size in standard deviations of the noise.
    Listed(&'static [&'static str], f64),
    /// Something that no effect of the library describes, of this size: over time, how.
    Unlisted(&'static str, f64),
}

struct Noise {
    random: Xoshiro256PlusPlus,
    memory: f64,
    state: f64,
}

impl Noise {
    fn new(seed: u64, memory: f64) -> Self {
        Self { random: Xoshiro256PlusPlus::seed_from_u64(seed), memory, state: 0.0 }
    }

    fn white(&mut self) -> f64 {
        StandardNormal.sample(&mut self.random)
    }

    /// Of deviation 1.
    fn next(&mut self) -> f64 {
        let new = self.white();
        self.state = self.memory * self.state + (1.0 - self.memory * self.memory).sqrt() * new;
        self.state
    }
}

/// Of deviation 1 over time `t` from 0 to 1, about 0.
fn unlisted(name: &str, count: usize, noise: &mut Noise) -> Vec<f64> {
    let line = (0..count).map(|k| k as f64 / count as f64);
    let mut values: Vec<f64> = match name {
        "tone" => line.map(|t| (20.0 * t + 1.0).sin()).collect(),
        "jump" => line.map(|t| f64::from(u8::from(t > 0.55))).collect(),
        _ => {
            let mut sum = 0.0;
            line.map(|_| {
                sum += noise.white();
                sum
            })
            .collect()
        }
    };
    let mean = values.iter().sum::<f64>() / count as f64;
    for v in &mut values {
        *v -= mean;
    }
    let size = (values.iter().map(|v| v * v).sum::<f64>() / count as f64).sqrt();
    for v in &mut values {
        *v /= size;
    }
    values
}

/// `y = 2 + 1.5 x + hidden + noise` of deviation 0.1.
fn signal(seed: u64, memory: f64, hidden: Hidden) -> Discovery {
    const DEVIATION: f64 = 0.1;
    let mut noise = Noise::new(seed, memory);
    let time: Vec<f64> = (0..POINTS).map(|k| 0.01 * k as f64).collect();
    let phases = [noise.white(), noise.white(), noise.white()];
    let wave = |a: f64, w: f64, p: f64, t: &f64| a * (w * t + p).sin();
    let x: Vec<f64> = time
        .iter()
        .map(|t| {
            wave(0.6, 1.3, phases[0], t)
                + wave(0.4, 3.1, phases[1], t)
                + wave(0.3, 7.7, phases[2], t)
        })
        .collect();
    let mut extra = vec![0.0; POINTS];
    match hidden {
        Hidden::Listed(names, size) => {
            for (_, law) in LAWS.iter().filter(|(name, _)| names.contains(name)) {
                let values: Vec<f64> = x.iter().map(|x| law(*x)).collect();
                let mean = values.iter().sum::<f64>() / POINTS as f64;
                let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
                let by = size * DEVIATION / (square / POINTS as f64).sqrt();
                extra.iter_mut().zip(values).for_each(|(e, v)| *e += by * v);
            }
        }
        Hidden::Unlisted(name, size) => {
            let values = unlisted(name, POINTS, &mut noise);
            extra.iter_mut().zip(values).for_each(|(e, v)| *e += size * DEVIATION * v);
        }
    }
    let of = |(x, extra): (&f64, &f64)| 2.0 + 1.5 * x + extra + DEVIATION * noise.next();
    let target = x.iter().zip(&extra).map(of).collect();
    let term = |name: &str| Term::new(name, name, name).amplitude("size", "V", (-10.0, 10.0), 0.1);
    let mut terms = vec![term("constant").always(), term("slope").always()];
    terms.extend(LAWS.iter().map(|(name, _)| term(name)));
    let along = [
        Coordinate::of_state("x", "1", x.clone()),
        Coordinate { state: false, ..Coordinate::of_state("time", "s", time.clone()) },
    ];
    let family = FnFamily::new(terms, time, target, move |given, out| {
        for (term, values) in given.terms() {
            let law = LAWS.iter().find(|(name, _)| *name == term.name).map(|(_, law)| *law);
            for (out, x) in out.iter_mut().zip(&x) {
                let shape = match term.name.as_str() {
                    "constant" => 1.0,
                    "slope" => *x,
                    _ => law.map_or(0.0, |law| law(*x)),
                };
                *out += values[0] * shape;
            }
        }
    });
    let family = along.into_iter().fold(family.predicting("signal", "V"), FnFamily::along);
    found(&family, &[], seed)
}

/// What a tank may have: loss by the square of the level, delay and lag of its pump, a dead zone, an offset, a drift.
#[derive(Clone, Copy, Default)]
struct Tank {
    gain: f64,
    loss: f64,
    square: f64,
    delay: f64,
    lag: f64,
    dead: f64,
    offset: f64,
    drift: f64,
}

/// Level of the tank under an input, each second.
fn level(input: &[f64], tank: &Tank, out: &mut [f64]) {
    let (mut y, mut pump) = (0.0f64, input[0]);
    for (k, level) in out.iter_mut().enumerate().take(input.len()) {
        *level = y + tank.offset + tank.drift * k as f64;
        let late = |by: usize| k.checked_sub(by).map_or(input[0], |k| input[k]);
        let (whole, part) = (tank.delay as usize, tank.delay.fract());
        let u = (1.0 - part) * late(whole) + part * late(whole + 1);
        pump += (u - pump) * if tank.lag > 0.0 { 1.0 - (-1.0 / tank.lag).exp() } else { 1.0 };
        let flow = (pump - tank.dead).max(0.0);
        y += tank.gain * flow - tank.loss * y - tank.square * y * y.abs();
        y = y.clamp(-1e6, 1e6);
    }
}

fn tank(seed: u64, memory: f64, hidden: Hidden) -> Discovery {
    let mut noise = Noise::new(seed, memory);
    let mut input: Vec<f64> = Vec::new();
    while input.len() < POINTS {
        let level = noise.random.random_range(0.0..4.0);
        input.extend(vec![level; noise.random.random_range(10..60)]);
    }
    input.truncate(POINTS);
    let base = Tank { gain: 0.1, loss: 0.05, ..Tank::default() };
    let (mut without, mut with) = (vec![0.0; POINTS], vec![0.0; POINTS]);
    level(&input, &base, &mut without);
    let size = (without.iter().map(|y| y * y).sum::<f64>() / POINTS as f64).sqrt();
    let deviation = 0.01 * size;
    let mut truth = base;
    // What a hidden effect changes is about this many deviations of the noise.
    let mut extra = vec![0.0; POINTS];
    match hidden {
        Hidden::Listed(names, times) => {
            for name in names {
                let field = |tank: &mut Tank, value: f64| match *name {
                    "square" => tank.square = value,
                    "delay" => tank.delay = value,
                    "pump-lag" => tank.lag = value,
                    _ => tank.dead = value,
                };
                // By bisection of its value.
                let (mut low, mut high) = match *name {
                    "square" => (0.0, 0.02),
                    "dead-zone" => (0.0, 0.9),
                    _ => (0.0, 9.0),
                };
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    let mut trial = truth;
                    field(&mut trial, middle);
                    level(&input, &trial, &mut with);
                    let best = {
                        // Least squares of a gain: what the base makes up for is not there.
                        let up: f64 = with.iter().zip(&without).map(|(a, b)| a * b).sum();
                        up / without.iter().map(|b| b * b).sum::<f64>()
                    };
                    let left: f64 =
                        with.iter().zip(&without).map(|(a, b)| (a - best * b).powi(2)).sum();
                    if (left / POINTS as f64).sqrt() < times * deviation {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                field(&mut truth, low);
            }
        }
        Hidden::Unlisted(name, times) => {
            extra = unlisted(name, POINTS, &mut noise);
            for e in &mut extra {
                *e *= times * deviation;
            }
        }
    }
    level(&input, &truth, &mut with);
    let of = |(y, extra): (&f64, &f64)| y + extra + deviation * noise.next();
    let measured: Vec<f64> = with.iter().zip(&extra).map(of).collect();
    let terms = vec![
        Term::new("tank", "an inflow and a loss", "y' = h u - c y")
            .amplitude("h", "m/s", (0.0, 1.0), 0.1)
            .shape("c", "1/s", (5e-3, 0.5), 0.03)
            .always(),
        Term::new("square", "turbulent loss", "-q y |y|").amplitude(
            "q",
            "1/m s",
            (0.0, 0.2),
            0.005,
        ),
        Term::new("delay", "a long pipe", "u(t - d)").shape("d", "s", (0.01, 30.0), 1.0),
        Term::new("pump-lag", "a slow pump", "T q' = u - q").shape("T", "s", (0.05, 60.0), 1.0),
        Term::new("dead-zone", "a pump that sticks", "max(u - z, 0)").shape(
            "z",
            "V",
            (1e-3, 1.0),
            0.1,
        ),
        Term::new("offset", "the sensor's zero", "o").amplitude("o", "m", (-9.0, 9.0), 0.1),
        Term::new("drift", "a sensor that drifts", "d t").amplitude("d", "m/s", (-1.0, 1.0), 1e-3),
    ];
    let time: Vec<f64> = (0..POINTS).map(|k| k as f64).collect();
    let flow = input.clone();
    let along = [
        Coordinate::of_state("pump", "V", flow),
        Coordinate { state: false, ..Coordinate::of_state("time", "s", time.clone()) },
    ];
    let family = FnFamily::new(terms, time, measured, move |given, out| {
        let one = |name: &str| given.of(name).map_or(0.0, |values| values[0]);
        let Some(&[gain, loss]) = given.of("tank") else { return };
        let tank = Tank {
            gain,
            loss,
            square: one("square"),
            delay: one("delay"),
            lag: one("pump-lag"),
            dead: one("dead-zone"),
            offset: one("offset"),
            drift: one("drift"),
        };
        level(&input, &tank, out);
    });
    let family = along.into_iter().fold(family.predicting("level", "m"), FnFamily::along);
    found(&family, &[], seed)
}

fn found(family: &dyn ModelFamily, base: &[&str], seed: u64) -> Discovery {
    let base = base.iter().map(|name| (*name).to_owned()).collect();
    let settings = Settings { base, seed, ..Settings::default() };
    discover(family, &settings, &mut ()).expect("the names are the family's own")
}

/// One row of the table.
fn row(
    name: &str,
    make: fn(u64, f64, Hidden) -> Discovery,
    memory: f64,
    hidden: Hidden,
    seeds: u64,
) {
    let all: Vec<Discovery> =
        (0..seeds).into_par_iter().map(|seed| make(9000 + seed, memory, hidden)).collect();
    let names: &[&str] = match hidden {
        Hidden::Listed(names, _) => names,
        Hidden::Unlisted(..) => &[],
    };
    let count = |is: &dyn Fn(&Discovery) -> bool| all.iter().filter(|found| is(found)).count();
    let is_true = |name: &String| names.contains(&name.as_str());
    let first = count(&|found| found.added.first().is_some_and(is_true));
    let exact = count(&|f| f.added.len() == names.len() && f.added.iter().all(is_true));
    let hedged = |f: &Discovery| f.verdict == Verdict::Ambiguous;
    let wrong = count(&|f| !f.added.iter().all(is_true) && !hedged(f));
    let doubtful = count(&|f| !f.added.iter().all(is_true) && hedged(f));
    let silent = count(&|f| f.added.is_empty());
    let nothing = count(&|f| f.verdict == Verdict::NothingMissing);
    let seconds = all.iter().map(|f| f.wall_s).sum::<f64>() / all.len() as f64;
    let noise = if memory > 0.0 { "coloured" } else { "white" };
    println!(
        "| {name} | {noise} | {} | {first} | {exact} | {wrong} | {doubtful} | {silent} | {nothing} | {seconds:.2} |",
        all.len()
    );
}

/// From a seed, a memory of the noise and what is hidden.
type Make = fn(u64, f64, Hidden) -> Discovery;

fn main() {
    let seeds: u64 = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(12);
    let only = std::env::args().nth(2).unwrap_or_default();
    println!(
        "| hidden | noise | runs | first right | exactly right | wrong, sure | wrong, ambiguous | none named | 'nothing missing' | mean s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let none = Hidden::Listed(&[], 0.0);
    let mut rows: Vec<(String, Make, Hidden, u64)> = vec![
        ("signal: nothing".into(), signal, none, 5 * seeds),
        ("tank: nothing".into(), tank, none, 5 * seeds),
    ];
    for size in [0.2, 0.5, 1.0, 3.0] {
        for one in [&["square"], &["sine"], &["step"]] {
            rows.push((
                format!("signal: {} {size}", one[0]),
                signal,
                Hidden::Listed(one, size),
                seeds,
            ));
        }
        rows.push((
            format!("signal: sine + cosine {size}"),
            signal,
            Hidden::Listed(&["sine", "cosine"], size),
            seeds,
        ));
        for one in [&["square"], &["delay"], &["pump-lag"], &["dead-zone"]] {
            rows.push((format!("tank: {} {size}", one[0]), tank, Hidden::Listed(one, size), seeds));
        }
    }
    for size in [1.0, 5.0] {
        for name in ["tone", "jump", "wandering"] {
            let hidden = Hidden::Unlisted(name, size);
            rows.push((format!("signal: {name} {size}, unlisted"), signal, hidden, seeds));
            rows.push((format!("tank: {name} {size}, unlisted"), tank, hidden, seeds));
        }
    }
    for (name, make, hidden, seeds) in rows {
        if !name.contains(&only) {
            continue;
        }
        for memory in [0.0, MEMORY] {
            row(&name, make, memory, hidden, seeds);
        }
    }
}
