//! Simpler effects in the place of others.

use super::*;

/// The effects of a set after simpler ones were asked in the place of each.
fn simplified(hidden: &[(usize, &[f64])], found: &[(usize, &[f64])]) -> Vec<usize> {
    beside_usual(&[], hidden, found)
}

/// The same where every plant has some.
fn beside_usual(
    usual: &[usize],
    hidden: &[(usize, &[f64])],
    found: &[(usize, &[f64])],
) -> Vec<usize> {
    let mut plant = Plant::new(6, hidden);
    plant.usual = usual.to_vec();
    let mut search = search(&plant, narrow());
    let set = node(&plant, found);
    let costs = (0..found.len()).map(|k| {
        let others = [&found[..k], &found[k + 1..]].concat();
        let without = search.refit(&Plant::model(&others), 0, STEPS.1);
        (found[k].0, search.comparison.compare(&without, &set), without)
    });
    let costs: Costs = costs.collect();
    let simpler = search.simplified(&mut climb(&plant, Vec::new()), &set, &costs);
    simpler.unwrap_or(set).effects(&plant)
}

#[test]
fn an_effect_of_fewer_parameters_that_shows_beside_another_takes_the_place_of_what_imitates_it() {
    let push: (usize, &[f64]) = (PUSH, &[0.05]);
    let beat: (usize, &[f64]) = (BEAT, &[0.05]);
    let tone: (usize, &[f64]) = (TONE, &[0.01, 5.0]);
    assert_eq!(simplified(&[push, beat], &[push, tone]), [PUSH, BEAT]);
    assert_eq!(
        simplified(&[push, (TONE, &[0.05, 5.0])], &[push, (TONE, &[0.05, 5.0])]),
        [PUSH, TONE]
    );
    // Of as many parameters another one is no simpler.
    assert_eq!(simplified(&[push, beat], &[push, (WAVE, &[0.01])]), [PUSH, WAVE]);
}

#[test]
fn a_single_effect_was_compared_with_the_others_when_it_was_found() {
    assert_eq!(simplified(&[(BEAT, &[0.05])], &[(TONE, &[0.01, 5.0])]), [TONE]);
}

#[test]
fn what_shows_only_beside_a_usual_effect_takes_the_place_of_one_of_as_many_parameters() {
    let push: (usize, &[f64]) = (PUSH, &[0.05]);
    let beat: (usize, &[f64]) = (BEAT, &[0.05]);
    let imitates: (usize, &[f64]) = (TONE, &[0.01, 5.0]);
    assert_eq!(beside_usual(&[PUSH], &[push, beat], &[imitates]), [PUSH, BEAT]);
    // What predicts no better does not, nor does one of more parameters.
    let tone: (usize, &[f64]) = (TONE, &[0.05, 5.0]);
    assert_eq!(beside_usual(&[PUSH], &[tone], &[tone]), [TONE]);
    assert_eq!(beside_usual(&[PUSH], &[push, beat], &[(WAVE, &[0.01])]), [WAVE]);
}

#[test]
fn what_was_asked_beside_a_usual_effect_is_an_alternative_though_it_is_two() {
    let hidden = [(TONE, &[0.05, 5.0][..])];
    let mut plant = Plant::new(6, &hidden);
    plant.usual = vec![PUSH];
    let (base, tone) = (node(&plant, &[]), node(&plant, &hidden));
    // Whatever is left is as little as the sensors make.
    let mut search = search(&plant, Thresholds { complete: 1e9, ..narrow() });
    let gain = search.comparison.compare(&base, &tone);
    let costs = || vec![(TONE, gain, base.clone())];
    let mut climb = climb(&plant, vec![vec![tone.clone()]]);
    assert!(search.simplified(&mut climb, &tone, &costs()).is_none());
    let found = search.conclude(climb, &tone, (costs(), 0.0), Screened::default(), None);
    let (last, others) = found.sets[1].split_first().unwrap();
    assert_eq!(*last, (vec![TONE], 0.0));
    assert!(!others.is_empty());
    for (set, lag) in others {
        assert!(set.len() == 2 && set[0] == PUSH && *lag > 20.0, "{set:?} {lag}");
    }
}

#[test]
fn the_most_promising_one_is_fitted_however_little_of_what_is_lost_it_promises() {
    let push: (usize, &[f64]) = (PUSH, &[0.05]);
    let plant = Plant::new(6, &[push, (BEAT, &[0.05])]);
    let (best, without) = (node(&plant, &[push, (TONE, &[0.01, 5.0])]), node(&plant, &[push]));
    for (cost, most) in [(100.0, 3), (1e9, 1)] {
        let mut search = search(&plant, Thresholds { beam: 3, ..narrow() });
        let mut climb = climb(&plant, Vec::new());
        let other = search.in_the_place_of(&mut climb, &best, cost, &without, 2).unwrap();
        assert_eq!(other.effects(&plant), [PUSH, BEAT]);
        assert!((1..=most).contains(&search.decisions.len()), "{}", search.decisions.len());
    }
}

#[test]
fn what_does_more_in_the_place_of_an_effect_but_is_refused_takes_that_back() {
    let push: (usize, &[f64]) = (PUSH, &[0.05]);
    let mut plant = Plant::new(6, &[push, (BEAT, &[0.05])]);
    plant.none = Some(BEAT);
    let (best, without) = (node(&plant, &[push, (TONE, &[0.01, 5.0])]), node(&plant, &[push]));
    let mut search = search(&plant, Thresholds { beam: 1, ..narrow() });
    let mut climb = climb(&plant, Vec::new());
    assert!(search.in_the_place_of(&mut climb, &best, 1e9, &without, 2).is_none());
    assert_eq!(climb.refused[0].0.effects(&plant), [PUSH, BEAT]);
    search.thresholds.complete = 0.5;
    let (left, told) = search.outdone(&climb, &best).unwrap();
    assert_eq!(left.effects(&plant), [PUSH]);
    assert!(matches!(told, Some(Remains::Outdone { nats, .. }) if nats > 20.0), "{told:?}");
}

#[test]
fn simpler_effects_are_asked_where_the_mass_is_right() {
    let plant = Plant::new(6, &[(WAVE, &[0.05])]);
    let search = search(&plant, narrow());
    let best = node(&plant, &[(WAVE, &[0.05])]);
    let near = |drive: f64| {
        let mut without = node(&plant, &[(PUSH, &[0.02])]);
        without.model.values[DRIVE] = drive;
        search.near(&best, &without)
    };
    // What every plant has stays, what came in the place of the effect is fitted.
    let there = near(4.0).unwrap();
    assert_eq!(there.model.terms, [DRIVE, PUSH]);
    assert!(there.is_held() && there.model.values[DRIVE] == best.model.values[DRIVE]);
    assert!(near(2.0).is_none());
}
