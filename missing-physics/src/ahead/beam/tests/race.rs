//! Which candidates are fitted where more of them promise enough than can be.

use super::*;
use crate::ahead::screen::Promise;

#[test]
fn of_more_than_can_be_fitted_those_that_lead_after_a_few_steps_go_on_whatever_they_promised() {
    let plant = Plant::new(1, &[(WAVE, &[0.05])]);
    let search = search(&plant, Thresholds::default());
    let base = search.base(Plant::model(&[]));
    let mut promises = screen(&plant, &plant, &base, &[WAVE, BEAT, PUSH], false).promises;
    for promise in &mut promises {
        promise.gain = [(WAVE, 10.0), (BEAT, 20.0), (PUSH, 30.0)]
            .into_iter()
            .find(|(term, _)| *term == promise.term)
            .map_or(0.0, |(_, gain)| gain);
    }
    promises.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let terms = |first: &[&Promise], most: usize| -> Vec<usize> {
        let raced = search.raced(first, &promises, (base.setting, 5.0), most);
        raced.iter().map(|promise| promise.term).collect()
    };
    // Three that promise enough, for two places: the wave, which promised least, is first.
    assert_eq!(terms(&[], 2)[0], WAVE);
    assert_eq!(terms(&[], 2).len(), 2);
    // One place is taken already, by the first of all.
    assert_eq!(terms(&[&promises[0]], 2), [WAVE]);
    // Where there is a place for each nobody races.
    assert_eq!(terms(&[], 3), [PUSH, BEAT, WAVE]);
    // What promises less than is asked does not begin.
    assert!(search.raced(&[], &promises, (base.setting, 50.0), 1).is_empty());
}
