//! Which of two models predicts better: the one rule that everything else rests on.
//!
//! `compare(a, b)` is the held-out log-likelihood of `b` less that of `a`, in nats. Every piece of the recording
//! is held out in turn, and foretold with the parameters as the others leave them open. Each model stands at its own most
//! likely process noise, both are judged in units of the smaller rms, and the difference is divided by
//! the number of errors of that model that say as much as an independent one.

use nalgebra::{DMatrix, DVector};

use super::fit::Normal;
use super::node::Node;
use super::predictive::{self, Bowl, Cost};
use super::{Ahead, scales, statistics};
use crate::family::{Fitted, ModelFamily, Role, Term, TermParameter};
use crate::statistics::signed_ranks::signed_ranks;

/// Folds of interleaved pieces.
const FOLDS: usize = 5;
/// Length of a piece, s. Shorter ones let a profile along the stroke predict what varies with time beside them.
const PIECE: f64 = 0.5;
/// Length of a block over which the standard error of a difference is taken, s.
const BLOCK: f64 = 2.0;

/// What a comparison says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Held-out log-likelihood of the second model less that of the first, nats.
    pub nats: f64,
    /// Standard error of it, from blocks of time.
    pub error: f64,
    /// By how many standard deviations the ranks of those blocks speak for the second model.
    pub ranks: f64,
}

impl Difference {
    /// Chance of as large a gain where there is none, from its standard error (one-sided, normal).
    pub fn p_value(&self) -> f64 {
        if self.error <= 0.0 {
            return if self.nats > 0.0 { 0.0 } else { 1.0 };
        }
        above(self.nats / self.error)
    }

    /// Chance of a gain that recurs so often where there is none: from its standard error or from the ranks of its blocks,
    /// whichever is less, times two. One block that dwarfs the others takes the standard error with it; ranks need many.
    pub fn recurs_by_chance(&self) -> f64 {
        (2.0 * self.p_value().min(above(self.ranks))).min(1.0)
    }
}

/// Chance of a normal number above so many standard deviations.
fn above(deviations: f64) -> f64 {
    0.5 * statrs::function::erf::erfc(deviations / std::f64::consts::SQRT_2)
}

/// Held-out losses of models, and what all comparisons share.
pub struct Comparison<'a> {
    family: &'a dyn ModelFamily,
    ahead: &'a dyn Ahead,
    /// Fold of each instant.
    fold: Vec<usize>,
    /// Block of each instant.
    block: Vec<usize>,
    blocks: usize,
}

impl<'a> Comparison<'a> {
    /// For the recording of `ahead`.
    pub fn new(family: &'a dyn ModelFamily, ahead: &'a dyn Ahead) -> Self {
        let first = ahead.instants().first().map_or(0.0, |i| i.0);
        let number = |length: f64| -> Vec<usize> {
            let mut count = 0;
            let mut last = None;
            let each = ahead.instants().iter().map(|(time, piece)| {
                let key = (((time - first) / length).floor() as i64, *piece);
                if last.is_some_and(|last| last != key) {
                    count += 1;
                }
                last = Some(key);
                count
            });
            each.collect()
        };
        let fold = number(PIECE).iter().map(|piece| piece % FOLDS).collect();
        let block = number(BLOCK);
        let blocks = block.last().map_or(0, |last| last + 1);
        Self { family, ahead, fold, block, blocks }
    }

    /// How much better `b` predicts than `a`.
    pub fn compare(&self, a: &Node, b: &Node) -> Difference {
        let cost = |node: &Node| {
            let cost = node.cost(|| self.cost(node));
            // Errors are worth as much as they are there, what is open is what it is.
            cost.open + cost.moved * node.correlation() / better(a, b).correlation()
        };
        // A part stands for a recording that gains so many times as much, and costs no more.
        self.beyond(a, b, self.ahead.share() * (cost(a) - cost(b)), |k| self.worth(k))
    }

    /// The same of two models as their errors stand: nothing is held out, and every error counts. Of those that were not fitted
    /// to this recording none has followed at which fraction of a count an axis stopped.
    pub fn unfitted(&self, a: &Node, b: &Node) -> Difference {
        self.beyond(a, b, 0.0, |_| 1.0)
    }

    /// What `b` gains over `a` among the errors that are `there` alone, nats.
    pub fn gained(&self, a: &Node, b: &Node, there: &[bool]) -> f64 {
        self.beyond(a, b, 0.0, |k| if there[k] { self.worth(k) } else { 0.0 }).nats
    }

    /// How much better `b` predicts than `a` where the parameters of `a` cost so much more, which every block bears alike, and
    /// an error is worth so much.
    fn beyond(&self, a: &Node, b: &Node, cost: f64, worth: impl Fn(usize) -> f64) -> Difference {
        let better = better(a, b);
        let (scale, correlation) = (better.deviation, better.correlation());
        let loss = |node: &Node, k: usize| statistics::loss(node.innovations[k] / scale);
        let mut sums = vec![0.0; self.blocks];
        for (k, block) in self.block.iter().enumerate() {
            sums[*block] += worth(k) * (loss(a, k) - loss(b, k)) / correlation;
        }
        let nats = sums.iter().sum::<f64>() + cost;
        let each = cost / self.blocks.max(1) as f64;
        for sum in &mut sums {
            *sum += each;
        }
        let mean = nats / self.blocks.max(1) as f64;
        let square: f64 = sums.iter().map(|sum| (sum - mean).powi(2)).sum();
        Difference { nats, error: square.sqrt(), ranks: signed_ranks(sums.into_iter()) }
    }

    /// What an error is worth.
    fn worth(&self, k: usize) -> f64 {
        self.ahead.worth().map_or(1.0, |worth| worth[k])
    }

    /// What its fitted parameters cost.
    fn cost(&self, node: &Node) -> Cost {
        let white = |errors: &[f64]| node.law.left(errors, self.ahead.instants());
        let jacobian: Vec<Vec<f64>> =
            node.jacobian(self.family, self.ahead).iter().map(|column| white(column)).collect();
        let folds: Vec<Bowl> = (0..FOLDS).map(|fold| self.part(node, &jacobian, fold)).collect();
        predictive::cost(self.prior(&node.model), &folds)
    }

    /// What is known of the parameters, on their scales, before the recording.
    fn prior(&self, model: &Fitted) -> Bowl {
        let moved = scales::of(self.family, model);
        let expected = expected(self.family, model);
        let each =
            moved.iter().zip(expected).zip(&model.values).map(|((moved, expected), value)| {
                let unit = moved.scale();
                (moved.prior() + unit * unit * expected, -unit * value * expected)
            });
        let (curvature, moment): (Vec<f64>, Vec<f64>) = each.unzip();
        Bowl { matrix: DMatrix::from_diagonal(&curvature.into()), moment: moment.into() }
    }

    /// What one fold knows.
    fn part(&self, node: &Node, jacobian: &[Vec<f64>], fold: usize) -> Bowl {
        // Squares are worth as much as errors are.
        let pick = |column: &[f64]| -> Vec<f64> {
            let of_fold = self.fold.iter().enumerate().filter(|(_, f)| **f == fold);
            of_fold.map(|(k, _)| self.worth(k).sqrt() * column[k]).collect()
        };
        let columns: Vec<Vec<f64>> = jacobian.iter().map(|column| pick(column)).collect();
        let all = Normal::of(&columns, &pick(&node.innovations), node.deviation);
        let worth = 1.0 / node.correlation();
        let at = |i: usize, j: usize| worth * all.matrix[i][j];
        let count = columns.len();
        Bowl {
            matrix: DMatrix::from_fn(count, count, at),
            moment: DVector::from_vec(all.moment) * worth,
        }
    }
}

/// The model whose errors are smaller: they are nearer to noise, whose size and colour both are judged by.
fn better<'n>(a: &'n Node, b: &'n Node) -> &'n Node {
    if a.deviation < b.deviation { a } else { b }
}

/// What is expected of the amplitudes of effects where the data say nothing: 0, give or take what those of the same
/// effect and unit are (an empirical prior, B. Efron and C. Morris, 1975). 1 over the variance of each parameter; 0 for those
/// that are no amplitude of an effect.
fn expected(family: &dyn ModelFamily, model: &Fitted) -> Vec<f64> {
    let parameters: Vec<_> = model.parameters(family).zip(&model.values).collect();
    let counts = |term: &Term, p: &TermParameter| !term.always && p.role == Role::Amplitude;
    let each = parameters.iter().map(|((term, p), _)| {
        let kin = parameters.iter().filter(|((other, q), _)| {
            counts(other, q) && other.name == term.name && q.unit == p.unit
        });
        let (square, count) =
            kin.fold((0.0, 0), |(sum, count), (_, value)| (sum + *value * *value, count + 1));
        let known = counts(term, p) && square > 0.0;
        if known { f64::from(count) / square } else { 0.0 }
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::fit::Fitter;
    use crate::ahead::testing::{BEAT, BENT, NOISE, Plant, TONE, WAVE};

    const WEAK: f64 = 0.01;

    fn fitted(plant: &Plant, terms: &[usize]) -> Node {
        let more: Vec<(usize, &[f64])> = terms.iter().map(|term| (*term, &[0.0][..])).collect();
        Fitter::new(plant, plant).fit(Plant::model(&more), 0, 8)
    }

    #[test]
    fn the_chance_of_a_gain_is_that_of_a_normal_error() {
        let p = |nats, error| Difference { nats, error, ranks: 0.0 }.p_value();
        for (nats, expected) in [
            (0.0, 0.5),
            (3.0 * 1.959_963_984_540_054, 0.025),
            (-3.0, 0.841_344_746_068_542_9),
            (30.0, 7.619_853_024_160_6e-24),
        ] {
            let found = p(nats, 3.0);
            assert!((found / expected - 1.0).abs() < 1e-6, "{nats}: {found}");
        }
        // Where every block says the same there is no doubt.
        assert_eq!((p(1.0, 0.0), p(0.0, 0.0), p(-1.0, 0.0)), (0.0, 1.0, 1.0));
    }

    #[test]
    fn an_error_counts_for_as_much_as_it_is_worth() {
        let mut plant = Plant::new(2, &[(WAVE, &[WEAK])]);
        let (base, wave) = (fitted(&plant, &[]), fitted(&plant, &[WAVE]));
        let of = |plant: &Plant| {
            let comparison = Comparison::new(plant, plant);
            let gain = comparison.beyond(&base, &wave, 0.0, |k| comparison.worth(k)).nats;
            (gain, comparison.cost(&wave), comparison.unfitted(&base, &wave))
        };
        let (all, cost, unfitted) = of(&plant);
        plant.worth = Some(vec![0.25; base.errors.len()]);
        let (quarter, less, same) = of(&plant);
        assert!((quarter / all - 0.25).abs() < 1e-12 && all > 10.0);
        assert_eq!((unfitted.nats, same), (all, unfitted));
        // Parameters move as far by errors that are all worth as much; what is open of them is a ratio.
        assert!((less.moved / cost.moved - 0.25).abs() < 0.02, "{less:?} {cost:?}");
        assert!((less.open - cost.open).abs() < 0.1 * cost.open, "{less:?} {cost:?}");
        // Either half of the recording alone.
        let half = base.errors.len() / 2;
        let halves = [1.0, 0.0].map(|first| {
            let worth = |k: usize| if k < half { first } else { 1.0 - first };
            plant.worth = Some((0..base.errors.len()).map(worth).collect());
            of(&plant).0
        });
        assert!((halves.iter().sum::<f64>() / all - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_gain_recurs_by_its_standard_error_or_by_its_ranks() {
        let p = |nats, error, ranks| Difference { nats, error, ranks }.recurs_by_chance();
        let normal = 1.959_963_984_540_054;
        for (found, expected) in [
            (p(normal, 1.0, -9.0), 0.05),
            (p(-9.0, 1.0, normal), 0.05),
            (p(normal, 1.0, 1.0), 0.05),
            (p(-1.0, 1.0, -1.0), 1.0),
        ] {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
    }

    #[test]
    fn a_comparison_the_other_way_round_says_the_opposite() {
        let plant = Plant::new(1, &[(WAVE, &[WEAK])]);
        let (a, b) = (fitted(&plant, &[]), fitted(&plant, &[WAVE]));
        let comparison = Comparison::new(&plant, &plant);
        let (there, back) = (comparison.compare(&a, &b), comparison.compare(&b, &a));
        assert!(there.nats > 0.0);
        assert_eq!(back, Difference { nats: -there.nats, ranks: -there.ranks, ..there });
        assert_eq!(comparison.compare(&b, &b), Difference { nats: 0.0, error: 0.0, ranks: 0.0 });
    }

    #[test]
    fn a_part_costs_its_share_of_what_the_whole_does() {
        let mut plant = Plant::new(1, &[(WAVE, &[WEAK])]);
        plant.pieces = Some((Box::new(Plant::new(1, &[(WAVE, &[WEAK])])), 0.25));
        let (a, b) = (fitted(&plant, &[]), fitted(&plant, &[WAVE]));
        let part = plant.ahead_in_part().unwrap();
        let cost = |ahead: &dyn Ahead| {
            let comparison = Comparison::new(&plant, ahead);
            comparison.unfitted(&a, &b).nats - comparison.compare(&a, &b).nats
        };
        let (whole, part) = (cost(&plant), cost(part.as_ref()));
        assert!(whole.abs() > 1.0 && (part / whole - 0.25).abs() < 1e-9, "{part} of {whole}");
    }

    #[test]
    fn the_true_structure_gains_the_likelihood_that_its_errors_say() {
        let plant = Plant::new(2, &[(WAVE, &[WEAK])]);
        let (a, b) = (fitted(&plant, &[]), fitted(&plant, &[WAVE]));
        let gain = Comparison::new(&plant, &plant).compare(&a, &b);
        let square = |node: &Node| node.errors.iter().map(|e| e * e).sum::<f64>();
        let expected = (square(&a) - square(&b)) / (2.0 * NOISE * NOISE * b.correlation());
        assert!((gain.nats / expected - 1.0).abs() < 0.1, "{} {expected}", gain.nats);
        assert!(gain.nats > 5.0 * gain.error, "{gain:?}");
        assert!((b.model.values[1] / WEAK - 1.0).abs() < 0.1, "{:?}", b.model);
    }

    #[test]
    fn what_is_not_there_gains_nothing_on_held_out_data() {
        // Twice the gain has one degree of freedom: above 3 nats, less what held-out data cost, at less than 1 %.
        let above = (0..100)
            .filter(|&seed| {
                let plant = Plant::new(1000 + seed, &[(WAVE, &[WEAK])]);
                let (a, b) = (fitted(&plant, &[WAVE]), fitted(&plant, &[WAVE, BEAT]));
                let nats = Comparison::new(&plant, &plant).compare(&a, &b).nats;
                assert!(nats < 15.0, "seed {seed}: {nats}");
                nats > 3.0
            })
            .count();
        assert!(above <= 5, "{above} of 100");
    }

    #[test]
    fn an_amplitude_is_expected_to_be_like_those_of_the_same_effect() {
        let plant = Plant::new(1, &[]);
        let model = Plant::model(&[(BENT, &[0.05, 0.01]), (TONE, &[0.2, 4.0])]);
        let of = |square: f64, count: f64| count / square;
        let bent = of(0.05 * 0.05 + 0.01 * 0.01, 2.0);
        // What every model has and a frequency are not drawn to 0.
        let known = [0.0, bent, bent, of(0.2 * 0.2, 1.0), 0.0];
        assert_eq!(expected(&plant, &model), known);
        // Each is drawn to 0 by its size over the variance.
        let prior = Comparison::new(&plant, &plant).prior(&model);
        for (k, moved) in scales::of(&plant, &model).iter().enumerate() {
            let (unit, value) = (moved.scale(), model.values[k]);
            assert_eq!(prior.moment[k], -unit * value * known[k]);
            let curvature = moved.prior() + unit * unit * known[k];
            assert_eq!(prior.matrix[(k, k)], curvature);
        }
    }
}
