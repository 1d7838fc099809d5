//! What every system has, in the place of what varies it.

use super::*;

/// The effects that are found among a wave, a beat and what is nearly both, and whether the usual ones were asked.
fn among_three(usual: &[usize], hidden: &[(usize, &[f64])]) -> (BTreeSet<usize>, bool) {
    let mut plant = Plant::new(1, hidden);
    plant.usual = usual.to_vec();
    let found = among(&[WAVE, BEAT, BOTH], &plant, Thresholds::default(), 4);
    let asked = found.decisions.iter().any(|d| d.because == Some(Reason::Usual));
    (found.added.into_iter().collect(), asked)
}

#[test]
fn what_every_plant_has_stands_where_one_effect_does_as_much() {
    let two: [(usize, &[f64]); 2] = [(WAVE, &[0.004]), (BEAT, &[0.004])];
    assert_eq!(among_three(&[], &two), ([BOTH].into(), false));
    assert_eq!(among_three(&[WAVE, BEAT], &two), ([WAVE, BEAT].into(), true));
}

#[test]
fn an_effect_stays_where_the_usual_ones_do_less() {
    assert_eq!(among_three(&[WAVE, BEAT], &[(BOTH, &[0.3])]), ([BOTH].into(), true));
    // Nothing usual is missing.
    assert_eq!(among_three(&[TONE], &[(BOTH, &[0.3])]), ([BOTH].into(), false));
}

#[test]
fn before_nothing_explains_it_the_usual_effects_are_given() {
    let hidden: [(usize, &[f64]); 2] = [(PUSH, &[0.1]), (WAVE, &[0.1])];
    for (usual, known, found) in [
        (vec![PUSH], None, vec![PUSH, WAVE]),
        (vec![], None, vec![]),
        // The search has been there.
        (vec![PUSH], Some(node(&Plant::new(5, &hidden), &hidden[..1])), vec![]),
    ] {
        let mut plant = Plant::new(5, &hidden);
        plant.usual = usual;
        let mut climb = climb(&plant, known.into_iter().map(|set| vec![set]).collect());
        let base = climb.base.clone();
        let best = search(&plant, narrow()).beside_usual(&mut climb, base);
        assert_eq!(best.effects(&plant), found);
        assert_eq!(climb.nodes.len(), if found.is_empty() { climb.nodes.len() } else { 3 });
    }
}

#[test]
fn with_the_usual_effects_alone_nothing_is_explained_that_was_not_before() {
    let mut plant = Plant::new(5, &[(WAVE, &[0.1])]);
    plant.usual = vec![PUSH];
    let mut climb = climb(&plant, Vec::new());
    let wave = node(&plant, &[(WAVE, &[0.1])]);
    let best = search(&plant, narrow()).beside_usual(&mut climb, wave);
    assert_eq!((best.effects(&plant), climb.nodes.len()), (vec![WAVE], 1));
}

#[test]
fn what_is_refused_beside_the_usual_effects_is_known_where_they_are_not_taken() {
    let [push, wave]: [(usize, &[f64]); 2] = [(PUSH, &[0.002]), (WAVE, &[0.1])];
    let mut plant = Plant::new(5, &[push, wave]);
    (plant.usual, plant.none) = (vec![PUSH], Some(WAVE));
    let mut climb = climb(&plant, Vec::new());
    let found = node(&plant, &[(TWIN, &[0.1])]);
    let best = search(&plant, narrow()).beside_usual(&mut climb, found);
    assert_eq!(best.effects(&plant), [TWIN]);
    let refused: Vec<_> = climb.refused.iter().map(|(set, _)| set.effects(&plant)).collect();
    assert!(refused.contains(&vec![PUSH, WAVE]), "{refused:?}");
}
