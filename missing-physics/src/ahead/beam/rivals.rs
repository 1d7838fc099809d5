//! Whether what stands for no effect predicts as well as the effects that were found.
//!
//! A friction level that is free at every moment explains nothing, but where it does what two effects do together those
//! two are not what the recording shows. One comparison decides, in both directions: the effects stay that are needed
//! beside it, and so does an effect that is one shape of it (a drift) where it predicts as well.

use super::{Climb, STEPS, Search, negative};
use crate::ahead::Rival;
use crate::ahead::compare::Difference;
use crate::ahead::decision::Outcome;
use crate::ahead::node::Node;
use crate::ahead::screen::screen;
use crate::family::ModelFamily;

/// Share of what is needed that the first order promises at least: from a poor model it sees little of the gain.
const PROMISED: f64 = 0.5;

impl<F: ModelFamily + ?Sized> Search<'_, F> {
    /// The model without effects that a rival makes up for, and what is to be said of it; nothing where all of them
    /// stand.
    pub(super) fn rivalled(&mut self, climb: &Climb, last: &Node) -> Option<(Node, String)> {
        let rivals = self.ahead.rivals();
        rivals.into_iter().find_map(|rival| self.without_rivalled(climb, last, rival))
    }

    fn without_rivalled(
        &mut self,
        climb: &Climb,
        last: &Node,
        rival: Rival,
    ) -> Option<(Node, String)> {
        let base = &climb.base;
        let added = Self::added(base, last);
        let gain = self.comparison.compare(base, last).nats;
        let clear = self.thresholds.clear(gain);
        // Where it does what takes several effects it need not be better.
        let needed = if added.len() > 1 { -clear } else { clear };
        let promised = screen(self.family, self.ahead, base, &[rival.term], false);
        let start = promised.promises.into_iter().next()?;
        if (self.stop)() || start.gain < PROMISED * self.thresholds.better {
            return None;
        }
        let free = self.refit(start.starts.first()?, base.setting, STEPS.2);
        let by = self.comparison.compare(last, &free);
        let stands = by.nats <= needed;
        let outcome = if stands { Outcome::Worse } else { Outcome::Rival };
        self.note(added.len(), &free, last, by, outcome, rival.words);
        if stands {
            return None;
        }
        let (kept, beside) = self.needed_beside(&added, last, &free, rival);
        let kin = added.iter().copied().find(|t| rival.kin == Some(self.main(*t)));
        let kin = kin.filter(|kin| {
            let alone = self.only(base, last, &[kept.as_slice(), &[*kin]].concat());
            self.comparison.compare(&alone, &beside).nats <= clear
        });
        let kept: Vec<usize> =
            added.iter().copied().filter(|t| kept.contains(t) || kin == Some(*t)).collect();
        if !added.is_empty() && kept.len() == added.len() {
            return None;
        }
        let result = if kept.is_empty() { base.clone() } else { self.only(base, last, &kept) };
        let size = self.size_of(&free, rival);
        let gone = added.iter().filter(|t| !kept.contains(t));
        let gone: Vec<&str> = gone.map(|t| self.family.terms()[*t].name.as_str()).collect();
        let text = if gone.is_empty() {
            format!(
                "{} lowers the prediction error by {:.0} nats: {size}.",
                capital(rival.words),
                by.nats
            )
        } else {
            format!(
                "{} does what {} would do ({:+.0} nats): {size}. Why, this recording does not show.",
                capital(rival.words),
                gone.join(" + "),
                by.nats
            )
        };
        Some((result, text))
    }

    /// The effects that are needed beside a rival, and the model with them and with it.
    fn needed_beside(
        &mut self,
        added: &[usize],
        last: &Node,
        free: &Node,
        rival: Rival,
    ) -> (Vec<usize>, Node) {
        let mut kept: Vec<usize> =
            added.iter().copied().filter(|t| rival.kin != Some(self.main(*t))).collect();
        let values = self.values(free, rival);
        let with = |search: &Self, kept: &[usize]| {
            let mut model = last.model.clone();
            for term in added.iter().filter(|t| !kept.contains(t)) {
                model = model.without(search.family, *term);
            }
            search.refit(&model.with(rival.term, &values), last.setting, STEPS.1)
        };
        let mut beside = if kept.is_empty() { free.clone() } else { with(self, &kept) };
        loop {
            let each = kept.iter().map(|term| {
                let others: Vec<usize> = kept.iter().copied().filter(|t| t != term).collect();
                let without = if others.is_empty() { free.clone() } else { with(self, &others) };
                (*term, self.comparison.compare(&without, &beside), without)
            });
            let least = each.min_by(|a, b| a.1.nats.total_cmp(&b.1.nats));
            let idle = |least: &(usize, Difference, Node)| least.1.nats < self.thresholds.better;
            let Some((term, cost, without)) = least.filter(idle) else { return (kept, beside) };
            let from = beside.clone();
            self.note(kept.len(), &without, &from, negative(cost), Outcome::Dropped, rival.words);
            kept.retain(|t| *t != term);
            beside = without;
        }
    }

    /// The model with only these of its added effects, refitted.
    fn only(&self, base: &Node, last: &Node, kept: &[usize]) -> Node {
        let mut model = last.model.clone();
        for term in Self::added(base, last).iter().filter(|t| !kept.contains(t)) {
            model = model.without(self.family, *term);
        }
        self.refit(&model, last.setting, STEPS.1)
    }

    fn size_of(&self, free: &Node, rival: Rival) -> String {
        self.family.describe(rival.term, &self.values(free, rival))
    }

    fn values(&self, free: &Node, rival: Rival) -> Vec<f64> {
        let position = free.model.terms.iter().position(|term| *term == rival.term);
        position
            .map_or_else(Vec::new, |k| free.model.values[free.model.range(self.family, k)].to_vec())
    }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
