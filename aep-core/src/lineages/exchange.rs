//! Whether a cost is a sum over components.

use serde::{Deserialize, Serialize};

use crate::random::{Stream, coin, index};

/// Exchanges that have to add up before a cost is taken for a sum.
const EXCHANGES: u32 = 3;

/// Two parents exchange some of their components. Where f is a sum over components the costs of both
/// children add up to those of both parents, whatever is exchanged:
/// f(a) + f(b) = f(a with components of b) + f(b with those of a).
///
/// Two evaluations tell a cost that is no such sum.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Exchange {
    /// Both parents, one after the other.
    parents: Vec<f64>,
    costs: [f64; 2],
    passed: u32,
}

/// What an exchange tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    Sum,
    NoSum,
    Undecided,
}

impl Exchange {
    /// `costs` must be finite.
    pub fn new(parents: [&[f64]; 2], costs: [f64; 2]) -> Self {
        Self { parents: parents.concat(), costs, passed: 0 }
    }

    /// The first parent and its cost.
    pub fn first(&self) -> (&[f64], f64) {
        (&self.parents[..self.parents.len() / 2], self.costs[0])
    }

    /// The two children of an exchange drawn from `rng`: at least one component, not all.
    pub fn ask(&self, rng: &mut Stream, points: &mut Vec<f64>) {
        let n = self.parents.len() / 2;
        let mut exchanged: Vec<bool> = (0..n).map(|_| coin(rng)).collect();
        let first = index(rng, n);
        exchanged[first] = true;
        exchanged[(first + 1 + index(rng, n - 1)) % n] = false;
        for own in [0, n] {
            let from = |j: usize| if exchanged[j] { n - own } else { own };
            points.extend((0..n).map(|j| self.parents[j + from(j)]));
        }
    }

    /// Judges the costs of both children; numbers are known to `epsilon` of their size.
    pub fn tell(&mut self, costs: &[f64], epsilon: f64) -> Verdict {
        let ([a, b], [c, d]) = (self.costs, [costs[0], costs[1]]);
        let largest = [a, b, c, d].iter().fold(0.0, |most: f64, cost| most.max(cost.abs()));
        // On a plateau everything adds up and nothing is told.
        let told_apart = (a - c).abs().min((a - d).abs()) > 1e5 * epsilon * largest;
        let adds_up = ((a + b) - (c + d)).abs() <= 64.0 * epsilon * largest;
        if !(told_apart && adds_up) {
            return Verdict::NoSum;
        }
        self.passed += 1;
        if self.passed == EXCHANGES { Verdict::Sum } else { Verdict::Undecided }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, Streams};

    fn verdict(cost: impl Fn(&[f64]) -> f64) -> Verdict {
        let (a, b) = ([0.1, 0.5, 0.9], [0.3, 0.2, 0.4]);
        let mut exchange = Exchange::new([&a, &b], [cost(&a), cost(&b)]);
        for generation in 1..=EXCHANGES {
            let mut rng = Streams::new(1, Purpose::Mutation, u64::from(generation)).stream(0);
            let mut points = Vec::new();
            exchange.ask(&mut rng, &mut points);
            let costs: Vec<f64> = points.chunks(3).map(&cost).collect();
            match exchange.tell(&costs, f64::EPSILON) {
                Verdict::Undecided => {}
                told => return told,
            }
        }
        Verdict::Undecided
    }

    #[test]
    fn sums_are_told_from_products_noise_and_plateaus() {
        let dent = |x: &f64| (7.0 * x).cos() + x * x * x;
        assert_eq!(verdict(|x| 100.0 + x.iter().map(dent).sum::<f64>()), Verdict::Sum);
        assert_eq!(verdict(|x| x.iter().map(dent).product()), Verdict::NoSum);
        assert_eq!(verdict(|_| 3.0), Verdict::NoSum);
        assert_eq!(verdict(|x| x[0] + f64::NAN), Verdict::NoSum);
        let noisy = |x: &[f64]| x[0] + x[1] + x[2] + 1e-9 * (1e9 * x[0] * x[1]).sin();
        assert_eq!(verdict(noisy), Verdict::NoSum);
    }
}
