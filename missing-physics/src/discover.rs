//! The loop: fit, see where it fails, screen, add, refit, until nothing more is gained.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::family::{Fitted, ModelFamily};
use crate::fit::{self, Fit};
use crate::ladder::Ladder;
use crate::report::Discovery;
use crate::screen::{self, Screened, Screening};
use crate::split::Split;
use crate::{diagnosis, noise, search, verdict, where_it_fails};

/// What is asked of a discovery.
#[derive(Debug)]
pub struct Settings<'a> {
    /// Names of the terms of the base model (those of every model need not be named).
    pub base: Vec<String>,
    /// Names of terms that are not to be tried.
    pub exclude: Vec<String>,
    /// Seed of every random choice.
    pub seed: u64,
    /// Largest p-value at which an effect is added: the false-alarm rate of a screening.
    pub alpha: f64,
    /// Smallest share of the held-out squared error that an effect must remove.
    pub least_gain: f64,
    /// Most effects that are added.
    pub most: usize,
    /// Set from outside to stop; what has been found is reported.
    pub stop: Option<&'a AtomicBool>,
    /// Time after which no new rung is begun.
    pub time_limit: Option<Duration>,
}

impl Default for Settings<'_> {
    fn default() -> Self {
        Self {
            base: Vec::new(),
            exclude: Vec::new(),
            seed: 1,
            alpha: 0.05,
            least_gain: 0.02,
            most: 8,
            stop: None,
            time_limit: None,
        }
    }
}

/// What happens, as it happens.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Event<'a> {
    /// The base model has been fitted.
    BaseFitted {
        /// Evaluations of the search.
        evaluations: usize,
    },
    /// Candidates are being screened for this rung, from 1.
    Screening {
        /// Number of the rung.
        rung: usize,
        /// Number of candidates.
        candidates: usize,
    },
    /// A candidate is being re-identified together with the whole model.
    Trying {
        /// Name of the effect.
        effect: &'a str,
        /// Share of the held-out squared error it is expected to remove.
        gain: f64,
        /// Its p-value.
        p_value: f64,
    },
    /// An effect was added.
    Added {
        /// Name of the effect.
        effect: &'a str,
        /// Relative error on held-out data before.
        before: f64,
        /// Relative error on held-out data after.
        after: f64,
    },
    /// An effect added before is no longer needed.
    Dropped {
        /// Name of the effect.
        effect: &'a str,
    },
    /// The loop has ended; the report is being made.
    Finishing,
}

/// Someone who watches.
pub trait Observer {
    /// Called for every event.
    fn event(&mut self, event: &Event<'_>);
}

/// Watches nothing.
impl Observer for () {
    fn event(&mut self, _: &Event<'_>) {}
}

/// Why a discovery cannot begin.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DiscoverError {
    /// A term that the family does not have.
    #[error("there is no effect '{name}'; there are: {known}")]
    UnknownTerm {
        /// The name asked for.
        name: String,
        /// Every name there is.
        known: String,
    },
}

/// The indices of terms by name, those of every model first.
///
/// # Errors
/// [`DiscoverError::UnknownTerm`] for a name that the family does not have.
pub fn terms<F: ModelFamily + ?Sized>(
    family: &F,
    names: &[String],
) -> Result<Vec<usize>, DiscoverError> {
    let all = family.terms();
    let mut indices: Vec<usize> = (0..all.len()).filter(|&k| all[k].always).collect();
    for name in names {
        let index = all.iter().position(|term| &term.name == name).ok_or_else(|| {
            let known: Vec<&str> =
                all.iter().filter(|t| !t.always).map(|t| t.name.as_str()).collect();
            DiscoverError::UnknownTerm { name: name.clone(), known: known.join(", ") }
        })?;
        if !indices.contains(&index) {
            indices.push(index);
        }
    }
    Ok(indices)
}

/// Fits the base model, then adds what is missing until nothing is gained on held-out data.
///
/// # Errors
/// When a name in the settings is unknown.
pub fn discover<F: ModelFamily + ?Sized>(
    family: &F,
    settings: &Settings<'_>,
    observer: &mut dyn Observer,
) -> Result<Discovery, DiscoverError> {
    let base = terms(family, &settings.base)?;
    let excluded = terms(family, &settings.exclude)?;
    Ok(Search::new(family, settings, &base, excluded, observer).run())
}

/// Fits `names` on the fitted blocks, screens everything else once and stops: what a model lacks,
/// without adding it.
///
/// # Errors
/// When a name is unknown.
pub fn suggest<F: ModelFamily + ?Sized>(
    family: &F,
    settings: &Settings<'_>,
    observer: &mut dyn Observer,
) -> Result<Discovery, DiscoverError> {
    let once = Settings {
        base: settings.base.clone(),
        exclude: settings.exclude.clone(),
        most: 0,
        ..*settings
    };
    discover(family, &once, observer)
}

/// The state of a running discovery.
struct Search<'a, F: ModelFamily + ?Sized> {
    family: &'a F,
    settings: &'a Settings<'a>,
    observer: &'a mut dyn Observer,
    started: Instant,
    split: Split,
    /// 1 on fitted points, 0 on held-out ones.
    fitted: Vec<f64>,
    motion: Vec<Vec<f64>>,
    excluded: Vec<usize>,
    fit: Fit,
    ladder: Ladder<'a, F>,
}

impl<'a, F: ModelFamily + ?Sized> Search<'a, F> {
    fn new(
        family: &'a F,
        settings: &'a Settings<'a>,
        base: &[usize],
        excluded: Vec<usize>,
        observer: &'a mut dyn Observer,
    ) -> Self {
        let started = Instant::now();
        let points = family.target().len();
        let split = Split::new(points, family.blocks());
        let fitted: Vec<f64> =
            split.fit(points).iter().map(|fit| if *fit { 1.0 } else { 0.0 }).collect();
        let found = search::identify(family, base, &fitted, settings.seed);
        observer.event(&Event::BaseFitted { evaluations: found.evaluations });
        let fit = found.fit;
        let motion = family.motion();
        let mut ladder = Ladder::new(family, split.clone(), fitted.clone());
        ladder.push(None, &fit, None);
        Self { family, settings, observer, started, split, fitted, motion, excluded, fit, ladder }
    }

    fn run(mut self) -> Discovery {
        let base = self.fit.clone();
        let mut last_screening;
        loop {
            last_screening = self.screen();
            self.ladder.rank(&last_screening);
            let enough = self.ladder.added().len() >= self.settings.most;
            if enough || self.stopped() || self.at_floor() {
                break;
            }
            let Some(chosen) = self.best_addition(&last_screening) else { break };
            self.add(chosen);
            self.drop_idle();
        }
        self.observer.event(&Event::Finishing);
        self.report(&base, &last_screening)
    }

    fn stopped(&self) -> bool {
        let asked = self.settings.stop.is_some_and(|stop| stop.load(Ordering::Relaxed));
        asked || self.settings.time_limit.is_some_and(|limit| self.started.elapsed() >= limit)
    }

    fn screen(&mut self) -> Vec<Screened> {
        let candidates: Vec<usize> = (0..self.family.terms().len())
            .filter(|&term| {
                self.family.joins(&self.fit.model, term)
                    && self.family.form_of(term).is_none()
                    && !self.excluded.contains(&term)
            })
            .collect();
        let rung = self.ladder.added().len() + 1;
        self.observer.event(&Event::Screening { rung, candidates: candidates.len() });
        let weights = weights(self.family.doubt(), &self.fit.residual);
        let screening = self.screening(&candidates, &weights);
        let mut screened = screen::screen(self.family, &self.fit, &screening);
        // A flexible term gains much by chance: what gains more than chance does stands before it.
        screened.sort_by_key(|candidate| candidate.p_value > self.settings.alpha);
        screened
    }

    /// Whether what has been added leaves no more than the noise floor: from there on an effect could
    /// only fit noise.
    fn at_floor(&self) -> bool {
        let floor = || noise::floor_of(self.family, &self.fit.residual);
        !self.ladder.added().is_empty() && square(&self.fit).sqrt() <= AT_FLOOR * floor()
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
    /// None where a plain structure along time explains more than any candidate: then no effect of
    /// the library is at work, but something that happens at its own time.
    fn best_addition(&mut self, screened: &[Screened]) -> Option<Tried> {
        let before = self.split.rms(&self.fit.residual).validation;
        let enough = before * (1.0 - self.settings.least_gain).sqrt();
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
        let helps = |tried: &Tried| {
            self.split.rms(&tried.fit.residual).validation < enough && self.confirmed(&tried.fit)
        };
        let mut tried: Vec<Tried> = tried.into_iter().filter(helps).collect();
        tried.sort_by(|a, b| a.square.total_cmp(&b.square));
        let before = square(&self.fit);
        let chosen = Self::simplest(&tried, before)?;
        if self.in_time(1.0 - tried[chosen].square / before) {
            return None;
        }
        let best = tried.swap_remove(chosen);
        let rivals =
            tried.iter().filter(|rival| as_good(rival, &best, before) && !self.at_bound(rival));
        self.ladder.rivals(best.term, rivals.map(|rival| rival.term).collect());
        Some(best)
    }

    /// Of the best candidate and those that are as good the one with the fewest parameters.
    fn simplest(tried: &[Tried], before: f64) -> Option<usize> {
        let best = tried.first()?;
        let parameters = |k: &usize| tried[*k].fit.model.values.len();
        (0..tried.len())
            .filter(|&k| k == 0 || as_good(&tried[k], best, before))
            .min_by_key(parameters)
    }

    /// A term re-identified with the whole model, its shapes searched around `values`.
    fn tried(&self, term: usize, values: &[f64], p_value: f64) -> Tried {
        let start =
            search::shaped(self.family, &self.fit, term, values, &self.fitted, self.settings.seed);
        let fit = fit::refine(self.family, start, &self.fitted);
        Tried { term, square: square(&fit), fit, p_value }
    }

    /// Whether a parameter of the tried term ended at a limit of its search: what the term says beyond
    /// a simpler one is then not in the data.
    fn at_bound(&self, tried: &Tried) -> bool {
        let model = &tried.fit.model;
        let values = &model.values[model.range(self.family, model.terms.len() - 1)];
        let parameters = &self.family.terms()[tried.term].parameters;
        parameters.iter().zip(values).any(|(parameter, value)| {
            let near = |limit: f64| (value - limit).abs() <= 1e-3 * limit.abs().max(1e-12);
            near(parameter.lower) || near(parameter.upper)
        })
    }

    /// Every candidate in its main form, or in another one that is clearly better. Other forms are only
    /// looked at where the main form is in the running.
    fn with_forms(&self, tried: Vec<Tried>) -> Vec<Tried> {
        let before = square(&self.fit);
        let best = tried.iter().map(|main| main.square).fold(before, f64::min);
        let hopeful = before - HOPEFUL * (before - best);
        let better = |main: Tried| if main.square <= hopeful { self.best_form(main) } else { main };
        tried.into_iter().map(better).collect()
    }

    /// The main form of an effect, or another one that is clearly better.
    fn best_form(&self, main: Tried) -> Tried {
        let weights = weights(self.family.doubt(), &self.fit.residual);
        let screening = self.screening(&[], &weights);
        (0..self.family.terms().len())
            .filter(|&form| self.family.form_of(form) == Some(main.term))
            .filter_map(|form| {
                let values = screen::best_values(self.family, &self.fit, &screening, form)?;
                Some(self.tried(form, &values, main.p_value))
            })
            .filter(|form| form.square < main.square * BETTER_FORM)
            .min_by(|a, b| a.square.total_cmp(&b.square))
            .unwrap_or(main)
    }

    /// Whether a step or a sine in time explains more of the residual than this share.
    fn in_time(&self, share: f64) -> bool {
        let places = self.along_time(&self.fit.residual);
        places.iter().any(|place| place.p_value <= IN_TIME && place.share > share)
    }

    fn along_time(&self, residual: &[f64]) -> Vec<crate::report::Where> {
        let weights = weights(self.family.doubt(), residual);
        let view = where_it_fails::View {
            residual,
            weights: &weights,
            motion: &self.motion,
            seed: self.settings.seed,
        };
        where_it_fails::times(self.family, &view)
    }

    /// Whether no other view of the error contradicts: what really acts on the plant helps
    /// in every view.
    fn confirmed(&self, fit: &Fit) -> bool {
        let before = self.ladder.views();
        let after = self.family.views(&fit.model, &self.split);
        after.iter().all(|(name, error)| {
            before.get(name).is_none_or(|old| {
                error.validation <= CONTRADICTION * old.validation
                    || error.fit <= CONTRADICTION * old.fit
            })
        })
    }

    fn add(&mut self, tried: Tried) {
        let before = self.ladder.relative();
        self.fit = tried.fit;
        self.ladder.push(Some(tried.term), &self.fit, Some(tried.p_value));
        self.observer.event(&Event::Added {
            effect: &self.family.terms()[tried.term].name,
            before,
            after: self.ladder.relative(),
        });
    }

    /// Takes out effects, added earlier, without which the held-out error is as small.
    fn drop_idle(&mut self) {
        let added = self.ladder.added();
        for &term in &added[..added.len().saturating_sub(1)] {
            let with = self.split.rms(&self.fit.residual).validation;
            let without =
                fit::refine(self.family, self.fit.model.without(self.family, term), &self.fitted);
            let error = self.split.rms(&without.residual).validation;
            if error.powi(2) * (1.0 - 0.5 * self.settings.least_gain) <= with.powi(2) {
                self.observer.event(&Event::Dropped { effect: &self.family.terms()[term].name });
                self.fit = without;
                self.ladder.drop(term, &self.fit);
            }
        }
    }

    fn report(self, base: &Fit, screened: &[Screened]) -> Discovery {
        let view = |residual: &[f64]| {
            where_it_fails::coordinates(
                self.family,
                &where_it_fails::View {
                    residual,
                    weights: &weights(self.family.doubt(), residual),
                    motion: &self.motion,
                    seed: self.settings.seed,
                },
            )
        };
        let evidence = verdict::Evidence {
            where_base: view(&base.residual),
            where_last: view(&self.fit.residual),
            base,
            last: &self.fit,
            screened,
            alpha: self.settings.alpha,
            interrupted: self.stopped(),
        };
        let mut discovery = verdict::report(self.family, self.ladder, &evidence);
        diagnosis::attach(self.family, base, &self.fit, self.settings.seed, &mut discovery);
        discovery.seed = self.settings.seed;
        discovery.wall_s = self.started.elapsed().as_secs_f64();
        discovery
    }
}

/// Candidates that are re-identified per rung.
const MOST_TRIED: usize = 4;
/// A rival's squared error is larger by at most this share.
const RIVAL: f64 = 0.05;

/// The same in standard errors of the difference.
const STANDARD_ERRORS: f64 = 1.0;
/// Another form of an effect is taken where it leaves at most this share of the main form's squared
/// error.
const BETTER_FORM: f64 = 0.8;
/// A model is at the noise floor where its error exceeds it by at most this factor.
const AT_FLOOR: f64 = 1.05;
/// Other forms are tried where the main form removes at least this share of what the best candidate
/// removes.
const HOPEFUL: f64 = 0.4;
/// Largest p-value of a structure along time that is taken for real.
const IN_TIME: f64 = 0.005;
/// Pieces of time for the standard error of a mean.
const PIECES: usize = 15;

/// A candidate re-identified with the whole model.
struct Tried {
    term: usize,
    fit: Fit,
    /// Mean squared residual on all data.
    square: f64,
    p_value: f64,
}

/// Mean squared residual on all data.
fn square(fit: &Fit) -> f64 {
    fit.residual.iter().map(|value| value * value).sum::<f64>() / fit.residual.len() as f64
}

/// Whether the data cannot tell a rival from the best: the rival removes half as much at least,
/// and its squared error is larger by less than a few per cent or by less than the differences
/// between pieces of time make likely. All data count: what a handful of
/// parameters gains by being fitted is small against what a third of the data leaves to chance.
fn as_good(rival: &Tried, best: &Tried, before: f64) -> bool {
    let (removed, more) = (before - best.square, rival.square - best.square);
    let pairs = rival.fit.residual.iter().zip(&best.fit.residual);
    let differences: Vec<f64> = pairs.map(|(a, b)| a * a - b * b).collect();
    let by_chance = STANDARD_ERRORS * error_of_mean(&differences);
    more < 0.5 * removed && (more < RIVAL * best.square || more < by_chance)
}

/// Standard error of the mean of autocorrelated values, from the means of contiguous pieces.
fn error_of_mean(values: &[f64]) -> f64 {
    let size = values.len().div_ceil(PIECES).max(1);
    let means: Vec<f64> =
        values.chunks(size).map(|piece| piece.iter().sum::<f64>() / piece.len() as f64).collect();
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    let square: f64 = means.iter().map(|piece| (piece - mean).powi(2)).sum();
    (square / (count * (count - 1.0).max(1.0))).sqrt()
}

/// Another view contradicts an effect where its error grows by this factor on held-out data and on
/// fitted data as well: one of them alone is a matter of a few windows.
const CONTRADICTION: f64 = 1.05;

/// Weights for screening: a point whose doubt exceeds the usual residual counts accordingly less.
pub fn weights(doubt: &[f64], residual: &[f64]) -> Vec<f64> {
    let mut sizes: Vec<f64> = residual.iter().map(|value| value.abs()).collect();
    let middle = sizes.len() / 2;
    // Median absolute residual, as a standard deviation.
    let usual = 1.4826 * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    doubt
        .iter()
        .map(|doubt| if usual > 0.0 { 1.0 / (1.0 + (doubt / usual).powi(2)).sqrt() } else { 1.0 })
        .collect()
}

/// A model at given values, evaluated on the whole grid.
pub fn evaluate<F: ModelFamily + ?Sized>(family: &F, model: Fitted) -> Fit {
    let weights = vec![1.0; family.target().len()];
    fit::evaluate(family, model, &weights)
}
