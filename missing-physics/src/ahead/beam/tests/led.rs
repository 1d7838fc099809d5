//! A set that another reading led to.

use super::*;

const WAVE_AND_TONE: [(usize, &[f64]); 2] = [(WAVE, &[0.05]), (TONE, &[0.05, 5.0])];

/// What is found from a search that ended at its base model, or beside a tone of a wrong frequency.
fn led_to(plant: &Plant, sizes: Vec<Vec<Node>>, led: &[(usize, &[f64])]) -> Found {
    search(plant, Thresholds { most: 3, ..narrow() })
        .finish_led(climb(plant, sizes), node(plant, led))
}

#[test]
fn a_search_that_ended_before_goes_on_from_where_another_one_led() {
    let plant = Plant::new(31, &WAVE_AND_TONE);
    let alone = search(&plant, narrow()).finish(climb(&plant, Vec::new()));
    assert!(alone.added.is_empty());
    let wrong = || vec![vec![node(&plant, &[(TONE, &[0.01, 25.0])])]];
    for sizes in [Vec::new(), wrong()] {
        let found = led_to(&plant, sizes, &WAVE_AND_TONE);
        let mut added = found.added.clone();
        added.sort_unstable();
        assert_eq!(added, [WAVE, TONE]);
        assert!(found.complete, "{:?}", found.places);
        assert_eq!((found.rungs.len(), found.sets.len()), (2, 3));
        // What was looked at beside either size, and beside all of it.
        assert_eq!(found.ranking.len(), 3);
    }
}

#[test]
fn what_another_search_lacks_is_found_beside_where_it_led() {
    let plant = Plant::new(31, &WAVE_AND_TONE);
    let found = led_to(&plant, Vec::new(), &WAVE_AND_TONE[..1]);
    let mut added = found.added.clone();
    added.sort_unstable();
    assert_eq!(added, [WAVE, TONE]);
}

#[test]
fn a_set_that_predicts_no_better_than_what_is_known_is_not_followed() {
    let there: (usize, &[f64]) = (TONE, &[0.05, 5.0]);
    let beside: (usize, &[f64]) = (TONE, &[0.01, 25.0]);
    let plant = Plant::new(31, &[there]);
    let search = search(&plant, narrow());
    let mut known = climb(&plant, vec![vec![node(&plant, &[there])]]);
    assert!(!search.follows(&mut known, &node(&plant, &[beside])));
    assert!(!search.follows(&mut known, &node(&plant, &[])));
    assert!(known.ended && known.nodes[1].len() == 1);
    let mut known = climb(&plant, vec![vec![node(&plant, &[beside])]]);
    assert!(search.follows(&mut known, &node(&plant, &[there])));
    // In the place of the same set, elsewhere.
    assert!(!known.ended && known.nodes[1].len() == 1 && known.ranking.len() == 1);
}
