//! What takes names back: what stands for no effect, and what was refused.

use super::*;
use crate::family::{Rival, Series};

const HIDDEN: [(usize, &[f64]); 2] = [(WAVE, &[0.05]), (BEAT, &[-0.02])];

#[test]
fn effects_that_are_shapes_of_a_rival_stand_where_they_predict_as_well() {
    let mut plant = Plant::new(11, &HIDDEN);
    for (kin, stand) in [(vec![], false), (vec![WAVE, BEAT], true)] {
        plant.kin = kin;
        let last = node(&plant, &HIDDEN);
        let without = search(&plant, narrow()).instead(&climb(&plant, Vec::new()), &last);
        assert_eq!(without.is_none(), stand);
    }
}

#[test]
fn a_shape_of_a_rival_that_predicts_worse_goes_with_the_others() {
    let hidden: [(usize, &[f64]); 2] = [(WAVE, &[0.1]), (BEAT, &[-0.04])];
    let mut plant = Plant::new(11, &hidden);
    plant.kin = vec![WAVE];
    let thresholds = Thresholds { share: 0.0, ..narrow() };
    let last = node(&plant, &hidden);
    let (without, remains) =
        search(&plant, thresholds).instead(&climb(&plant, Vec::new()), &last).unwrap();
    assert!(without.effects(&plant).is_empty());
    let Some(Remains::Rival { instead_of, .. }) = remains else { panic!("{remains:?}") };
    assert_eq!(instead_of.len(), 2);
}

#[test]
fn a_shape_of_a_rival_that_predicts_as_well_beside_what_every_system_has_stands() {
    let hidden: [(usize, &[f64]); 2] = [(WAVE, &[0.1]), (BEAT, &[-0.04])];
    let mut plant = Plant::new(11, &hidden);
    plant.kin = vec![WAVE];
    let last = node(&plant, &hidden[..1]);
    for (usual, stands) in [(vec![], false), (vec![BEAT], true)] {
        plant.usual = usual;
        let thresholds = Thresholds { share: 0.0, ..narrow() };
        let without = search(&plant, thresholds).instead(&climb(&plant, Vec::new()), &last);
        assert_eq!(without.is_none(), stands);
    }
}

#[test]
fn other_shapes_of_a_rival_that_predict_as_well_take_the_place_of_worse_ones() {
    let thresholds = Thresholds { share: 0.0, ..narrow() };
    let mut plant = Plant::new(11, &[(WAVE, &[0.1]), (BEAT, &[-0.04])]);
    let last = node(&plant, &[(WAVE, &[0.1]), (PUSH, &[0.01])]);
    let others = node(&plant, &[(WAVE, &[0.1]), (BEAT, &[-0.04])]);
    for (kin, stand) in [(vec![WAVE, PUSH], false), (vec![WAVE, PUSH, BEAT], true)] {
        plant.kin = kin;
        let climb = climb(&plant, vec![Vec::new(), vec![last.clone(), others.clone()]]);
        let (set, remains) = search(&plant, thresholds).instead(&climb, &last).unwrap();
        assert_eq!(set.effects(&plant), if stand { vec![WAVE, BEAT] } else { Vec::new() });
        assert_eq!(remains.is_none(), stand);
        // They are not asked to give way to what is worse.
        assert_eq!(search(&plant, thresholds).instead(&climb, &others).is_none(), stand);
    }
}

#[test]
fn how_a_rival_runs_is_told_where_what_it_is_measured_in_is_known() {
    let plant = Plant::new(12, &[(WAVE, &[0.05])]);
    let rival = Rival { term: RIVAL, title: "a wave less a beat", kin: Vec::new() };
    let search = search(&plant, narrow());
    let mut with = node(&plant, &[(RIVAL, &[0.05])]);
    assert!(matches!(search.course(&with, &rival), Some(Course::Values { .. })));
    with.model.values[DRIVE] = plant.terms()[DRIVE].parameters[0].upper;
    assert_eq!(search.course(&with, &rival), None);
}

#[test]
fn what_is_no_such_rival_as_it_was_fitted_says_nothing_against_a_complete_base() {
    for (size, incomplete) in [(0.002, false), (0.05, true)] {
        let mut plant = Plant::new(12, &[(RIVAL, &[size])]);
        for (none, told) in [(None, true), (Some(RIVAL), incomplete)] {
            plant.none = none;
            let base = node(&plant, &[]);
            let mut search = search(&plant, narrow());
            assert_eq!(search.is_complete(&base), !incomplete, "{size}: {}", search.budget(&base));
            let found = search.instead(&climb(&plant, Vec::new()), &base);
            assert_eq!(found.is_some(), told, "{size} {none:?}");
        }
    }
}

#[test]
fn a_rival_must_predict_better_than_one_effect_and_as_well_as_several() {
    // As well, to a few nats.
    let one = Plant::new(12, &[(WAVE, &[0.05])]);
    let rival = Rival { term: RIVAL, title: "a wave less a beat", kin: Vec::new() };
    let (last, with) = (node(&one, &[(WAVE, &[0.05])]), node(&one, &[(TWIN, &[0.05])]));
    let mut search = search(&one, Thresholds { better: 1e4, ..narrow() });
    let base = node(&one, &[]);
    assert!(!search.does_as_much(&base, &last, &with, 1, &rival));
    assert!(search.does_as_much(&base, &last, &with, 2, &rival));
}

#[test]
fn a_rival_takes_the_place_of_one_of_two_effects_that_leave_no_more_than_the_sensors_make() {
    let push: (usize, &[f64]) = (PUSH, &[0.3]);
    let hidden = [push, (WAVE, &[0.006][..]), (BEAT, &[-0.0024])];
    let mut plant = Plant::new(17, &hidden);
    plant.kin = vec![WAVE];
    let last = node(&plant, &hidden[..2]);
    let thresholds = Thresholds { share: 0.0, ..narrow() };
    let mut search = search(&plant, thresholds);
    assert!(search.is_complete(&last));
    let (without, remains) = search.instead(&climb(&plant, Vec::new()), &last).unwrap();
    assert_eq!(without.effects(&plant), [PUSH]);
    let Some(Remains::Rival { instead_of, .. }) = remains else { panic!("{remains:?}") };
    assert_eq!(instead_of, ["wave"]);
}

/// A model that lacks a force of some size, known to a band.
fn lacks(node: &Node, size: f64, band: f64) -> Node {
    node.clone().lacking(Series {
        time: vec![0.0, 0.1],
        force: vec![size, -size],
        deviation: vec![band / 1.96; 2],
        recorded: vec![9.0; 2],
        known: vec![true; 2],
    })
}

#[test]
fn beside_a_base_that_leaves_nothing_a_rival_is_no_finding() {
    let plant = Plant::new(12, &[(RIVAL, &[5e-4])]);
    let mut search = search(&plant, Thresholds { better: 5.0, ..narrow() });
    let mut climb = climb(&plant, Vec::new());
    for (force, nothing) in [(0.7, false), (0.6, true)] {
        climb.base = lacks(&climb.base, force, 0.5);
        let last = climb.base.clone();
        assert_eq!(search.leaves_nothing(&last), nothing, "{force}");
        assert_eq!(search.instead(&climb, &last).is_none(), nothing, "{force}");
    }
    climb.base.scale = 1.01 * crate::ahead::testing::NOISE;
    assert!(!search.leaves_nothing(&climb.base));
}

#[test]
fn what_a_refused_set_takes_back_beside_a_base_that_leaves_nothing_is_not_nothing() {
    let hidden: [(usize, &[f64]); 2] = [(PUSH, &[0.05]), (WAVE, &[0.1])];
    let mut plant = Plant::new(18, &hidden);
    plant.kin = Vec::new();
    for (best, told) in [(&hidden[..1], true), (&[], false)] {
        let mut climb = climb(&plant, Vec::new());
        climb.base.scale = 0.9 * crate::ahead::testing::NOISE;
        climb.base = lacks(&climb.base, 0.6, 0.5);
        let refusal = Refusal::AtLimit { parameter: "wave.size".into() };
        climb.refused.push((node(&plant, &hidden[1..]), refusal));
        let search = search(&plant, Thresholds { share: 0.0, ..narrow() });
        assert!(search.leaves_nothing(&climb.base));
        let found = search.finish_grown(climb, node(&plant, best));
        assert!(found.added.is_empty());
        let outdone = matches!(found.rival, Some(Remains::Outdone { .. }));
        assert_eq!(outdone, told, "{:?}", found.rival);
    }
}

/// What a refused set does to the last model.
fn outdone(
    plant: &Plant,
    last: &[(usize, &[f64])],
    refused: &[(usize, &[f64])],
) -> Option<(Node, Option<Remains>)> {
    outdone_by(plant, Thresholds { share: 0.0, ..narrow() }, last, refused)
}

/// Thresholds by which every model is complete.
fn lenient() -> Thresholds {
    Thresholds { share: 0.0, complete: 100.0, ..narrow() }
}

fn outdone_by(
    plant: &Plant,
    thresholds: Thresholds,
    last: &[(usize, &[f64])],
    refused: &[(usize, &[f64])],
) -> Option<(Node, Option<Remains>)> {
    let mut climb = climb(plant, Vec::new());
    let refusal = Refusal::AtLimit { parameter: "wave.size".into() };
    climb.refused.push((node(plant, refused), refusal));
    search(plant, thresholds).outdone(&climb, &node(plant, last))
}

#[test]
fn a_refused_set_takes_back_the_effects_that_it_does_without() {
    let plant = Plant::new(13, &[(WAVE, &[0.05]), (BEAT, &[0.05])]);
    let last: [(usize, &[f64]); 2] = [(WAVE, &[0.05]), (PUSH, &[0.01])];
    let refused: [(usize, &[f64]); 2] = [(WAVE, &[0.05]), (BEAT, &[0.05])];
    let (without, remains) = outdone(&plant, &last, &refused).unwrap();
    assert_eq!(without.effects(&plant), [WAVE]);
    let Some(Remains::Outdone { by, instead_of, .. }) = remains else { panic!("{remains:?}") };
    assert_eq!((by, instead_of), (vec!["wave".into(), "beat".into()], vec!["push".to_owned()]));
}

#[test]
fn a_rival_that_is_told_beside_all_effects_does_not_keep_a_refused_set_from_taking_them_back() {
    let push: (usize, &[f64]) = (PUSH, &[0.3]);
    let mut plant = Plant::new(15, &[push, (WAVE, &[0.5]), (BEAT, &[-0.2])]);
    plant.kin = Vec::new();
    let last = node(&plant, &[push]);
    let mut climb = climb(&plant, Vec::new());
    let mut search = search(&plant, Thresholds { share: 0.0, ..narrow() });
    let (beside, remains) = search.instead(&climb, &last).unwrap();
    assert_eq!(beside.effects(&plant), [PUSH]);
    assert!(matches!(remains, Some(Remains::Rival { instead_of, .. }) if instead_of.is_empty()));
    let refusal = Refusal::AtLimit { parameter: "wave.size".into() };
    climb.refused.push((node(&plant, &[(WAVE, &[0.5])]), refusal));
    let (without, remains) = search.instead(&climb, &last).unwrap();
    assert!(without.effects(&plant).is_empty());
    assert!(matches!(remains, Some(Remains::Outdone { .. })), "{remains:?}");
}

#[test]
fn what_a_rival_leaves_is_compared_with_a_refused_set_too() {
    let push: (usize, &[f64]) = (PUSH, &[0.1]);
    let mut plant = Plant::new(11, &[HIDDEN[0], HIDDEN[1], push]);
    plant.kin = Vec::new();
    let mut climb = climb(&plant, Vec::new());
    let refusal = Refusal::AtLimit { parameter: "wave.size".into() };
    climb.refused.push((node(&plant, &HIDDEN[..1]), refusal));
    let best = node(&plant, &[HIDDEN[0], HIDDEN[1], push]);
    let found = search(&plant, Thresholds { share: 0.0, ..narrow() }).finish_grown(climb, best);
    assert_eq!(found.added, [PUSH]);
    let of_push = |decision: &&Decision| decision.compared_with == ["push"];
    let refused = |decision: &Decision| matches!(decision.because, Some(Reason::Refused { .. }));
    assert!(found.decisions.iter().filter(of_push).any(refused), "{:?}", found.decisions);
}

#[test]
fn a_refused_set_takes_nothing_back_where_it_predicts_no_better() {
    let plant = Plant::new(13, &[(WAVE, &[0.05]), (BEAT, &[0.05])]);
    let (push, wave, both) = ((PUSH, &[0.01][..]), (WAVE, &[0.05][..]), (BOTH, &[1e-4][..]));
    assert!(outdone(&plant, &[push], &[wave]).is_some());
    assert!(outdone(&plant, &[wave], &[both]).is_none());
}

#[test]
fn a_refused_set_of_more_effects_takes_back_what_leaves_something_where_it_leaves_nothing() {
    let push: (usize, &[f64]) = (PUSH, &[1e-4]);
    for (size, takes_back) in [(0.05, true), (0.001, false)] {
        let [wave, beat] = [[size], [size]];
        let both: [(usize, &[f64]); 2] = [(WAVE, &wave), (BEAT, &beat)];
        let plant = Plant::new(13, &both);
        assert_eq!(outdone(&plant, &[push], &both).is_some(), takes_back, "{size}");
        // It leaves the beat.
        assert!(outdone(&plant, &[push], &[both[0], (TONE, &[1e-4, 3.0])]).is_none(), "{size}");
    }
}

#[test]
fn where_nothing_was_found_a_refused_set_that_explains_it_says_that_something_is_missing() {
    let plant = Plant::new(13, &[(WAVE, &[0.05])]);
    let told = |wave: f64| outdone(&plant, &[], &[(WAVE, &[wave])]);
    let (without, remains) = told(0.05).unwrap();
    assert!(without.effects(&plant).is_empty());
    let Some(Remains::Outdone { by, instead_of, nats, .. }) = remains else {
        panic!("{remains:?}")
    };
    assert_eq!((by, instead_of), (vec!["wave".to_owned()], Vec::new()));
    assert!(nats > 100.0, "{nats}");
    // It predicts better, and leaves nearly all of it.
    assert!(told(0.002).is_none());
    // Nothing is missing.
    let plant = Plant::new(13, &[]);
    assert!(outdone(&plant, &[], &[(WAVE, &[1e-3])]).is_none());
}

#[test]
fn a_refused_set_takes_nothing_back_that_it_is_another_way_to_write() {
    let bent: (usize, &[f64]) = (BENT, &[0.05, 0.05]);
    let plant = Plant::new(14, &[bent]);
    assert!(outdone(&plant, &[(PUSH, &[0.01])], &[bent]).is_some());
    assert!(outdone(&plant, &[(WAVE, &[0.05])], &[bent]).is_none(), "another form");
    // What it is related to stands for it where that does the greater part, beyond what is beside it.
    for (last, related, takes_back) in
        [(TWIN, None, true), (TWIN, Some(TWIN), false), (PUSH, Some(PUSH), true)]
    {
        for beside in [&[][..], &[(BEAT, &[0.2][..])]] {
            let and = |term| [beside, &[(term, &[0.05])]].concat();
            let mut plant = Plant::new(14, &and(WAVE));
            plant.related = related.map(|other| (WAVE, other));
            let mut climb = climb(&plant, Vec::new());
            let mut search = search(&plant, Thresholds { share: 0.0, ..narrow() });
            let fitted = |term| search.refit(&Plant::model(&and(term)), 0, STEPS.1);
            let (last, refused) = (fitted(last), fitted(WAVE));
            climb.base = search.refit(&climb.base.model, 0, STEPS.1);
            climb.refused.push((refused, Refusal::AtLimit { parameter: "wave.size".into() }));
            let found = search.outdone(&climb, &last).map(|(without, _)| without.effects(&plant));
            let kept = beside.iter().map(|(term, _)| *term).collect();
            assert_eq!(found, takes_back.then_some(kept), "{related:?} {}", beside.len());
        }
    }
}

#[test]
fn what_every_system_has_comes_before_what_does_no_more_and_is_nothing_that_is_missing() {
    let [wave, twin, beat, push]: [(usize, &[f64]); 4] =
        [(WAVE, &[0.02]), (TWIN, &[0.02]), (BEAT, &[0.01]), (PUSH, &[1e-4])];
    let mut plant = Plant::new(19, &[wave, beat]);
    let asked = |plant: &Plant, last: &[(usize, &[f64])], refused: &[(usize, &[f64])]| {
        let found = outdone_by(plant, lenient(), last, refused);
        found.map(|(without, remains)| (without.effects(plant), remains.is_some()))
    };
    assert_eq!(asked(&plant, &[beat, twin], &[beat, wave]), None);
    assert_eq!(asked(&plant, &[], &[wave]), Some((vec![], true)));
    plant.unseen = Some(WAVE);
    assert_eq!(asked(&plant, &[beat, twin], &[beat, wave]), Some((vec![BEAT], false)));
    assert_eq!(asked(&plant, &[twin], &[wave]), Some((vec![], false)));
    assert_eq!(asked(&plant, &[], &[wave]), None, "nothing to take back");
    assert_eq!(asked(&plant, &[beat, twin], &[wave]), None, "it leaves the beat");
    assert_eq!(asked(&plant, &[beat, twin], &[beat, push, wave]), None, "beside another effect");
    // Where the base leaves something.
    assert!(outdone(&plant, &[beat, twin], &[beat, wave]).is_none());
}

#[test]
fn what_every_system_has_gives_way_to_what_does_more_again_and_again() {
    let mut plant = Plant::new(19, &[(WAVE, &[0.02])]);
    plant.unseen = Some(WAVE);
    let last = node(&plant, &[(TWIN, &[0.02])]);
    let mut climb = climb(&plant, Vec::new());
    // What the other one errs more: everywhere, or in an eighth of the recording alone.
    for ([there, elsewhere], takes_back) in
        [([1.3, 1.3], false), ([2.0, 0.99], true), ([100.0, 0.99], false)]
    {
        let eighth = last.errors.len() / 8;
        let errors = last.errors.iter().enumerate();
        let errors = errors.map(|(k, error)| error * if k < eighth { there } else { elsewhere });
        let refused =
            Node::new(&plant, Plant::model(&[(WAVE, &[0.02])]), last.setting, errors.collect());
        climb.refused = vec![(refused, Refusal::AtLimit { parameter: "wave.size".into() })];
        let mut search = search(&plant, lenient());
        let by = search.comparison.compare(&last, &climb.refused[0].0);
        assert!(by.nats < -lenient().better, "{by:?}");
        assert_eq!(search.outdone(&climb, &last).is_some(), takes_back, "{by:?}");
    }
}

#[test]
fn what_every_system_has_is_asked_in_the_place_of_a_name_though_the_search_passed_it_by() {
    let refused = |plant: &Plant, last: &[(usize, &[f64])], before: usize| {
        let mut climb = climb(plant, Vec::new());
        let refusal = Refusal::AtLimit { parameter: "push.size".into() };
        climb.refused = vec![(node(plant, &[(PUSH, &[1e-4])]), refusal); before];
        let mut search = search(plant, lenient());
        let (last, base) = (node(plant, last), climb.base.clone());
        let cost = search.comparison.compare(&base, &last);
        let costs: Vec<_> =
            last.effects(plant).into_iter().map(|term| (term, cost, base.clone())).collect();
        search.ask_unseen(&mut climb, &last, &costs);
        let found = search.outdone(&climb, &last);
        let found = found.map(|(without, told)| (without.effects(plant), told.is_some()));
        (climb.refused.len() - before, found)
    };
    let twin: [(usize, &[f64]); 1] = [(TWIN, &[0.0025])];
    let mut plant = Plant::new(19, &[(WAVE, &[0.0025])]);
    plant.none = Some(WAVE);
    assert_eq!(refused(&plant, &twin, 0), (0, None));
    plant.unseen = Some(WAVE);
    assert_eq!(refused(&plant, &twin, 0), (1, Some((vec![], false))));
    // Where nothing is named there must be something that says what is missing.
    assert_eq!(refused(&plant, &[], 0).0, 0);
    assert_eq!(refused(&plant, &[], 1).0, 1);
    // What it cannot do.
    let mut plant = Plant::new(19, &[(BEAT, &[0.05])]);
    (plant.none, plant.unseen) = (Some(WAVE), Some(WAVE));
    assert_eq!(refused(&plant, &[(BEAT, &[0.05])], 0), (0, None));
}

#[test]
fn what_another_look_refused_is_asked_again_where_it_does_clearly_more() {
    let [wave, push]: [(usize, &[f64]); 2] = [(WAVE, &[0.05]), (PUSH, &[1e-4])];
    let mut plant = Plant::new(20, &[wave]);
    plant.none = Some(WAVE);
    let mut climb = climb(&plant, Vec::new());
    let mut search = search(&plant, narrow());
    let last = node(&plant, &[push]);
    assert_eq!(search.refused_most(&climb, &last), None);
    let start = Plant::model(&[(WAVE, &[0.02])]);
    search.ask_again(&mut climb, &start);
    let model = search.refused_most(&climb, &last).unwrap();
    assert!((model.values[1] - 0.05).abs() < 0.005, "{:?}", model.values);
    assert_eq!(search.refused_most(&climb, &node(&plant, &[wave])), None);
    // What is an effect here is found here.
    plant.none = None;
    let mut climb = self::climb(&plant, Vec::new());
    self::search(&plant, narrow()).ask_again(&mut climb, &start);
    assert!(climb.refused.is_empty());
}

#[test]
fn what_explains_all_that_the_sensors_do_not_is_not_outdone() {
    let all: [(usize, &[f64]); 2] = [(WAVE, &[0.05]), (BEAT, &[0.05])];
    let plant = Plant::new(13, &all);
    let push: (usize, &[f64]) = (PUSH, &[0.01]);
    let mut climb = climb(&plant, Vec::new());
    let refusal = Refusal::AtLimit { parameter: "wave.size".into() };
    climb.refused.push((node(&plant, &all[..1]), refusal));
    let mut last = node(&plant, &[push]);
    let mut search = search(&plant, Thresholds { share: 0.0, ..narrow() });
    assert!(search.outdone(&climb, &last).is_some());
    last.scale = 0.99 * crate::ahead::testing::NOISE;
    assert!(search.outdone(&climb, &last).is_none());
    // Of a base that is complete there is nothing to explain.
    climb.base.scale = 1.2 * crate::ahead::testing::NOISE;
    assert!(search.outdone(&climb, &last).is_some());
    // But for a force that is there beyond doubt: all of it.
    for (before, left, band, explained) in
        [(2.0, 0.4, 0.5, true), (2.0, 0.5, 0.5, false), (2.0, 0.4, 1.1, false)]
    {
        let base = lacks(&climb.base, before, band);
        let is = search.explains(&base, &lacks(&last, left, band));
        assert_eq!(is, explained, "{before} {left} {band}");
    }
}

#[test]
fn a_refused_set_that_goes_on_from_what_was_found_takes_it_back_where_it_does_the_greater_part() {
    let parts = |wave: f64, beat: f64| {
        let hidden: [(usize, &[f64]); 2] = [(WAVE, &[wave]), (BEAT, &[beat])];
        let plant = Plant::new(16, &hidden);
        let mut climb = climb(&plant, Vec::new());
        let refusal = Refusal::AtLimit { parameter: "beat.size".into() };
        climb.refused.push((node(&plant, &hidden), refusal));
        let found = search(&plant, narrow()).outdone(&climb, &node(&plant, &hidden[..1]));
        found.map(|(without, _)| without.effects(&plant))
    };
    assert_eq!(parts(0.02, 0.2), Some(vec![]), "the wave is the smaller part");
    assert_eq!(parts(0.2, 0.02), None);
    // As large as the other part, and a little more.
    let balance = |beat: f64| {
        let hidden: [(usize, &[f64]); 2] = [(WAVE, &[0.1]), (BEAT, &[beat])];
        let plant = Plant::new(16, &hidden);
        let square = |count: usize| node(&plant, &hidden[..count]).scale.powi(2);
        2.0 * square(1) - square(2) - square(0)
    };
    let even = (0..40).fold((0.01, 1.0), |(low, high), _| {
        let middle = 0.5 * (low + high);
        if balance(middle) < 0.0 { (middle, high) } else { (low, middle) }
    });
    assert_eq!(parts(0.1, 0.9999 * even.0), None);
    assert_eq!(parts(0.1, 1.0001 * even.0), Some(vec![]));
    // Where nothing is left nothing is a part of something else.
    assert_eq!(parts(0.001, 0.002), None);
}

#[test]
fn what_does_more_alone_leaves_nothing_to_be_asked_one_by_one() {
    let plant = Plant::new(11, &[(RIVAL, &[0.05])]);
    let last = node(&plant, &[(PUSH, &[1e-3]), (TONE, &[1e-3, 5.0])]);
    let free = node(&plant, &[(RIVAL, &[0.05])]);
    let rival = Rival { term: RIVAL, title: "a wave less a beat", kin: Vec::new() };
    let mut search = search(&plant, narrow());
    let (kept, beside) = search.needed_beside(&node(&plant, &[]), &last, &free, &rival);
    assert!(kept.is_empty());
    assert_eq!(beside.model, free.model);
    assert_eq!(search.decisions.len(), 1, "{:?}", search.decisions[0].candidate);
    // Where each does what the rival does not all stay.
    let plant = Plant::new(11, &[(RIVAL, &[0.05]), (PUSH, &[0.05]), (TONE, &[0.05, 5.0])]);
    let last = node(&plant, &[(PUSH, &[0.05]), (TONE, &[0.05, 5.0])]);
    let free = node(&plant, &[(RIVAL, &[0.05])]);
    let mut search = super::search(&plant, narrow());
    let (kept, _) = search.needed_beside(&node(&plant, &[]), &last, &free, &rival);
    assert_eq!((kept, search.decisions.len()), (vec![PUSH, TONE], 0));
}

#[test]
fn that_the_data_do_not_tell_what_makes_an_effect_that_effect_is_said_of_nothing_else() {
    let plant = Plant::new(13, &[(WAVE, &[0.05])]);
    let climb = climb(&plant, Vec::new());
    let search = search(&plant, narrow());
    let told = |refusal: &Refusal| {
        let gain = Difference { nats: 100.0, error: 10.0, ranks: 3.0 };
        search.unknown(&climb, &node(&plant, &[(WAVE, &[0.05])]), refusal, gain)
    };
    let parameter = "wave.size".to_owned();
    let unknown =
        Refusal::Unknown { parameter: parameter.clone(), low: 0.0, high: 1.0, unit: "V".into() };
    let Some(Remains::Outdone { by, refusal, instead_of, nats }) = told(&unknown) else { panic!() };
    assert_eq!((by, refusal, instead_of, nats), (vec!["wave".into()], unknown, vec![], 100.0));
    assert_eq!(told(&Refusal::AtLimit { parameter }), None);
}
