//! Which of two models predicts better: the one rule that everything else rests on.
//!
//! `compare(a, b)` is the held-out log-likelihood of `b` less that of `a`, in nats. Every piece of the recording
//! is held out in turn; a refit without it is one step of Gauss and Newton. Each model stands at its own most likely
//! process noise, both are judged in units of the smaller rms, and the difference is divided by
//! the number of errors that say as much as an independent one.

use super::fit::Normal;
use super::node::Node;
use super::{Ahead, scales, statistics};
use crate::family::{Fitted, ModelFamily, Role, Term, TermParameter};
use crate::statistics::basis::{dot, solve};

/// Folds of interleaved pieces.
const FOLDS: usize = 5;
/// Length of a piece, s. Shorter ones let a profile along the stroke predict what varies with time beside them.
const PIECE: f64 = 0.5;
/// Shares of a Gauss-Newton step that are tried in a refit.
const SHARES: [f64; 2] = [1.0, 0.3];
/// Length of a block over which the standard error of a difference is taken, s.
const BLOCK: f64 = 2.0;

/// What a comparison says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Held-out log-likelihood of the second model less that of the first, nats.
    pub nats: f64,
    /// Standard error of it, from blocks of time.
    pub error: f64,
}

impl Difference {
    /// Chance of as large a gain where there is none, from its standard error (one-sided, normal).
    pub fn p_value(&self) -> f64 {
        if self.error <= 0.0 {
            return if self.nats > 0.0 { 0.0 } else { 1.0 };
        }
        0.5 * statrs::function::erf::erfc(self.nats / self.error / std::f64::consts::SQRT_2)
    }
}

/// Held-out losses of models, with what all comparisons share.
pub struct Comparison<'a, F: ModelFamily + ?Sized> {
    family: &'a F,
    ahead: &'a dyn Ahead,
    /// Fold of each instant.
    fold: Vec<usize>,
    /// Block of each instant.
    block: Vec<usize>,
    blocks: usize,
}

impl<'a, F: ModelFamily + ?Sized> Comparison<'a, F> {
    /// For the recording of `ahead`.
    pub fn new(family: &'a F, ahead: &'a dyn Ahead) -> Self {
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
        self.of_errors(a, b, |node| node.held_out(|| self.held_out(node)))
    }

    /// The same of two models that were not fitted to this recording: nothing is held out.
    pub fn unfitted(&self, a: &Node, b: &Node) -> Difference {
        self.of_errors(a, b, |node| &node.innovations)
    }

    /// From the errors that count for each.
    fn of_errors<'n>(
        &self,
        a: &'n Node,
        b: &'n Node,
        errors: impl Fn(&'n Node) -> &'n [f64],
    ) -> Difference {
        let scale = a.deviation.min(b.deviation);
        let loss = |node: &'n Node| -> Vec<f64> {
            errors(node).iter().map(|e| statistics::loss(e / scale)).collect()
        };
        self.difference(&loss(a), &loss(b), b.correlation())
    }

    fn difference(&self, before: &[f64], after: &[f64], correlation: f64) -> Difference {
        let mut sums = vec![0.0; self.blocks];
        for (k, block) in self.block.iter().enumerate() {
            sums[*block] += (before[k] - after[k]) / correlation;
        }
        let nats: f64 = sums.iter().sum();
        let mean = nats / self.blocks.max(1) as f64;
        let square: f64 = sums.iter().map(|sum| (sum - mean).powi(2)).sum();
        Difference { nats, error: square.sqrt() }
    }

    /// Each error as predicted by a model that was refitted without its fold: one Gauss-Newton step, as far as it
    /// lowers the loss of the other folds. Of what these know nothing the model as it is says it.
    fn held_out(&self, node: &Node) -> Vec<f64> {
        let white = |errors: &[f64]| node.law.left(errors, self.ahead.instants());
        let jacobian: Vec<Vec<f64>> =
            node.jacobian(self.family, self.ahead).iter().map(|column| white(column)).collect();
        let moved = scales::of(self.family, &node.model);
        let shrunk = Shrunk::of(self.family, &node.model);
        let all: Vec<usize> = (0..moved.len()).collect();
        let parts: Vec<Normal> =
            (0..FOLDS).map(|fold| self.part(node, &jacobian, node.deviation, fold)).collect();
        let mut trials: Vec<(Fitted, usize)> = Vec::new();
        let mut known = vec![false; node.innovations.len()];
        for held in 0..FOLDS {
            let mut matrix = vec![vec![0.0; moved.len()]; moved.len()];
            let mut moment = vec![0.0; moved.len()];
            for part in parts.iter().enumerate().filter(|(fold, _)| *fold != held).map(|(_, p)| p) {
                for (row, other) in matrix.iter_mut().zip(&part.matrix) {
                    crate::statistics::basis::add_scaled(row, 1.0, other);
                }
                crate::statistics::basis::add_scaled(&mut moment, 1.0, &part.moment);
            }
            for (k, row) in matrix.iter_mut().enumerate() {
                let scale = moved[k].scale();
                row[k] += moved[k].prior() + scale * scale * shrunk.curvature[k];
                moment[k] -= scale * node.model.values[k] * shrunk.curvature[k];
            }
            let by = solve(&matrix, &moment, &all);
            self.known(node, (&jacobian, &matrix), held, &mut known);
            for share in SHARES {
                let values = moved.iter().zip(&by).map(|(moved, by)| moved.by(share * by));
                let model = Fitted { terms: node.model.terms.clone(), values: values.collect() };
                trials.push((model, node.setting));
            }
        }
        let refitted: Vec<Vec<f64>> =
            self.ahead.errors(&trials).iter().map(|errors| white(errors)).collect();
        let doubt = self.doubt(node);
        let mut errors = node.innovations.clone();
        let tried = trials.chunks(SHARES.len()).zip(refitted.chunks(SHARES.len()));
        for (held, (models, steps)) in tried.enumerate() {
            // The model as it is stands where no step leads down.
            let seen = |model: &Fitted, errors: &[f64]| -> f64 {
                let others = errors.iter().zip(&self.fold).filter(|(_, fold)| **fold != held);
                let loss: f64 = others.map(|(e, _)| statistics::loss(e / node.deviation)).sum();
                loss + shrunk.loss(&model.values)
            };
            let as_it_is = seen(&node.model, &node.innovations) - doubt;
            let mut best = (as_it_is, &node.innovations);
            for ((model, _), step) in models.iter().zip(steps) {
                let loss = seen(model, step);
                if loss < best.0 {
                    best = (loss, step);
                }
            }
            let of_fold = |i: usize| known[i] && self.fold[i] == held;
            for (i, e) in errors.iter_mut().enumerate().filter(|(i, _)| of_fold(*i)) {
                *e = best.1[i];
            }
        }
        errors
    }

    /// Of which errors of a fold the others know something: what they leave open of the parameters changes such an error by
    /// less than its own deviation. Elsewhere (at an end of the stroke that only this fold visits) a refit may say anything.
    fn known(
        &self,
        node: &Node,
        (jacobian, matrix): (&[Vec<f64>], &[Vec<f64>]),
        held: usize,
        known: &mut [bool],
    ) {
        let all: Vec<usize> = (0..matrix.len()).collect();
        let unit = |k: usize| -> Vec<f64> { all.iter().map(|l| f64::from(*l == k)).collect() };
        let inverse: Vec<Vec<f64>> = all.iter().map(|k| solve(matrix, &unit(*k), &all)).collect();
        let allowed = node.deviation.powi(2) / node.correlation();
        for (i, known) in known.iter_mut().enumerate().filter(|(i, _)| self.fold[*i] == held) {
            let row: Vec<f64> = jacobian.iter().map(|column| column[i]).collect();
            let variance: f64 = inverse.iter().zip(&row).map(|(of, by)| by * dot(of, &row)).sum();
            *known = variance <= allowed;
        }
    }

    /// What a step must gain in the other folds. A rival is free everywhere, also where only the fold looks that is held
    /// out (at the moment of a jump, between two knots): there a step that follows noise would let it say anything, and
    /// what it is asked is only whether effects are needed beside it. Noise gains half a nat for each of its values.
    fn doubt(&self, node: &Node) -> f64 {
        let rivals = self.ahead.rivals();
        let is_rival = |term: &&usize| rivals.iter().any(|rival| rival.term == **term);
        let terms = node.model.terms.iter().filter(is_rival);
        let free: usize = terms.map(|term| self.family.terms()[*term].parameters.len()).sum();
        if free == 0 { 0.0 } else { 0.5 * free as f64 * node.correlation() }
    }

    /// Normal equations of one fold.
    fn part(&self, node: &Node, jacobian: &[Vec<f64>], scale: f64, fold: usize) -> Normal {
        let pick = |column: &[f64]| -> Vec<f64> {
            column.iter().zip(&self.fold).filter(|(_, f)| **f == fold).map(|(v, _)| *v).collect()
        };
        let columns: Vec<Vec<f64>> = jacobian.iter().map(|column| pick(column)).collect();
        Normal::of(&columns, &pick(&node.innovations), scale)
    }
}

/// What is expected of the amplitudes of effects where the data say nothing: 0, give or take what those of the same
/// effect and unit are (an empirical prior, B. Efron and C. Morris, 1975). Without it a refit that does not see a place
/// of the stroke may say anything there.
struct Shrunk {
    /// 1 over the variance of each parameter; 0 for those that are no amplitude of an effect.
    curvature: Vec<f64>,
}

impl Shrunk {
    fn of<F: ModelFamily + ?Sized>(family: &F, model: &Fitted) -> Self {
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
        Self { curvature: each.collect() }
    }

    /// How unlikely values are, nats.
    fn loss(&self, values: &[f64]) -> f64 {
        values.iter().zip(&self.curvature).map(|(value, c)| 0.5 * c * value * value).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::fit::{self, Fitter};
    use crate::ahead::testing::{BEAT, BENT, NOISE, Plant, RIVAL, TONE, TWIN, WAVE};

    const WEAK: f64 = 0.01;

    fn fitted(plant: &Plant, terms: &[usize]) -> Node {
        let more: Vec<(usize, &[f64])> = terms.iter().map(|term| (*term, &[0.0][..])).collect();
        Fitter::new(plant, plant).fit(Plant::model(&more), 0, 8)
    }

    #[test]
    fn the_chance_of_a_gain_is_that_of_a_normal_error() {
        let p = |nats, error| Difference { nats, error }.p_value();
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
    fn a_comparison_the_other_way_round_says_the_opposite() {
        let plant = Plant::new(1, &[(WAVE, &[WEAK])]);
        let (a, b) = (fitted(&plant, &[]), fitted(&plant, &[WAVE]));
        let comparison = Comparison::new(&plant, &plant);
        let (there, back) = (comparison.compare(&a, &b), comparison.compare(&b, &a));
        // Both in nats of independent errors of the model that is judged.
        let (there, back) = (there.nats * b.correlation(), back.nats * a.correlation());
        assert!(there > 0.0 && (there + back).abs() < 1e-9 * there, "{there} {back}");
        assert_eq!(comparison.compare(&b, &b), Difference { nats: 0.0, error: 0.0 });
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
    fn a_rival_is_refitted_where_that_gains_more_than_noise_does() {
        let moves = |plant: &Plant, node: &Node| {
            Comparison::new(plant, plant).held_out(node) != node.innovations
        };
        // A step without a fold gains a tenth of a nat on average in the others, for each parameter of the model.
        let moved = |term: usize| {
            let plants = (0..20).map(|seed| Plant::new(seed, &[(term, &[WEAK])]));
            plants.filter(|plant| moves(plant, &fitted(plant, &[term]))).count()
        };
        assert_eq!(moved(TWIN), 20);
        assert!(moved(RIVAL) <= 10);
        let there = Plant::new(3, &[(RIVAL, &[WEAK])]);
        assert!(moves(&there, &fit::evaluated(&there, Plant::model(&[(RIVAL, &[0.0])]), 0)));
    }

    #[test]
    fn noise_gains_half_a_nat_for_each_value_of_a_rival() {
        let plant = Plant::new(1, &[]);
        let comparison = Comparison::new(&plant, &plant);
        let nodes = [vec![], vec![WAVE], vec![RIVAL]].map(|terms| fitted(&plant, &terms));
        let doubts = nodes.each_ref().map(|node| comparison.doubt(node) / node.correlation());
        assert_eq!(doubts, [0.0, 0.0, 0.5]);
    }

    #[test]
    fn nobody_knows_what_only_the_fold_looks_at_that_is_held_out() {
        let plant = Plant::new(1, &[]);
        let comparison = Comparison::new(&plant, &plant);
        let node = fit::evaluated(&plant, Plant::model(&[]), 0);
        let n = node.innovations.len();
        let here = |i: usize| comparison.fold[i] == 0 && i < 100;
        // One parameter acts everywhere, one at a place that the first fold visits once.
        let place = (0..n).map(|i| if here(i) { node.deviation } else { 0.0 });
        let jacobian = [vec![0.1 * node.deviation; n], place.collect()];
        for (prior, visible) in [(1e-3, false), (1e3, true)] {
            let matrix = [vec![0.008 * n as f64, 0.0], vec![0.0, prior]];
            let mut known = vec![false; n];
            comparison.known(&node, (&jacobian, &matrix), 0, &mut known);
            for (i, known) in known.iter().enumerate() {
                assert_eq!(*known, comparison.fold[i] == 0 && (visible || !here(i)), "{i}");
            }
        }
    }

    #[test]
    fn an_amplitude_is_expected_to_be_like_those_of_the_same_effect() {
        let plant = Plant::new(1, &[]);
        let model = Plant::model(&[(BENT, &[0.05, 0.01]), (TONE, &[0.2, 4.0])]);
        let shrunk = Shrunk::of(&plant, &model);
        let of = |square: f64, count: f64| count / square;
        let bent = of(0.05 * 0.05 + 0.01 * 0.01, 2.0);
        // What every model has and a frequency are not drawn to 0.
        assert_eq!(shrunk.curvature, [0.0, bent, bent, of(0.2 * 0.2, 1.0), 0.0]);
        assert!((shrunk.loss(&model.values) - 1.5).abs() < 1e-12);
        assert_eq!(shrunk.loss(&[7.0, 0.0, 0.0, 0.0, 9.0]), 0.0);
    }
}
