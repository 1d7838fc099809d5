//! Friction as people know it: level and viscosity in either direction, whatever effects a model has them from.
//!
//! Many effects share one curve of friction over speed: a constant force, a difference of the two directions, and what
//! saturates look alike while the axis slides, so that none of them is determined by itself, while their sum is. The sum
//! is what a line through the model's friction along the measured motion says, one for each direction:
//!
//! ```text
//! F(theta)_k = F_C+ + F_v+ v_k  where v_k > 0,   -F_C- + F_v- v_k  where v_k < 0     by least squares: q = P F(theta)
//! ```
//!
//! What fades with speed is left out: a line through a hump would tell a negative viscosity. Nothing is told where
//! friction is no line without it.
//!
//! Its intervals follow from the covariance of all parameters together, `var q = P J S J' P'` with `J = dF/dtheta`:
//! never from a sum of their intervals.

use aep_core::Scale;
use missing_physics::diagnosis::fitted_blocks;
use missing_physics::fit::uncertainty::Covariance;
use missing_physics::report::{Combination, Combinations, Estimate};
use missing_physics::{Fitted, ModelFamily, fit, prediction_fit};

use super::{Decides, FrictionFamily};
use crate::axis::Quantity;
use crate::driven::force_along;
use crate::effects::Slot;
use crate::model::{MASS, Model};

/// What acts on something else than the sliding mass, or yields before it slides.
const ELSEWHERE: [Slot; 4] = [Slot::Drive, Slot::Sensor, Slot::Attached, Slot::Contact];
/// Fewest samples of a direction, and the least spread of its speeds about their mean, for a line.
const FEWEST: usize = 100;
const SPREAD: f64 = 0.1;
/// A line misses less than this share of the level, rms, or is none.
const STRAIGHT: f64 = 0.1;
/// Step of differences, of logarithms and of values.
const STEP: f64 = 1e-4;
/// An interval up to this share of the friction determines a quantity.
const DETERMINED: f64 = 0.5;

impl FrictionFamily {
    /// The friction of a model as level and viscosity in either direction. Nothing beside a given force, which has
    /// friction of its own.
    pub fn friction(&self, fitted: &Fitted, decides: Decides) -> Combinations {
        let Some(lines) = Lines::of(self) else { return Combinations::default() };
        let friction = |fitted: &Fitted| {
            let model = self.sliding_part(&self.model(fitted).ok()?)?;
            let force = self.driven(|motion| force_along(&model, motion));
            let p = &self.prepared;
            let alone = force.iter().zip(&p.acceleration).map(|(f, a)| f - model.mass() * a);
            Some(alone.collect::<Vec<f64>>())
        };
        let value = |fitted: &Fitted| lines.through(&friction(fitted)?);
        let here = friction(fitted).and_then(|force| lines.straight(&force));
        let Some(here) = here else { return Combinations::default() };
        let (found, weights) = match (decides, self.ahead()) {
            (Decides::Prediction, Some(ahead)) => {
                let found = prediction_fit(self, &*ahead, fitted);
                let weights = vec![1.0; found.residual.len()];
                (found, weights)
            }
            (Decides::FittedForce, _) => {
                let weights = fitted_blocks(self);
                (fit::evaluate(self, fitted.clone(), &weights), weights)
            }
            _ => (fit::as_given(self, fitted.clone()), vec![1.0; self.time.len()]),
        };
        let Some(covariance) = Covariance::of(&found, &weights) else {
            return Combinations::default();
        };
        // Derivatives of the six quantities by each parameter on its own scale.
        let mut derivatives = vec![Vec::new(); here.len()];
        for (k, (_, parameter)) in fitted.parameters(self).enumerate() {
            let mut near = fitted.clone();
            let step = match parameter.scale {
                Scale::Log => {
                    near.values[k] *= STEP.exp();
                    STEP
                }
                Scale::Linear => {
                    let step = STEP * near.values[k].abs().max(parameter.start.abs());
                    near.values[k] += step;
                    step
                }
            };
            let there = value(&near).unwrap_or(here);
            for (derivatives, (there, here)) in derivatives.iter_mut().zip(there.iter().zip(&here))
            {
                let change = (there - here) / step;
                // What rounding leaves is nothing.
                let is_something = (there - here).abs() > 1e-9 * here.abs().max(1e-9);
                derivatives.push(if is_something { change } else { 0.0 });
            }
        }
        let reach: Vec<f64> = derivatives.iter().map(|by| covariance.reach(by)).collect();
        let quantities = self.told(&here, &reach);
        let estimates = fit::uncertainty::estimates(self, &found, &weights);
        let alone = |(k, (term, parameter)): (
            usize,
            (&missing_physics::Term, &missing_physics::TermParameter),
        )| {
            let key = term.key(parameter);
            let is_in = derivatives.iter().any(|by| by[k] != 0.0);
            let lost = estimates.get(&key).is_some_and(|estimate| !estimate.identifiable);
            (is_in && lost).then_some(key)
        };
        let not_alone = fitted.parameters(self).enumerate().filter_map(alone).collect();
        Combinations { quantities, not_alone }
    }

    /// What of a model is friction of the sliding mass.
    fn sliding_part(&self, model: &Model) -> Option<Model> {
        if self.is_beside() {
            return None;
        }
        let names: Vec<&str> = model
            .terms()
            .iter()
            .filter(|term| {
                let about = term.effect().about();
                let effect = term.effect();
                ELSEWHERE.iter().any(|slot| about.acts_on(*slot))
                    || effect.is_of_place()
                    || effect.fades_with_speed()
            })
            .map(crate::model::ModelEffect::name)
            .collect();
        let part = names.iter().fold(model.clone(), |model, name| model.without(name));
        part.get(MASS).is_ok().then_some(part)
    }

    fn told(&self, values: &[f64; 6], reach: &[f64]) -> Vec<Combination> {
        let level = values[2].abs();
        let fastest = self.top_speed;
        let each = NAMES.iter().enumerate().map(|(k, (name, title, quantity))| {
            let (value, reach) = (values[k], reach[k]);
            // As a force at the highest speed, so that level and viscosity are judged alike.
            let as_force = if *quantity == Quantity::Damping { fastest } else { 1.0 };
            let size = (value * as_force).abs().max(level);
            let estimate = Estimate {
                value,
                low: value - reach,
                high: value + reach,
                unit: self.effort.unit(self.axis, *quantity).to_owned(),
                identifiable: reach * as_force < DETERMINED * size,
            };
            Combination { name: (*name).to_owned(), title: (*title).to_owned(), estimate }
        });
        each.collect()
    }
}

/// What is told, in order.
const NAMES: [(&str, &str, Quantity); 6] = [
    ("F_C+", "friction level forwards", Quantity::Force),
    ("F_C-", "friction level backwards", Quantity::Force),
    ("F_C mean", "mean of the two", Quantity::Force),
    ("F_v+", "viscosity forwards", Quantity::Damping),
    ("F_v-", "viscosity backwards", Quantity::Damping),
    ("F_v mean", "mean of the two", Quantity::Damping),
];

/// Samples at which the axis slides in either direction, with their speeds.
struct Lines {
    directions: [Vec<(usize, f64)>; 2],
}

impl Lines {
    fn of(family: &FrictionFamily) -> Option<Self> {
        let p = &family.prepared;
        let slides = |sign: f64| -> Vec<(usize, f64)> {
            let all = (0..p.velocity.len()).map(|k| (k, sign * p.velocity[k]));
            all.filter(|(k, speed)| p.moving[*k] > 0.0 && *speed > p.rest_speed).collect()
        };
        let directions = [slides(1.0), slides(-1.0)];
        let shows = |samples: &Vec<(usize, f64)>| {
            let count = samples.len() as f64;
            let mean = samples.iter().map(|(_, v)| v).sum::<f64>() / count;
            let square = samples.iter().map(|(_, v)| (v - mean).powi(2)).sum::<f64>() / count;
            samples.len() >= FEWEST && square.sqrt() > SPREAD * mean
        };
        directions.iter().all(shows).then_some(Self { directions })
    }

    /// Lines through a friction force, if it is one of lines.
    fn straight(&self, force: &[f64]) -> Option<[f64; 6]> {
        let lines = self.through(force)?;
        let mut squares = 0.0;
        for (way, samples) in self.directions.iter().enumerate() {
            let (sign, level, slope) = ([1.0, -1.0][way], lines[way], lines[3 + way]);
            let missed = samples.iter().map(|(k, v)| sign * force[*k] - level - slope * v);
            squares += missed.map(|missed| missed.powi(2)).sum::<f64>();
        }
        let count = self.directions.iter().map(Vec::len).sum::<usize>() as f64;
        ((squares / count).sqrt() <= STRAIGHT * lines[2].abs()).then_some(lines)
    }

    /// Level and slope of a friction force over speed in either direction, and their means.
    fn through(&self, force: &[f64]) -> Option<[f64; 6]> {
        let line = |samples: &[(usize, f64)], sign: f64| {
            let count = samples.len() as f64;
            let mean =
                |of: &dyn Fn(&(usize, f64)) -> f64| samples.iter().map(of).sum::<f64>() / count;
            let (speed, level) = (mean(&|(_, v)| *v), mean(&|(k, _)| sign * force[*k]));
            let both = mean(&|(k, v)| (v - speed) * (sign * force[*k] - level));
            let slope = both / mean(&|(_, v)| (v - speed).powi(2));
            (level - slope * speed, slope)
        };
        let (ahead, back) = (line(&self.directions[0], 1.0), line(&self.directions[1], -1.0));
        let mean = |a: f64, b: f64| f64::midpoint(a, b);
        let all = [ahead.0, back.0, mean(ahead.0, back.0), ahead.1, back.1, mean(ahead.1, back.1)];
        all.iter().all(|value| value.is_finite()).then_some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::{Hide, Level, generate};
    use crate::family::Options;
    use missing_physics::{fit, terms};

    #[test]
    fn effects_that_share_one_curve_are_told_as_what_they_are_together() {
        let made = generate(&Hide::Nothing, 1, Level::Clear).unwrap();
        let family = FrictionFamily::new(&made.recording, &Options::default()).unwrap();
        let truth = &made.truth.model;
        let names = ["coulomb", "viscous", "offset", "asymmetry"].map(str::to_owned);
        let all = terms(&family, &names).unwrap();
        let found = fit::identify(&family, &all, &fitted_blocks(&family), 1).fit;
        let told = family.friction(&found.model, Decides::FittedForce);
        let of = |name: &str| {
            let found = told.quantities.iter().find(|found| found.name == name);
            found.map(|found| found.estimate.clone()).unwrap()
        };
        let (level, offset) =
            (truth.get("coulomb.F_C").unwrap(), truth.get("offset.F_0").unwrap_or(0.0));
        for (name, value) in
            [("F_C+", level + offset), ("F_C-", level - offset), ("F_C mean", level)]
        {
            let found = of(name);
            assert!((found.value - value).abs() < 0.03 * level, "{name}: {found:?} {value}");
            assert!(
                found.identifiable && found.low < value && value < found.high,
                "{name} {found:?}"
            );
            assert!(found.high - found.low < 0.1 * level, "{name} {found:?}");
        }
        let damping = truth.get("viscous.F_v").unwrap();
        let found = of("F_v mean");
        assert!((found.value / damping - 1.0).abs() < 0.05, "{found:?} {damping}");
    }

    #[test]
    fn a_hump_does_not_turn_the_viscosity_and_what_is_no_line_is_not_told_as_one() {
        let made = generate(&Hide::Nothing, 1, Level::Clear).unwrap();
        let family = FrictionFamily::new(&made.recording, &Options::default()).unwrap();
        let fastest = family.top_speed;
        let told = |effect: &str, values: &[f64]| {
            let names = ["coulomb", "viscous", effect].map(str::to_owned);
            let values = [&[2.0, 20.0, 1.0 / fastest], values].concat();
            let model = Fitted { terms: terms(&family, &names).unwrap(), values };
            family.friction(&model, Decides::FittedForce).quantities
        };
        let humped = told("stribeck:gaussian", &[20.0, fastest]);
        for (found, value) in humped.iter().zip([20.0, 20.0, 20.0, 1.0 / fastest]) {
            assert!((found.estimate.value - value).abs() < 0.02 * value, "{found:?} {value}");
        }
        let square = |share: f64| [share * 20.0 / fastest.powi(2)];
        assert_eq!(told("quadratic-drag", &square(0.1)).len(), 6);
        assert!(told("quadratic-drag", &square(10.0)).is_empty());
    }
}
