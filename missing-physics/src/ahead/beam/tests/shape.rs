//! Where a candidate begins, in which valley it ends, in which form it stands.

use super::*;
use crate::ahead::screen::Promise;

const TONES: [f64; 2] = [3.0, 5.0];

fn plant() -> Plant {
    Plant::new(1, &[(TONE, &[0.05, TONES[1]])])
}

fn omega(node: &Node) -> f64 {
    *node.model.values.last().unwrap()
}

#[test]
fn of_several_starts_the_one_that_leads_deepest_is_taken() {
    let plant = plant();
    let starts = TONES.map(|omega| Plant::model(&[(TONE, &[0.01, omega])])).to_vec();
    let promise = Promise { term: TONE, gain: 100.0, starts, leverage: None };
    let node = search(&plant, narrow()).begun(&promise, 0).unwrap();
    assert!((omega(&node) / TONES[1] - 1.0).abs() < 0.01, "{}", omega(&node));
}

#[test]
fn nothing_is_begun_once_time_is_over() {
    let plant = plant();
    let start = Plant::model(&[(TONE, &[0.01, 5.0])]);
    let promise = Promise { term: TONE, gain: 100.0, starts: vec![start], leverage: None };
    let over = || true;
    let search = Search::new(&plant, &plant, narrow(), ALL.to_vec(), &over, &|_| ());
    assert!(search.begun(&promise, 0).is_none());
}

#[test]
fn a_lower_valley_beside_is_leapt_to_and_a_higher_one_is_not() {
    let mut plant = plant();
    for (from, to) in [(TONES[0], TONES[1]), (TONES[1], TONES[0])] {
        plant.leaps = vec![to];
        let search = search(&plant, narrow());
        let there = search.rescanned(&node(&plant, &[(TONE, &[0.05, from])]));
        assert!((omega(&there) / TONES[1] - 1.0).abs() < 0.01, "{from}: {}", omega(&there));
    }
}

#[test]
fn the_way_to_a_lower_valley_is_gone_on_a_part_and_its_end_on_all() {
    let mut plant = plant();
    plant.leaps = vec![TONES[1]];
    // On this part the far valley is no lower one.
    plant.part = Some(Box::new(Plant::new(2, &[(TONE, &[0.05, TONES[0]])])));
    let stays = search(&plant, narrow()).gone_far(&Plant::model(&[(TONE, &[0.05, TONES[0]])]), 0);
    assert!((omega(&stays) / TONES[0] - 1.0).abs() < 0.1, "{}", omega(&stays));
    // What a part leads to stands only where it is better on all.
    let at_best = node(&plant, &[(TONE, &[0.05, TONES[1]])]);
    let there = search(&plant, narrow()).rescanned(&at_best);
    assert!(there.deviation <= at_best.deviation);
    assert!((omega(&there) / TONES[1] - 1.0).abs() < 0.01, "{}", omega(&there));
}

#[test]
fn a_flexible_form_goes_on_to_a_lower_valley() {
    let mut plant = Plant::new(3, &[(BENT, &[0.05, 0.05]), (TONE, &[0.05, TONES[1]])]);
    plant.leaps = vec![TONES[1]];
    let shaped = search(&plant, narrow())
        .shaped(&node(&plant, &[(WAVE, &[0.05]), (TONE, &[0.05, TONES[0]])]));
    assert_eq!(shaped.effects(&plant), [BENT, TONE]);
    assert!((omega(&shaped) / TONES[1] - 1.0).abs() < 0.01, "{}", omega(&shaped));
}

#[test]
fn a_flexible_form_stands_where_it_gains_enough_and_not_where_it_gains_less() {
    // A bend so small that it gains something, and less than a form must.
    for (bend, gained, expected) in [(0.05, true, BENT), (0.0001, true, WAVE), (0.0, false, WAVE)] {
        let plant = Plant::new(3, &[(BENT, &[0.05, bend])]);
        let (plain, bent) =
            (node(&plant, &[(WAVE, &[0.05])]), node(&plant, &[(BENT, &[0.05, bend])]));
        let search = search(&plant, narrow());
        let nats = search.comparison.compare(&plain, &bent).nats;
        assert_eq!(nats > 0.0, gained, "{bend}: {nats}");
        assert_eq!(search.shaped(&plain).model.terms, [0, expected], "{bend}: {nats}");
    }
}

#[test]
fn a_plain_form_comes_back_only_where_it_is_as_good_and_still_needed() {
    let plant = Plant::new(3, &[(BENT, &[0.05, 1e-4])]);
    let bent = node(&plant, &[(BENT, &[0.05, 1e-4])]);
    let base = node(&plant, &[]);
    let cost = |without: &Node| {
        let search = search(&plant, narrow());
        vec![(BENT, search.comparison.compare(without, &bent), without.clone())]
    };
    let plain = |without: &Node| {
        let mut search = search(&plant, narrow());
        (search.plainest(bent.clone(), &cost(without)).model.terms, search.decisions)
    };
    let (terms, decisions) = plain(&base);
    assert_eq!((terms, decisions[0].outcome), (vec![0, WAVE], Outcome::Added));
    // Where what is there without it predicts as well as the plain form does, that one is not needed.
    let (terms, decisions) = plain(&node(&plant, &[(WAVE, &[0.05])]));
    assert_eq!((terms, decisions[0].outcome), (vec![0, BENT], Outcome::OtherShape));
}
