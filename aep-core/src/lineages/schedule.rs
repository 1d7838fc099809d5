//! Which lineage comes after one that has ended.

use serde::{Deserialize, Serialize};

use super::{Ingredient, Lineages};
use crate::random::{self, Stream};

/// Individuals of the first population; doubled with each.
const FIRST_POPULATION: usize = 40;
/// Evaluations per component that populations are taken to have spent at the start: one of them needs about as
/// many before it gets anywhere, so that the lineages come first.
const FIRST_CHARGE: u64 = 2_000;
/// By how much each large lineage is larger than the one before.
const GROWTH: usize = 3;
/// Most children or individuals.
const LARGEST: usize = 40_960;

/// How evaluations are shared: each regime with the part of the evaluations that it gets.
const REGIMES: [(Regime, Ingredient, f64); 3] = [
    (Regime::Large, Ingredient::LargeLineages, 1.0),
    (Regime::Small, Ingredient::SmallLineages, 0.5),
    (Regime::Population, Ingredient::Populations, 0.5),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Regime {
    First,
    Large,
    Small,
    Population,
}

/// What begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Next {
    Lineage { lambda: usize, sigma: f64 },
    Population { size: usize },
}

/// What each regime has spent, and how far it has come.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Schedule {
    present: Regime,
    /// Evaluations charged to the large, the small lineages and the populations.
    spent: [u64; 3],
    /// Children of the last large lineage, and its evaluations.
    large: (usize, u64),
    /// Individuals of the next population.
    population: usize,
    /// Most evaluations of the present lineage.
    limit: u64,
}

impl Schedule {
    /// Before the first lineage, of `lambda` children in `dimension` components.
    pub fn new(dimension: usize, lambda: usize) -> Self {
        Self {
            present: Regime::First,
            spent: [0, 0, FIRST_CHARGE * dimension as u64],
            large: (lambda, 0),
            population: FIRST_POPULATION,
            limit: u64::MAX,
        }
    }

    /// Whether the present lineage may go on after so many evaluations.
    pub fn allows(&self, evaluations: u64) -> bool {
        evaluations <= self.limit
    }

    /// Notes what the present lineage has spent, and chooses the next one: of the regime that is farthest
    /// below its part.
    pub fn next(&mut self, config: &Lineages, lambda: usize, spent: u64, rng: &mut Stream) -> Next {
        self.note(spent);
        self.limit = u64::MAX;
        let regimes = REGIMES.iter().zip(&self.spent);
        let used = regimes.filter(|((_, ingredient, _), _)| config.uses(*ingredient));
        let behind = |((_, _, part), spent): (&(_, _, f64), &u64)| *spent as f64 / part;
        let next = used.reduce(|a, b| if behind(b) < behind(a) { b } else { a });
        self.present = next.map_or(Regime::First, |((regime, _, _), _)| *regime);
        match self.present {
            Regime::First => Next::Lineage { lambda, sigma: config.sigma },
            Regime::Large => {
                self.large.0 = (GROWTH * self.large.0).min(LARGEST.max(lambda));
                Next::Lineage { lambda: self.large.0, sigma: config.sigma }
            }
            Regime::Small => {
                self.limit = self.large.1 / 2;
                let size: f64 = random::uniform(rng);
                let step: f64 = random::uniform(rng);
                let most = (0.5 * self.large.0 as f64 / lambda as f64).max(1.0);
                let lambda = (lambda as f64 * most.powf(size * size)) as usize;
                Next::Lineage { lambda, sigma: config.sigma * 10_f64.powf(-2.0 * step) }
            }
            Regime::Population => {
                let size = self.population;
                self.population = (2 * size).min(LARGEST);
                Next::Population { size }
            }
        }
    }

    fn note(&mut self, spent: u64) {
        match self.present {
            Regime::First => self.large.1 = spent,
            Regime::Large => {
                self.large.1 = spent;
                self.spent[0] += spent;
            }
            Regime::Small => self.spent[1] += spent,
            Regime::Population => self.spent[2] += spent,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, Streams};

    #[test]
    fn regimes_share_the_evaluations_by_their_parts() {
        let config = Lineages::default();
        let mut schedule = Schedule::new(2, 8);
        let mut spent = 500;
        let mut large = Vec::new();
        for run in 0..2_000 {
            let mut rng = Streams::new(1, Purpose::Restart, run).stream(0);
            let next = schedule.next(&config, 8, spent, &mut rng);
            spent = match next {
                Next::Lineage { lambda, .. } if schedule.present == Regime::Large => {
                    large.push(lambda);
                    900
                }
                _ => 300,
            };
        }
        assert_eq!(large[..3], [24, 72, 216]);
        let [of_large, of_small, of_populations] = schedule.spent.map(|spent| spent as f64);
        assert!((of_small / of_large - 0.5).abs() < 0.01, "{:?}", schedule.spent);
        assert!((of_populations / of_large - 0.5).abs() < 0.01, "{:?}", schedule.spent);
    }

    #[test]
    fn what_is_left_out_never_comes() {
        let config = Lineages::default()
            .without(Ingredient::LargeLineages)
            .without(Ingredient::Populations)
            .without(Ingredient::SmallLineages);
        let mut schedule = Schedule::new(2, 8);
        for run in 0..50 {
            let mut rng = Streams::new(1, Purpose::Restart, run).stream(0);
            let next = schedule.next(&config, 8, 100, &mut rng);
            assert_eq!(next, Next::Lineage { lambda: 8, sigma: 0.2 });
        }
    }
}
