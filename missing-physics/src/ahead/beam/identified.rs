//! A model of given terms, from nothing but their usual sizes.
//!
//! AEP finds the valley of what has at most a few shapes. Of many shapes a search takes minutes and ends beside the valley, where
//! one effect after the other is found as a discovery finds them: screened, fitted, the most promising first.

use super::{STEPS, Search, TRIED};
use crate::ahead::fit::{self, Fitter};
use crate::ahead::node::Node;
use crate::ahead::screen::screen;
use crate::family::{Fitted, Role};

/// Most shapes of the one effect that is searched with all amplitudes at once.
const SHAPES: usize = 2;

impl Search<'_> {
    /// Terms that are searched at once, and those that join them one by one.
    pub fn parted(&self, terms: &[usize]) -> (Vec<usize>, Vec<usize>) {
        let shapes = |term: &usize| {
            let parameters = self.family.terms()[*term].parameters.iter();
            parameters.filter(|parameter| parameter.role == Role::Shape).count()
        };
        let mut one = terms.iter().copied().filter(|term| shapes(term) > 0);
        let one = one.next().filter(|term| shapes(term) <= SHAPES);
        terms.iter().copied().partition(|term| shapes(term) == 0 || Some(*term) == one)
    }

    /// A model with more terms, however little they do, in the order of `terms`. Where time is up they begin as they promise
    /// to be best and are fitted together in a few steps.
    pub fn joined(&self, node: Node, more: &[usize], terms: &[usize]) -> Node {
        if more.is_empty() {
            return node;
        }
        let (mut found, mut left) = (node, more.to_vec());
        while !left.is_empty() {
            found = self.with_one_of(&found, &mut left);
        }
        // Without a base model nothing can be said, however little time there is.
        let steps = if (self.stop)() { TRIED } else { STEPS.2 };
        let fitter = Fitter::new(self.family, self.ahead);
        fitter.refit(self.ordered(&found.model, terms), found.setting, steps)
    }

    /// A model with the most promising of the terms that are left, which goes from them.
    fn with_one_of(&self, found: &Node, left: &mut Vec<usize>) -> Node {
        // A form that is not tried by itself begins from its main one.
        let tried = |term: usize| {
            let form = !self.ahead.is_candidate(term);
            self.family.form_of(term).filter(|_| form).unwrap_or(term)
        };
        let open: Vec<usize> = left.iter().map(|term| tried(*term)).collect();
        let screened = screen(self.family, self.ahead, found, &open, false);
        let most = screened.promises.into_iter().next();
        let place = most.as_ref().and_then(|most| open.iter().position(|t| *t == most.term));
        let term = left.remove(place.unwrap_or(0));
        let begun = most.and_then(|most| {
            let begun = self.begun(&most, found.setting);
            let start =
                || Some(fit::evaluated(self.ahead, most.starts.first()?.clone(), found.setting));
            begun.or_else(start)
        });
        let as_asked = begun.and_then(|begun| {
            if begun.model.terms.contains(&term) {
                return Some(begun);
            }
            let flexible = self.ahead.flexible(&begun.model, tried(term))?;
            let flexible = flexible.terms.contains(&term).then_some(flexible)?;
            Some(self.fitter().fit(flexible, begun.setting, STEPS.1))
        });
        as_asked.unwrap_or_else(|| {
            let parameters = self.family.terms()[term].parameters.iter();
            let usual: Vec<f64> = parameters.map(|parameter| parameter.start).collect();
            self.fitter().fit(found.model.with(term, &usual), found.setting, STEPS.0)
        })
    }

    /// The same model with its terms in another order: those that every model has, then as they stand in `terms`.
    fn ordered(&self, model: &Fitted, terms: &[usize]) -> Fitted {
        let place = |term: usize| terms.iter().position(|t| *t == term);
        let mut positions: Vec<usize> = (0..model.terms.len()).collect();
        positions.sort_by_key(|position| place(model.terms[*position]));
        positions.into_iter().fold(Fitted::default(), |ordered, position| {
            let values = &model.values[model.range(self.family, position)];
            ordered.with(model.terms[position], values)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::Thresholds;
    use crate::ahead::testing::{BEAT, Plant, TONE, WAVE};

    fn search<'a>(plant: &'a Plant, stop: &'a (dyn Fn() -> bool + Sync)) -> Search<'a> {
        Search::new(plant, plant, Thresholds::default(), vec![WAVE, BEAT, TONE], stop, &|_| {})
    }

    #[test]
    fn amplitudes_and_one_effect_of_few_shapes_are_searched_at_once() {
        let plant = Plant::new(1, &[]);
        let search = search(&plant, &|| false);
        assert_eq!(search.parted(&[0, WAVE, TONE]), (vec![0, WAVE, TONE], vec![]));
        assert_eq!(search.parted(&[0, TONE, WAVE]), (vec![0, TONE, WAVE], vec![]));
    }

    #[test]
    fn what_joins_is_fitted_and_stands_where_it_was_asked_for() {
        let truth = [(WAVE, &[0.05][..]), (TONE, &[0.04, 5.0][..])];
        let plant = Plant::new(2, &truth);
        for stopped in [false, true] {
            let stop = move || stopped;
            let search = search(&plant, &stop);
            let base = search.base(Plant::model(&[]));
            let all = search.joined(base, &[WAVE, TONE], &[0, TONE, WAVE]);
            assert_eq!(all.model.terms, [0, TONE, WAVE]);
            let expected = Plant::model(&[(TONE, &[0.04, 5.0]), (WAVE, &[0.05])]);
            for (found, true_value) in all.model.values.iter().zip(&expected.values) {
                assert!((found / true_value - 1.0).abs() < 0.1, "{stopped}: {:?}", all.model);
            }
        }
    }

    #[test]
    fn what_promises_nothing_joins_all_the_same() {
        let plant = Plant::new(3, &[]);
        let search = search(&plant, &|| false);
        let base = search.base(Plant::model(&[]));
        let with = search.joined(base.clone(), &[BEAT], &[0, BEAT]);
        assert_eq!(with.model.terms, [0, BEAT]);
        assert!(search.comparison.compare(&base, &with).nats < 15.0);
        // And nothing joins where nothing is left.
        assert_eq!(search.joined(base.clone(), &[], &[0]).model, base.model);
    }
}
