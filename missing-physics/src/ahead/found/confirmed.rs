//! What a search of a part of a recording found, asked of all of it.

use rayon::prelude::*;

use super::Found;
use crate::ahead::Ahead;
use crate::ahead::compare::Comparison;
use crate::ahead::fit::{self, Fitter};
use crate::ahead::node::Node;
use crate::ahead::refused::{as_read, refused, unknown};
use crate::family::{Fitted, ModelFamily};
use crate::report::{Refusal, Remains, Remark};
use crate::task::Thresholds;

/// Steps of a refit on all of a recording that was searched in part.
pub const IN_FULL: usize = 8;

impl Found {
    /// Brings what was found on a part to all of the recording: every rung is refitted there, and what gains too little
    /// or no more than chance, or lowers no error beside others, goes. Nothing where it is told to stop before that is done.
    pub fn confirmed(
        mut self,
        family: &dyn ModelFamily,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Self> {
        if stop() {
            return None;
        }
        let comparison = Comparison::new(family, ahead);
        let fitter = Fitter::new(family, ahead).stopped_by(stop);
        let whole = |model: &Fitted| {
            let setting = fit::best_setting(ahead, model);
            fitter.fit(model.clone(), setting, IN_FULL)
        };
        let main = |t: usize| family.form_of(t).unwrap_or(t);
        let without = |node: &Node, term: usize| {
            let form = node.model.terms.iter().find(|t| main(**t) == main(term));
            form.map(|form| whole(&node.model.without(family, *form)))
        };
        self.base = whole(&self.base.model);
        self.rungs = self.rungs.par_iter().map(|rung| whole(&rung.model)).collect();
        // With a term more a model can do no worse: a part leads astray where it does not reach.
        for k in 0..self.rungs.len() {
            let below = k.checked_sub(1).map_or(&self.base, |k| &self.rungs[k]);
            let rung = &self.rungs[k];
            if rung.foretells_more(below) {
                continue;
            }
            let form = rung.model.terms.iter().position(|t| main(*t) == main(self.added[k]));
            let Some(form) = form else { continue };
            let values = &rung.model.values[rung.model.range(family, form)];
            // Each at the setting that suits it: else the one that was looked for longer gains by that.
            let below = fitter.settled(below.clone(), IN_FULL);
            let start = below.model.with(rung.model.terms[form], values);
            let again = fitter.refit(start, below.setting, IN_FULL);
            if again.foretells_more(rung) {
                *k.checked_sub(1).map_or(&mut self.base, |k| &mut self.rungs[k]) = below;
                self.rungs[k] = again;
            }
        }
        while let Some(top) = self.rungs.last() {
            if stop() {
                return None;
            }
            // All of the recording may take an effect to where it is none.
            let place = |term: usize| self.added.iter().position(|t| main(*t) == main(term));
            let refused = refused(family, ahead, &self.base, top)
                .or_else(|| as_read(family, ahead, &self.base, top));
            let mut goes = refused.and_then(|(term, refusal)| Some((place(term)?, Some(refusal))));
            if goes.is_none() {
                let last = self.added.len() - 1;
                let below = last.checked_sub(1).map_or(&self.base, |k| &self.rungs[k]);
                let costs = self.added.par_iter().enumerate().map(|(k, term)| {
                    let without = if k == last { None } else { without(top, *term) };
                    let without = without.as_ref().unwrap_or(below);
                    // A single effect with which no error falls has a remark of its own.
                    (comparison.compare(without, top), last == 0 || top.foretells_more(without))
                });
                let (costs, lowers): (Vec<_>, Vec<_>) = costs.unzip();
                self.p_values = costs.iter().map(|c| self.chance.p_value(c.nats)).collect();
                self.costs = costs;
                let each = self.costs.iter().zip(&self.p_values).enumerate();
                let idle = each.filter(|(k, (cost, p))| {
                    cost.nats < thresholds.better || **p > thresholds.chance || !lowers[*k]
                });
                let least = idle.min_by(|a, b| a.1.0.nats.total_cmp(&b.1.0.nats));
                goes = least.map(|(place, _)| (place, None));
                goes = goes.or_else(|| {
                    let (term, refusal) = unknown(family, ahead, &self.base, top)?;
                    Some((place(term)?, Some(refusal)))
                });
            }
            let Some((idle, refusal)) = goes else { break };
            let term = self.added.remove(idle);
            self.alike = self.alike.max(self.costs.get(idle).map_or(0.0, |cost| cost.nats));
            let effect = family.terms()[term].name.clone();
            if self.added.is_empty()
                && let Some(refusal @ Refusal::Unknown { .. }) = &refusal
            {
                // Something is missing all the same.
                let nats = comparison.compare(&self.base, top).nats;
                let by = vec![effect.clone()];
                let refusal = refusal.clone();
                let outdone = Remains::Outdone { by, refusal, instead_of: Vec::new(), nats };
                self.rival.get_or_insert(outdone);
            }
            self.remarks.push(match refusal {
                Some(refusal) => Remark::NotNamed { effects: vec![effect], refusal },
                None => Remark::FoundInPartOnly { effect },
            });
            let mut rungs = std::mem::take(&mut self.rungs);
            let above = rungs.split_off(idle + 1);
            rungs.pop();
            rungs.extend(
                above.par_iter().filter_map(|rung| without(rung, term)).collect::<Vec<_>>(),
            );
            self.rungs = rungs;
        }
        if self.rungs.is_empty() {
            self.costs.clear();
            self.p_values.clear();
        }
        let before = std::iter::once(&self.base).chain(&self.rungs);
        self.gains = before.zip(&self.rungs).map(|(a, b)| comparison.compare(a, b)).collect();
        if thresholds.most == 0 {
            // Nothing is to be added: what candidates gain is all that is told.
            let fitted = |start: &Fitted| {
                let node = whole(start);
                let nats = comparison.compare(&self.base, &node).nats;
                (node.model, nats)
            };
            let gain = |term: usize, model: &Fitted| {
                let found = fitted(model);
                let place = model.terms.iter().position(|other| *other == term);
                let Some(place) = place.filter(|_| found.1 < 0.0) else { return found };
                // A part led to another valley: with a term more a model can do no worse.
                let values = &model.values[model.range(family, place)];
                let again = fitted(&self.base.model.with(term, values));
                if again.1 > found.1 { again } else { found }
            };
            if let Some(ranked) = self.ranking.first_mut() {
                ranked.ask(thresholds.better, gain);
            }
        }
        // What was cut short is no fit.
        if stop() {
            return None;
        }
        self.place(family, ahead, thresholds);
        Some(self)
    }

    /// What was found on a `share` of the recording, where time ran out before all of it was asked: gains are those that
    /// they stand for on all of it.
    #[must_use]
    pub fn unconfirmed(mut self, share: f64) -> Self {
        for difference in self.gains.iter_mut().chain(&mut self.costs) {
            difference.nats /= share;
            difference.error /= share;
        }
        self.stopped = true;
        self.remarks.push(Remark::Unconfirmed { share });
        self
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::ahead::chance::Chance;
    use crate::ahead::compare::Difference;
    use crate::ahead::found::{Ranked, Row};
    use crate::ahead::testing::{BEAT, Plant, WAVE};

    #[test]
    fn what_gains_too_little_on_all_of_the_recording_is_taken_back_from_wherever_it_stood() {
        // The part had a beat that the whole does not have; it stands below the wave.
        let whole = Plant::new(1, &[(WAVE, &[0.05])]);
        let node = |terms| fit::evaluated(&whole, Plant::model(terms), 0);
        let rungs = vec![node(&[(BEAT, &[0.03])]), node(&[(BEAT, &[0.03]), (WAVE, &[0.05])])];
        let found = Found { added: vec![BEAT, WAVE], rungs, ..Found::of(node(&[])) };
        // Nothing is known of chance here.
        let thresholds = Thresholds { better: 20.0, chance: 1.0, ..Thresholds::default() };
        let found = found.confirmed(&whole, &whole, &thresholds, &|| false).unwrap();
        assert_eq!(found.added, [WAVE]);
        assert_eq!(found.rungs.len(), 1);
        assert!(!found.rungs[0].model.terms.contains(&BEAT));
        assert_eq!(found.remarks, [Remark::FoundInPartOnly { effect: "beat".into() }]);
        assert!(found.gains[0].nats > 20.0 && found.complete);
    }

    #[test]
    fn where_nothing_is_to_be_added_candidates_are_told_by_what_they_gain_on_all_of_the_recording()
    {
        let whole = Plant::new(1, &[(WAVE, &[0.05])]);
        let node = |terms| fit::evaluated(&whole, Plant::model(terms), 0);
        let row = |terms: &[(usize, &[f64])], nats| {
            let (term, model) = (terms[0].0, Plant::model(terms));
            Row { term, model, nats, p_value: 0.01 }
        };
        // What a part promised.
        let rows = vec![row(&[(BEAT, &[0.03])], 700.0), row(&[(WAVE, &[0.05])], 600.0)];
        let ranking = vec![Ranked { rows, chance: Chance::default(), points: 1000.0 }];
        let found = Found { ranking, ..Found::of(node(&[])) };
        let thresholds = Thresholds { most: 0, better: 20.0, ..Thresholds::default() };
        let told = found.clone().confirmed(&whole, &whole, &thresholds, &|| false).unwrap();
        let [first, second] = &told.ranking[0].rows[..] else { panic!() };
        assert_eq!((first.term, second.term), (WAVE, BEAT));
        assert!(first.nats > 1000.0 && second.nats < 20.0, "{first:?} {second:?}");
        // A search that adds tells of its rungs.
        let thresholds = Thresholds { most: 1, ..thresholds };
        let told = found.confirmed(&whole, &whole, &thresholds, &|| false).unwrap();
        assert_eq!(told.ranking[0].rows[0].nats, 700.0);
    }

    #[test]
    fn what_all_of_the_recording_takes_to_where_it_is_none_is_not_named() {
        let mut whole = Plant::new(1, &[(WAVE, &[0.05])]);
        whole.none = Some(WAVE);
        let node = |terms| fit::evaluated(&whole, Plant::model(terms), 0);
        let rungs = vec![node(&[(WAVE, &[0.05])])];
        let found = Found { added: vec![WAVE], rungs, ..Found::of(node(&[])) };
        let found = found.confirmed(&whole, &whole, &Thresholds::default(), &|| false).unwrap();
        assert!(found.added.is_empty() && found.rungs.is_empty());
        let [Remark::NotNamed { effects, .. }] = &found.remarks[..] else {
            panic!("{:?}", found.remarks)
        };
        assert_eq!(effects, &["wave"]);
    }

    #[test]
    fn what_time_does_not_allow_to_be_asked_of_all_of_the_recording_is_told_as_such() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let node = |terms| fit::evaluated(&plant, Plant::model(terms), 0);
        let gain = Difference { nats: 30.0, error: 3.0, ranks: 2.0 };
        let on_part = || Found {
            added: vec![WAVE],
            rungs: vec![node(&[(WAVE, &[0.05])])],
            gains: vec![gain],
            costs: vec![gain],
            ..Found::of(node(&[]))
        };
        // Told to stop at once, and after some steps.
        for after in [0, 3] {
            let asked = AtomicUsize::new(0);
            let stop = || asked.fetch_add(1, Ordering::Relaxed) >= after;
            let cut = on_part().confirmed(&plant, &plant, &Thresholds::default(), &stop);
            assert!(cut.is_none(), "{after}");
        }
        let told = on_part().unconfirmed(0.25);
        assert_eq!((told.added.as_slice(), told.stopped), (&[WAVE][..], true));
        assert_eq!(told.gains, [Difference { nats: 120.0, error: 12.0, ranks: 2.0 }]);
        assert_eq!(told.costs, told.gains);
        assert_eq!(told.remarks, [Remark::Unconfirmed { share: 0.25 }]);
    }
}
