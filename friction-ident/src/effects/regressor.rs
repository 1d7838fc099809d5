//! A known regressor: a signal that the user gives as a formula over columns, as a force up to a factor.

use missing_physics::Recording;

use super::beside::Tabled;
use super::formula::{FormulaError, check_name};
use super::{About, Effect, Parameter, ParameterRole, Scale, Signal, Slot};
use crate::axis::Quantity;

/// What regressors name as their source.
pub const REFERENCE: &str = "a regressor of the user";
/// Prefix of the channels of a recording that hold known regressors.
pub const REGRESSOR: &str = "regressor ";

/// `k r(t)`.
struct Regressor {
    about: &'static About,
}

/// The effect of the regressor called `name`. It stays in memory, as models refer to effects for as long as they like.
///
/// # Errors
/// The library has an effect of that name, or it cannot stand in a list.
pub fn regressor(name: &str) -> Result<&'static dyn Effect, FormulaError> {
    check_name(name)?;
    let about = Box::leak(Box::new(about(String::leak(name.to_owned()), 1e3, 1.0)));
    Ok(Box::leak(Box::new(Regressor { about })))
}

/// Names of the regressors that a recording holds.
pub fn regressors(recording: &Recording) -> impl Iterator<Item = &str> {
    recording.channels().iter().filter_map(|channel| channel.name.strip_prefix(REGRESSOR))
}

/// The factor is searched within `most`; `typical` is where a search starts.
fn about(name: &'static str, most: f64, typical: f64) -> About {
    About {
        name,
        title: "a regressor of the user",
        equation: String::leak(format!("k {name}(t)")),
        parameters: Vec::leak(vec![Parameter {
            name: "k",
            meaning: "factor on the regressor",
            quantity: Quantity::One,
            role: ParameterRole::Amplitude,
            low: -most,
            high: most,
            scale: Scale::Linear,
            default: typical,
            extent: None,
        }]),
        slots: &[Slot::SmoothForce],
        shows: "a residual in proportion to the regressor",
        reference: REFERENCE,
    }
}

impl Effect for Regressor {
    fn about(&self) -> &'static About {
        self.about
    }

    /// With a factor that could make up twice the whole force.
    fn bound(&self, recording: &Recording) -> Option<&'static dyn Effect> {
        let name = format!("{REGRESSOR}{}", self.about.name);
        let signal = Signal::of(recording, &name)?;
        let rms = |values: &[f64]| {
            (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
        };
        let force = rms(&recording.channel("force")?.values);
        let size = rms(&recording.channel(&name)?.values);
        let typical = 0.1 * force / size;
        if !(typical > 0.0 && typical.is_finite()) {
            return None;
        }
        let about = Box::leak(Box::new(about(self.about.name, 20.0 * typical, typical)));
        Some(Tabled::keep(about, signal))
    }
}

#[cfg(test)]
mod tests {
    use missing_physics::Channel;

    use super::super::testing::{Point, smooth};
    use super::*;

    #[test]
    fn a_regressor_is_a_force_up_to_a_factor_within_twice_the_force() {
        let time: Vec<f64> = (0..20).map(f64::from).collect();
        let force = vec![50.0; 20];
        let values = vec![0.25; 20];
        let channels =
            vec![Channel::new("force", "N", force), Channel::new("regressor load", "", values)];
        let recording = Recording::new("run", time, channels).unwrap();
        assert_eq!(regressors(&recording).collect::<Vec<_>>(), ["load"]);
        let bound = regressor("load").unwrap().bound(&recording).unwrap();
        assert_eq!(smooth(bound, &[8.0], Point::at(0.0, 0.1)).0, 2.0);
        assert!((bound.about().parameters[0].high - 400.0).abs() < 1e-9);
    }

    #[test]
    fn names_of_the_library_are_refused() {
        for name in ["stribeck", "mass", "inertia", "Load", "a b", ""] {
            assert!(regressor(name).is_err(), "{name}");
        }
    }
}
