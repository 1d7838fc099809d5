//! What of a model belongs to a recording: where homing put the position's zero, how warm the lubricant is.

use missing_physics::family::Own;
use missing_physics::{Fitted, ModelFamily};

use super::FrictionFamily;
use crate::effects;

/// Zeros that are tried within the shortest period, and at least and at most.
const PER_PERIOD: f64 = 8.0;
const ZEROS: (f64, f64) = (16.0, 96.0);
/// How many times as hard a lubricant may shear: some 20 K less or more.
const SHEAR: [f64; 9] = [0.5, 0.6, 0.7, 0.85, 1.0, 1.2, 1.4, 1.7, 2.0];

/// A number of a recording and what it does to an effect.
type Change = (Own, fn(f64) -> effects::Own);

impl FrictionFamily {
    /// See [`missing_physics::family::Ahead::own`].
    pub(super) fn own(&self, model: &Fitted) -> Vec<Own> {
        self.owns(model).into_iter().map(|(own, _)| own).collect()
    }

    /// See [`missing_physics::family::Ahead::with_own`].
    pub(super) fn with_own(&self, model: &Fitted, values: &[f64]) -> Fitted {
        let mut own = model.clone();
        for ((_, by), value) in self.owns(model).iter().zip(values) {
            for place in 0..model.terms.len() {
                if let Some(moved) = self.in_recording(&own, place, by(*value)) {
                    let range = own.range(self, place);
                    own.values[range].copy_from_slice(&moved);
                }
            }
        }
        own
    }

    fn owns(&self, model: &Fitted) -> Vec<Change> {
        let home = self.home(model).map(|own| (own, effects::Own::Home as fn(f64) -> _));
        let shear = self.shear(model).map(|own| (own, effects::Own::Shear as fn(f64) -> _));
        home.into_iter().chain(shear).collect()
    }

    fn in_recording(&self, model: &Fitted, place: usize, own: effects::Own) -> Option<Vec<f64>> {
        let values = &model.values[model.range(self, place)];
        self.effect(model.terms[place])?.in_recording(values, own)
    }

    fn home(&self, model: &Fitted) -> Option<Own> {
        let each = (0..model.terms.len()).filter_map(|place| {
            self.in_recording(model, place, effects::Own::Home(0.0))?;
            let law = self.periodic(model.terms[place])?;
            let parameters = &self.terms()[model.terms[place]].parameters;
            let k = parameters.iter().position(|p| p.name == law.period)?;
            let period = model.values[model.range(self, place)][k];
            Some((period, parameters[k].unit.clone()))
        });
        let periods: Vec<(f64, String)> = each.collect();
        let unit = periods.first()?.1.clone();
        let shortest = periods.iter().map(|(period, _)| *period).fold(f64::INFINITY, f64::min);
        let longest = periods.iter().map(|(period, _)| *period).fold(0.0, f64::max);
        let count = (PER_PERIOD * longest / shortest).clamp(ZEROS.0, ZEROS.1) as usize;
        let trial = |k: usize| longest * (k as f64 / count as f64 - 0.5);
        let trials = (0..=count).map(trial).collect();
        Some(Own { name: "home", unit, neutral: 0.0, trials })
    }

    fn shear(&self, model: &Fitted) -> Option<Own> {
        let shears = |place| self.in_recording(model, place, effects::Own::Shear(1.0)).is_some();
        (0..model.terms.len()).any(shears).then(|| Own {
            name: "shear",
            unit: String::new(),
            neutral: 1.0,
            trials: SHEAR.to_vec(),
        })
    }
}
