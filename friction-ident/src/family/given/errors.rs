//! Models beside a given force, one step ahead.

use std::sync::Arc;

use missing_physics::ahead::whitening::ORDERS;
use missing_physics::ahead::{Ahead, Columns, Rival, Trial, trials};
use missing_physics::family::Series;
use missing_physics::report::Refusal;
use missing_physics::{Fitted, ModelFamily};
use rayon::prelude::*;

use super::super::FrictionFamily;
use super::super::ahead::rivals;
use super::Given;
use crate::effects::Slot;

/// Trial delays: the shortest and the longest in samples, and how many.
const LATE: (f64, f64, usize) = (2.0, 100.0, 14);

/// The family with its given force.
pub(in super::super) struct View<'a> {
    pub family: &'a FrictionFamily,
    pub given: &'a Given,
}

impl View<'_> {
    fn residual(&self, model: &Fitted) -> Vec<f64> {
        let prediction = missing_physics::fit::predict(self.family, model);
        missing_physics::fit::residual(self.family, &prediction)
    }

    /// Ways to begin with a delay or a lag: the shift, which may have made up for part of it, goes back to what a held
    /// command makes.
    fn late(&self, model: &Fitted, term: usize) -> Option<Vec<Trial>> {
        let about = self.family.effects[term.checked_sub(1)?].about();
        let parameters = &self.family.terms()[term].parameters;
        let time = parameters.iter().position(|parameter| parameter.unit == "s")?;
        if !about.acts_on(Slot::Drive) {
            return None;
        }
        let interval = self.family.prepared.interval;
        let mut base = model.clone();
        let shift = self.family.terms()[0].parameters.iter().position(|p| p.name == "shift");
        if let Some(k) = shift {
            base.values[k] = base.values[k].clamp(0.0, 0.5 * interval);
        }
        let (least, most) = (LATE.0 * interval, (LATE.1 * interval).min(parameters[time].upper));
        let line = (0..LATE.2).map(|k| k as f64 / (LATE.2 - 1) as f64);
        let each = line.map(|part| {
            let mut values: Vec<f64> = parameters.iter().map(|parameter| parameter.start).collect();
            values[time] = least * (most / least).powf(part);
            Trial { model: base.with(term, &values), amplitudes: Vec::new() }
        });
        Some(each.collect())
    }
}

/// What a force that repeats along the stroke changes, to its fundamental.
fn sine_and_cosine(wave: &[(f64, f64)]) -> Vec<Vec<f64>> {
    vec![
        wave.iter().map(|(sine, _)| *sine).collect(),
        wave.iter().map(|(_, cosine)| *cosine).collect(),
    ]
}

impl Ahead for View<'_> {
    fn settings(&self) -> usize {
        ORDERS.len()
    }

    fn expected(&self, _setting: usize) -> f64 {
        self.given.whitening.budget
    }

    fn budget(&self) -> f64 {
        self.given.whitening.budget
    }

    fn errors(&self, models: &[(Fitted, usize)]) -> Vec<Vec<f64>> {
        let each = models.par_iter().map(|(model, setting)| {
            let residual = self.residual(model);
            // A combination that is no plant predicts nothing, and so does one that overflows.
            if self.family.model(model).is_err() || !residual.iter().all(|r| r.is_finite()) {
                return vec![f64::MAX; residual.len()];
            }
            self.given.whitening.errors(&residual, *setting)
        });
        each.collect()
    }

    fn errors_beside(&self, model: &Fitted, setting: usize, others: &[Fitted]) -> Vec<Vec<f64>> {
        let own = self.residual(model);
        let residual = |other: &Fitted| {
            let is_plant = self.family.model(other).is_ok();
            if is_plant { self.residual(other) } else { vec![f64::NAN; own.len()] }
        };
        let others: Vec<Vec<f64>> = others.par_iter().map(residual).collect();
        self.given.whitening.errors_beside(&own, setting, &others)
    }

    fn instants(&self) -> &[(f64, usize)] {
        &self.given.instants
    }

    fn along(&self) -> Vec<(String, String, Vec<f64>)> {
        let coordinates = self.family.coordinates().iter();
        let position = coordinates.filter(|c| c.name == "position" && c.parity.is_none());
        position.map(|c| (c.name.clone(), c.unit.clone(), c.values.clone())).collect()
    }

    fn trials(&self, model: &Fitted, term: usize) -> Vec<Trial> {
        if let Some(trials) = self.family.two_masses(model, term) {
            return trials;
        }
        if let Some(trials) = self.late(model, term) {
            return trials;
        }
        trials(self.family, model, term, &self.family.few_shapes(term))
    }

    fn columns(&self, setting: usize, term: usize, trials: &[Trial]) -> Option<Columns> {
        let law = self.family.periodic(term).filter(|law| law.ranked)?;
        let parameters = &self.family.terms()[term].parameters;
        let from_end = parameters.iter().rev().position(|p| p.name == law.period)? + 1;
        let base = trials.first()?.model.without(self.family, term);
        let residual = self.residual(&base);
        let change = self.given.whitening.change(&residual, setting);
        let period = |trial: &Trial| vec![trial.model.values[trial.model.values.len() - from_end]];
        let periods: Vec<Vec<f64>> = trials.iter().map(period).collect();
        let waves = self.family.repeated(sine_and_cosine, &periods);
        let single = |column: &Vec<f64>| change(column).iter().map(|x| -*x as f32).collect();
        let pairs = waves.par_iter().map(|wave| [single(&wave[0]), single(&wave[1])]);
        Some(Arc::new(pairs.collect()))
    }

    fn missing_force(&self, model: &Fitted, _setting: usize) -> Option<Series> {
        let residual = self.residual(model);
        let count = residual.len();
        Some(Series {
            time: self.family.time().to_vec(),
            force: residual.iter().map(|r| -r).collect(),
            deviation: vec![self.given.whitening.budget; count],
            recorded: self.family.target().to_vec(),
            known: vec![true; count],
        })
    }

    fn flexible(&self, model: &Fitted, term: usize) -> Option<Fitted> {
        let shows = |t: &usize| self.family.shows_beside_given_force(*t);
        self.family.in_flexible_form(model, term).filter(|model| model.terms.iter().all(shows))
    }

    fn variations(&self, model: &Fitted) -> Vec<Fitted> {
        self.family.beside(model)
    }

    fn relatives(&self, model: &Fitted) -> Vec<Fitted> {
        self.family.related_second_bodies(model)
    }

    fn rivals(&self) -> Vec<Rival> {
        rivals(self.family)
    }

    fn vanishes(&self, model: &Fitted, base: &Fitted) -> Option<(usize, Refusal)> {
        self.family.vanishes(model, base)
    }

    fn starts(&self, term: usize) -> usize {
        self.family.starts(term)
    }

    fn is_candidate(&self, term: usize) -> bool {
        self.family.is_candidate(term) && self.family.shows_beside_given_force(term)
    }
}
