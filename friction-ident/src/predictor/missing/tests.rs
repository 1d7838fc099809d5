use missing_physics::{Channel, Hold, Recording};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::*;
use crate::predictor::tests::{DAMPING, MASS, best, rms, table};
use crate::simulator::{Input, Start, simulate};

/// Standard deviation of the position, m: noise, or counts as coarse.
const NOISE: f64 = 1e-6;
const COUNTS: f64 = 3.5e-6;
const FINE: f64 = 1e-8;
const SAMPLES: u32 = 8000;

fn even() -> Vec<f64> {
    (0..SAMPLES).map(|k| f64::from(k) * 1e-3).collect()
}

fn irregular() -> Vec<f64> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
    let jitter = |k| (f64::from(k) + random.random_range(-0.4..0.4)) * 1e-3;
    (0..SAMPLES).map(jitter).collect()
}

/// What is found beside the plain table of a run of `truth` on which a force acts that was not recorded, and what
/// acts there beyond the plain table at each of its instants.
struct Run {
    found: Series,
    truth: Vec<f64>,
}

struct Case<'a> {
    truth: &'a Model,
    /// The model that is run, and the mass that the gains are made for.
    model: &'a Model,
    mass: f64,
    time: Vec<f64>,
    hidden: &'a dyn Fn(f64) -> f64,
    /// What `truth` has beyond the plain table, by its velocity.
    friction: &'a dyn Fn(f64) -> f64,
}

impl Case<'_> {
    fn run(self) -> Run {
        let command = |t: &f64| 24.0 * (5.0 * t).sin() + 12.0 * (13.0 * t + 1.0).sin();
        let force: Vec<f64> = self.time.iter().map(command).collect();
        let acting: Vec<f64> =
            self.time.iter().zip(&force).map(|(t, force)| force + (self.hidden)(*t)).collect();
        let input = Input::new(&self.time, &acting, Hold::ZeroOrder).with_max_step(5e-5);
        let out = simulate(self.truth, &input, &Start::at(0.0, 0.0)).unwrap();
        let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        // The size of noise is not known between irregular samples, that of counts is.
        let regular = (self.time[1] - self.time[0] - 1e-3).abs() < 1e-9;
        let (noise, count) = if regular { (NOISE, FINE) } else { (0.0, COUNTS) };
        let shown = |x: &f64| ((x + noise * normal()) / count).round() * count;
        let channels = vec![
            Channel::new("force", "N", force),
            Channel::new("position", "m", out.position.iter().map(shown).collect()),
        ];
        let recording = Recording::new("hidden", self.time.clone(), channels).unwrap();
        let recording = recording.with_hold(Hold::ZeroOrder);
        let predictor = Predictor::new(&recording, self.mass, DAMPING).unwrap();
        let setting = best(&predictor, self.model).0;
        let found = predictor.missing_force(self.model, setting).unwrap();
        let before = |end: &f64| self.time.partition_point(|t| t < end) - 1;
        let truth = |end: &f64| {
            let k = before(end);
            (self.hidden)(self.time[k]) + (self.friction)(out.velocity[k])
        };
        let truth = found.time.iter().map(truth).collect();
        Run { found, truth }
    }
}

impl Run {
    /// Instants at which the force is known, as indices.
    fn known(&self) -> Vec<usize> {
        (0..self.truth.len()).filter(|k| self.found.known[*k]).collect()
    }

    /// Root mean squares of the force, of its error and of its standard deviation, and the share of the time that it is
    /// within two of these.
    fn sizes(&self) -> (f64, f64, f64, f64) {
        let known = self.known();
        let error = |k: &usize| self.found.force[*k] - self.truth[*k];
        let of = |f: &dyn Fn(&usize) -> f64| rms(&known.iter().map(f).collect::<Vec<_>>());
        let inside = known.iter().filter(|k| error(k).abs() < 2.0 * self.found.deviation[**k]);
        (
            of(&|k| self.found.force[*k]),
            of(&|k| error(k)),
            of(&|k| self.found.deviation[*k]),
            inside.count() as f64 / known.len() as f64,
        )
    }
}

fn hidden(time: Vec<f64>, hidden: &dyn Fn(f64) -> f64) -> Run {
    let table = table();
    Case { truth: &table, model: &table, mass: MASS, time, hidden, friction: &|_| 0.0 }.run()
}

#[test]
fn beside_the_true_model_nothing_is_missing() {
    for time in [even(), irregular()] {
        let run = hidden(time, &|_| 0.0);
        let (size, _, deviation, inside) = run.sizes();
        // 19 N act.
        assert!(size < 0.02 && deviation < 0.05, "{size} {deviation}");
        assert!(inside > 0.95, "{inside}");
        assert!(run.known().len() > run.truth.len() * 8 / 10);
    }
}

#[test]
fn a_step_of_3_n_is_recovered_within_its_band() {
    for time in [even(), irregular()] {
        let run = hidden(time, &|t| if t > 4.0 { 3.0 } else { 0.0 });
        let (size, error, deviation, inside) = run.sizes();
        assert!((size - 2.1).abs() < 0.15 && error < 0.15, "{size} {error}");
        assert!(deviation < 0.3 && inside > 0.95, "{deviation} {inside}");
    }
}

#[test]
fn a_slow_sine_is_recovered_within_its_band() {
    for time in [even(), irregular()] {
        let run = hidden(time, &|t| 2.0 * (3.0 * t).sin());
        let (_, error, deviation, inside) = run.sizes();
        assert!(error < 0.1 && deviation < 0.15 && inside > 0.95, "{error} {deviation} {inside}");
    }
}

#[test]
fn a_hump_at_low_speed_is_recovered_within_its_band_where_the_table_turns_too() {
    let truth = table().with("stribeck", &[("dF", 4.0), ("v_s", 1e-2)]).unwrap();
    let hump = |v: f64| -4.0 * v.signum() / (1.0 + (v / 1e-2).powi(2));
    let (model, time) = (&table(), even());
    let case = Case { truth: &truth, model, mass: MASS, time, hidden: &|_| 0.0, friction: &hump };
    let run = case.run();
    let (size, error, deviation, inside) = run.sizes();
    assert!(size > 1.0 && error < 0.35 && deviation < 0.5, "{size} {error} {deviation}");
    assert!(inside > 0.93, "{inside}");
}

#[test]
fn gains_for_a_mass_that_is_a_tenth_off_make_a_force_that_is_so_too() {
    let (table, time) = (table(), even());
    let sine = |t: f64| 2.0 * (3.0 * t).sin();
    let case = Case {
        truth: &table,
        model: &table,
        mass: 1.1 * MASS,
        time,
        hidden: &sine,
        friction: &|_| 0.0,
    };
    let run = case.run();
    let ratio = run.sizes().0 / rms(&run.known().iter().map(|k| run.truth[*k]).collect::<Vec<_>>());
    assert!((1.05..1.12).contains(&ratio), "{ratio}");
}

#[test]
fn beside_a_contact_or_a_coupling_it_is_recovered_too() {
    let load: &[(&str, f64)] = &[("m_L", 12.0), ("f", 60.0), ("zeta", 0.05)];
    let cases = [
        (table().with("presliding", &[("k_t", 2e6)]).unwrap(), MASS),
        (table().with("presliding", &[("k_t", 2e4)]).unwrap(), MASS),
        (table().with("flexible-coupling", load).unwrap(), MASS + 12.0),
    ];
    for (model, mass) in &cases {
        let sine = |t: f64| 2.0 * (3.0 * t).sin();
        let case = Case {
            truth: model,
            model,
            mass: *mass,
            time: even(),
            hidden: &sine,
            friction: &|_| 0.0,
        };
        let (_, error, deviation, inside) = case.run().sizes();
        assert!(error < 0.15 && deviation < 0.2 && inside > 0.95, "{error} {deviation} {inside}");
    }
}

#[test]
fn while_the_model_rests_the_band_is_as_wide_as_the_force() {
    let run = hidden(even(), &|_| 0.0);
    let resting: Vec<usize> = (0..run.truth.len()).filter(|k| !run.found.known[*k]).collect();
    assert!(resting.len() > 50, "{}", resting.len());
    let recorded = rms(&run.found.recorded);
    for k in resting {
        assert!(run.found.deviation[k] > 0.9 * recorded && run.found.force[k] == 0.0);
    }
}

#[test]
fn samples_that_only_repeat_the_one_before_are_no_measurements() {
    let command = |t: &f64| 24.0 * (5.0 * t).sin();
    let force: Vec<f64> = even().iter().map(command).collect();
    let input_time = even();
    let input = Input::new(&input_time, &force, Hold::ZeroOrder).with_max_step(5e-5);
    let out = simulate(&table(), &input, &Start::at(0.0, 0.0)).unwrap();
    let counted = |x: &f64| (x / COUNTS).round() * COUNTS;
    let mut position: Vec<f64> = out.position.iter().map(counted).collect();
    for k in (7..position.len()).step_by(40) {
        position[k] = position[k - 1];
    }
    let channels = vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
    let recording = Recording::new("dropped", even(), channels).unwrap();
    let predictor = Predictor::new(&recording.with_hold(Hold::ZeroOrder), MASS, DAMPING).unwrap();
    assert!(predictor.stale() > 0.01);
    let setting = best(&predictor, &table()).0;
    let found = predictor.missing_force(&table(), setting).unwrap();
    assert!(rms(&found.force) < 0.1, "{}", rms(&found.force));
}

#[test]
fn nothing_is_said_of_a_model_that_runs_away() {
    let time = even();
    let force: Vec<f64> = time.iter().map(|t| 10.0 * (5.0 * t).sin()).collect();
    let position: Vec<f64> = time.iter().map(|t| 0.01 * (5.0 * t).sin()).collect();
    let channels = vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
    let recording = Recording::new("none", time, channels).unwrap().with_hold(Hold::ZeroOrder);
    let predictor = Predictor::new(&recording, MASS, DAMPING).unwrap();
    let mut model = table();
    model.set("mass", 1e-300).unwrap();
    let found = predictor.missing_force(&model, 0);
    assert!(found.is_none_or(|found| found.force.iter().all(|force| force.is_finite())));
}
