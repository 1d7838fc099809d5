//! The lockstep simulator against a scalar loop and against a kernel, both written by hand for one
//! model: coulomb, viscous, stribeck and presliding.
//!
//! `cargo bench -p benches --bench simulator`. The throughput printed is steps of plants per second;
//! all on one core. `AEP_SIMD=baseline|avx2|avx512` limits the instruction set of the lockstep
//! simulator; the kernel is the best that this machine has.

use std::hint::black_box;

use aep_core::Aep;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use friction_ident::challenge::{self, Hide, Level};
use friction_ident::family::{FrictionFamily, Options};
use friction_ident::{
    Axis, MeasuredMotion, Model, Plants, Start, WindowOptions, columns_along, force_along, paper,
    window_errors,
};
use missing_physics::{Fitted, ModelFamily};

/// Steps of one run.
const STEPS: usize = 2000;
/// Length of a step, s.
const STEP: f64 = 1e-3;
/// Numbers of plants in lockstep.
const LANES: [usize; 4] = [8, 32, 128, 512];

/// The command: slow and fast motion with reversals.
fn commands() -> Vec<f64> {
    let at = |t: f64| 14.0 * (3.0 * t).sin() + 30.0 * (40.0 * t).sin();
    (0..STEPS).map(|k| at(k as f64 * STEP)).collect()
}

/// Parameters of plant `i`.
#[derive(Clone, Copy)]
struct Plant {
    mass: f64,
    coulomb: f64,
    viscous: f64,
    hump: f64,
    speed: f64,
    stiffness: f64,
}

fn plant(i: usize) -> Plant {
    let u = (i as f64 * 0.618_034).fract();
    Plant {
        mass: 25.0 + 20.0 * u,
        coulomb: 6.0 + 4.0 * u,
        viscous: 150.0 + 100.0 * u,
        hump: 2.0 + 2.0 * u,
        speed: 1e-3 + 1e-3 * u,
        stiffness: 1e6 + 1e6 * u,
    }
}

fn model(i: usize) -> Model {
    let p = plant(i);
    Model::new(Axis::Linear, p.mass)
        .and_then(|m| m.with("coulomb", &[("F_C", p.coulomb)]))
        .and_then(|m| m.with("viscous", &[("F_v", p.viscous)]))
        .and_then(|m| m.with("stribeck", &[("dF", p.hump), ("v_s", p.speed)]))
        .and_then(|m| m.with("presliding", &[("k_t", p.stiffness)]))
        .expect("a valid model")
}

/// The same step as the simulator's, for one plant with everything known in advance.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn step(p: &Plant, force: f64, x: f64, v: f64, slope: f64, held: f64) -> (f64, f64, f64, f64) {
    let predicted = v + 0.5 * STEP * slope;
    let square = p.speed * p.speed;
    let level = p.coulomb + p.hump * square / (square + predicted * predicted);
    let start = held.max(-level).min(level);
    let inertia = 2.0 * p.mass + STEP * p.viscous;
    let push = 2.0 * p.mass * v + STEP * force;
    let bend = p.stiffness * STEP;
    let (free, whole) = (push - STEP * start, inertia + 0.5 * bend * STEP);
    let trial = start * whole + bend * free;
    let breaks = trial.abs() > level * whole;
    let slid = level.copysign(trial);
    let sliding = push - 0.5 * STEP * (start + slid);
    let mean = if breaks { sliding } else { free } / if breaks { inertia } else { whole };
    let change = 2.0 * (mean - v);
    let end = if breaks { slid } else { start + bend * mean };
    (x + STEP * mean, v + change, change * (1.0 / STEP), end)
}

/// One plant after the other.
fn scalar(plants: &[Plant], commands: &[f64]) -> f64 {
    let mut sum = 0.0;
    for p in plants {
        let (mut x, mut v, mut slope, mut held) = (0.0, 0.0, 0.0, 0.0);
        for force in commands {
            (x, v, slope, held) = step(p, *force, x, v, slope, held);
        }
        sum += x;
    }
    sum
}

/// State of plants in lockstep.
struct Lanes {
    plants: [Vec<f64>; 6],
    x: Vec<f64>,
    v: Vec<f64>,
    slope: Vec<f64>,
    held: Vec<f64>,
}

impl Lanes {
    fn new(count: usize) -> Self {
        let of = |f: fn(&Plant) -> f64| (0..count).map(|i| f(&plant(i))).collect();
        Self {
            plants: [
                of(|p| p.mass),
                of(|p| p.coulomb),
                of(|p| p.viscous),
                of(|p| p.hump),
                of(|p| p.speed),
                of(|p| p.stiffness),
            ],
            x: vec![0.0; count],
            v: vec![0.0; count],
            slope: vec![0.0; count],
            held: vec![0.0; count],
        }
    }

    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn advance(&mut self, force: f64) {
        let n = self.x.len();
        let [mass, coulomb, viscous, hump, speed, stiffness] =
            self.plants.each_ref().map(|p| &p[..n]);
        let (x, v) = (&mut self.x[..n], &mut self.v[..n]);
        let (slope, held) = (&mut self.slope[..n], &mut self.held[..n]);
        for i in 0..n {
            let p = Plant {
                mass: mass[i],
                coulomb: coulomb[i],
                viscous: viscous[i],
                hump: hump[i],
                speed: speed[i],
                stiffness: stiffness[i],
            };
            (x[i], v[i], slope[i], held[i]) = step(&p, force, x[i], v[i], slope[i], held[i]);
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
fn kernel_avx512(lanes: &mut Lanes, commands: &[f64]) {
    for force in commands {
        lanes.advance(*force);
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn kernel_avx2(lanes: &mut Lanes, commands: &[f64]) {
    for force in commands {
        lanes.advance(*force);
    }
}

#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "the features are detected")]
fn kernel(lanes: &mut Lanes, commands: &[f64]) {
    let wide = is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl");
    let limited = std::env::var("AEP_SIMD").is_ok_and(|set| set == "avx2");
    if wide && !limited {
        // SAFETY: detected above.
        unsafe { kernel_avx512(lanes, commands) }
    } else if is_x86_feature_detected!("avx2") {
        // SAFETY: detected above.
        unsafe { kernel_avx2(lanes, commands) }
    } else {
        for force in commands {
            lanes.advance(*force);
        }
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn kernel(lanes: &mut Lanes, commands: &[f64]) {
    for force in commands {
        lanes.advance(*force);
    }
}

fn lockstep(plants: &mut Plants, commands: &[f64]) -> f64 {
    let lanes = plants.lanes();
    for i in 0..lanes {
        plants.start(i, &Start::default());
    }
    let (duration, mut force) = (vec![STEP; lanes], vec![0.0; lanes]);
    for command in commands {
        force.fill(*command);
        plants.step(&duration, &force);
    }
    plants.position().iter().sum()
}

fn simulators(c: &mut Criterion) {
    let commands = commands();
    let mut group = c.benchmark_group("plants");
    group.sample_size(20);
    for count in LANES {
        group.throughput(Throughput::Elements((count * STEPS) as u64));
        let plants: Vec<Plant> = (0..count).map(plant).collect();
        group.bench_function(format!("scalar loop by hand/{count}"), |b| {
            b.iter(|| scalar(black_box(&plants), &commands));
        });
        group.bench_function(format!("kernel by hand/{count}"), |b| {
            b.iter(|| kernel(black_box(&mut Lanes::new(count)), &commands));
        });
        let models: Vec<Model> = (0..count).map(model).collect();
        let mut plants = Plants::new(&models).expect("plants of one structure");
        group.bench_function(format!("lockstep simulator/{count}"), |b| {
            b.iter(|| lockstep(black_box(&mut plants), &commands));
        });
    }
    group.finish();
}

/// Cost per plant and step with the number of effects.
fn effects(c: &mut Criterion) {
    let commands = commands();
    let mut group = c.benchmark_group("effects");
    group.sample_size(20).throughput(Throughput::Elements((128 * STEPS) as u64));
    let mut model = Model::new(Axis::Linear, 30.0).expect("a valid model");
    for name in
        ["coulomb", "viscous", "presliding", "stribeck", "offset", "asymmetry", "quadratic-drag"]
    {
        model = model.with(name, &[]).expect("a known effect");
        let mut plants = Plants::uniform(&model, 128);
        group.bench_function(format!("{} up to {name}", model.effects().len()), |b| {
            b.iter(|| lockstep(black_box(&mut plants), &commands));
        });
    }
    group.finish();
}

/// The force along 25,000 samples of a measured motion, and its columns.
fn force_along_a_motion(c: &mut Criterion) {
    let time: Vec<f64> = (0..25_000).map(|k| f64::from(k) * 1e-3).collect();
    let x: Vec<f64> = time.iter().map(|t| 0.1 * t.sin()).collect();
    let v: Vec<f64> = time.iter().map(|t| 0.1 * t.cos()).collect();
    let a: Vec<f64> = x.iter().map(|x| -x).collect();
    let motion = MeasuredMotion::new(&time, &x, &v, &a).expect("equally long channels");
    let with = |names: &[&str]| {
        let model = Model::new(Axis::Linear, 30.0).expect("a valid model");
        names.iter().fold(model, |model, name| model.with(name, &[]).expect("a known effect"))
    };
    let plain = with(&["coulomb", "viscous", "offset", "asymmetry", "stribeck", "actuator-lag"]);
    let contact = plain.clone().with("presliding", &[]).expect("a known effect");
    let mut group = c.benchmark_group("force along a motion");
    group.sample_size(20).throughput(Throughput::Elements(25_000));
    for (name, model) in [("6 effects", plain), ("with a contact", contact)] {
        group.bench_function(format!("force, {name}"), |b| {
            b.iter(|| force_along(black_box(&model), &motion));
        });
        group.bench_function(format!("columns, {name}"), |b| {
            b.iter(|| columns_along(black_box(&model), &motion));
        });
    }
    group.finish();
}

/// Windows of a challenge at the truth.
fn windows(c: &mut Criterion) {
    let made = challenge::generate(&Hide::Nothing, 1, Level::Clear).expect("a challenge");
    let mut group = c.benchmark_group("windows");
    group.sample_size(10).throughput(Throughput::Elements(made.recording.len() as u64));
    for length in [0.1, 0.5] {
        let options = WindowOptions::new(length);
        group.bench_function(format!("of {length} s"), |b| {
            b.iter(|| window_errors(&made.truth.model, black_box(&made.recording), &options));
        });
    }
    group.finish();
}

/// Models predicted one sample ahead along a challenge of 20 s, on one thread: pieces of the recording in strips beside each other,
/// so that several models take little longer than one. The throughput printed is predictions per second.
fn predictions(c: &mut Criterion) {
    let made = challenge::generate(&Hide::Nothing, 1, Level::Clear).expect("a challenge");
    let family = FrictionFamily::new(&made.recording, &Options::default()).expect("a family");
    let ahead = family.ahead().expect("it is predicted one sample ahead");
    let terms: Vec<usize> = (0..family.terms().len())
        .filter(|k| {
            let term = &family.terms()[*k];
            term.always || ["coulomb", "viscous", "stribeck"].contains(&term.name.as_str())
        })
        .collect();
    let values = terms.iter().flat_map(|k| family.terms()[*k].parameters.iter().map(|p| p.start));
    let model = Fitted { values: values.collect(), terms };
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let mut group = c.benchmark_group("one sample ahead");
    group.sample_size(10);
    for count in [1, 5, 16] {
        let models: Vec<(Fitted, usize)> = (0..count)
            .map(|k| {
                let mut model = model.clone();
                model.values[0] *= 1.0 + 0.01 * k as f64;
                (model, 2)
            })
            .collect();
        group.throughput(Throughput::Elements((count * ahead.instants().len()) as u64));
        group.bench_function(format!("models/{count}"), |b| {
            b.iter(|| one_thread.install(|| ahead.errors(black_box(&models))));
        });
    }
    group.finish();
}

/// The paper's identification: 8 parameters, 8,000 samples, 40 individuals, 250 generations; on all
/// cores.
fn identification(c: &mut Criterion) {
    let table = paper::table().expect("the paper's table");
    let data = paper::training_data(&table, paper::SAMPLE_TIME).expect("a recording");
    let task = paper::task(&data, paper::SAMPLE_TIME).expect("a task");
    let mut group = c.benchmark_group("identification");
    group.sample_size(10);
    group.bench_function("40 individuals, 250 generations", |b| {
        b.iter(|| paper::identify(&task, &Aep::practical(), paper::GENERATIONS, 1));
    });
    group.finish();
}

criterion_group!(
    benches,
    simulators,
    effects,
    force_along_a_motion,
    windows,
    predictions,
    identification
);
criterion_main!(benches);
