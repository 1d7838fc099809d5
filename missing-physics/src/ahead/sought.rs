//! What was found in a reading, and how it compares with what another look found.

use super::compare::Comparison;
use super::fit::{Fitter, best_setting};
use super::found::{Found, IN_FULL};
use super::reading::Reading;
use super::refused::refused;
use crate::family::Fitted;
use crate::report::{Decision, Remark};
use crate::task::Thresholds;

/// Effects that a second look goes up to.
pub(super) const PAIR: usize = 2;

/// What was found in a reading.
pub(super) struct Sought<'a> {
    pub(super) reading: &'a Reading<'a>,
    pub(super) found: Found,
    /// Whether it was not asked of all of the recording.
    pub(super) on_part: bool,
}

impl Sought<'_> {
    /// The same without names that are not the cause.
    pub(super) fn judged(mut self, thresholds: &Thresholds) -> Self {
        let Reading { family, .. } = self.reading;
        self.found.judge(*family, self.reading.asked(self.on_part), thresholds);
        self
    }

    /// What share of a recording was searched where that names nothing: what shows in few places may not be among its pieces,
    /// and what is small gains less there than chance may.
    pub(super) fn searched_in_vain(&self, thresholds: &Thresholds) -> Option<f64> {
        let Reading { family, whole, part, .. } = self.reading;
        let part = part.as_ref().filter(|_| !self.on_part)?;
        let mut found = self.found.clone();
        found.judge_force(*family, &**whole, thresholds);
        found.added.is_empty().then(|| part.share())
    }

    /// Whether so few effects leave nothing that no other look can do with less: those that every system has hide none.
    pub(super) fn is_pair(&self) -> bool {
        let added = self.found.added.iter().filter(|term| !self.reading.family.is_usual(**term));
        self.found.complete && added.count() <= PAIR
    }

    /// Whether it leaves nothing where the other does, or does so with fewer effects that do as much.
    pub(super) fn is_plainer_than(&self, other: &Self, thresholds: &Thresholds) -> bool {
        let fewer = self.found.added.len() < other.found.added.len();
        self.found.complete
            && (!other.found.complete || fewer && !self.misses(&other.found, thresholds))
    }

    /// Whether what was found elsewhere does more here than what was found here.
    pub(super) fn misses(&self, other: &Found, thresholds: &Thresholds) -> bool {
        let Reading { family, .. } = *self.reading;
        let ahead = self.reading.asked(self.on_part);
        let model = other.top().0.model.clone().within(family);
        let setting = best_setting(ahead, &model);
        let other = Fitter::new(family, ahead).refit(model, setting, IN_FULL);
        let compare = |from, to| Comparison::new(family, ahead).compare(from, to).nats;
        let share = if self.on_part { ahead.share() } else { 1.0 };
        let clear = thresholds.in_part(share).clear(compare(&self.found.base, &other));
        compare(self.found.top().0, &other) > clear
            && refused(family, ahead, &self.found.base, &other).is_none()
    }

    /// Whether it names nothing, and bears out what the other look found.
    pub(super) fn is_silent_on(&self, other: &Self) -> bool {
        self.found.added.is_empty() && self.reading.bears_out(&other.found)
    }

    /// The same with what was compared before, and refused.
    pub(super) fn after(mut self, decisions: Vec<Decision>, refused: Vec<Fitted>) -> Self {
        self.found.decisions.splice(0..0, decisions);
        self.found.refused.extend(refused);
        self
    }

    /// The same with a remark.
    pub(super) fn but(mut self, remark: Remark) -> Self {
        self.found.remarks.push(remark);
        self
    }

    /// The same where what might have told better was cut, or left no time to be asked of all of the recording.
    pub(super) fn cut(mut self) -> Self {
        self.found.stopped = true;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::fit::evaluated;
    use crate::ahead::testing::{BEAT, Plant, WAVE};

    fn plant() -> Plant {
        Plant::new(1, &[(WAVE, &[0.05])])
    }

    /// A result with so many effects.
    fn sought<'a>(
        reading: &'a Reading<'a>,
        plant: &Plant,
        effects: usize,
        complete: bool,
    ) -> Sought<'a> {
        let base = Fitter::new(plant, plant).refit(Plant::model(&[]), 0, IN_FULL);
        let found = Found { added: vec![WAVE; effects], complete, ..Found::of(base) };
        Sought { reading, found, on_part: false }
    }

    #[test]
    fn what_leaves_nothing_with_fewer_effects_is_plainer_and_what_leaves_something_never_is() {
        let plant = plant();
        let reading = Reading::of(&plant).unwrap();
        let of = |effects, complete| sought(&reading, &plant, effects, complete);
        let is_plainer = |effects, complete, other: &Sought<'_>| {
            of(effects, complete).is_plainer_than(other, &Thresholds::default())
        };
        assert!(is_plainer(1, true, &of(2, true)));
        assert!(is_plainer(3, true, &of(1, false)));
        assert!(!is_plainer(2, true, &of(2, true)));
        assert!(!is_plainer(1, false, &of(2, false)));
    }

    #[test]
    fn a_look_that_misses_what_another_found_is_not_plainer() {
        let plant = plant();
        let reading = Reading::of(&plant).unwrap();
        let other = |size: f64| {
            let model = Plant::model(&[(WAVE, &[size]), (BEAT, &[1e-3])]);
            let mut other = sought(&reading, &plant, 2, true);
            other.found.rungs = vec![evaluated(&plant, model, 0)];
            other
        };
        let is_plainer = |first: &Sought<'_>, wave: &[f64]| {
            let mut second = sought(&reading, &plant, wave.len(), true);
            let nodes = wave.iter().map(|size| Plant::model(&[(WAVE, &[*size])]));
            second.found.rungs = nodes.map(|model| evaluated(&plant, model, 0)).collect();
            second.is_plainer_than(first, &Thresholds::default())
        };
        // A wave is there and no beat.
        assert!(is_plainer(&other(0.05), &[0.05]));
        assert!(!is_plainer(&other(0.05), &[]));
        // What was found elsewhere is asked at its best here.
        assert!(!is_plainer(&other(0.01), &[]));
    }

    #[test]
    fn two_effects_that_leave_nothing_are_a_pair_and_three_are_none() {
        let plant = plant();
        let reading = Reading::of(&plant).unwrap();
        let is_pair = |effects, complete| sought(&reading, &plant, effects, complete).is_pair();
        assert!(is_pair(2, true) && is_pair(0, true));
        assert!(!is_pair(3, true) && !is_pair(2, false));
    }

    #[test]
    fn what_every_plant_has_does_not_count_in_a_pair() {
        let mut plant = plant();
        plant.usual = vec![BEAT];
        let reading = Reading::of(&plant).unwrap();
        let mut three = sought(&reading, &plant, 2, true);
        three.found.added.push(BEAT);
        assert!(three.is_pair());
        three.found.added.push(WAVE);
        assert!(!three.is_pair());
    }

    #[test]
    fn a_cut_look_is_told_and_what_was_compared_before_stands_first() {
        let plant = plant();
        let reading = Reading::of(&plant).unwrap();
        let of_pieces = Remark::SearchedInPieces { share: 0.25 };
        let cut = sought(&reading, &plant, 1, false).but(of_pieces.clone()).cut();
        assert!(cut.found.stopped);
        assert_eq!(cut.found.remarks, [of_pieces]);
        let decision = |rung| Decision {
            rung,
            candidate: Vec::new(),
            compared_with: Vec::new(),
            difference: 0.0,
            standard_error: 0.0,
            budget: 1.0,
            outcome: crate::report::Outcome::TooLittle,
            because: None,
        };
        let mut later = sought(&reading, &plant, 1, true);
        later.found.decisions = vec![decision(2)];
        let all = later.after(vec![decision(1)], Vec::new()).found.decisions;
        assert_eq!(all.iter().map(|d| d.rung).collect::<Vec<_>>(), [1, 2]);
    }

    #[test]
    fn a_family_that_predicts_bears_nothing_out_for_residuals() {
        let plant = plant();
        let reading = Reading::of(&plant).unwrap();
        let silent = sought(&reading, &plant, 0, false);
        let mut other = sought(&reading, &plant, 1, true);
        other.found.rungs = vec![evaluated(&plant, Plant::model(&[(WAVE, &[0.05])]), 0)];
        assert!(!silent.is_silent_on(&other));
        // The same errors, as those of a family that only gives residuals.
        let residuals = Reading { residuals: true, ..Reading::of(&plant).unwrap() };
        assert!(sought(&residuals, &plant, 0, false).is_silent_on(&other));
        assert!(!sought(&residuals, &plant, 1, false).is_silent_on(&other));
        // What changes nothing lowers nothing.
        other.found.rungs = vec![evaluated(&plant, Plant::model(&[]), 0)];
        assert!(!sought(&residuals, &plant, 0, false).is_silent_on(&other));
    }
}
