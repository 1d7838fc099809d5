//! Families that say at once what a whole recording should be: what is left of it are the errors.
//!
//! In a first look they count as they are, and what resembles its neighbours says less. Only in a second one are they
//! [whitened](Whitening): an autoregression of what a wrong model leaves looks away from where that is large, and whatever
//! lowers the rest a little gets a name.
//!
//! How large noise makes the errors is known where the family states it ([`ModelFamily::noise`]), else from what changes
//! quickly in the residual of the base model; its colour is what [`ModelFamily::colour`] says, white where that says
//! nothing. An autoregression foretells a force that is missing as well as it foretells noise, so that small errors one
//! sample ahead do not make a model complete: what remains is asked as well.

use rayon::prelude::*;

use super::whitening::{ORDERS, Whitening};
use super::{Ahead, Trial, quick, statistics, trials};
use crate::ahead::autoregression::Autoregression;
use crate::diagnosis::where_it_fails::{self, Look};
use crate::family::{Fitted, ModelFamily};
use crate::fit;
use crate::report::{NoCause, Remains, Where, floor_key};
use crate::statistics::autocorrelation::pieces;
use crate::statistics::basis::weighed;
use crate::statistics::weights;

/// What changes less than this share of the target is not looked for: no two computations agree much better.
const FLOOR: f64 = 1e-4;
/// Errors that are asked for all that an effect must gain. Where 8,000 are, 900 find 11 of 24 effects half as large as noise
/// that has memory, not 20; where 32,000 are, 9 of 240 recordings that lack nothing get a name, not none.
const IN_FULL: f64 = 16_000.0;
/// Where the base model's own prediction changes from sample to sample by more than this share of what its residual does,
/// that may be as little noise as the prediction is.
const SMOOTH: f64 = 0.5;
/// Largest p-value and smallest share of the square of a dependence on a coordinate that keeps a model incomplete.
const STRUCTURE: (f64, f64) = (Where::STRUCTURE, 0.08);
/// Share of what is more than noise that effects may leave and still be its cause.
const MOST: f64 = 0.5;
/// Settings where residuals count as they are, one on each ladder.
const PLAIN: usize = 2;
/// Starts of a term with shapes: valleys between them are narrow.
const STARTS: usize = 3;

/// A family that only gives residuals.
pub struct Residuals<'a> {
    family: &'a dyn ModelFamily,
    instants: Vec<(f64, usize)>,
    /// How much each residual counts, the same for every model.
    weights: Vec<f64>,
    whitening: Whitening,
    /// Share of the noise that is left at each setting, by its stated colour.
    left: Vec<f64>,
    /// Whether what changes quickly may be anything.
    coarse: bool,
    /// Whether residuals are whitened.
    whitened: bool,
}

impl<'a> Residuals<'a> {
    /// Of a family; the residual of `base` shows the noise.
    pub fn new(family: &'a dyn ModelFamily, base: &Fitted) -> Self {
        let prediction = fit::predict(family, base);
        let residual = fit::residual(family, &prediction);
        let weights = weights(family.doubt(), &residual);
        let residual = weighed(&residual, &weights);
        let (time, colour) = (family.time(), family.colour());
        let runs = pieces(time);
        let places = runs.iter().enumerate().flat_map(|(k, run)| run.clone().map(move |i| (i, k)));
        let instants = places.map(|(i, piece)| (time[i], piece)).collect();
        let mean = family.target().iter().sum::<f64>() / time.len().max(1) as f64;
        let swing: Vec<f64> = family.target().iter().map(|value| value - mean).collect();
        let moves = quick::noise(&prediction, &runs, &[]);
        let mut whitening = Whitening::of(&swing, &residual, runs, &colour, FLOOR);
        let about = family.quantity();
        let stated = family.noise().get(&floor_key(&about.name, &about.unit)).copied();
        let coarse = stated.is_none() && moves > SMOOTH * whitening.budget;
        whitening.budget = stated.unwrap_or(whitening.budget).max(f64::MIN_POSITIVE);
        let colour: Vec<f64> = std::iter::once(1.0).chain(colour).collect();
        let law = Autoregression::from_products(&colour, 1.0);
        let left = ORDERS.iter().map(|order| law.with_before(*order).left.sqrt()).collect();
        Self { family, instants, weights, whitening, left, coarse, whitened: false }
    }

    /// Where the order of a setting stands.
    fn order(&self, setting: usize) -> usize {
        if self.whitened { setting.min(ORDERS.len() - 1) } else { 0 }
    }

    fn residual(&self, model: &Fitted) -> Vec<f64> {
        let residual = fit::residual(self.family, &fit::predict(self.family, model));
        weighed(&residual, &self.weights)
    }

    /// What `look` finds to be uneven in a residual beyond chance, the largest share first.
    fn uneven(
        &self,
        residual: &[f64],
        look: fn(&dyn ModelFamily, &Look<'_>) -> Vec<Where>,
    ) -> Option<Where> {
        let motion = self.family.motion();
        let view = Look { residual, weights: &vec![1.0; residual.len()], motion: &motion, seed: 1 };
        let places = look(self.family, &view);
        places.into_iter().find(|p| p.p_value <= STRUCTURE.0 && p.share >= STRUCTURE.1)
    }

    /// Along which coordinate, or along time, what is left is uneven beyond chance.
    fn structure(&self, residual: &[f64]) -> Option<Where> {
        let over_time = || self.uneven(residual, where_it_fails::times);
        self.uneven(residual, where_it_fails::coordinates).or_else(over_time)
    }
}

impl Ahead for Residuals<'_> {
    fn settings(&self) -> usize {
        if self.whitened { ORDERS.len() } else { PLAIN }
    }

    fn expected(&self, setting: usize) -> f64 {
        self.whitening.budget * self.left[self.order(setting)]
    }

    fn budget(&self) -> f64 {
        self.expected(ORDERS.len())
    }

    fn errors(&self, models: &[(Fitted, usize)]) -> Vec<Vec<f64>> {
        let each = models.par_iter().map(|(model, setting)| {
            let residual = self.residual(model);
            if !residual.iter().all(|r| r.is_finite()) {
                return vec![f64::MAX; residual.len()];
            }
            self.whitening.errors(&residual, self.order(*setting))
        });
        each.collect()
    }

    fn errors_beside(&self, model: &Fitted, setting: usize, others: &[Fitted]) -> Vec<Vec<f64>> {
        let own = self.residual(model);
        let others: Vec<Vec<f64>> = others.par_iter().map(|other| self.residual(other)).collect();
        self.whitening.errors_beside(&own, self.order(setting), &others)
    }

    fn instants(&self) -> &[(f64, usize)] {
        &self.instants
    }

    fn coloured(&self) -> Option<Box<dyn Ahead + '_>> {
        Some(Box::new(Residuals {
            family: self.family,
            instants: self.instants.clone(),
            weights: self.weights.clone(),
            whitening: self.whitening.clone(),
            left: self.left.clone(),
            coarse: self.coarse,
            whitened: true,
        }))
    }

    fn asked(&self) -> f64 {
        (self.instants.len() as f64 / IN_FULL).min(1.0)
    }

    fn along(&self) -> Vec<(String, String, Vec<f64>)> {
        let coordinates = self.family.coordinates().iter();
        let plain = coordinates.filter(|c| c.parity.is_none() && c.name != "time");
        plain.map(|c| (c.name.clone(), c.unit.clone(), c.values.clone())).collect()
    }

    fn trials(&self, model: &Fitted, term: usize) -> Vec<Trial> {
        trials(self.family, model, term, &self.family.shapes(term))
    }

    fn starts(&self, term: usize) -> usize {
        if self.family.shapes(term).len() > 1 { STARTS } else { 1 }
    }

    fn remains(&self, model: &Fitted, complete: f64) -> Option<Remains> {
        let residual = self.residual(model);
        let unit = self.family.quantity().unit;
        let (rms, noise) = (statistics::rms(&residual, f64::INFINITY), self.whitening.budget);
        if self.coarse {
            return Some(Remains::TooCoarse);
        }
        if let Some(place) = self.structure(&residual) {
            return Some(Remains::Structure { place });
        }
        (rms > complete * noise).then_some(Remains::Slow { rms, noise, unit })
    }

    fn has_shares(&self) -> bool {
        !self.whitened
    }

    fn is_no_cause(&self, base: &Fitted, last: &Fitted) -> Option<NoCause> {
        let [before, after] = [base, last].map(|model| self.residual(model));
        let [rms, left] = [&before, &after].map(|r| statistics::rms(r, f64::INFINITY).powi(2));
        let plain = self.uneven(&before, where_it_fails::times);
        if let Some(plain) = plain.filter(|plain| (1.0 - plain.share) * rms < left) {
            return Some(NoCause::PlainDoesMore { place: plain });
        }
        let beyond = |square: f64| (square - self.whitening.budget.powi(2)).max(0.0);
        let still = self.structure(&after).filter(|_| beyond(left) > MOST * beyond(rms));
        still.map(|place| NoCause::MostIsLeft { coordinate: place.coordinate })
    }
}
