//! An experiment as data: what a file of results holds of it.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use super::{Experiment, Separation, Tried};

#[derive(Serialize)]
struct Told<'a> {
    effects: &'a [String],
    motion: &'a str,
    about: &'a str,
    duration_s: f64,
    predicted: Apart,
    here: Apart,
    gain: f64,
    tried: &'a [Tried],
}

/// A separation; the name of the force says its unit.
#[derive(Serialize)]
struct Apart {
    #[serde(flatten)]
    force: BTreeMap<String, f64>,
    noises: f64,
    deviations: f64,
}

impl Serialize for Experiment {
    /// Without the motion itself, which is a file of its own.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let apart = |separation: &Separation| Apart {
            force: BTreeMap::from([(format!("force_{}", self.unit), separation.force)]),
            noises: self.noises(separation),
            deviations: separation.deviations,
        };
        let told = Told {
            effects: &self.effects,
            motion: &self.motion,
            about: &self.about,
            duration_s: self.duration(),
            predicted: apart(&self.separation),
            here: apart(&self.here),
            gain: self.gain,
            tried: &self.tried,
        };
        told.serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::Reference;

    fn experiment() -> Experiment {
        let separation = |force, deviations| Separation { force, deviations };
        Experiment {
            effects: vec!["a".into(), "b".into()],
            motion: "sweep".into(),
            about: "faster and faster".into(),
            reference: Reference {
                sample_time: 0.01,
                position: vec![0.0; 200],
                velocity: vec![0.0; 200],
                acceleration: vec![0.0; 200],
            },
            separation: separation(6.0, 40.0),
            here: separation(1.5, 10.0),
            gain: 2.0,
            noise: 3.0,
            unit: "N m",
            position_unit: "rad",
            tried: vec![Tried { motion: "sweep".into(), deviations: 40.0 }],
        }
    }

    #[test]
    fn forces_are_told_with_their_unit_and_in_multiples_of_the_noise() {
        let json = serde_json::to_value(experiment()).unwrap();
        assert_eq!(json["predicted"]["force_N m"], 6.0);
        assert_eq!(
            (&json["predicted"]["noises"], &json["here"]["noises"]),
            (&2.0.into(), &0.5.into())
        );
        assert_eq!(
            (&json["duration_s"], &json["tried"][0]["deviations"]),
            (&2.0.into(), &40.0.into())
        );
        assert!(json.get("reference").is_none());
    }

    #[test]
    fn the_motion_is_a_recording_in_the_unit_of_the_axis() {
        let motion = experiment().recording().unwrap();
        let position = motion.channel("position").unwrap();
        assert_eq!((position.unit.as_str(), motion.len()), ("rad", 200));
        assert!((motion.time()[199] - 1.99).abs() < 1e-12);
    }

    #[test]
    fn a_motion_that_tells_little_more_is_not_worth_running() {
        assert!(experiment().is_worth_running());
        assert!(!Experiment { gain: 1.4, ..experiment() }.is_worth_running());
    }
}
