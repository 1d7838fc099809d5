//! What does a linear model of two coupled electric drives lack? A subject without any friction.
//!
//! Two motors drive a pulley through a flexible belt; a sensor measures the pulley's speed. The engine
//! knows nothing of drives. It is given a linear model (a lag of the motors, a resonance of the belt) and
//! what else could lie between input and sensor, and it names what is missing.
//!
//! The data: T. Wigren, M. Schoukens, Coupled electric drives data set and reference models, Uppsala
//! University 2017, free for benchmarking; their sensor returns |speed|. Without the file such a drive is
//! simulated; and a drive whose sensor keeps the sign, in any case.
//!
//! `cargo run --release -p missing-physics --example coupled_drives [FILE [INPUT OUTPUT]]`

use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

use aep_core::Scale;
use missing_physics::{
    Coordinate, Fitted, ModelFamily, Parameter, Quantity, Regime, Role, Settings, Term, discover,
};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Where the recordings lie beside a checkout, if they do.
const DATA: &str = "../shared/data/coupled-drives/ced_prbs.csv";
/// Sampling interval, s.
const INTERVAL: f64 = 0.02;
/// Steps of the integration per sample.
const STEPS: usize = 10;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |k: usize, default: &str| words.get(k).map_or(default, String::as_str).to_owned();
    let path = word(0, DATA);
    if Path::new(&path).exists() {
        let (input, output) = (word(1, "u1_V"), word(2, "z1_V"));
        println!("== Measured: {output} from {input}");
        let (u, z) = read(Path::new(&path), &input, &output)?;
        tell(&Drives::new(u, z))?;
    } else {
        println!("== Simulated, as {path} is not there: a sensor that returns |speed|");
        let (u, z) = simulated(f64::abs);
        let first = tell(&Drives::new(u, z))?;
        known(first.as_deref(), Some("rectifying-sensor"))?;
    }
    println!("\n== Simulated: a sensor that keeps the sign");
    let (u, z) = simulated(|speed| speed);
    known(tell(&Drives::new(u, z))?.as_deref(), None)
}

/// Fails where a known truth was not found.
fn known(found: Option<&str>, truth: Option<&str>) -> Result<(), Box<dyn Error>> {
    if found == truth { Ok(()) } else { Err(format!("{found:?} instead of {truth:?}").into()) }
}

/// Prints what a discovery says; the first effect that it added.
fn tell(drives: &Drives) -> Result<Option<String>, Box<dyn Error>> {
    let settings = Settings { base: vec!["dynamics".into()], ..Settings::default() };
    let found = discover(drives, &settings, &mut ())?;
    println!("What the linear model lacks, candidates best first:");
    for candidate in found.ranking.first().into_iter().flatten() {
        let (gain, p) = (100.0 * candidate.gain, candidate.p_value);
        println!("{:>18}  gain {gain:6.1} %  p {p:.3}", candidate.effect);
    }
    println!("The ladder:");
    for rung in &found.ladder {
        let error = 100.0 * rung.error["speed_relative"].validation;
        let name = rung.added.as_deref().unwrap_or("linear model");
        println!("{name:>18}  {error:5.1} % of the held-out signal left");
    }
    println!("{:?} in {:.1} s: {}", found.verdict, found.wall_s, found.summary);
    Ok(found.added.first().cloned())
}

/// What a candidate adds to the signal; `x` is the speed of a drive of its own with gain 1.
const CANDIDATES: [(&str, &str, &str); 6] = [
    ("rectifying-sensor", "the sensor loses the sign", "c |x|, c >= 0"),
    ("curved-sensor", "the sensor is not straight", "c x^2"),
    ("dead-zone", "the sensor does not see small speeds", "c sgn(x) max(|x| - d, 0)"),
    ("delay", "a part arrives late", "c x(t - T)"),
    ("offset", "the sensor is not zero at rest", "c"),
    ("drift", "the sensor's zero wanders", "c t"),
];

/// A recording of the drives as a model family. The signal is `gain x + candidates`.
struct Drives {
    terms: Vec<Term>,
    time: Vec<f64>,
    input: Vec<f64>,
    target: Vec<f64>,
    doubt: Vec<f64>,
    coordinates: Vec<Coordinate>,
    regimes: Vec<Regime>,
}

impl Drives {
    fn new(input: Vec<f64>, target: Vec<f64>) -> Self {
        let time: Vec<f64> = (0..input.len()).map(|k| INTERVAL * k as f64).collect();
        let coordinate = |name: &str, unit: &str, values: Vec<f64>, state| Coordinate {
            name: name.into(),
            unit: unit.into(),
            values,
            parity: None,
            state,
        };
        let coordinates = vec![
            coordinate("input", "V", input.clone(), true),
            coordinate("input, smoothed", "V", smoothed(&input, 0.2), true),
            coordinate("time", "s", time.clone(), false),
        ];
        let settled = |k: usize| (k.saturating_sub(25)..k).all(|j| input[j] == input[k]);
        let regime = |name: &str, wanted| Regime {
            name: name.into(),
            member: (0..input.len()).map(|k| settled(k) == wanted).collect(),
        };
        let regimes = vec![regime("after a step", false), regime("settled", true)];
        let doubt = vec![0.0; target.len()];
        let mut terms = vec![term(("dynamics", "linear drive", "gain x"))];
        terms.extend(CANDIDATES.map(term));
        Self { terms, time, input, target, doubt, coordinates, regimes }
    }

    /// What a term adds to the signal.
    fn signal(&self, term: &Term, values: &[f64]) -> Vec<f64> {
        let c = values[0];
        let of_speed = |law: &dyn Fn(f64) -> f64| -> Vec<f64> {
            speed(&self.input, &values[1..4]).into_iter().map(|x| c * law(x)).collect()
        };
        match term.name.as_str() {
            "rectifying-sensor" => of_speed(&f64::abs),
            "curved-sensor" => of_speed(&|x| x * x),
            "dead-zone" => of_speed(&|x| x.signum() * (x.abs() - values[4]).max(0.0)),
            "delay" => late(&of_speed(&|x| x), values[4] / INTERVAL),
            "offset" => vec![c; self.time.len()],
            "drift" => self.time.iter().map(|t| c * t).collect(),
            _ => of_speed(&|x| x),
        }
    }
}

/// A term with its amplitude and, where it looks at a speed, a drive of its own.
///
/// The inputs swing symmetrically, so that a linear model of a signal without sign has no gain: what a
/// sensor makes of *its* speed says nothing. With dynamics as shapes of each candidate the engine
/// profiles them together with what the sensor does.
fn term((name, title, equation): (&str, &str, &str)) -> Term {
    let parameter = |name: &str, unit: &str, role, range: (f64, f64), start| Parameter {
        name: name.into(),
        unit: unit.into(),
        role,
        lower: range.0,
        upper: range.1,
        scale: if role == Role::Shape { Scale::Log } else { Scale::Linear },
        start,
    };
    let lower = if name == "rectifying-sensor" { 0.0 } else { -20.0 };
    let size = if name == "dynamics" { "gain" } else { "c" };
    let mut parameters = vec![parameter(size, "V", Role::Amplitude, (lower, 20.0), 1.0)];
    if !matches!(name, "offset" | "drift") {
        parameters.extend([
            parameter("tau", "s", Role::Shape, (0.03, 1.0), 0.2),
            parameter("f", "Hz", Role::Shape, (0.5, 10.0), 2.0),
            parameter("zeta", "1", Role::Shape, (0.05, 1.0), 0.3),
        ]);
    }
    match name {
        "dead-zone" => parameters.push(parameter("d", "V", Role::Shape, (0.05, 0.8), 0.2)),
        "delay" => parameters.push(parameter("T", "s", Role::Shape, (0.02, 0.4), 0.1)),
        _ => {}
    }
    Term {
        name: name.into(),
        title: title.into(),
        equation: equation.into(),
        parameters,
        always: name == "dynamics",
    }
}

/// Speed of a drive of gain 1: `tau w' + w = u`, `x'' + 2 zeta omega x' + omega^2 x = omega^2 w`.
fn speed(input: &[f64], shape: &[f64]) -> Vec<f64> {
    let (tau, omega, zeta) = (shape[0], TAU * shape[1], shape[2]);
    let step = INTERVAL / STEPS as f64;
    let lag = 1.0 - (-step / tau).exp();
    let (mut motor, mut x, mut slope) = (0.0, 0.0, 0.0);
    let advance = |u: &f64| {
        let now = x;
        for _ in 0..STEPS {
            motor += lag * (u - motor);
            slope += step * omega * (omega * (motor - x) - 2.0 * zeta * slope);
            x += step * slope;
        }
        now
    };
    input.iter().map(advance).collect()
}

/// A signal `samples` later, linear between them.
fn late(signal: &[f64], samples: f64) -> Vec<f64> {
    let at = |k: f64| if k < 0.0 { 0.0 } else { signal[k as usize] };
    let value = |k: usize| {
        let from = k as f64 - samples;
        let part = from - from.floor();
        (1.0 - part) * at(from.floor()) + part * at(from.ceil())
    };
    (0..signal.len()).map(value).collect()
}

fn smoothed(signal: &[f64], tau: f64) -> Vec<f64> {
    let (lag, mut state) = (1.0 - (-INTERVAL / tau).exp(), 0.0);
    let advance = |value: &f64| {
        state += lag * (value - state);
        state
    };
    signal.iter().map(advance).collect()
}

impl ModelFamily for Drives {
    fn terms(&self) -> &[Term] {
        &self.terms
    }
    fn quantity(&self) -> Quantity {
        Quantity { name: "speed".into(), unit: "V".into() }
    }
    fn time(&self) -> &[f64] {
        &self.time
    }
    fn target(&self) -> &[f64] {
        &self.target
    }
    fn doubt(&self) -> &[f64] {
        &self.doubt
    }
    fn predict(&self, model: &Fitted, out: &mut [f64]) {
        out.fill(0.0);
        for (position, &index) in model.terms.iter().enumerate() {
            let values = &model.values[model.range(self, position)];
            let signal = self.signal(&self.terms[index], values);
            out.iter_mut().zip(signal).for_each(|(out, value)| *out += value);
        }
    }
    fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }
    fn regimes(&self) -> &[Regime] {
        &self.regimes
    }
    fn motion(&self) -> Vec<Vec<f64>> {
        vec![self.input.clone()]
    }
}

/// A drive under a random binary input, seen by `sensor` with noise of 0.05 V.
fn simulated(sensor: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut input = Vec::new();
    while input.len() < 500 {
        let level = if random.random_bool(0.5) { 1.0 } else { -1.0 };
        input.extend(vec![level; random.random_range(10..40)]);
    }
    input.truncate(500);
    let noise = |random: &mut Xoshiro256PlusPlus| -> f64 { StandardNormal.sample(random) };
    let speeds = speed(&input, &[0.17, 3.2, 0.15]);
    let seen = speeds.iter().map(|x| sensor(1.9 * x) + 0.05 * noise(&mut random)).collect();
    (input, seen)
}

/// Two columns of a CSV file.
fn read(path: &Path, input: &str, output: &str) -> Result<(Vec<f64>, Vec<f64>), Box<dyn Error>> {
    let text = std::fs::read_to_string(path)?;
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column = |name: &str| {
        let found = header.iter().position(|have| *have == name);
        found.ok_or_else(|| format!("no column '{name}'; there are: {}", header.join(", ")))
    };
    let (from, to) = (column(input)?, column(output)?);
    let mut both = (Vec::new(), Vec::new());
    for line in lines {
        let row = line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        let missing = || format!("a row of {} fields, {} are needed", row.len(), header.len());
        both.0.push(*row.get(from).ok_or_else(missing)?);
        both.1.push(*row.get(to).ok_or_else(missing)?);
    }
    Ok(both)
}
