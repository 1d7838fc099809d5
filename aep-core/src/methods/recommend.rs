//! Which method to take.

use super::{Named, find};

/// What is known of a task before anything has been evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// Number of components.
    pub dimension: usize,
    /// Whether the same position can have another cost, or neighbours' costs differ by chance.
    pub noisy: bool,
    /// Whether the cost is a sum of squared residuals that the task gives ([`crate::LeastSquares`]).
    pub residuals: bool,
    /// Whether some components are whole numbers ([`crate::Integers`]).
    pub integers: bool,
    /// Evaluations that run at the same time.
    pub width: usize,
}

impl Facts {
    /// A task of so many components: without noise, nothing known but the cost, one evaluation at a time.
    pub fn new(dimension: usize) -> Self {
        Self { dimension, noisy: false, residuals: false, integers: false, width: 1 }
    }

    /// The same with a cost that is, or is not, subject to chance.
    #[must_use]
    pub fn with_noise(self, noisy: bool) -> Self {
        Self { noisy, ..self }
    }

    /// The same with residuals.
    #[must_use]
    pub fn with_residuals(self) -> Self {
        Self { residuals: true, ..self }
    }

    /// The same with components that are, or are not, whole numbers.
    #[must_use]
    pub fn with_integers(self, integers: bool) -> Self {
        Self { integers, ..self }
    }

    /// The same with `width` evaluations at the same time.
    #[must_use]
    pub fn with_width(self, width: usize) -> Self {
        Self { width, ..self }
    }
}

/// What to run.
#[derive(Clone, Copy)]
pub struct Advice {
    /// The method.
    pub method: &'static Named,
    /// Its population; 0 for its own default.
    pub population: usize,
    /// Why this method, in one line.
    pub why: &'static str,
}

/// A method and where it is the one to take.
struct Rule {
    /// By the facts, and the evaluations per component.
    holds: fn(&Facts, u64) -> bool,
    method: &'static str,
    why: &'static str,
}

/// The first one that holds decides; the last one always does. What they are worth:
/// docs/optimizers.md, "Tasks and peers" and "Noise and whole numbers".
const RULES: &[Rule] = &[
    Rule {
        holds: |facts, _| facts.residuals,
        method: "aep-lineages",
        why: "descends on the residuals, with a search beside it",
    },
    Rule {
        holds: |facts, budget| facts.integers && budget >= 1_000,
        method: "aep-practical-restarts",
        why: "whole numbers and many evaluations: it solves the most",
    },
    Rule {
        holds: |facts, budget| facts.dimension <= 5 && budget >= 5_000 && !facts.noisy,
        method: "de",
        why: "few parameters and many evaluations: it misses the fewest best minima",
    },
    Rule {
        holds: |facts, _| facts.width > USUAL,
        method: "cma-es",
        why: "many evaluations at once: it asks for a whole generation",
    },
    Rule {
        holds: |_, _| true,
        method: "aep-lineages",
        why: "needs the fewest evaluations of these methods on most fits",
    },
];

/// The method to take for a task, with `evaluations` to spend; 0 where that is not known.
///
/// ```
/// use aep_core::methods::{Facts, recommend};
/// let advice = recommend(&Facts::new(7).with_width(64), 20_000);
/// assert_eq!((advice.method.name, advice.population), ("cma-es", 64));
/// println!("{}: {}", advice.method.name, advice.why);
/// ```
pub fn recommend(facts: &Facts, evaluations: u64) -> Advice {
    let per_component = match evaluations {
        0 => u64::MAX,
        evaluations => evaluations / facts.dimension.max(1) as u64,
    };
    let (rule, method) = RULES
        .iter()
        .filter(|rule| (rule.holds)(facts, per_component))
        .find_map(|rule| Some((rule, find(rule.method)?)))
        .expect("the last rule holds always and names a method");
    // A generation narrower than what runs at once leaves machines idle.
    let population = if facts.width > USUAL { facts.width } else { 0 };
    Advice { method, population, why: rule.why }
}

/// About what the methods have as their own population.
const USUAL: usize = 20;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_names_a_method_and_the_last_one_holds_always() {
        assert!(RULES.iter().all(|rule| find(rule.method).is_some()));
        let last = &RULES[RULES.len() - 1];
        for dimension in [1, 5, 30, 1_000] {
            for facts in [Facts::new(dimension), Facts::new(dimension).with_noise(true)] {
                assert!(
                    [0, 10, 1_000, u64::MAX].iter().all(|budget| (last.holds)(&facts, *budget))
                );
            }
        }
    }

    #[test]
    fn residuals_are_for_the_method_that_descends_on_them() {
        let few = Facts::new(5).with_noise(true);
        assert_eq!(recommend(&few, 50_000).method.name, "aep-lineages");
        assert_eq!(recommend(&few.with_noise(false), 50_000).method.name, "de");
        assert_eq!(recommend(&few.with_residuals(), 50_000).method.name, "aep-lineages");
    }

    #[test]
    fn many_evaluations_a_component_are_for_the_method_that_misses_least() {
        let advised =
            |dimension, evaluations| recommend(&Facts::new(dimension), evaluations).method.name;
        assert_eq!(advised(5, 50_000), "de");
        assert_eq!(advised(5, 5_000), "aep-lineages");
        assert_eq!(advised(20, 1_000_000), "aep-lineages");
    }

    #[test]
    fn whole_numbers_and_many_evaluations_are_for_the_method_that_solves_most() {
        let advised = |n, budget| recommend(&Facts::new(n).with_integers(true), budget).method.name;
        assert_eq!(
            (advised(5, 20_000), advised(40, 40_000)),
            ("aep-practical-restarts", "aep-practical-restarts")
        );
        assert_eq!(advised(10, 5_000), "aep-lineages");
    }

    #[test]
    fn a_wide_machine_is_filled() {
        assert_eq!(recommend(&Facts::new(5), 1_000).population, 0);
        let wide = recommend(&Facts::new(5).with_width(256), 1_000);
        assert_eq!((wide.method.name, wide.population), ("cma-es", 256));
    }
}
