//! Which candidates are worth a fit: the gain in likelihood to first order, the model's own parameters free.

use super::chance::{Chance, Changed};
use super::node::Node;
use super::{Ahead, Trial, fit, scales, statistics};
use crate::family::{Fitted, ModelFamily};
use crate::statistics::basis::{Basis, constrained, dot, gram, weighed};
use rayon::prelude::*;

/// A change is cut off at this many scales: far from the model the first order says nothing.
const CUT: f64 = 60.0;
/// Largest multiple of a whole change, and of the size at which an amplitude was tried.
const MOST: (f64, f64) = (1.5, 60.0);
/// A trial that changes the errors by more than so many scales (rms) is looked at once more, at a size that changes them
/// by about so many.
const ROUGH: f64 = 6.0;
const GENTLE: f64 = 2.0;
/// An amplitude that the first order puts at 0 starts at this share of the size that it was tried at.
const LEAST: f64 = 0.03;

/// Trials that are looked at as they are where a cheaper look has ranked all of them: by their linear response, and on
/// a part of the recording.
const LIKELY: (usize, usize) = (6, 3);

/// A term and how much it promises.
#[derive(Clone, Debug)]
pub struct Promise {
    /// The term.
    pub term: usize,
    /// Gain, nats.
    pub gain: f64,
    /// Where to begin, the most promising first.
    pub starts: Vec<Fitted>,
    /// Gain per square of the first amplitude, nats: what a size would have shown. Nothing without amplitudes.
    pub leverage: Option<f64>,
}

/// What a screening says.
#[derive(Clone, Debug, Default)]
pub struct Screened {
    /// The candidates, the most promising first.
    pub promises: Vec<Promise>,
    /// The largest gain of any candidate where the errors are shifted in time.
    pub chance: Chance,
}

/// The best trial of every candidate. What they gain by chance is only looked at where `with_chance` asks for it.
pub fn screen(
    family: &dyn ModelFamily,
    ahead: &dyn Ahead,
    node: &Node,
    candidates: &[usize],
    with_chance: bool,
) -> Screened {
    let screening = Screening::new(family, ahead, node);
    let part = ahead.part();
    let at_part =
        part.as_deref().map(|part| fit::evaluated(part, node.model.clone(), node.setting));
    let part = part.as_deref().zip(at_part.as_ref());
    let part = part.map(|(part, node)| Screening::new(family, part, node));
    // Many a term has too few trials to keep all threads busy.
    let each = candidates.par_iter().map(|&term| {
        let trials = ahead.trials(&node.model, term);
        let tried = trials.len();
        let trials = screening.likely(family, term, trials, part.as_ref());
        let (promise, changed) = screening.best(family, term, &trials, with_chance);
        (promise, changed, tried)
    });
    let (mut promises, mut changed, mut tried) = (Vec::new(), Vec::new(), 0);
    for (promise, of_term, count) in each.collect::<Vec<_>>() {
        promises.extend(promise);
        changed.extend(of_term);
        tried += count;
    }
    promises.sort_by(|a: &Promise, b| b.gain.total_cmp(&a.gain));
    let chance =
        if with_chance { Chance::of(&screening.left, &changed, tried) } else { Chance::default() };
    Screened { promises, chance }
}

struct Screening<'a> {
    node: &'a Node,
    ahead: &'a dyn Ahead,
    scale: f64,
    weight: Vec<f64>,
    own: Basis,
    left: Vec<f64>,
}

impl<'a> Screening<'a> {
    fn new(family: &dyn ModelFamily, ahead: &'a dyn Ahead, node: &'a Node) -> Self {
        let shrunk = node.deviation / node.scale;
        let scale = node.weighing(ahead.expected(node.setting)) * shrunk;
        let weight: Vec<f64> =
            node.innovations.iter().map(|e| statistics::weight(e / scale).sqrt() / scale).collect();
        let mut left = weighed(&node.innovations, &weight);
        // What the model's own parameters cannot do, since they are at a limit, is open to others.
        let own: Vec<Vec<f64>> = node
            .jacobian(family, ahead)
            .iter()
            .map(|column| weighed(&node.law.left(column, ahead.instants()), &weight))
            .zip(scales::of(family, &node.model))
            .filter(|(column, moved)| !moved.is_held(-dot(column, &left)))
            .map(|(column, _)| column)
            .collect();
        let own = Basis::of(&own);
        own.project_out(&mut left);
        Self { node, ahead, scale, weight, own, left }
    }

    /// The few trials that promise most, where that can be said at less than the cost of looking at all.
    fn likely(
        &self,
        family: &dyn ModelFamily,
        term: usize,
        trials: Vec<Trial>,
        part: Option<&Self>,
    ) -> Vec<Trial> {
        let few = LIKELY.1.max(self.ahead.starts(term));
        let (gains, few) = if let Some(gains) = self.by_response(term, &trials) {
            (gains, LIKELY.0)
        } else if let Some(part) = part.filter(|_| trials.len() > 2 * few) {
            (part.looked_at(family, &trials).into_iter().map(|(gain, ..)| gain).collect(), few)
        } else {
            return trials;
        };
        let mut ranked: Vec<(f64, Trial)> = gains.into_iter().zip(trials).collect();
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
        ranked.into_iter().take(few).map(|(_, trial)| trial).collect()
    }

    /// Gain of every trial by its linear response, where the family has one and there are many.
    fn by_response(&self, term: usize, trials: &[Trial]) -> Option<Vec<f64>> {
        if trials.len() <= LIKELY.0 {
            return None;
        }
        let columns = self.ahead.columns(self.node.setting, term, trials)?;
        let own = single(self.own.columns());
        let (left, weight) = (
            single(std::slice::from_ref(&self.left)).swap_remove(0),
            single(std::slice::from_ref(&self.weight)).swap_remove(0),
        );
        let white = |column: &Vec<f32>| -> Vec<f32> {
            let column: Vec<f64> = column.iter().map(|v| f64::from(*v)).collect();
            single(&[self.node.law.left(&column, self.ahead.instants())]).swap_remove(0)
        };
        let as_they_are = self.node.law.is_none();
        let gain = |pair: &[Vec<f32>; 2]| {
            if as_they_are {
                return first_order(pair, &weight, &own, &left);
            }
            first_order(&pair.each_ref().map(white), &weight, &own, &left)
        };
        Some(columns.par_iter().map(gain).collect())
    }

    /// Gain of every trial as it is, the multiples of its sizes that reach it, and its columns.
    fn looked_at(
        &self,
        family: &dyn ModelFamily,
        trials: &[Trial],
    ) -> Vec<(f64, Vec<f64>, Vec<Vec<f64>>)> {
        let looks: Vec<Look> = trials.iter().flat_map(looks).collect();
        let with = |looks: &[&Look], shares: &[f64]| -> Vec<Vec<f64>> {
            let models = looks.iter().zip(shares).map(|(look, share)| look.at(*share));
            let models: Vec<Fitted> = models.collect();
            self.ahead.errors_beside(&self.node.model, self.node.setting, &models)
        };
        let mut errors = with(&looks.iter().collect::<Vec<_>>(), &vec![1.0; looks.len()]);
        // What changes the errors beyond measure is looked at once more, gently: the first order is what is asked.
        let mut shares = vec![1.0; looks.len()];
        let sizes = errors.iter().map(|errors| self.size(errors));
        let sizes = looks.iter().zip(sizes).enumerate();
        let rough: Vec<(usize, f64)> = sizes
            .filter(|(_, (look, size))| look.amplitude.is_some() && *size > ROUGH)
            .map(|(k, (_, size))| (k, GENTLE / size))
            .collect();
        let (again, gently): (Vec<&Look>, Vec<f64>) =
            rough.iter().map(|(k, share)| (&looks[*k], *share)).unzip();
        for ((k, share), gentle) in rough.iter().zip(with(&again, &gently)) {
            (errors[*k], shares[*k]) = (gentle, *share);
        }
        let mut columns = errors.iter().zip(&shares).map(|(errors, share)| {
            let mut column = self.change(errors);
            for value in &mut column {
                *value /= share;
            }
            column
        });
        let each = trials.iter().map(|trial| {
            let count = trial.amplitudes.len().max(1);
            let columns: Vec<Vec<f64>> = columns.by_ref().take(count).collect();
            let (gain, by) = self.gain(family, trial, &columns);
            (gain, by, columns)
        });
        each.collect()
    }

    /// Root mean square of what a trial changes, in scales.
    fn size(&self, errors: &[f64]) -> f64 {
        let square: f64 = self.differences(errors).iter().map(|change| change * change).sum();
        (square / errors.len().max(1) as f64).sqrt() / self.scale
    }

    /// What a trial changes in each innovation.
    fn differences(&self, errors: &[f64]) -> Vec<f64> {
        let change: Vec<f64> =
            errors.iter().zip(&self.node.errors).map(|(e, old)| e - old).collect();
        let cut = CUT * self.scale;
        let change = self.node.law.left(&change, self.ahead.instants());
        change.into_iter().map(|change| change.clamp(-cut, cut)).collect()
    }

    /// The best of a term's trials, and what all of them change where that is asked for.
    fn best(
        &self,
        family: &dyn ModelFamily,
        term: usize,
        trials: &[Trial],
        with_changes: bool,
    ) -> (Option<Promise>, Vec<Changed>) {
        let mut changed = Vec::new();
        let mut best: Option<Promise> = None;
        let mut starts: Vec<(f64, Fitted)> = Vec::new();
        let looked_at = self.looked_at(family, trials);
        for (trial, (gain, by, columns)) in trials.iter().zip(looked_at) {
            if best.as_ref().is_none_or(|best| gain > best.gain) {
                let size = trial.amplitudes.first().map(|(_, size)| size);
                let leverage = size.map(|size| 0.5 * dot(&columns[0], &columns[0]) / (size * size));
                best = Some(Promise { term, gain, starts: Vec::new(), leverage });
            }
            starts.push((gain, started(trial, &by)));
            if with_changes {
                let positive = columns.len() == 1 && positive(family, trial)[0];
                changed.push(Changed { matrix: gram(&columns), columns, positive });
            }
        }
        starts.sort_by(|a, b| b.0.total_cmp(&a.0));
        starts.truncate(self.ahead.starts(term));
        let starts = starts.into_iter().map(|(_, start)| start).collect();
        (best.map(|best| Promise { starts, ..best }), changed)
    }

    /// What a trial changes, weighed and freed of what the model's own parameters do.
    fn change(&self, errors: &[f64]) -> Vec<f64> {
        let mut column = weighed(&self.differences(errors), &self.weight);
        self.own.project_out(&mut column);
        column
    }

    /// Gain and the multiples of the trial's sizes that reach it.
    fn gain(
        &self,
        family: &dyn ModelFamily,
        trial: &Trial,
        columns: &[Vec<f64>],
    ) -> (f64, Vec<f64>) {
        let positive = positive(family, trial);
        let moment: Vec<f64> = columns.iter().map(|c| -dot(c, &self.left)).collect();
        let matrix = gram(columns);
        let mut by = constrained(&matrix, &moment, &positive);
        let most = if trial.amplitudes.is_empty() { MOST.0 } else { MOST.1 };
        for by in &mut by {
            *by = by.clamp(-most, most);
        }
        let linear: f64 = by.iter().zip(&moment).map(|(b, m)| b * m).sum();
        let square: f64 = by.iter().zip(&matrix).map(|(b, row)| b * dot(row, &by)).sum();
        // One nat for each free amplitude: what noise alone gives is half of that.
        (linear - 0.5 * square - by.len() as f64, by)
    }
}

/// In single precision.
fn single(columns: &[Vec<f64>]) -> Vec<Vec<f32>> {
    columns.iter().map(|column| column.iter().map(|v| *v as f32).collect()).collect()
}

/// Gain of two columns of free sign beside the orthonormal `own` ones, which `left` is free of: what lies in their
/// space is taken out of the scalar products, not out of the columns.
fn first_order(pair: &[Vec<f32>; 2], weight: &[f32], own: &[Vec<f32>], left: &[f32]) -> f64 {
    let [a, b] = pair
        .each_ref()
        .map(|column| column.iter().zip(weight).map(|(c, w)| c * w).collect::<Vec<f32>>());
    let inside = |column: &[f32]| -> Vec<f64> { own.iter().map(|q| product(q, column)).collect() };
    let (qa, qb) = (inside(&a), inside(&b));
    let free = |x: &[f32], y: &[f32], qx: &[f64], qy: &[f64]| product(x, y) - dot(qx, qy);
    let (aa, ab, bb) = (free(&a, &a, &qa, &qa), free(&a, &b, &qa, &qb), free(&b, &b, &qb, &qb));
    let (ma, mb) = (product(&a, left), product(&b, left));
    let determinant = aa * bb - ab * ab;
    if determinant <= 1e-9 * aa * bb {
        return 0.0;
    }
    0.5 * (bb * ma * ma - 2.0 * ab * ma * mb + aa * mb * mb) / determinant
}

/// Scalar product in single precision, its blocks added up in double.
fn product(x: &[f32], y: &[f32]) -> f64 {
    let block = |(x, y): (&[f32], &[f32])| {
        let mut sums = [0.0f32; 16];
        let (x16, y16) = (x.chunks_exact(16), y.chunks_exact(16));
        let tail: f32 = x16.remainder().iter().zip(y16.remainder()).map(|(x, y)| x * y).sum();
        for (x, y) in x16.zip(y16) {
            for lane in 0..16 {
                sums[lane] += x[lane] * y[lane];
            }
        }
        f64::from(sums.iter().sum::<f32>() + tail)
    };
    x.chunks(1024).zip(y.chunks(1024)).map(block).sum()
}

/// Which amplitudes of a trial cannot be negative; a whole change has one.
fn positive(family: &dyn ModelFamily, trial: &Trial) -> Vec<bool> {
    if trial.amplitudes.is_empty() {
        return vec![true];
    }
    let lower: Vec<f64> = trial.model.parameters(family).map(|(_, p)| p.lower).collect();
    trial.amplitudes.iter().map(|(k, _)| lower[*k] >= 0.0).collect()
}

/// A model that a trial is looked at with.
struct Look {
    model: Fitted,
    /// The amplitude that is tried, and its size.
    amplitude: Option<(usize, f64)>,
}

impl Look {
    /// The model with this share of the amplitude.
    fn at(&self, share: f64) -> Fitted {
        let mut model = self.model.clone();
        if let Some((k, size)) = self.amplitude {
            model.values[k] = share * size;
        }
        model
    }
}

/// One for each amplitude of a trial, or one for the whole change.
fn looks(trial: &Trial) -> Vec<Look> {
    let look = |amplitude| Look { model: trial.model.clone(), amplitude };
    if trial.amplitudes.is_empty() {
        return vec![look(None)];
    }
    trial.amplitudes.iter().map(|amplitude| look(Some(*amplitude))).collect()
}

/// The trial with the amplitudes that the first order finds.
fn started(trial: &Trial, by: &[f64]) -> Fitted {
    let mut model = trial.model.clone();
    for ((k, size), by) in trial.amplitudes.iter().zip(by) {
        let by = if *by == 0.0 { LEAST } else { *by };
        model.values[*k] = by * size;
    }
    model
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::compare::Comparison;
    use crate::ahead::fit::{Fitter, evaluated};
    use crate::ahead::testing::{BEAT, BOTH, PUSH, Plant, TONE, TWIN, WAVE};

    const ALL: [usize; 5] = [WAVE, BEAT, BOTH, TONE, PUSH];
    const WEAK: f64 = 2e-3;

    fn base(plant: &Plant) -> Node {
        Fitter::new(plant, plant).fit(Plant::model(&[]), 0, 8)
    }

    #[test]
    fn what_a_parameter_cannot_do_at_its_limit_is_promised_to_another_effect() {
        // A wave is at most 10.
        let promised = |own: f64| {
            let plant = Plant::new(3, &[(WAVE, &[own + WEAK])]);
            let from = evaluated(&plant, Plant::model(&[(WAVE, &[own])]), 0);
            screen(&plant, &plant, &from, &[TWIN], false).promises[0].gain
        };
        assert!(promised(9.0) < 1.0, "{}", promised(9.0));
        assert!(promised(10.0) > 10.0, "{}", promised(10.0));
    }

    #[test]
    fn the_true_candidate_comes_first_with_the_gain_that_a_fit_has() {
        let truths: [(usize, &[f64]); 4] =
            [(WAVE, &[WEAK]), (BEAT, &[WEAK]), (PUSH, &[WEAK]), (TONE, &[WEAK, 3.3])];
        for (seed, truth) in truths.into_iter().enumerate() {
            let plant = Plant::new(10 + seed as u64, &[truth]);
            let from = base(&plant);
            let best = screen(&plant, &plant, &from, &ALL, false).promises.swap_remove(0);
            assert_eq!(best.term, truth.0);
            let fitted = Fitter::new(&plant, &plant).fit(best.starts[0].clone(), 0, 10);
            let gain = Comparison::new(&plant, &plant).compare(&from, &fitted);
            // The grid of frequencies and the weights far from the truth cost some of it.
            let all = gain.nats * fitted.correlation();
            assert!(best.gain > 0.5 * all && best.gain < 1.3 * all, "{} {all}", best.gain);
            let (found, truth) = (fitted.model.values[1], truth.1[0]);
            // Between two frequencies of the grid a fit need not find the way.
            assert!(best.term == TONE || (found / truth - 1.0).abs() < 0.15, "{found} {truth}");
        }
    }

    #[test]
    fn the_leverage_says_what_a_size_would_have_shown() {
        let plant = Plant::new(20, &[]);
        let from = base(&plant);
        let of = |promises: Vec<Promise>| promises.into_iter().find(|p| p.term == BEAT);
        let none = of(screen(&plant, &plant, &from, &ALL, false).promises).unwrap();
        let there = Plant::new(20, &[(BEAT, &[0.6 * WEAK])]);
        let from = base(&there);
        let gain = of(screen(&there, &there, &from, &ALL, false).promises).unwrap().gain;
        let foreseen = none.leverage.unwrap() * (0.6 * WEAK).powi(2);
        assert!((gain / foreseen - 1.0).abs() < 0.3, "{gain} {foreseen}");
    }

    #[test]
    fn what_would_have_to_be_negative_promises_nothing() {
        // Against the sign that it can have.
        let plant = Plant::new(21, &[(PUSH, &[-0.05])]);
        let from = base(&plant);
        let promises = screen(&plant, &plant, &from, &[PUSH], false).promises;
        assert!(promises[0].gain <= 0.0, "{}", promises[0].gain);
    }

    #[test]
    fn a_gain_by_chance_is_told_from_one_that_is_none() {
        // At 5 % for the best of four candidates more than 6 of 40 happen once in 300. A pure tone is itself again
        // after every period, which leaves it next to no placebos.
        let all = [WAVE, BEAT, BOTH, PUSH];
        let alarms = (0..40)
            .filter(|&seed| {
                let plant = Plant::new(3000 + seed, &[]);
                let screened = screen(&plant, &plant, &base(&plant), &all, true);
                screened.chance.p_value(screened.promises[0].gain) <= 0.05
            })
            .count();
        assert!(alarms <= 6, "{alarms} of 40");
        let plant = Plant::new(22, &[(BEAT, &[WEAK])]);
        let screened = screen(&plant, &plant, &base(&plant), &ALL, true);
        let p_value = screened.chance.p_value(screened.promises[0].gain);
        assert!(p_value <= 0.01, "{p_value}");
        let without = screen(&plant, &plant, &base(&plant), &ALL, false).chance;
        assert_eq!(without.p_value(f64::INFINITY), 1.0);
    }

    #[test]
    fn a_start_is_never_at_the_zero_where_a_term_is_not_seen() {
        let plant = Plant::new(23, &[]);
        let node = evaluated(&plant, Plant::model(&[]), 0);
        for promise in screen(&plant, &plant, &node, &ALL, false).promises {
            assert!(promise.starts.iter().all(|start| start.values[1] != 0.0));
        }
    }
}
