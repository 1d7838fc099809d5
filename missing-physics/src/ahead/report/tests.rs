//! What is told of a search, piece by piece.

use super::*;
use crate::ahead::chance::Chance;
use crate::ahead::fit::evaluated;
use crate::ahead::found::Row;
use crate::ahead::screen::screen;
use crate::ahead::testing::{BEAT, BENT, NOISE, PUSH, Plant, TONE, TWIN, WAVE};
use crate::report::{Outcome, Where};
use crate::task::Thresholds;

const HIDDEN: [(usize, &[f64]); 2] = [(WAVE, &[0.05]), (BEAT, &[0.05])];

fn node(plant: &Plant, terms: &[(usize, &[f64])]) -> Node {
    evaluated(plant, Plant::model(terms), 0)
}

fn by(nats: f64) -> Difference {
    Difference { nats, error: 1.0, ranks: 0.0 }
}

/// A search that found a wave, then a beat.
fn both(plant: &Plant) -> Found {
    Found {
        rungs: vec![node(plant, &HIDDEN[..1]), node(plant, &HIDDEN)],
        added: vec![WAVE, BEAT],
        gains: vec![by(200.0), by(100.0)],
        p_values: vec![0.01, 0.02],
        complete: true,
        alike: 10.0,
        ..Found::of(node(plant, &[]))
    }
}

fn reported(plant: &Plant, found: Found, brief: bool, stop: bool) -> Discovery {
    let settings = Settings { seed: 7, ..Settings::default() };
    let stop = move || stop;
    let report =
        Report { family: plant, ahead: plant, settings: &settings, found, brief, stop: &stop };
    report.discovery()
}

fn told(plant: &Plant, found: Found) -> Discovery {
    reported(plant, found, false, false)
}

#[test]
fn the_verdict_follows_from_what_was_found_and_what_is_left() {
    let plant = Plant::new(1, &HIDDEN);
    let of = |found: bool, complete: bool, stopped: bool, ambiguous: bool| {
        let found = if found { both(&plant) } else { Found::of(node(&plant, &[])) };
        let sets = if ambiguous {
            vec![Vec::new(), Vec::new(), vec![(vec![WAVE, BEAT], 0.0), (vec![WAVE, PUSH], 5.0)]]
        } else {
            Vec::new()
        };
        told(&plant, Found { sets, complete, stopped, ..found }).verdict
    };
    for complete in [false, true] {
        assert_eq!(of(false, complete, true, false), Verdict::Stopped);
        assert_eq!(of(true, complete, true, false), Verdict::Stopped);
        assert_eq!(of(true, complete, false, false), Verdict::EffectsFound);
        assert_eq!(of(true, complete, false, true), Verdict::Ambiguous);
    }
    assert_eq!(of(false, true, false, false), Verdict::NothingMissing);
    assert_eq!(of(false, false, false, false), Verdict::Unexplained);
}

#[test]
fn rungs_tell_what_each_adds_and_gains_from_the_base_on() {
    let plant = Plant::new(1, &HIDDEN);
    let told = told(&plant, both(&plant));
    assert_eq!(told.added, ["wave", "beat"]);
    let added: Vec<&[String]> = told.ladder.iter().map(|rung| &rung.added[..]).collect();
    assert_eq!(added, [&[] as &[&str], &["wave"], &["beat"]]);
    let effects: Vec<&[String]> = told.ladder.iter().map(|rung| &rung.effects[..]).collect();
    assert_eq!(effects, [&[] as &[&str], &["wave"], &["wave", "beat"]]);
    let gains: Vec<Option<f64>> = told.ladder.iter().map(|rung| rung.likelihood_gain).collect();
    assert_eq!(gains, [None, Some(200.0), Some(100.0)]);
    let p_values: Vec<Option<f64>> = told.ladder.iter().map(|rung| rung.p_value).collect();
    assert_eq!(p_values, [None, Some(0.01), Some(0.02)]);
    // As many times as large as the sensors make it.
    let times: Vec<f64> = told.ladder.iter().map(|rung| rung.budget.unwrap()).collect();
    assert!(times[0] > times[1] && times[1] > 1.2 * times[2] && (times[2] - 1.0).abs() < 0.1);
    let budget = told.budget.unwrap();
    assert_eq!((budget.expected, budget.base, budget.last), (NOISE, times[0], times[2]));
    assert!(budget.complete && budget.allowed == Thresholds::default().complete);
    // The error of the input itself falls, too, and is asked of either model.
    assert!(told.ladder[2].metrics.is_some() && told.regimes_base != told.regimes);
    assert_eq!(told.noise_floor.keys().collect::<Vec<_>>(), ["input_V"]);
}

#[test]
fn a_gain_that_is_no_number_is_none() {
    let plant = Plant::new(1, &HIDDEN);
    let found = Found { gains: vec![by(f64::NAN), by(f64::INFINITY)], ..both(&plant) };
    let told = told(&plant, found);
    let rung = |k: usize| (told.ladder[k].likelihood_gain, told.ladder[k].p_value);
    assert_eq!((rung(1), rung(2)), ((None, Some(1.0)), (None, Some(0.02))));
}

#[test]
fn a_budget_that_nobody_knows_is_not_told() {
    let plant = Plant::new(1, &HIDDEN);
    let mut base = node(&plant, &[]);
    base.scale = f64::NAN;
    let told = told(&plant, Found::of(base));
    assert!(told.budget.is_none() && told.ladder[0].budget.is_none());
}

#[test]
fn a_model_that_errs_far_less_than_the_sensors_says_so() {
    let plant = Plant::new(1, &HIDDEN);
    let remarks = |times: f64| {
        let mut base = node(&plant, &[]);
        base.scale = times * plant.budget();
        told(&plant, Found::of(base)).remarks
    };
    assert!(remarks(0.6).is_empty());
    assert_eq!(remarks(0.25), [Remark::SensorsBetter { times: 0.25 }]);
}

#[test]
fn where_nothing_was_added_the_base_fails_where_the_last_model_does() {
    let plant = Plant::new(1, &HIDDEN);
    let nothing = told(&plant, Found::of(node(&plant, &[])));
    assert!(!nothing.where_it_fails.is_empty());
    assert_eq!(nothing.where_it_fails, nothing.where_base);
    assert_eq!(nothing.regimes, nothing.regimes_base);
    let something = told(&plant, both(&plant));
    assert_ne!(something.where_it_fails, something.where_base);
}

#[test]
fn a_term_that_describes_what_is_left_is_told_where_nothing_explains_it_and_only_along_structure() {
    let plant = Plant::new(1, &HIDDEN);
    // A base that swings slowly where the plant does not.
    let nothing = || Found::of(node(&plant, &[(TONE, &[1.0, 0.2])]));
    let term = told(&plant, nothing()).generic_term;
    assert_eq!(term.as_deref(), Some("time true"));
    // What was found explains it, and where all is explained nothing is left to describe.
    assert_eq!(told(&plant, both(&plant)).generic_term, None);
    assert_eq!(told(&plant, Found { complete: true, ..nothing() }).generic_term, None);
    // The first coordinate along which there is structure, by its name.
    let settings = Settings::default();
    let found = nothing();
    let residual = vec![0.0; plant.target().len()];
    let place = |coordinate: &str, p_value: f64| {
        let place = told(&plant, nothing()).where_it_fails.swap_remove(0);
        Where { coordinate: coordinate.to_owned(), p_value, ..place }
    };
    let (family, ahead, brief) = (&plant, &plant, false);
    let report = Report { family, ahead, settings: &settings, found, brief, stop: &|| false };
    let told = |places: &[Where]| report.generic_term(places, &residual);
    assert!(told(&[place("load", 1.0), place("time", 0.0)]).is_some());
    assert!(told(&[place("load", 0.0), place("time", 0.0)]).is_none());
    assert!(told(&[place("time", 1.0)]).is_none());
}

#[test]
fn what_takes_long_is_left_out_where_time_is_up() {
    let plant = Plant::new(1, &HIDDEN);
    let brief = |brief: bool, stop: bool, stopped: bool| {
        let told = reported(&plant, Found { stopped, ..both(&plant) }, brief, stop);
        let said = told.remarks.iter().filter(|r| matches!(r, Remark::ToldInBrief)).count();
        (told.where_it_fails.is_empty(), told.diagnosis.is_none(), said)
    };
    assert_eq!(brief(false, false, false), (false, false, 0));
    assert_eq!(brief(true, false, false), (true, true, 1));
    assert_eq!(brief(false, true, false), (true, true, 1));
    // A search that was cut says so itself.
    assert_eq!(brief(true, false, true), (true, true, 0));
}

#[test]
fn rivals_of_one_effect_stand_together() {
    let plant = Plant::new(1, &HIDDEN);
    let ambiguous = |sets: &[(&[usize], f64)]| -> Vec<Vec<String>> {
        let sets = sets.iter().map(|(set, lag)| (set.to_vec(), *lag)).collect();
        let found = Found { sets: vec![Vec::new(), Vec::new(), sets], ..both(&plant) };
        told(&plant, found).ambiguous.into_iter().map(|set| set.effects).collect()
    };
    let found: (&[usize], f64) = (&[WAVE, BEAT], 0.0);
    assert!(ambiguous(&[found]).is_empty());
    let rivals = ambiguous(&[
        found,
        (&[WAVE, PUSH], 1.0),
        (&[TWIN, BEAT], 2.0),
        // Told once, too far behind, another form of what was found, and two effects in the place of two.
        (&[PUSH, WAVE], 3.0),
        (&[WAVE, TONE], 20.0),
        (&[BENT, BEAT], 4.0),
        (&[PUSH, TWIN], 5.0),
    ]);
    assert_eq!(rivals, [vec!["wave", "twin"], vec!["beat", "push"]]);
    // What every system has may come with a rival, or go with what it takes the place of.
    let of_usual = |found: &[usize], other: &[usize]| -> Vec<Vec<String>> {
        let mut plant = Plant::new(1, &HIDDEN);
        plant.usual = vec![PUSH];
        let both = both(&plant);
        let mut sets = vec![Vec::new(); 3];
        sets[found.len()] = vec![(found.to_vec(), 0.0), (other.to_vec(), 1.0)];
        let rungs = both.rungs[..found.len()].to_vec();
        let found = Found { sets, added: found.to_vec(), rungs, ..both };
        told(&plant, found).ambiguous.into_iter().map(|set| set.effects).collect()
    };
    assert_eq!(of_usual(&[WAVE], &[PUSH, TONE]), [["wave", "tone"]]);
    assert_eq!(of_usual(&[PUSH, TONE], &[WAVE]), [["tone", "wave"]]);
    assert!(of_usual(&[WAVE], &[TONE, BEAT]).is_empty());
    // Another law of what was found is no rival of it.
    let mut plant = Plant::new(1, &HIDDEN);
    plant.laws = vec![(TWIN, WAVE)];
    let sets = vec![(vec![WAVE, BEAT], 0.0), (vec![TWIN, BEAT], 2.0)];
    let found = Found { sets: vec![Vec::new(), Vec::new(), sets], ..both(&plant) };
    assert!(told(&plant, found).ambiguous.is_empty());
}

#[test]
fn candidates_are_told_with_their_size_and_their_share_of_the_error() {
    let plant = Plant::new(1, &HIDDEN);
    let row = |nats: f64| Row {
        term: TONE,
        model: Plant::model(&[(WAVE, &[0.3]), (TONE, &[0.2, 5.0])]),
        nats,
        p_value: 0.25,
    };
    let ranked = Ranked {
        rows: vec![row(50.0), row(f64::NAN), row(f64::INFINITY)],
        chance: Chance::default(),
        points: 1000.0,
    };
    let told = told(&plant, Found { ranking: vec![ranked], ..both(&plant) });
    let [first, second, third] = &told.ranking[0][..] else { panic!("{:?}", told.ranking) };
    assert_eq!((first.effect.as_str(), first.nats, first.p_value), ("tone", Some(50.0), 0.25));
    assert!((first.gain - 0.0952).abs() < 1e-4, "{}", first.gain);
    let size: Vec<(&str, f64)> = first.size.iter().map(|s| (s.name.as_str(), s.value)).collect();
    assert_eq!(size, [("size", 0.2), ("omega", 5.0)]);
    assert_eq!((second.nats, second.p_value), (None, 1.0));
    assert_eq!((third.nats, third.p_value), (None, 0.25));
}

#[test]
fn a_limit_of_detection_is_the_size_that_would_have_gained_enough() {
    let plant = Plant::new(1, &[]);
    let base = node(&plant, &[]);
    let mut promises = screen(&plant, &plant, &base, &[BEAT, BENT, PUSH], false).promises;
    for promise in &mut promises {
        promise.leverage = Some(if promise.term == PUSH { 0.0 } else { 2000.0 });
    }
    let told = told(&plant, Found { last_screening: promises, ..Found::of(base) });
    // Neither what nothing would show nor the form of another effect has one.
    assert_eq!(told.detection_limits.keys().collect::<Vec<_>>(), ["beat"]);
    let size = told.detection_limits["beat"].size.unwrap();
    let better = Thresholds::default().better * plant.asked();
    assert!((size / (better / 2000.0).sqrt() - 1.0).abs() < 1e-12, "{size}");
}

#[test]
fn numbers_that_are_none_do_not_reach_a_file() {
    let decision = Decision {
        rung: 1,
        candidate: vec!["a".to_owned()],
        compared_with: Vec::new(),
        difference: f64::NAN,
        standard_error: 1.0,
        budget: f64::INFINITY,
        outcome: Outcome::TooLittle,
        because: None,
    };
    let told = finite(&decision);
    assert_eq!((told.difference, told.standard_error, told.budget), (0.0, 1.0, 0.0));
    assert_eq!(told.because, Some(Reason::NotFinite));
    let of_error = finite(&Decision { standard_error: f64::NAN, ..decision });
    assert_eq!(of_error.standard_error, 0.0);
    assert_eq!(share(f64::NAN, 10.0), -1.0);
    assert_eq!(share(-1e9, 10.0), -1.0);
    assert_eq!(share(f64::INFINITY, 10.0), 1.0);
    assert!((share(5.0, 1000.0) - 0.00995).abs() < 1e-5);
}
