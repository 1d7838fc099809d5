//! Up the ladder: what the next rung is, and when there is none.

mod evidence;
mod forms;
mod grounds;
mod ladder;
mod limits;
pub mod pairs;
mod reconsider;
pub mod screen;
mod tried;
mod verdict;
mod views;

use std::sync::atomic::Ordering;
use std::time::Instant;

use crate::climb::grounds::Grounds;
use crate::climb::ladder::Ladder;
use crate::climb::pairs::Pair;
use crate::climb::screen::{Screened, Screening};
use crate::climb::tried::{Tried, as_good, square};
use crate::diagnosis::{self, noise, where_it_fails};
use crate::family::ModelFamily;
use crate::fit::{self, Fit};
use crate::report::{Discovery, Where};
use crate::statistics::split::Split;
use crate::statistics::weights;
use crate::task::{Event, Observer, Settings};

/// Candidates that are re-identified per rung.
const MOST_TRIED: usize = 4;
/// Pairs that are re-identified where no single candidate helps.
const MOST_PAIRS: usize = 4;
/// Smallest share of the held-out squared error that a pair must remove: it has twice the freedom.
const LEAST_PAIR: f64 = 0.05;
/// A model is at the noise floor where its error exceeds it by at most this factor.
const AT_FLOOR: f64 = 1.05;
/// What a candidate removes at least this share of, on held-out data, is not noise.
const NO_NOISE: f64 = 0.2;
/// Largest p-value of a structure along time that is taken for real.
const IN_TIME: f64 = 0.005;

/// The state of a running discovery.
pub(crate) struct Search<'a, F: ModelFamily + ?Sized> {
    family: &'a F,
    settings: &'a Settings<'a>,
    observer: &'a mut (dyn Observer + Send),
    started: Instant,
    split: Split,
    /// 1 on fitted points, 0 on held-out ones.
    fitted: Vec<f64>,
    motion: Vec<Vec<f64>>,
    excluded: Vec<usize>,
    fit: Fit,
    ladder: Ladder<'a, F>,
    /// Effects that were exchanged for others.
    exchanges: usize,
}

impl<'a, F: ModelFamily + ?Sized> Search<'a, F> {
    pub(crate) fn new(
        family: &'a F,
        settings: &'a Settings<'a>,
        base: &[usize],
        excluded: Vec<usize>,
        observer: &'a mut (dyn Observer + Send),
    ) -> Self {
        let started = Instant::now();
        let points = family.target().len();
        let split = Split::new(points, family.blocks());
        let fitted: Vec<f64> =
            split.fit(points).iter().map(|fit| if *fit { 1.0 } else { 0.0 }).collect();
        let found = fit::identify(family, base, &fitted, settings.seed);
        observer.event(&Event::BaseFitted { evaluations: found.evaluations });
        let fit = found.fit;
        let motion = family.motion();
        let mut ladder = Ladder::new(family, split.clone(), fitted.clone());
        ladder.push(&[], &fit, None);
        Self {
            family,
            settings,
            observer,
            started,
            split,
            fitted,
            motion,
            excluded,
            fit,
            ladder,
            exchanges: 0,
        }
    }

    pub(crate) fn run(mut self) -> Discovery {
        let base = self.fit.clone();
        let mut first_screening = None;
        let mut last_screening;
        loop {
            last_screening = self.screen();
            first_screening.get_or_insert_with(|| last_screening.clone());
            self.ladder.rank(&last_screening);
            let Some(chosen) = self.next(&last_screening) else {
                if self.reconsider() {
                    continue;
                }
                break;
            };
            if let Some((old, better)) = self.other_form(&chosen) {
                self.replace(old, better);
                continue;
            }
            let newest = chosen.terms.len();
            self.add(chosen);
            self.drop_idle(newest);
        }
        self.observer.event(&Event::Finishing);
        self.report(&base, &first_screening.unwrap_or_default(), &last_screening)
    }

    /// What to add, if anything.
    fn next(&mut self, screened: &[Screened]) -> Option<Tried> {
        let enough = self.ladder.added().len() >= self.settings.most;
        if enough || self.stopped() || self.at_floor(screened) {
            return None;
        }
        // Where a plain structure along time explains more, no effect of the library is at work, but
        // something that happens at its own time.
        let single = self.best_addition(screened).filter(|best| !self.in_time(best));
        single.or_else(|| self.best_pair(screened).filter(|best| !self.in_time(best)))
    }

    fn stopped(&self) -> bool {
        let asked = self.settings.stop.is_some_and(|stop| stop.load(Ordering::Relaxed));
        asked || self.settings.time_limit.is_some_and(|limit| self.started.elapsed() >= limit)
    }

    fn screen(&mut self) -> Vec<Screened> {
        // Every form takes part: what a soft contact leaves, say, a stiff one shows nothing of.
        let candidates: Vec<usize> = (0..self.family.terms().len())
            .filter(|&term| {
                let main = self.family.form_of(term).unwrap_or(term);
                let excluded = [term, main].iter().any(|term| self.excluded.contains(term));
                self.family.joins(&self.fit.model, term) && !excluded
            })
            .collect();
        let rung = self.ladder.height();
        self.observer.event(&Event::Screening { rung, candidates: candidates.len() });
        let weights = weights(self.family.doubt(), &self.fit.residual);
        let screening = self.screening(&candidates, &weights);
        let mut screened = self.one_of_each(&screen::screen(self.family, &self.fit, &screening));
        // A flexible term gains much by chance: what gains more than chance does stands before it.
        screened.sort_by_key(|candidate| candidate.p_value > self.settings.alpha);
        screened
    }

    /// Whether what has been added leaves no more than the noise floor: from there on an effect could
    /// only fit noise. What is no function of the present state (a drift, a ringing) is noise to
    /// the floor: a candidate that removes much of it refutes that.
    fn at_floor(&self, screened: &[Screened]) -> bool {
        let refuted =
            screened.iter().any(|c| c.p_value <= self.settings.alpha && c.gain >= NO_NOISE);
        let floor = || noise::floor_of(self.family, &self.fit.residual);
        !self.ladder.added().is_empty()
            && !refuted
            && square(&self.fit).sqrt() <= AT_FLOOR * floor()
    }

    fn screening<'b>(&'b self, candidates: &'b [usize], weights: &'b [f64]) -> Screening<'b> {
        let rung = self.ladder.added().len() as u64 + 1;
        Screening {
            candidates,
            weights,
            split: &self.split,
            motion: &self.motion,
            seed: self.settings.seed.wrapping_add(rung),
        }
    }

    /// The candidate that, re-identified with the whole model, leaves the smallest error, of those that
    /// lower the held-out error.
    fn best_addition(&mut self, screened: &[Screened]) -> Option<Tried> {
        let likely = screened
            .iter()
            .filter(|c| c.p_value <= self.settings.alpha && c.gain >= self.settings.least_gain);
        let mut tried: Vec<Tried> = Vec::new();
        for candidate in likely.take(MOST_TRIED) {
            if self.stopped() {
                break;
            }
            self.observer.event(&Event::Trying {
                effect: &self.family.terms()[candidate.term].name,
                gain: candidate.gain,
                p_value: candidate.p_value,
            });
            tried.push(self.tried(candidate.term, &candidate.values, candidate.p_value));
        }
        let tried = self.with_forms(tried);
        let mut tried = self.helpful(tried, self.settings.least_gain);
        let before = square(&self.fit);
        let at_bound = tried.first().is_some_and(|best| self.at_bound(best));
        let chosen = tried::simplest(&tried, before, at_bound)?;
        let best = tried.swap_remove(chosen);
        let rivals =
            tried.iter().filter(|rival| as_good(rival, &best, before) && !self.at_bound(rival));
        let rivals = rivals.map(|rival| rival.terms[0]).collect();
        let others = tried.iter().map(|other| (other.terms[0], other.p_value)).collect();
        self.ladder.contest(best.terms[0], others, rivals);
        Some(best)
    }

    /// Two candidates that help together where no single one does.
    fn best_pair(&mut self, screened: &[Screened]) -> Option<Tried> {
        if self.stopped() {
            return None;
        }
        let candidates: Vec<usize> = screened.iter().map(|candidate| candidate.term).collect();
        let count = candidates.len() * candidates.len().saturating_sub(1) / 2;
        self.observer.event(&Event::ScreeningPairs { pairs: count });
        let weights = weights(self.family.doubt(), &self.fit.residual);
        let screening = self.screening(&candidates, &weights);
        let pairs = pairs::screen(self.family, &self.fit, &screening, LEAST_PAIR);
        let likely = |pair: &&Pair| pair.p_value <= self.settings.alpha;
        let tried = pairs.iter().filter(likely).take(MOST_PAIRS).map(|pair| {
            let terms = [0, 1].map(|k| (pair.terms[k], pair.shapes[k].as_slice()));
            let start = fit::joined(self.family, &self.fit, &terms, &self.fitted);
            let fit = fit::refine(self.family, start, &self.fitted);
            Tried::new(&pair.terms, fit, pair.p_value)
        });
        let tried = tried.collect();
        self.helpful(tried, LEAST_PAIR).into_iter().next().map(|pair| self.without_idle(pair))
    }

    /// A pair, or the one of the two that does as well alone.
    fn without_idle(&self, pair: Tried) -> Tried {
        let alone = pair.terms.iter().find_map(|&idle| {
            let fit = self.without(&pair.fit, idle)?;
            let rest: Vec<usize> = pair.terms.iter().copied().filter(|&t| t != idle).collect();
            Some(Tried::new(&rest, fit, pair.p_value))
        });
        alone.unwrap_or(pair)
    }

    /// The model of `fit` without a term, where its held-out error is as small.
    fn without(&self, fit: &Fit, term: usize) -> Option<Fit> {
        let lean = fit::refine(self.family, fit.model.without(self.family, term), &self.fitted);
        let error = |fit: &Fit| self.split.rms(&fit.residual).validation.powi(2);
        let as_small = error(&lean) * (1.0 - 0.5 * self.settings.least_gain) <= error(fit);
        as_small.then_some(lean)
    }

    /// Those that lower the held-out squared error by a share of `least` and that no other view
    /// contradicts, the smallest error first.
    fn helpful(&self, mut tried: Vec<Tried>, least: f64) -> Vec<Tried> {
        let before = self.split.rms(&self.fit.residual).validation;
        let enough = before * (1.0 - least).sqrt();
        tried.retain(|tried| {
            self.split.rms(&tried.fit.residual).validation < enough
                && self.confirmed(&tried.fit)
                && self.stands_out(&tried.fit)
        });
        tried.sort_by(|a, b| a.square.total_cmp(&b.square));
        tried
    }

    /// A term re-identified with the whole model, its shapes searched around `values`.
    fn tried(&self, term: usize, values: &[f64], p_value: f64) -> Tried {
        self.tried_from(&self.fit, term, values, p_value)
    }

    /// The same beside another model than the present one.
    fn tried_from(&self, beside: &Fit, term: usize, values: &[f64], p_value: f64) -> Tried {
        let start =
            fit::shaped(self.family, beside, term, values, &self.fitted, self.settings.seed);
        let fit = fit::refine(self.family, start, &self.fitted);
        Tried::new(&[term], fit, p_value)
    }

    /// Whether a parameter of the tried term ended at a limit of its search: what the term says beyond
    /// a simpler one is then not in the data.
    fn at_bound(&self, tried: &Tried) -> bool {
        let model = &tried.fit.model;
        let values = &model.values[model.range(self.family, model.terms.len() - 1)];
        let parameters = &self.family.terms()[tried.terms[0]].parameters;
        parameters.iter().zip(values).any(|(parameter, value)| {
            let near = |limit: f64| (value - limit).abs() <= 1e-3 * limit.abs().max(1e-12);
            near(parameter.lower) || near(parameter.upper)
        })
    }

    /// Whether a step or a sine in time explains more of the residual than what has been tried. Two effects
    /// have so much more freedom that they must leave half of what the plain structure leaves.
    fn in_time(&self, tried: &Tried) -> bool {
        let left = tried.square / square(&self.fit);
        let left = if tried.terms.len() > 1 { 2.0 * left } else { left };
        let places = self.along_time(&self.fit.residual);
        places.iter().any(|place| place.p_value <= IN_TIME && 1.0 - place.share < left)
    }

    fn along_time(&self, residual: &[f64]) -> Vec<Where> {
        self.where_it_fails(residual, where_it_fails::times)
    }

    /// What `look` says of a residual, weighed by its doubt.
    fn where_it_fails(
        &self,
        residual: &[f64],
        look: fn(&F, &where_it_fails::Look<'_>) -> Vec<Where>,
    ) -> Vec<Where> {
        let weights = weights(self.family.doubt(), residual);
        let view = where_it_fails::Look {
            residual,
            weights: &weights,
            motion: &self.motion,
            seed: self.settings.seed,
        };
        look(self.family, &view)
    }

    fn add(&mut self, tried: Tried) {
        let before = self.ladder.relative();
        self.fit = tried.fit;
        self.ladder.push(&tried.terms, &self.fit, Some(tried.p_value));
        self.observer.event(&Event::Added {
            effects: &self.ladder.names(&tried.terms),
            before,
            after: self.ladder.relative(),
        });
    }

    /// Takes out effects, added before the `newest`, without which the held-out error is as small.
    fn drop_idle(&mut self, newest: usize) {
        let added = self.ladder.added();
        for &term in &added[..added.len().saturating_sub(newest)] {
            if let Some(without) = self.without(&self.fit, term) {
                self.observer.event(&Event::Dropped { effect: &self.family.terms()[term].name });
                self.fit = without;
                self.ladder.drop(term, &self.fit);
            }
        }
    }

    fn report(mut self, base: &Fit, first: &[Screened], last: &[Screened]) -> Discovery {
        let mut evidence = self.evidence(base, &self.fit, last);
        let mut notes = Vec::new();
        // A climb that was cut short has not said its last word.
        let ended = !self.stopped() && self.ladder.added().len() < self.settings.most;
        if ended
            && !self.ladder.added().is_empty()
            && verdict::explains_little(self.family, &self.split, &evidence)
        {
            notes.push(format!(
                "nearest: {} would lower the held-out error only to {:.2} %, and most of the structure \
                 would remain: that is not the cause",
                self.ladder.names(&self.ladder.added()).join(" + "),
                100.0 * self.ladder.relative(),
            ));
            self.ladder.clear();
            evidence = self.evidence(base, base, first);
        }
        let mut discovery = verdict::report(self.family, self.ladder, &evidence);
        discovery.notes.append(&mut notes);
        let seed = self.settings.seed;
        diagnosis::attach(self.family, base, evidence.last, seed, &mut discovery);
        discovery.seed = seed;
        discovery.wall_s = self.started.elapsed().as_secs_f64();
        discovery
    }

    fn evidence<'b>(&self, base: &'b Fit, last: &'b Fit, screened: &'b [Screened]) -> Grounds<'b> {
        let view = |residual: &[f64]| self.where_it_fails(residual, where_it_fails::coordinates);
        Grounds {
            where_base: view(&base.residual),
            where_last: view(&last.residual),
            base,
            last,
            screened,
            alpha: self.settings.alpha,
            interrupted: self.stopped(),
            within_noise: self.within_noise(),
        }
    }
}
