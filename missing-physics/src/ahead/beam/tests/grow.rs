//! Which sets are looked at, and where a search ends.

use super::*;
use crate::ahead::screen::Promise;

/// What a search compared at its first size.
fn first(plant: &Plant, candidates: &[usize], thresholds: Thresholds) -> (Climb, Vec<String>) {
    let candidates = candidates.to_vec();
    let mut search = Search::new(plant, plant, thresholds, candidates, &never, &|_| ());
    let climb = search.begin(node(plant, &[]), Vec::new());
    let names = search.decisions.iter().flat_map(|d| d.candidate.clone());
    (climb, names.collect())
}

/// Whatever it gains, it stands beside the others.
const EVERYTHING: Thresholds = Thresholds {
    better: -1e6,
    share: 0.0,
    complete: 1.3,
    local: 2.0,
    chance: 0.05,
    beam: 3,
    fitted: 5,
    most: 4,
};

#[test]
fn the_search_goes_on_from_several_sets_unless_one_is_inside_the_budget() {
    let inside = Plant::new(1, &[(WAVE, &[0.05])]);
    assert_eq!(first(&inside, &ALL, EVERYTHING).0.beam.len(), 1);
    let outside = Plant::new(1, &[(WAVE, &[0.05]), (BEAT, &[0.05])]);
    assert_eq!(first(&outside, &ALL, EVERYTHING).0.beam.len(), 3);
}

#[test]
fn where_a_leading_candidate_is_inside_the_budget_those_that_promise_little_are_not_fitted() {
    // The beat promises more than nothing: it is fitted where more than a wave is missing.
    let names = |plant: &Plant| first(plant, &[WAVE, BOTH, BEAT], EVERYTHING).1;
    assert_eq!(names(&Plant::new(1, &[(WAVE, &[0.05])])), ["wave", "both"]);
    let outside = Plant::new(1, &[(WAVE, &[0.05]), (TONE, &[0.05, 5.0])]);
    assert!(names(&outside).contains(&"beat".to_owned()), "{:?}", names(&outside));
}

#[test]
fn a_base_model_elsewhere_is_a_start_and_no_model_to_be_better_than() {
    let plant = Plant::new(1, &[(WAVE, &[0.05])]);
    let gain = |elsewhere: Option<f64>| {
        let mut search = search(&plant, Thresholds::default());
        let at = |drive| {
            let mut model = Plant::model(&[]);
            model.values[0] = drive;
            search.base_holding(model)
        };
        let (base, elsewhere) = (at(1.0), elsewhere.map(at).into_iter().collect());
        let climb = search.begin(base, elsewhere);
        let most = search.decisions.iter().map(|d| d.difference).fold(0.0, f64::max);
        (search.key(climb.top().0), most, search.decisions.len())
    };
    let (here, both) = (gain(None), gain(Some(1.01)));
    assert_eq!(here.0, both.0);
    assert!(both.2 > here.2 && (both.1 / here.1 - 1.0).abs() < 0.05, "{here:?} {both:?}");
}

#[test]
fn beside_the_base_what_promises_far_less_than_it_must_gain_is_not_fitted() {
    // Something is there, and so small that it promises a few nats.
    let plant = Plant::new(6, &[(WAVE, &[2.5e-4])]);
    let fitted = |better: f64| {
        let mut search = search(&plant, Thresholds { better, ..Thresholds::default() });
        let base = search.base(Plant::model(&[]));
        let (children, screened) = search.expand(&base, &base, 1, None);
        (children.len(), screened.promises.iter().map(|p| p.gain).fold(0.0, f64::max))
    };
    let (few, most) = fitted(80.0);
    assert!(few == 0 && most > 2.0 && most < 12.0, "{few} {most}");
    assert!(fitted(most).0 > 0);
}

#[test]
fn what_was_screened_beside_a_model_as_good_is_not_screened_again() {
    let plant = Plant::new(6, &[(WAVE, &[0.1])]);
    let search = search(&plant, narrow());
    let with = |size: f64| node(&plant, &[(WAVE, &[size])]);
    let mut climb = climb(&plant, vec![vec![with(0.1)]]);
    // A screening that no other one is.
    climb.screened.push((with(0.1), Screened::default()));
    let again = |node: &Node| !search.beside(&climb, node).promises.is_empty();
    assert!(!again(&with(0.1)) && !again(&with(0.1001)));
    let elsewhere = fit::evaluated(&plant, Plant::model(&[(WAVE, &[0.1])]), 1);
    assert!(again(&elsewhere) && again(&climb.base));
}

#[test]
fn a_search_ends_where_chance_gains_as_much_as_the_best_candidate() {
    // Beside what is missing a tone is fitted and gains something: once what chance seldom does, once what it often does.
    // Whatever it gained would stand.
    for (size, by_chance) in [(0.0005, false), (0.001, true)] {
        let plant = Plant::new(42, &[(BEAT, &[size])]);
        let mut search = Search::new(&plant, &plant, EVERYTHING, vec![TONE], &never, &|_| ());
        let climb = search.begin(search.base(Plant::model(&[])), Vec::new());
        let (Some(told), Some(row)) = (search.decisions.first(), climb.ranking[0].rows.first())
        else {
            panic!("nothing was fitted beside {size}")
        };
        assert_eq!(told.candidate, ["tone"]);
        assert_eq!(climb.ranking[0].chance.p_value(row.nats) > 0.5, by_chance, "{row:?}");
        assert_eq!((climb.ended, climb.nodes.len() == 1), (by_chance, by_chance));
    }
}

#[test]
fn what_gains_too_little_is_no_set_to_go_on_from() {
    let plant = Plant::new(1, &[(WAVE, &[0.05])]);
    let (climb, _) = first(&plant, &[WAVE], narrow());
    assert!(!climb.ended && climb.nodes.len() == 2);
    let (climb, names) = first(&plant, &[WAVE], Thresholds { better: 1e6, ..narrow() });
    assert!(climb.ended && climb.nodes.len() == 1);
    assert_eq!(names, ["wave"]);
}

#[test]
fn what_is_refused_is_kept_for_comparison_told_and_not_gone_on_from() {
    let mut plant = Plant::new(1, &[(WAVE, &[0.05])]);
    plant.none = Some(WAVE);
    let mut search = search(&plant, narrow());
    let base = || node(&plant, &[(BEAT, &[1e-3])]);
    let climb = search.begin(base(), Vec::new());
    let (refused, _) = &climb.refused[0];
    assert_eq!(refused.effects(&plant), [BEAT, WAVE]);
    assert!(climb.nodes.iter().flatten().all(|set| !set.model.terms.contains(&WAVE)));
    let [Remark::NotNamed { effects, .. }] = &search.remarks[..] else {
        panic!("{:?}", search.remarks)
    };
    assert_eq!(effects, &["wave"]);
    search.begin(base(), Vec::new());
    assert_eq!(search.remarks.len(), 1, "told once");
}

#[test]
fn a_related_effect_is_fitted_where_one_that_it_is_related_to_leads() {
    let mut plant = Plant::new(1, &[(WAVE, &[0.05])]);
    let names = |plant: &Plant, candidates: &[usize]| {
        let mut names = first(plant, candidates, EVERYTHING).1;
        names.sort();
        names
    };
    // A push promises nothing by itself.
    assert_eq!(names(&plant, &[WAVE, PUSH]), ["wave"]);
    plant.related = Some((WAVE, PUSH));
    assert_eq!(names(&plant, &[WAVE, PUSH]), ["push", "wave"]);
    assert_eq!(names(&plant, &[WAVE]), ["wave"], "no candidate");
}

/// Promises of terms in this order, the first one the largest.
fn promises(terms: &[usize]) -> Vec<Promise> {
    let promise = |(place, term): (usize, &usize)| Promise {
        term: *term,
        gain: 100.0 - place as f64,
        starts: Vec::new(),
        leverage: None,
    };
    terms.iter().enumerate().map(promise).collect()
}

fn terms(chosen: &[&Promise]) -> Vec<usize> {
    chosen.iter().map(|promise| promise.term).collect()
}

#[test]
fn at_most_two_forms_of_an_effect_are_fitted_and_they_are_one_effect() {
    let mut plant = Plant::new(1, &[]);
    plant.forms = vec![(BENT, WAVE), (BEAT, WAVE)];
    let search = search(&plant, narrow());
    let all = promises(&[WAVE, BENT, BEAT, TONE, PUSH]);
    assert_eq!(terms(&search.chosen(&all, 0.0, 5)), [WAVE, BENT, TONE, PUSH]);
    assert_eq!(terms(&search.chosen(&all, 0.0, 2)), [WAVE, BENT, TONE]);
    assert_eq!(terms(&search.chosen(&all, 99.5, 5)), [WAVE]);
}

#[test]
fn beside_sets_that_are_not_the_best_eight_effects_are_looked_at_whatever_their_forms() {
    let mut plant = Plant::new(1, &[]);
    plant.forms = vec![(2, 1), (5, 4)];
    let leading = search(&plant, narrow()).leading(&promises(&[9, 1, 2, 3, 4, 5, 6, 7, 8, 10, 11]));
    assert_eq!(leading.into_iter().collect::<Vec<_>>(), [1, 3, 4, 6, 7, 8, 9, 10]);
}

#[test]
fn the_search_ends_where_a_smaller_set_predicts_better() {
    let plant = Plant::new(1, &[(WAVE, &[0.05]), (BEAT, &[0.04])]);
    let fitted = |term| search(&plant, narrow()).refit(&Plant::model(&[(term, &[0.05])]), 1, 6);
    let [wave, push] = [WAVE, PUSH].map(fitted);
    // The beat is found beside a push, which is not there.
    for (sets, ends) in [(vec![push.clone()], false), (vec![wave, push.clone()], true)] {
        let mut climb =
            Climb { beam: vec![push.clone()], ended: false, ..climb(&plant, vec![sets]) };
        let thresholds = Thresholds { better: 10.0, ..narrow() };
        let mut search = Search::new(&plant, &plant, thresholds, vec![BEAT], &never, &|_| ());
        search.grow(&mut climb);
        assert_eq!((climb.ended, climb.beam.is_empty()), (ends, ends));
        let compared: Vec<Vec<usize>> =
            climb.nodes[2].iter().map(|set| set.effects(&plant)).collect();
        assert_eq!(compared, [[PUSH, BEAT]], "it is told how much worse it is");
    }
}

/// Terms of the last effect of each set beside a wave, where that set lags so far behind.
fn beside_a_wave(promised: &[usize], lag: f64) -> Vec<usize> {
    let plant = Plant::new(1, &[(WAVE, &[0.05]), (BEAT, &[0.05]), (TONE, &[0.05, 5.0])]);
    let mut search = search(&plant, EVERYTHING);
    search.promised.extend(promised);
    let (base, from) = (node(&plant, &[]), node(&plant, &[(WAVE, &[0.05])]));
    let (children, _) = search.expand(&base, &from, 1, Some(lag));
    let mut last: Vec<usize> =
        children.iter().filter_map(|child| child.model.terms.last().copied()).collect();
    last.sort_unstable();
    last
}

#[test]
fn beside_a_set_that_lags_only_what_promised_beside_the_best_is_fitted() {
    assert_eq!(beside_a_wave(&[BEAT, TONE], 0.0), [BEAT, TONE]);
    assert_eq!(beside_a_wave(&[TONE], 0.0), [TONE]);
}

#[test]
fn beside_a_set_that_lags_far_behind_what_promises_too_little_to_catch_up_is_not_fitted() {
    // A beat and a tone promise some hundred nats here.
    assert_eq!(beside_a_wave(&[BEAT, TONE], 1e3), [BEAT, TONE]);
    assert_eq!(beside_a_wave(&[BEAT, TONE], 1e5), [0; 0]);
}

#[test]
fn what_is_related_to_an_effect_that_errs_much_more_than_the_best_is_not_fitted() {
    let names = |size: f64| {
        let mut plant = Plant::new(1, &[(WAVE, &[size])]);
        plant.related = Some((BOTH, PUSH));
        first(&plant, &[WAVE, BOTH, PUSH], EVERYTHING).1
    };
    for (size, is_fitted) in [(0.05, false), (0.01, true)] {
        let names = names(size);
        assert!(names.contains(&"both".to_owned()), "{size}: {names:?}");
        assert_eq!(names.contains(&"push".to_owned()), is_fitted, "{size}: {names:?}");
    }
}
