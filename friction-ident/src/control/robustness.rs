//! What happens to the compensation when the model is wrong.

use rayon::prelude::*;
use serde::Serialize;

use crate::effects::ParameterRole;
use crate::model::{MASS, Model};
use crate::reference::Reference;

use super::compensator::{Compensator, Settings};
use super::measures::Measures;
use super::trial::{ControlError, Servo, Trial, run, samples};

/// The compensation with one parameter off.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Deviation {
    /// Address of the parameter; `all forces` for all amplitudes together, `none` for the model as
    /// it is.
    pub parameter: String,
    /// Factor on it.
    pub factor: f64,
    /// What is measured.
    pub measures: Measures,
    /// What is to be called by its name.
    pub behaviour: Vec<Behaviour>,
}

/// What a wrong model does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Behaviour {
    /// More force in the direction of motion than the plant takes.
    OverCompensated,
    /// Less force.
    UnderCompensated,
    /// It sticks though the reference moves.
    Sticks,
    /// It repeats a motion nobody asked for.
    LimitCycle,
    /// The loop runs away.
    RunsAway,
}

impl Behaviour {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::OverCompensated => "over-compensated",
            Self::UnderCompensated => "under-compensated",
            Self::Sticks => "sticks",
            Self::LimitCycle => "limit cycle",
            Self::RunsAway => "runs away",
        }
    }
}

/// Share of the mean force by which a compensation must differ to be called too much or too little.
const SHARE: f64 = 0.01;

/// All amplitudes together.
const ALL: &str = "all forces";

/// The compensator of `model` with every parameter multiplied by each of `factors`, on `plant`; the
/// first entry is the model as it is.
///
/// # Errors
/// The compensator cannot be built, or the model as it is runs away.
pub fn robustness(
    plant: &Model,
    model: &Model,
    reference: &Reference,
    servo: &Servo,
    settings: Settings,
    factors: &[f64],
) -> Result<Vec<Deviation>, ControlError> {
    let exact = Compensator::new(model, settings)?;
    let exact = run(plant, reference, servo, Some(&exact))?;
    let needed = needed(plant, &exact, reference, settings);
    let nominal = Deviation {
        parameter: "none".into(),
        factor: 1.0,
        behaviour: behaviour(&exact.measures, mean_force(&exact.compensation, reference), needed),
        measures: exact.measures,
    };
    let mut cases = Vec::new();
    for parameter in parameters(model, settings)? {
        cases.extend(factors.iter().map(|factor| (parameter.clone(), *factor)));
    }
    let deviate = |(parameter, factor): &(String, f64)| -> Result<Deviation, ControlError> {
        let changed = changed(model, parameter, *factor);
        let compensator = Compensator::new(&changed, settings)?;
        let (measures, behaviour) = match run(plant, reference, servo, Some(&compensator)) {
            Ok(trial) => {
                let force = mean_force(&trial.compensation, reference);
                let found = behaviour(&trial.measures, force, needed);
                (trial.measures, found)
            }
            Err(ControlError::Loop(_)) => (Measures::default(), vec![Behaviour::RunsAway]),
            Err(error) => return Err(error),
        };
        Ok(Deviation { parameter: parameter.clone(), factor: *factor, measures, behaviour })
    };
    let deviations: Vec<Deviation> = cases.par_iter().map(deviate).collect::<Result<_, _>>()?;
    Ok(std::iter::once(nominal).chain(deviations).collect())
}

/// Addresses of what the compensator uses, and all amplitudes together.
fn parameters(model: &Model, settings: Settings) -> Result<Vec<String>, ControlError> {
    let left_out = Compensator::new(model, settings)?;
    let left_out = left_out.left_out();
    let uses = |address: &String| {
        let effect = address.rsplit_once('.').map_or("", |(effect, _)| effect);
        let fixed = model.parameter(address).is_none_or(|p| p.role == ParameterRole::Fixed);
        address != MASS && !fixed && !left_out.iter().any(|l| l.effect == effect)
    };
    let nonzero = |address: &String| model.get(address).is_ok_and(|value| value != 0.0);
    let mut all: Vec<String> = model.addresses().into_iter().filter(uses).filter(nonzero).collect();
    all.push(ALL.to_owned());
    Ok(all)
}

/// `model` with `parameter` multiplied by `factor`; what the model cannot have stays as it was.
fn changed(model: &Model, parameter: &str, factor: f64) -> Model {
    let mut changed = model.clone();
    for address in model.addresses() {
        let amplitude =
            model.parameter(&address).is_some_and(|p| p.role == ParameterRole::Amplitude);
        let concerned = address == parameter || parameter == ALL && amplitude;
        if let (true, Ok(value)) = (concerned, model.get(&address)) {
            // A positive factor keeps every value acceptable.
            let _ = changed.set(&address, value * factor);
        }
    }
    changed
}

/// Mean force in the direction of motion that the plant takes: that of its own compensator, or of the
/// one that ran where the plant has nothing that can be compensated.
fn needed(plant: &Model, ran: &Trial, reference: &Reference, settings: Settings) -> f64 {
    let Ok(mut own) = Compensator::new(plant, settings) else {
        return mean_force(&ran.compensation, reference);
    };
    let seen = samples(&ran.run, reference);
    mean_force(&seen.iter().map(|sample| own.force(sample)).collect::<Vec<f64>>(), reference)
}

/// Mean of forces in the direction of the reference's motion, N or N m.
fn mean_force(forces: &[f64], reference: &Reference) -> f64 {
    let moving = || forces.iter().zip(&reference.velocity).filter(|(_, v)| **v != 0.0);
    moving().map(|(force, v)| force * v.signum()).sum::<f64>() / moving().count().max(1) as f64
}

fn behaviour(measures: &Measures, force: f64, needed: f64) -> Vec<Behaviour> {
    let mut found = Vec::new();
    let (more, share) = (force - needed, SHARE * needed.abs());
    if more > share {
        found.push(Behaviour::OverCompensated);
    }
    if more < -share {
        found.push(Behaviour::UnderCompensated);
    }
    match measures.limit_cycle {
        Some(_) => found.push(Behaviour::LimitCycle),
        None if measures.stick_episodes > measures.standstill.len() => {
            found.push(Behaviour::Sticks);
        }
        None => {}
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::course::Course;
    use super::*;
    use crate::axis::Axis;

    #[test]
    fn too_much_friction_runs_ahead_and_too_little_lags_by_the_missing_force() {
        let model = Model::new(Axis::Linear, 30.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 10.0)]))
            .and_then(|m| m.with("viscous", &[("F_v", 100.0)]))
            .unwrap();
        let servo = Servo::for_mass(30.0, 1e-3);
        let reference = Course::Ramp { speed: 0.01 }.sampled(1e-3, 3.0);
        let settings = Settings::new(1e-3, 1e-3);
        let found = robustness(&model, &model, &reference, &servo, settings, &[0.8, 1.2]).unwrap();
        assert_eq!(found.len(), 1 + 2 * 3);
        assert_eq!(found[0].parameter, "none");
        let of = |parameter: &str, factor: f64| {
            found.iter().find(|d| d.parameter == parameter && d.factor == factor).unwrap()
        };
        for (factor, name) in
            [(0.8, Behaviour::UnderCompensated), (1.2, Behaviour::OverCompensated)]
        {
            let deviation = of("coulomb.F_C", factor);
            assert_eq!(deviation.behaviour[0], name);
            // 2 N too little or too much are an error of 2 N / K_P.
            let lag = (1.0 - factor) * 10.0 / servo.proportional;
            let start = 1e-6;
            let seen = deviation.measures.mean_lag - found[0].measures.mean_lag;
            assert!((seen - lag).abs() < start, "{seen} {lag}");
            assert!(of("viscous.F_v", factor).measures.rms_error < deviation.measures.rms_error);
        }
        assert!(found[0].behaviour.is_empty());
    }

    #[test]
    fn a_model_without_what_the_plant_has_is_called_too_little_as_it_is() {
        let model = Model::new(Axis::Linear, 30.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 10.0)]))
            .unwrap();
        let plant = model.clone().with("viscous", &[("F_v", 100.0)]).unwrap();
        let servo = Servo::for_mass(30.0, 1e-3);
        let reference = Course::Ramp { speed: 0.01 }.sampled(1e-3, 2.0);
        let settings = Settings::new(1e-3, 1e-3);
        let found = robustness(&plant, &model, &reference, &servo, settings, &[1.2]).unwrap();
        assert_eq!(found[0].behaviour, [Behaviour::UnderCompensated]);
        assert_eq!(found[1].behaviour, [Behaviour::OverCompensated]);
    }
}
