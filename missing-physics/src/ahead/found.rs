//! What a search found, brought to all of the recording and judged.

mod confirmed;
mod judge;
mod ranked;

pub use confirmed::IN_FULL;
pub use judge::{MOST_WITHIN, leaves_most};
pub use ranked::{Ranked, Row};

use super::chance::Chance;
use super::compare::Difference;
use super::node::Node;
use super::screen::Promise;
use crate::family::{Fitted, ModelFamily};
use crate::report::{Decision, Remains, Remark};

/// What a search found.
#[derive(Clone, Debug)]
pub struct Found {
    /// The base model.
    pub base: Node,
    /// The model of every rung above it, the last one with all that was found.
    pub rungs: Vec<Node>,
    /// Term that each rung adds.
    pub added: Vec<usize>,
    /// What each rung gains over the one before.
    pub gains: Vec<Difference>,
    /// What the last model loses without each of the terms added.
    pub costs: Vec<Difference>,
    /// Sets of added terms by their number, and how far each lies behind the best of it, nats.
    pub sets: Vec<Vec<(Vec<usize>, f64)>>,
    /// Sets that differ by less than this are alike, nats: what an effect must gain, or the most that anything gains
    /// beside what is named without being named, where that is more. What is wrong with one model may gain that, too.
    pub alike: f64,
    /// Candidates beside the best set of each size.
    pub ranking: Vec<Ranked>,
    /// Chance of a gain as large as what the last model would lose without it, for each effect.
    pub p_values: Vec<f64>,
    /// What any candidate gains beside the last model where the errors are shifted in time.
    pub chance: Chance,
    /// The candidates beside the last model, to first order.
    pub last_screening: Vec<Promise>,
    /// What stands for no effect, but does what effects would do.
    pub rival: Option<Remains>,
    /// Whether the last model leaves no more than the sensors make.
    pub complete: bool,
    /// Noise of the input that makes what the last model leaves where sensors alone do not: its standard deviation from sample to sample.
    pub input_noise: Option<f64>,
    /// Where what is left lies, the largest first.
    pub places: Vec<Remains>,
    /// What a user should know besides.
    pub remarks: Vec<Remark>,
    /// The model that was refused and does most beyond the last one, if it does more: another look begins with it, too.
    pub refused: Vec<Fitted>,
    /// Every comparison.
    pub decisions: Vec<Decision>,
    /// Terms that were not tried because time ran out.
    pub untried: Vec<usize>,
    /// Whether the search was cut short.
    pub stopped: bool,
}

impl Found {
    /// Nothing beside the base model, nothing compared.
    #[cfg(test)]
    pub fn of(base: Node) -> Self {
        Self {
            base,
            rungs: Vec::new(),
            added: Vec::new(),
            gains: Vec::new(),
            costs: Vec::new(),
            sets: Vec::new(),
            alike: 0.0,
            ranking: Vec::new(),
            p_values: Vec::new(),
            chance: Chance::default(),
            last_screening: Vec::new(),
            rival: None,
            complete: false,
            input_noise: None,
            places: Vec::new(),
            remarks: Vec::new(),
            refused: Vec::new(),
            decisions: Vec::new(),
            untried: Vec::new(),
            stopped: false,
        }
    }

    /// The last model and its number of effects.
    pub fn top(&self) -> (&Node, usize) {
        (self.rungs.last().unwrap_or(&self.base), self.added.len())
    }

    /// Sets of added terms that cannot be told from the one that was found.
    pub fn as_good(&self, family: &dyn ModelFamily) -> Vec<&[usize]> {
        let sets = self.sets.get(self.added.len()).map_or(&[][..], Vec::as_slice);
        let is_it = |set: &[usize]| self.added.iter().all(|t| Self::is_in(set, *t, family));
        let Some((_, found)) = sets.iter().find(|(set, _)| is_it(set)) else { return Vec::new() };
        let others = sets.iter().filter(|(set, lag)| !is_it(set) && lag - found < self.alike);
        others.map(|(set, _)| set.as_slice()).collect()
    }

    /// Whether a term, in whatever form, is among `terms`.
    pub fn is_in(terms: &[usize], term: usize, family: &dyn ModelFamily) -> bool {
        let main = |t: usize| family.form_of(t).unwrap_or(t);
        terms.iter().any(|other| main(*other) == main(term))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::fit::evaluated;
    use crate::ahead::testing::{BEAT, Plant, TWIN, WAVE};

    #[test]
    fn sets_are_told_apart_by_more_than_what_gains_as_much_without_a_name() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let node = |terms| evaluated(&plant, Plant::model(terms), 0);
        let rungs = vec![node(&[(WAVE, &[0.05])])];
        let found = Found { added: vec![WAVE], rungs, ..Found::of(node(&[])) };
        let sets = vec![Vec::new(), vec![(vec![TWIN], 0.0), (vec![WAVE], 5.0), (vec![BEAT], 45.0)]];
        let as_good = |alike: f64| {
            let found = Found { sets: sets.clone(), alike, ..found.clone() };
            found.as_good(&plant).concat()
        };
        assert_eq!(as_good(20.0), [TWIN]);
        assert_eq!(as_good(39.0), [TWIN]);
        assert_eq!(as_good(41.0), [TWIN, BEAT]);
    }
}
