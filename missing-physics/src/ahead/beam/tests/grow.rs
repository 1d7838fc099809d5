//! Which sets are looked at, and where a search ends.

use super::*;

/// What a search compared at its first size.
fn first(plant: &Plant, candidates: &[usize], thresholds: Thresholds) -> (Climb, Vec<String>) {
    let candidates = candidates.to_vec();
    let mut search = Search::new(plant, plant, thresholds, candidates, &never, &|_| ());
    let climb = search.begin(node(plant, &[]));
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
fn a_search_ends_where_chance_gains_as_much_as_the_best_candidate() {
    // Beside what is missing a tone is fitted and gains something: once what chance seldom does, once what it often does.
    // Whatever it gained would stand.
    for (size, by_chance) in [(0.0005, false), (0.001, true)] {
        let plant = Plant::new(42, &[(BEAT, &[size])]);
        let mut search = Search::new(&plant, &plant, EVERYTHING, vec![TONE], &never, &|_| ());
        let climb = search.begin(search.base(Plant::model(&[])));
        let (Some(told), Some(row)) = (search.decisions.first(), climb.ranking[0].rows.first())
        else {
            panic!("nothing was fitted beside {size}")
        };
        assert_eq!(told.candidate, ["tone"]);
        assert_eq!(climb.ranking[0].chance.p_value(row.2) > 0.5, by_chance, "{row:?}");
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
    let climb = search.begin(node(&plant, &[]));
    let (refused, _) = &climb.refused[0];
    assert_eq!(refused.effects(&plant), [WAVE]);
    assert!(climb.nodes.iter().flatten().all(|set| !set.model.terms.contains(&WAVE)));
    let [Remark::NotNamed { effects, .. }] = &search.remarks[..] else {
        panic!("{:?}", search.remarks)
    };
    assert_eq!(effects, &["wave"]);
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
