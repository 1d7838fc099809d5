//! What is another law of a usual effect of the base model.

use super::*;

/// What is found beside a base model with a wave, of which what is nearly a wave and a beat is another law.
fn beside_wave(hidden: &[(usize, &[f64])], law: bool) -> Found {
    let mut plant = Plant::new(21, hidden);
    if law {
        plant.laws = vec![(BOTH, WAVE)];
    }
    let thresholds = Thresholds { most: 2, ..narrow() };
    let search = |candidates| Search::new(&plant, &plant, thresholds, candidates, &never, &|_| ());
    let mut search = search(vec![BOTH, TONE]);
    let base = search.base(Plant::model(&[(WAVE, &[0.05])]));
    let climb = search.begin(base, Vec::new());
    search.finish(climb)
}

const LAW: (usize, &[f64]) = (BOTH, &[0.05]);

#[test]
fn a_law_that_leaves_nothing_of_a_usual_effect_stands_in_the_base() {
    let found = beside_wave(&[LAW], true);
    assert!(found.added.is_empty(), "{:?}", found.added);
    assert!(found.complete && found.rival.is_none());
    assert_eq!(found.base.model.terms, [DRIVE, WAVE, BOTH]);
    let [Remark::OtherLaw { of, law, nats }] = &found.remarks[..] else {
        panic!("{:?}", found.remarks)
    };
    assert_eq!((of.as_str(), law.as_str()), ("wave", "both"));
    assert!(*nats > 100.0, "{nats}");
    let asked = found.decisions.iter().find(|d| d.because == Some(Reason::OtherLaw)).unwrap();
    assert_eq!(
        (asked.outcome, &asked.candidate[..]),
        (Outcome::Added, &["wave".to_owned(), "both".to_owned()][..])
    );
    // Of what is no law of another it is a name.
    assert_eq!(beside_wave(&[LAW], false).added, [BOTH]);
}

#[test]
fn beside_a_law_that_stands_in_the_base_another_effect_is_found() {
    let found = beside_wave(&[LAW, (TONE, &[0.03, 5.0])], true);
    assert_eq!(found.added, [TONE]);
    assert!(found.base.model.terms.contains(&BOTH));
}

#[test]
fn what_stands_on_some_of_either_does_not_hide_that_a_law_alone_leaves_nothing() {
    let mut plant = Plant::new(21, &[LAW, (TONE, &[0.03, 5.0])]);
    plant.laws = vec![(BOTH, WAVE)];
    let mut search = search(&plant, narrow());
    let mut climb = climb(&plant, Vec::new());
    climb.base = search.base(Plant::model(&[(WAVE, &[0.05])]));
    // As the beam may leave it: half of the wave beside half of the law.
    let last = node(&plant, &[(WAVE, &[0.02]), (BOTH, &[0.025]), (TONE, &[0.03, 5.0])]);
    let with = search.with_other_law(&climb, &last).unwrap();
    assert_eq!(with.model.terms, [DRIVE, WAVE, BOTH]);
    // Beside what is a wave for the most part it is none.
    let last = node(&plant, &[(WAVE, &[0.02]), (TONE, &[0.03, 5.0])]);
    assert!(search.with_other_law(&climb, &last).is_none());
}

#[test]
fn a_law_beside_what_it_is_a_law_of_is_an_effect() {
    let found = beside_wave(&[LAW, (WAVE, &[0.1])], true);
    assert_eq!(found.added, [BOTH]);
    assert!(found.remarks.is_empty(), "{:?}", found.remarks);
}

#[test]
fn of_a_usual_effect_that_the_base_has_none_of_nothing_is_left() {
    let mut plant = Plant::new(21, &[LAW]);
    plant.laws = vec![(BOTH, WAVE)];
    let mut search = search(&plant, narrow());
    let mut climb = climb(&plant, Vec::new());
    climb.base = node(&plant, &[(WAVE, &[0.0])]);
    let last = |wave: f64| node(&plant, &[(WAVE, &[wave]), LAW]);
    assert!(search.with_other_law(&climb, &last(0.0)).is_some());
    assert!(search.with_other_law(&climb, &last(0.01)).is_none());
}

#[test]
fn what_stands_for_the_reading_stands_in_the_base() {
    let found = |hidden: &[(usize, &[f64])]| {
        let mut plant = Plant::new(21, hidden);
        plant.read = Some(PUSH);
        let thresholds = Thresholds { most: 2, ..narrow() };
        let candidates = vec![PUSH, WAVE];
        let mut search = Search::new(&plant, &plant, thresholds, candidates, &never, &|_| ());
        let base = search.base(Plant::model(&[]));
        let climb = search.begin(base, Vec::new());
        search.finish(climb)
    };
    let read: (usize, &[f64]) = (PUSH, &[0.05]);
    let both = found(&[read, (WAVE, &[0.1])]);
    assert_eq!(both.added, [WAVE]);
    assert_eq!(both.base.model.terms, [DRIVE, PUSH]);
    assert!(both.complete && both.rival.is_none(), "{:?}", both.rival);
    let alone = found(&[read]);
    assert!(alone.added.is_empty() && alone.complete);
    assert_eq!(alone.base.model.terms, [DRIVE, PUSH]);
    // The wave hides most of what it gains.
    for (told, least) in [(both.remarks, 0.0), (alone.remarks, 10.0)] {
        let [Remark::OfReading { effect, nats, .. }] = &told[..] else { panic!("{told:?}") };
        assert!(effect == "push" && *nats > least, "{told:?}");
    }
}
