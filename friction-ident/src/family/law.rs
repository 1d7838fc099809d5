//! What each effect of a model contributes to the force, along the coordinate that its law follows.
//!
//! The contribution of an effect is what the force that the model requires along the measured motion loses without it,
//! all other parameters as they are. Beside it stands the same with the residual of the whole model: a
//! component-plus-residual plot, in which a law that does not fit the data is seen as one.

use missing_physics::report::{Law, LawBin};
use missing_physics::{Coordinate, Fitted, ModelFamily, fit};

use super::FrictionFamily;
use crate::axis::Quantity;

/// Stretches of a coordinate, and of a period.
const STRETCHES: usize = 60;
const OF_A_PERIOD: usize = 40;
/// Fewest points of a picture.
const FEWEST: usize = 4 * STRETCHES;
/// A coordinate is as good as another one that leaves less of a contribution unexplained by this share of it.
const AS_GOOD: f64 = 0.02;
/// A contribution below this share of the measured quantity is none.
const NOTHING: f64 = 1e-6;

/// A coordinate to draw along.
pub(super) struct Along {
    pub name: String,
    pub unit: String,
    values: Vec<f64>,
    /// Signs that contributions are multiplied with.
    parity: Option<Vec<f64>>,
    stretches: usize,
}

impl FrictionFamily {
    /// A picture for each effect of a model that adds something to the force along the measured motion.
    pub(super) fn laws(&self, model: &Fitted) -> Vec<Law> {
        let whole = fit::predict(self, model);
        let residual = fit::residual(self, &whole);
        if self.target.len() < FEWEST || !residual.iter().all(|value| value.is_finite()) {
            return Vec::new();
        }
        let effects = (0..model.terms.len()).filter(|k| !self.terms()[model.terms[*k]].always);
        effects.filter_map(|k| self.law(model, k, (&whole, &residual))).collect()
    }

    fn law(&self, model: &Fitted, k: usize, (whole, residual): (&[f64], &[f64])) -> Option<Law> {
        let range = model.range(self, k);
        let mut without = model.clone();
        without.terms.remove(k);
        without.values.drain(range.clone());
        // An effect that others act through cannot be taken away from them.
        self.model(&without).ok()?;
        let rest = fit::predict(self, &without);
        let part: Vec<f64> = whole.iter().zip(&rest).map(|(whole, rest)| whole - rest).collect();
        let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
        let size = square(&part);
        if !(size > NOTHING * NOTHING * square(&self.target) && size.is_finite()) {
            return None;
        }
        let term = model.terms[k];
        let along = match self.periods(term, &model.values[range]) {
            Some(along) => along,
            None => self.followed(&part, size)?,
        };
        let data: Vec<f64> = part.iter().zip(residual).map(|(part, left)| part + left).collect();
        let quantity = self.quantity();
        Some(Law {
            effect: self.terms()[term].name.clone(),
            bins: along.means(&part, &data),
            against_motion: along.parity.is_some(),
            along: along.name,
            unit: along.unit,
            quantity: [quantity.name, quantity.unit],
        })
    }

    /// The place within a period, for a law that repeats along the stroke.
    fn periods(&self, term: usize, values: &[f64]) -> Option<Along> {
        let effect = self.effects.get(term.checked_sub(1)?)?;
        let periodic = self.periodic.get(term - 1)?.as_ref()?;
        // What is fixed has no value here.
        let free = &self.terms()[term].parameters;
        let at = free.iter().position(|parameter| parameter.name == periodic.period)?;
        let period = values.get(at).copied().filter(|period| *period > 0.0)?;
        effect.about().parameters.iter().find(|parameter| parameter.name == periodic.period)?;
        let position = self.coordinates.iter().find(|c| c.name == "position")?;
        Some(Along {
            name: "position within a period".to_owned(),
            unit: self.axis.unit(Quantity::Length).to_owned(),
            values: position.values.iter().map(|x| x.rem_euclid(period)).collect(),
            parity: None,
            stretches: OF_A_PERIOD,
        })
    }

    /// The coordinate along which a contribution is most nearly a curve; of those as good the first.
    fn followed(&self, part: &[f64], size: f64) -> Option<Along> {
        let each: Vec<(Along, f64)> = (self.coordinates.iter())
            .filter(|coordinate| coordinate.values.iter().all(|value| value.is_finite()))
            .map(|coordinate| {
                let along = Along { parity: coordinate.parity.clone(), ..Along::of(coordinate) };
                let left = along.unexplained(part);
                (along, left)
            })
            .collect();
        let least = each.iter().map(|(_, left)| *left).fold(f64::INFINITY, f64::min);
        each.into_iter().find(|(_, left)| *left <= least + AS_GOOD * size).map(|(along, _)| along)
    }
}

impl Along {
    /// A coordinate, contributions as they are.
    pub fn of(coordinate: &Coordinate) -> Self {
        let (name, unit) = (coordinate.name.clone(), coordinate.unit.clone());
        Self { name, unit, values: coordinate.values.clone(), parity: None, stretches: STRETCHES }
    }

    /// Points in the order of the coordinate, in stretches of about as many points each.
    fn stretches(&self) -> Vec<Vec<usize>> {
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        order.sort_by(|a, b| self.values[*a].total_cmp(&self.values[*b]));
        order.chunks(order.len().div_ceil(self.stretches)).map(<[usize]>::to_vec).collect()
    }

    fn seen(&self, values: &[f64], k: usize) -> f64 {
        values[k] * self.parity.as_ref().map_or(1.0, |parity| parity[k])
    }

    fn mean(&self, values: &[f64], points: &[usize]) -> f64 {
        points.iter().map(|k| self.seen(values, *k)).sum::<f64>() / points.len() as f64
    }

    fn unexplained(&self, values: &[f64]) -> f64 {
        let within = |points: &Vec<usize>| {
            let mean = self.mean(values, points);
            points.iter().map(|k| (self.seen(values, *k) - mean).powi(2)).sum::<f64>()
        };
        self.stretches().iter().map(within).sum()
    }

    /// Means of a contribution, and of what the data say of it.
    pub fn means(&self, law: &[f64], data: &[f64]) -> Vec<LawBin> {
        let bin = |points: &Vec<usize>| LawBin {
            at: points.iter().map(|k| self.values[*k]).sum::<f64>() / points.len() as f64,
            law: self.mean(law, points),
            data: self.mean(data, points),
        };
        self.stretches().iter().map(bin).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::{Hide, Level, generate};
    use crate::family::Options;

    #[test]
    fn a_ripple_is_drawn_over_one_period_and_friction_over_velocity() {
        let hidden = Hide::Effect("ripple".to_owned());
        let made = generate(&hidden, 1, Level::Clear).unwrap();
        let family = FrictionFamily::new(&made.recording, &Options::default()).unwrap();
        let laws = family.laws(&family.fitted(&made.truth.model).unwrap());
        let of = |name: &str| laws.iter().find(|law| law.effect == name).unwrap();
        assert_eq!(of("coulomb").along, "velocity");
        let ripple = of("ripple");
        assert_eq!(ripple.along, "position within a period");
        // One period: up once and down once.
        let signs: Vec<bool> = ripple.bins.iter().map(|bin| bin.law > 0.0).collect();
        let changes = (0..signs.len()).filter(|k| signs[*k] != signs[(k + 1) % signs.len()]);
        assert_eq!(changes.count(), 2);
    }
}
