//! The engine on a family that has nothing to do with friction: smooth functions of one coordinate,
//! autocorrelated noise.

use std::collections::BTreeMap;

use missing_physics::report::{Remains, Verdict};
use missing_physics::{
    ComparedQuantity, Coordinate, Discovery, Fitted, ModelFamily, Regime, Role, Settings, Term,
    TermParameter, confirm, discover,
};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

const POINTS: usize = 900;
const INTERVAL: f64 = 0.01;

type Law = fn(f64) -> f64;

/// Signals that candidates are made of: functions of a coordinate that wanders.
const CANDIDATES: [(&str, Law); 5] = [
    ("square", |x| x * x),
    ("cube", |x| x * x * x),
    ("sine", |x| (5.0 * x).sin()),
    ("cosine", |x| (9.0 * x).cos()),
    ("step", |x| f64::from(u8::from(x > 0.4))),
];

struct Family {
    terms: Vec<Term>,
    time: Vec<f64>,
    x: Vec<f64>,
    target: Vec<f64>,
    doubt: Vec<f64>,
    colour: Vec<f64>,
    noise: Option<f64>,
    coordinates: Vec<Coordinate>,
    regimes: Vec<Regime>,
}

fn term(name: &str, always: bool, lower: f64) -> Term {
    let parameter = TermParameter {
        name: "size".into(),
        unit: "V".into(),
        role: Role::Amplitude,
        lower,
        upper: 10.0,
        scale: aep_core::Scale::Linear,
        start: 0.1,
    };
    Term {
        name: name.into(),
        title: name.into(),
        equation: name.into(),
        parameters: vec![parameter],
        always,
    }
}

impl Family {
    /// `y = 2 + 1.5 x + hidden + noise`, the noise autocorrelated over about ten samples.
    fn new(seed: u64, noise: f64, hidden: impl Fn(f64, f64) -> f64) -> Self {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut normal = move || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..POINTS).map(|k| k as f64 * INTERVAL).collect();
        let phases = [normal(), normal(), normal()];
        let x: Vec<f64> = time
            .iter()
            .map(|t| {
                0.6 * (1.3 * t + phases[0]).sin()
                    + 0.4 * (3.1 * t + phases[1]).sin()
                    + 0.3 * (7.7 * t + phases[2]).sin()
            })
            .collect();
        let (memory, mut state) = (0.9f64, 0.0);
        let target = time
            .iter()
            .zip(&x)
            .map(|(t, x)| {
                state = memory * state + (1.0 - memory * memory).sqrt() * normal();
                2.0 + 1.5 * x + hidden(*t, *x) + noise * state
            })
            .collect();
        let mut terms = vec![term("constant", true, -10.0), term("slope", false, -10.0)];
        terms.extend(CANDIDATES.iter().map(|(name, _)| term(name, false, -10.0)));
        let coordinate = |name: &str, values: &[f64], state| Coordinate {
            name: name.into(),
            unit: "1".into(),
            values: values.to_vec(),
            parity: None,
            state,
        };
        let coordinates = vec![coordinate("x", &x, true), coordinate("time", &time, false)];
        let regimes = vec![
            Regime { name: "low".into(), member: x.iter().map(|x| *x < 0.0).collect() },
            Regime { name: "high".into(), member: x.iter().map(|x| *x >= 0.0).collect() },
        ];
        let (doubt, colour, noise) = (vec![0.0; POINTS], Vec::new(), None);
        Self { terms, time, x, target, doubt, colour, noise, coordinates, regimes }
    }

    /// The same, saying what colour its noise has.
    fn with_colour(mut self) -> Self {
        self.colour = (1..100).map(|lag| 0.9f64.powi(lag)).collect();
        self
    }

    fn discover(&self, seed: u64) -> Discovery {
        let settings = Settings { base: vec!["slope".into()], seed, ..Settings::default() };
        discover(self, &settings, &mut ()).unwrap()
    }
}

impl ModelFamily for Family {
    fn terms(&self) -> &[Term] {
        &self.terms
    }
    fn quantity(&self) -> ComparedQuantity {
        ComparedQuantity { name: "signal".into(), unit: "V".into() }
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
        for (out, x) in out.iter_mut().zip(&self.x) {
            *out = model
                .terms
                .iter()
                .zip(&model.values)
                .map(|(&term, value)| match term {
                    0 => *value,
                    1 => value * x,
                    k => value * CANDIDATES[k - 2].1(*x),
                })
                .sum();
        }
    }
    fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }
    fn regimes(&self) -> &[Regime] {
        &self.regimes
    }
    fn motion(&self) -> Vec<Vec<f64>> {
        vec![self.x.clone()]
    }
    fn colour(&self) -> Vec<f64> {
        self.colour.clone()
    }
    fn noise(&self) -> BTreeMap<String, f64> {
        self.noise.map(|noise| ("signal_V".to_owned(), noise)).into_iter().collect()
    }
}

#[test]
fn where_nothing_is_missing_effects_are_added_at_most_at_the_stated_rate() {
    // At a true rate of 5 % more than 8 of 60 happen with a probability of 0.3 %.
    let alarms = (0..60)
        .filter(|&seed| {
            let found = Family::new(seed, 0.1, |_, _| 0.0).discover(seed);
            !found.added.is_empty()
        })
        .count();
    assert!(alarms <= 8, "{alarms} false alarms in 60");
}

#[test]
fn a_hidden_term_is_the_first_one_added_and_its_size_is_right() {
    for (index, (name, law)) in CANDIDATES.iter().enumerate() {
        for seed in 0..4 {
            let family = Family::new(100 + seed, 0.05, |_, x| 0.4 * law(x));
            let found = family.discover(seed);
            assert_eq!(found.added.first().map(String::as_str), Some(*name), "{name} {seed}");
            let size = &found.ladder[1].parameters[&format!("{name}.size")];
            assert!((size.value - 0.4).abs() < 0.1, "{name} {seed}: {size:?}, candidate {index}");
            assert!(size.identifiable && size.low < size.value && size.value < size.high);
        }
    }
}

#[test]
fn two_hidden_terms_are_both_found_and_the_error_falls_to_the_noise() {
    for seed in 0..6 {
        let family =
            Family::new(200 + seed, 0.05, |_, x| 0.4 * (5.0 * x).sin() + 0.3 * (9.0 * x).cos());
        let found = family.discover(seed);
        let mut added = found.added.clone();
        added.sort();
        assert_eq!(added, ["cosine", "sine"], "seed {seed}: {:?}", found.remains);
        assert_eq!(found.verdict, Verdict::EffectsFound);
        let error = found.ladder.last().unwrap().error["signal_rms_V"].validation;
        assert!(error < 0.08, "{error}");
    }
}

#[test]
fn structure_that_no_candidate_explains_is_called_so_with_its_coordinate() {
    let mut called = 0;
    for seed in 0..6 {
        // Periodic in time: no function of x.
        let family = Family::new(300 + seed, 0.02, |t, _| 0.4 * (2.5 * t).sin());
        let found = family.discover(seed);
        let first = &found.where_it_fails[0];
        if found.verdict == Verdict::Unexplained && first.coordinate == "time" {
            called += 1;
        }
    }
    assert!(called >= 5, "{called} of 6");
}

#[test]
fn an_error_in_a_part_of_the_time_alone_is_told_with_its_time() {
    for seed in 0..3 {
        // So quick that it is a function of nothing.
        let quick = |t: f64| if (3.0..4.5).contains(&t) { 0.3 * (1e5 * t * t).sin() } else { 0.0 };
        let found = Family::new(500 + seed, 0.02, |t, _| quick(t)).discover(seed);
        assert_eq!(found.verdict, Verdict::Unexplained, "{:?}", found.remains);
        assert!(!found.budget.unwrap().complete);
        let at = |remains: &Remains| match remains {
            Remains::ErrorNear { coordinate, at, .. } => {
                coordinate == "time" && (2.9..4.6).contains(at)
            }
            Remains::Structure { place } => place.coordinate == "time",
            _ => false,
        };
        assert!(found.remains.iter().any(at), "{:?}", found.remains);
    }
}

#[test]
fn noise_of_a_colour_that_was_stated_lacks_nothing_and_of_another_one_nobody_says_so() {
    let verdict = |family: Family, seed| family.discover(seed).verdict;
    let (mut told, mut claimed) = (0, 0);
    for seed in 0..20 {
        let stated = Family::new(seed, 0.1, |_, _| 0.0).with_colour();
        told += usize::from(verdict(stated, seed) == Verdict::NothingMissing);
        let unstated = verdict(Family::new(seed, 0.1, |_, _| 0.0), seed);
        claimed += usize::from(unstated == Verdict::NothingMissing);
    }
    assert!(told >= 16, "{told} of 20");
    assert_eq!(claimed, 0);
}

#[test]
fn an_effect_as_large_as_noise_of_a_colour_that_nobody_stated_is_named() {
    // Whitened, what is slow of an effect is a small part of the errors.
    let named = |seed: &u64| {
        let family = Family::new(*seed, 0.1, |_, x| 0.14 * (5.0 * x).sin());
        family.discover(*seed).added == ["sine"]
    };
    let named = (0..12).filter(named).count();
    assert!(named >= 10, "{named} of 12");
}

#[test]
fn where_the_output_is_as_quick_as_what_is_left_only_stated_noise_makes_a_model_complete() {
    let coarse = |noise: Option<f64>| {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
        let mut family = Family::new(3, 0.0, |_, _| 0.0);
        family.noise = noise;
        // From one sample to the next the coordinate is anywhere.
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        for (x, y) in family.x.iter_mut().zip(&mut family.target) {
            *x = normal();
            *y = 2.0 + 1.5 * *x + 0.1 * normal();
        }
        family.coordinates.retain(|coordinate| !coordinate.state);
        family.discover(1)
    };
    let unknown = coarse(None);
    assert_eq!(unknown.verdict, Verdict::Unexplained);
    assert_eq!(unknown.remains.first(), Some(&Remains::TooCoarse));
    assert_eq!(coarse(Some(0.1)).verdict, Verdict::NothingMissing);
    assert_eq!(coarse(Some(0.05)).verdict, Verdict::Unexplained);
}

#[test]
fn what_was_found_holds_on_another_recording_and_what_is_not_there_does_not() {
    let found = Family::new(1, 0.05, |_, x| 0.4 * (5.0 * x).sin()).discover(1);
    assert_eq!(found.added, ["sine"]);
    let settings = Settings { base: vec!["slope".into()], ..Settings::default() };
    let holds = |other: &Family| confirm(other, &found.ladder, &settings).unwrap()[1].holds;
    assert_eq!(holds(&Family::new(2, 0.05, |_, x| 0.4 * (5.0 * x).sin())), Some(true));
    assert_eq!(holds(&Family::new(3, 0.05, |_, _| 0.0)), Some(false));
}

#[test]
fn the_same_seed_gives_the_same_discovery_on_one_thread_and_on_two() {
    let family = Family::new(7, 0.05, |_, x| 0.4 * x * x);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut found = pool.install(|| family.discover(3));
        found.wall_s = 0.0;
        found
    };
    assert_eq!(on(1), on(2));
}

#[test]
fn shares_of_the_regimes_sum_to_one() {
    let found = Family::new(1, 0.1, |_, x| x * x).discover(1);
    let sum = |pick: fn(&missing_physics::report::RegimeShare) -> f64| {
        found.regimes_base.iter().map(pick).sum::<f64>()
    };
    assert!((sum(|r| r.share) - 1.0).abs() < 1e-12);
    assert!((sum(|r| r.time_share) - 1.0).abs() < 1e-12);
}

#[test]
fn an_unknown_effect_is_refused_with_the_names_that_there_are() {
    let family = Family::new(1, 0.1, |_, _| 0.0);
    let settings = Settings { base: vec!["slop".into()], ..Settings::default() };
    let error = discover(&family, &settings, &mut ()).unwrap_err().to_string();
    assert!(error.contains("'slop'") && error.contains("slope, square"), "{error}");
}

#[test]
fn of_two_hidden_terms_in_loud_noise_none_is_a_wrong_one() {
    let mut both = 0;
    for seed in 1..=20 {
        let family = Family::new(seed, 0.2, |_, x| 0.4 * x * x + 0.3 * (9.0 * x).cos());
        let found = family.discover(seed);
        let wrong = found.added.iter().any(|name| !["square", "cosine"].contains(&name.as_str()));
        assert!(!wrong || found.verdict == Verdict::Ambiguous, "seed {seed}: {:?}", found.remains);
        both += usize::from(found.added.len() == 2 && !wrong);
    }
    assert!(both >= 10, "{both} of 20");
}
