//! The size of the set, and what goes at the end.

use super::*;

fn sized(search: &mut Search<'_>, climb: &Climb) -> Node {
    search.size(climb, climb.base.clone(), 0)
}

const BOTH_HIDDEN: [(usize, &[f64]); 2] = [(WAVE, &[0.2]), (BEAT, &[0.005])];

#[test]
fn of_sets_that_predict_alike_the_one_with_fewer_parameters_stands() {
    let plant = Plant::new(1, &[(WAVE, &[0.05])]);
    let wave: (usize, &[f64]) = (WAVE, &[0.05]);
    let (more, fewer) =
        (node(&plant, &[wave, (TONE, &[1e-6, 5.0])]), node(&plant, &[wave, (PUSH, &[1e-6])]));
    for sets in [vec![more.clone(), fewer.clone()], vec![fewer, more]] {
        let best = sized(&mut search(&plant, narrow()), &climb(&plant, vec![sets]));
        assert_eq!(best.model.terms, [0, WAVE, PUSH]);
    }
}

#[test]
fn a_set_with_fewer_parameters_does_not_stand_where_it_predicts_worse() {
    let plant = Plant::new(1, &[(WAVE, &[0.05])]);
    let sets = vec![node(&plant, &[(WAVE, &[0.05])]), node(&plant, &[])];
    let best = sized(&mut search(&plant, narrow()), &climb(&plant, vec![sets]));
    assert_eq!(best.model.terms, [0, WAVE]);
}

#[test]
fn a_further_effect_must_gain_a_share_of_what_all_of_them_do() {
    let plant = Plant::new(2, &BOTH_HIDDEN);
    let sizes = || vec![vec![node(&plant, &BOTH_HIDDEN[..1])], vec![node(&plant, &BOTH_HIDDEN)]];
    for (share, effects) in [(0.0, 2), (0.2, 1)] {
        let mut search = search(&plant, Thresholds { share, ..narrow() });
        let best = sized(&mut search, &climb(&plant, sizes()));
        assert_eq!(best.effects(&plant).len(), effects, "{:?}", search.decisions);
        let last = search.decisions.last().unwrap();
        let outcome = if effects == 2 { Outcome::Added } else { Outcome::TooLittle };
        assert_eq!((last.rung, last.outcome), (2, outcome));
    }
}

#[test]
fn an_effect_that_the_others_do_without_goes_and_one_that_they_need_stays() {
    let plant = Plant::new(3, &[(WAVE, &[0.05]), (BEAT, &[0.05])]);
    let all = [(WAVE, &[0.05][..]), (BEAT, &[0.05]), (PUSH, &[1e-4])];
    let mut search = search(&plant, narrow());
    let (kept, costs) = search.prune(&climb(&plant, Vec::new()), node(&plant, &all));
    assert_eq!(kept.effects(&plant), [WAVE, BEAT]);
    assert!(costs.len() == 2 && costs.iter().all(|(_, cost, _)| cost.nats > 20.0), "{costs:?}");
    let [dropped] = &search.decisions[..] else { panic!("{:?}", search.decisions) };
    assert_eq!(dropped.outcome, Outcome::Dropped);
    assert_eq!(dropped.because, Some(Reason::AsGoodWithout));
    assert!(search.none.is_empty(), "another set may need it");
}

#[test]
fn of_several_that_are_not_needed_the_one_with_the_most_parameters_goes_first() {
    let plant = Plant::new(3, &[(WAVE, &[0.05])]);
    // The push costs less.
    let all = [(PUSH, &[1e-5][..]), (WAVE, &[0.05]), (TONE, &[2e-4, 5.0])];
    let mut search = search(&plant, narrow());
    let (kept, _) = search.prune(&climb(&plant, Vec::new()), node(&plant, &all));
    assert_eq!(kept.effects(&plant), [WAVE]);
    let names: Vec<usize> = search.decisions.iter().map(|d| d.candidate.len()).collect();
    assert_eq!(names, [2, 1]);
    assert_eq!(search.decisions[0].candidate, ["push", "wave"]);
}

#[test]
fn an_effect_with_which_the_error_does_not_fall_beside_others_goes_whatever_it_gains() {
    let all = [(WAVE, &[0.05][..]), (BEAT, &[0.05]), (TONE, &[0.01, 5.0])];
    let plant = Plant::new(3, &all);
    let without = node(&plant, &all[..2]).scale;
    for (scale, kept) in [(None, vec![WAVE, BEAT, TONE]), (Some(1.01 * without), vec![WAVE, BEAT])]
    {
        let mut search = search(&plant, narrow());
        let mut best = node(&plant, &all);
        best.scale = scale.unwrap_or(best.scale);
        let (last, _) = search.prune(&climb(&plant, Vec::new()), best);
        assert_eq!(last.effects(&plant), kept, "{:?}", search.decisions);
        let because = search.decisions.first().and_then(|d| d.because.clone());
        assert_eq!(because, scale.map(|_| Reason::ErrorNoLower));
        assert_eq!(
            search.none.into_iter().collect::<Vec<_>>(),
            scale.map_or(vec![], |_| vec![TONE])
        );
    }
}

#[test]
fn where_what_is_no_effect_stood_before_what_is_left_the_search_begins_without_it() {
    let plant = Plant::new(2, &[(WAVE, &[0.05]), (BEAT, &[0.02])]);
    let [both, beat] = [(BOTH, &[0.04][..]), (BEAT, &[0.02])].map(|term| node(&plant, &[term]));
    for (sets, again) in [([&both, &beat], true), ([&beat, &both], false)] {
        let mut search = search(&plant, narrow());
        search.none.insert(BOTH);
        let mut climb = climb(&plant, vec![sets.map(Clone::clone).to_vec()]);
        assert_eq!(search.goes_without(&mut climb, &beat, 1), again);
        assert_eq!(search.candidates.contains(&BOTH), !again);
        assert_eq!(climb.nodes[1][0].effects(&plant), if again { [WAVE] } else { [BEAT] });
        assert_eq!(search.thresholds.most, if again { 1 } else { narrow().most });
    }
}

#[test]
fn beside_an_incomplete_model_an_effect_must_gain_again_and_again() {
    let plant = Plant::new(3, &[(WAVE, &[0.05])]);
    let search = search(&plant, narrow());
    let (mut set, mut without) = (node(&plant, &[]), node(&plant, &[]));
    let mut why = |times: f64, fewer: f64, nats: f64, error: f64, ranks: f64| {
        (set.scale, without.scale) = (times * plant.budget(), fewer * plant.budget());
        search.why_goes(&set, WAVE, Difference { nats, error, ranks }, &without)
    };
    assert_eq!(why(1.5, 2.0, 1000.0, 380.0, 0.0), None);
    assert_eq!(why(1.5, 2.0, 1000.0, 400.0, 2.5), Some(Reason::NotRecurring));
    assert_eq!(why(1.5, 2.0, 1000.0, 900.0, 2.6), None);
    // Errors of a complete model are what the likelihood supposes.
    assert_eq!(why(1.2, 2.0, 1000.0, 450.0, 0.0), None);
    assert_eq!(why(1.1, 1.0, 1000.0, 300.0, 9.0), Some(Reason::ErrorNoLower));
    assert_eq!(why(1.1, 2.0, 0.5 * narrow().better, 0.0, 9.0), Some(Reason::AsGoodWithout));
}

#[test]
fn what_errs_less_than_the_sensors_is_gained_in_their_units() {
    let plant = Plant::new(3, &[(WAVE, &[0.05])]);
    let search = search(&plant, narrow());
    let (mut set, mut without) = (node(&plant, &[]), node(&plant, &[]));
    let better = narrow().better;
    for (times, nats, named) in
        [(0.9, 1.01, true), (2.0, 1.01, true), (0.5, 3.0, false), (0.5, 3.1, true)]
    {
        (set.scale, without.scale) = (0.4 * plant.budget(), times * plant.budget());
        let gain = Difference { nats: nats * better, error: 0.0, ranks: 9.0 };
        let because = search.why_goes(&set, WAVE, gain, &without);
        assert_eq!(because != Some(Reason::WithinSensors), named, "{times} {nats} {because:?}");
    }
}

#[test]
fn a_single_effect_of_an_incomplete_model_goes_where_it_gains_in_one_stretch() {
    let plant = Plant::new(3, &[]);
    // Errors of the base against those of the effect: larger everywhere, or in an eighth of the recording alone.
    for ([there, elsewhere], kept) in [([1.2, 1.2], vec![WAVE]), ([2.0, 0.97], vec![])] {
        let mut search = search(&plant, narrow());
        let mut climb = climb(&plant, Vec::new());
        let eighth = climb.base.errors.len() / 8;
        let errors = climb.base.errors.iter().enumerate();
        let errors = errors.map(|(k, error)| error * if k < eighth { there } else { elsewhere });
        climb.base = Node::new(&plant, Plant::model(&[]), 0, errors.collect());
        let mut set = node(&plant, &[(WAVE, &[1e-5])]);
        (set.scale, climb.base.scale) = (1.5 * plant.budget(), 2.0 * plant.budget());
        let (last, costs) = search.prune(&climb, set);
        let told: Vec<_> = costs.iter().map(|(_, cost, _)| cost).collect();
        assert_eq!(last.effects(&plant), kept, "{told:?}");
        let because = search.decisions.first().and_then(|d| d.because.clone());
        assert_eq!(because, kept.is_empty().then_some(Reason::NotRecurring));
    }
}

#[test]
fn what_acts_wherever_a_system_moves_is_named_by_what_it_gains_where_that_moves_fast() {
    let mut plant = Plant::new(3, &[]);
    let half = plant.instants().len() / 2;
    plant.in_motion = Some((0..plant.instants().len()).map(|k| k >= half).collect());
    // Errors of the base against those of the effect, before it moves fast and then.
    for ([before, then], kept) in
        [([1.2, 1.2], true), ([1.0, 1.3], true), ([1.3, 1.1], true), ([1.3, 1.0], false)]
    {
        let mut search = search(&plant, narrow());
        let mut climb = climb(&plant, Vec::new());
        let errors = climb.base.errors.iter().enumerate();
        let errors = errors.map(|(k, error)| error * if k < half { before } else { then });
        climb.base = Node::new(&plant, Plant::model(&[]), 0, errors.collect());
        let (last, _) = search.prune(&climb, node(&plant, &[(WAVE, &[1e-5])]));
        assert_eq!(last.effects(&plant), if kept { vec![WAVE] } else { vec![] }, "{before} {then}");
        let because = search.decisions.first().and_then(|d| d.because.clone());
        assert_eq!(because, (!kept).then_some(Reason::AtRest));
        assert_eq!(search.none.contains(&WAVE), !kept);
    }
}

#[test]
fn what_rings_is_named_by_what_it_gains_beside_what_the_errors_foretell() {
    // Errors of the base that ring by themselves, or that are larger.
    let rings = |errors: &[f64]| {
        let ring = |past: &mut [f64; 2], error: &f64| {
            *past = [error + 0.6 * past[0] - 0.7 * past[1], past[0]];
            Some(past[0])
        };
        errors.iter().scan([0.0; 2], ring).collect::<Vec<f64>>()
    };
    let larger = |errors: &[f64]| errors.iter().map(|error| 1.3 * error).collect::<Vec<f64>>();
    for (it_rings, foretold, kept) in
        [(true, true, false), (true, false, true), (false, true, true), (false, false, true)]
    {
        let mut plant = Plant::new(3, &[]);
        plant.in_motion = it_rings.then(|| vec![true; plant.instants().len()]);
        let mut search = search(&plant, narrow());
        let mut climb = climb(&plant, Vec::new());
        let errors = &climb.base.errors;
        let errors = if foretold { rings(errors) } else { larger(errors) };
        climb.base = Node::new(&plant, Plant::model(&[]), 0, errors);
        let (last, _) = search.prune(&climb, node(&plant, &[(WAVE, &[1e-5])]));
        assert_eq!(last.effects(&plant), if kept { vec![WAVE] } else { vec![] });
        let because = search.decisions.first().and_then(|d| d.because.clone());
        assert_eq!(because, (!kept).then_some(Reason::Colour));
    }
}

#[test]
fn a_usual_effect_that_came_with_an_alternative_need_not_be_there() {
    let mut plant = Plant::new(9, &[(WAVE, &[0.05])]);
    let alternatives = |plant: &Plant| {
        let wave = node(plant, &[(WAVE, &[0.05])]);
        // Whatever the difference is, they are alike.
        let mut search = search(plant, Thresholds { better: 1e9, ..narrow() });
        search.twins.push(node(plant, &[(PUSH, &[1e-5]), (TWIN, &[0.05])]));
        let climb = climb(plant, vec![vec![wave.clone()]]);
        let cost = search.comparison.compare(&climb.base, &wave);
        let costs = vec![(WAVE, cost, climb.base.clone())];
        let found = search.conclude(climb, &wave, (costs, 0.0), Screened::default(), None);
        found.sets[1].len() - 1
    };
    // Where not every system has it these are two effects, one of which may not be there.
    assert_eq!(alternatives(&plant), 0);
    plant.usual = vec![PUSH];
    assert_eq!(alternatives(&plant), 1);
}

#[test]
fn another_form_of_what_the_base_has_leaves_its_place_to_it_and_is_no_effect_then() {
    let plant = Plant::new(3, &[(WAVE, &[0.05]), (BEAT, &[0.05])]);
    let based = |sizes| Climb { base: node(&plant, &[(WAVE, &[0.05])]), ..climb(&plant, sizes) };
    let bent = node(&plant, &[(BENT, &[0.05, 1e-4]), (BEAT, &[0.05])]);
    // Of the same effects, so that it must not be taken for what is left.
    let mut search = search(&plant, narrow());
    let climb = based(vec![vec![], vec![bent.clone()]]);
    let (kept, costs) = search.prune(&climb, bent.clone());
    assert_eq!(kept.effects(&plant), [BEAT, WAVE]);
    assert_eq!(costs.iter().map(|(term, ..)| *term).collect::<Vec<_>>(), [BEAT]);
    // Where it went to that of the base after the costs were taken.
    let costs = [BENT, BEAT].map(|term| {
        let without = search.without(&climb, &bent, term);
        (term, search.comparison.compare(&without, &bent), without)
    });
    let beside = Screened::default();
    let found = search.conclude(based(vec![]), &kept, (costs.to_vec(), 0.0), beside, None);
    assert_eq!(found.added, [BEAT]);
    assert_eq!((found.rungs.len(), found.costs.len(), found.p_values.len()), (1, 1, 1));
}

#[test]
fn a_single_effect_is_not_dropped_for_what_it_gains() {
    // Whether it is enough was asked where its size was.
    let plant = Plant::new(3, &[]);
    let mut search = search(&plant, narrow());
    let (kept, costs) = search.prune(&climb(&plant, Vec::new()), node(&plant, &[(PUSH, &[1e-4])]));
    assert_eq!((kept.effects(&plant), costs.len()), (vec![PUSH], 1));
}

#[test]
fn an_effect_is_weighed_beside_a_fitted_model_though_time_is_up() {
    // Together a wave and its twin are what is there; either is without the other.
    let plant = Plant::new(3, &[(WAVE, &[0.05])]);
    let both = node(&plant, &[(WAVE, &[0.02]), (TWIN, &[0.03])]);
    let stop = || true;
    let search = Search::new(&plant, &plant, narrow(), ALL.to_vec(), &stop, &|_| ());
    let without = search.without(&climb(&plant, Vec::new()), &both, TWIN);
    let cost = search.comparison.compare(&without, &both).nats;
    assert!(cost < 1.0, "{cost}");
    let as_it_was = node(&plant, &[(WAVE, &[0.02])]);
    assert!(search.comparison.compare(&as_it_was, &both).nats > 20.0);
}

#[test]
fn what_is_left_of_a_refused_set_must_gain_as_much_as_any() {
    let plant = Plant::new(3, &[(WAVE, &[0.05])]);
    let mut search = search(&plant, narrow());
    let climb = climb(&plant, Vec::new());
    let left =
        [&[(PUSH, &[1e-4][..])][..], &[(WAVE, &[0.05])], &[(PUSH, &[1e-4]), (TWIN, &[1e-4])]]
            .map(|terms| search.what_is_left(&climb, &node(&plant, terms)).effects(&plant));
    assert_eq!(left, [vec![], vec![WAVE], vec![PUSH, TWIN]]);
    let dropped: Vec<_> = search.decisions.iter().map(|d| (d.rung, d.outcome)).collect();
    assert_eq!(dropped, [(0, Outcome::Dropped)]);
}

#[test]
fn what_is_left_of_a_refused_set_gives_way_to_one_of_its_size_that_does_clearly_more() {
    let hidden: [(usize, &[f64]); 2] = [(WAVE, &[0.05]), (BEAT, &[0.02])];
    let plant = Plant::new(3, &hidden);
    let [wave, beat] = hidden.map(|effect| node(&plant, &[effect]));
    let none = node(&plant, &[]);
    let climb = climb(&plant, vec![vec![beat.clone(), wave.clone()], vec![node(&plant, &hidden)]]);
    let search = search(&plant, narrow());
    let of_its_size = |left: &Node| search.best_of_its_size(&climb, left.clone()).effects(&plant);
    assert_eq!(of_its_size(&beat), [WAVE]);
    assert_eq!(of_its_size(&wave), [WAVE]);
    assert_eq!(of_its_size(&none), [0; 0]);
    // As good is not better.
    let near = node(&plant, &[(WAVE, &[0.0499])]);
    let kept = search.best_of_its_size(&climb, near.clone());
    assert_eq!(kept.model, near.model);
}

#[test]
fn two_effects_are_taken_together_where_one_gains_too_little_if_each_is_worth_its_gain() {
    let hidden: [(usize, &[f64]); 2] = [(WAVE, &[0.05]), (BEAT, &[0.05])];
    let plant = Plant::new(3, &hidden);
    let one = node(&plant, &[(PUSH, &[1e-4])]);
    let climb = climb(&plant, vec![vec![one], vec![node(&plant, &hidden)]]);
    let gain = search(&plant, narrow()).comparison.compare(&climb.base, &climb.nodes[2][0]).nats;
    for (needed, taken) in [(0.45 * gain, true), (0.55 * gain, false)] {
        let mut search = search(&plant, Thresholds { better: needed, share: 0.0, ..narrow() });
        let best = search.size(&climb, climb.base.clone(), 0);
        assert_eq!(best.effects(&plant).len(), if taken { 2 } else { 0 }, "{needed} of {gain}");
    }
}

#[test]
fn what_chance_gains_as_often_as_it_is_allowed_to_is_not_named() {
    let plant = Plant::new(1, &[(WAVE, &[0.05])]);
    assert_eq!(among(&[WAVE], &plant, narrow(), 1).added, [WAVE]);
    // No shift gains as much, which is one in all of them and not none.
    let found = among(&[WAVE], &plant, Thresholds { chance: 0.0, ..narrow() }, 1);
    assert_eq!(found.added, [0; 0]);
    let dropped = |d: &&Decision| d.outcome == Outcome::Dropped;
    let dropped = found.decisions.iter().find(dropped).unwrap();
    assert_eq!(dropped.because, Some(Reason::Chance));
}

#[test]
fn where_pruning_comes_to_a_set_that_no_size_had_the_search_goes_on_from_there() {
    let hidden = [(WAVE, &[0.2][..]), (BEAT, &[0.12]), (TONE, &[0.04, 5.0])];
    let plant = Plant::new(2, &hidden);
    let thresholds = Thresholds { share: 0.0, ..narrow() };
    let both: (usize, &[f64]) = (BOTH, &[0.001]);
    let set = |more: &[(usize, &[f64])]| vec![node(&plant, more)];
    // Nearly the sum of both came first.
    let sizes = |second| vec![set(&[(BOTH, &[0.15])]), second, set(&[hidden[0], hidden[1], both])];
    let grown = |second| {
        let mut climb = climb(&plant, sizes(second));
        let mut found = search(&plant, thresholds).grown(&mut climb).effects(&plant);
        found.sort_unstable();
        found
    };
    assert_eq!(grown(set(&[(BOTH, &[0.12]), (WAVE, &[0.08])])), [WAVE, BEAT, TONE]);
    // Where a size had it, what comes after it is known.
    assert_eq!(grown(set(&hidden[..2])), [WAVE, BEAT]);
}

#[test]
fn what_every_plant_has_is_told_after_what_is_needed_as_much() {
    let all = [(WAVE, &[0.05][..]), (BEAT, &[0.05])];
    let told = |usual: &[usize], share: f64| {
        let mut plant = Plant::new(3, &all);
        plant.usual = usual.to_vec();
        let mut search = search(&plant, Thresholds { share, ..narrow() });
        let climb = climb(&plant, Vec::new());
        let (last, costs) = search.prune(&climb, node(&plant, &all));
        search.conclude(climb, &last, (costs, 0.0), Screened::default(), None).added
    };
    let order = told(&[], 0.0);
    assert_eq!(told(&order[..1], 0.0), order, "one is needed more");
    assert_eq!(told(&order[..1], 1.0), [order[1], order[0]]);
}

#[test]
fn sets_are_alike_by_what_this_search_asks_of_an_effect_or_what_gains_more_without_a_name() {
    let hidden: [(usize, &[f64]); 2] = [(WAVE, &[0.05]), (BEAT, &[0.05])];
    let plant = Plant::new(3, &hidden);
    let alike = |refused: Vec<Node>| {
        let mut search = search(&plant, narrow());
        let mut climb = climb(&plant, Vec::new());
        let refusal = Refusal::AtLimit { parameter: "beat.size".into() };
        climb.refused = refused.into_iter().map(|node| (node, refusal.clone())).collect();
        let (last, costs) = search.prune(&climb, node(&plant, &hidden[..1]));
        search.conclude(climb, &last, (costs, 0.0), Screened::default(), None).alike
    };
    assert_eq!(alike(Vec::new()), narrow().better);
    assert!(alike(vec![node(&plant, &hidden)]) > 2.0 * narrow().better);
}

#[test]
fn a_set_of_a_usual_effect_more_is_an_alternative_where_it_predicts_no_worse() {
    let mut plant = Plant::new(9, &[(WAVE, &[0.05])]);
    let alternatives = |plant: &Plant, twin: f64| {
        let wave = node(plant, &[(WAVE, &[0.049])]);
        // However far behind, what is as large is alike.
        let search = search(plant, Thresholds { better: 1e9, ..narrow() });
        let more = node(plant, &[(PUSH, &[1e-5]), (TWIN, &[twin])]);
        let climb = climb(plant, vec![vec![wave.clone()], vec![more]]);
        let cost = search.comparison.compare(&climb.base, &wave);
        let costs = vec![(WAVE, cost, climb.base.clone())];
        let found = search.conclude(climb, &wave, (costs, 0.0), Screened::default(), None);
        found.sets[1].len() - 1
    };
    // Where not every system has it these are two effects.
    assert_eq!(alternatives(&plant, 0.05), 0);
    plant.usual = vec![PUSH];
    assert_eq!(alternatives(&plant, 0.05), 1);
    assert_eq!(alternatives(&plant, 0.03), 0);
}
