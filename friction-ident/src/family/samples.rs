//! A recording and a ladder of models sample by sample, as a page draws them.

use missing_physics::Fitted;
use missing_physics::report::{Compared, Samples, Track};

use super::coordinates::since_reversal;
use super::{Decides, FrictionFamily, ModelPoints};
use crate::axis::Quantity;
use missing_physics::ModelFamily;

impl FrictionFamily {
    /// What was measured, what `models` predict at every sample, and what each effect of the last one contributes.
    /// Velocity and acceleration are those of the smoothed motion.
    pub fn samples(&self, models: &[Fitted], decides: Decides) -> Samples {
        self.as_read_by(models.last()).samples_as_read(models, decides)
    }

    fn samples_as_read(&self, models: &[Fitted], decides: Decides) -> Samples {
        let Ok(position) = self.recording.require("position") else { return Samples::default() };
        let points = self.points_as_read(models, decides);
        let predicts =
            !points.models.is_empty() && points.models.iter().all(|m| !m.position.is_empty());
        let ahead_decides = predicts && decides == Decides::Prediction;
        // What decides is left out for reasons of its own.
        let of_forces = if ahead_decides {
            let near = self.nearest_prepared();
            self.left_out_of_forces(&near, &points.compared_force, Decides::Force)
        } else {
            points.left_out.clone()
        };
        let both = of_forces.iter().chain(&points.left_out);
        let (reasons, mut of_forces) = indexed(both.map(|why| why.map(ToOwned::to_owned)));
        let of_ahead = of_forces.split_off(points.left_out.len());
        let (regimes, regime) =
            indexed(points.regime.iter().map(|regime| Some((*regime).to_owned())));
        let series = |of: fn(&ModelPoints) -> &Vec<f64>| -> Vec<Vec<f64>> {
            points.models.iter().map(|model| of(model).clone()).collect()
        };
        let quantity = self.quantity();
        let force = Compared {
            name: quantity.name.clone(),
            about: format!(
                "{} that the measured motion requires, below {:.3} Hz",
                quantity.name, self.prepared.bandwidth
            ),
            unit: quantity.unit,
            measured: points.compared_force.clone(),
            predicted: series(|model| &model.force),
            left_out: of_forces,
            decides: !ahead_decides,
        };
        let ahead = predicts.then(|| Compared {
            name: "position".to_owned(),
            about: "position, predicted one sample ahead from the samples before it".to_owned(),
            unit: self.axis.unit(Quantity::Length).to_owned(),
            measured: position.to_vec(),
            predicted: series(|model| &model.position),
            left_out: of_ahead,
            decides: ahead_decides,
        });
        Samples {
            time: self.recording.time().to_vec(),
            piece: points.piece,
            regimes,
            regime: regime.into_iter().map(Option::unwrap_or_default).collect(),
            reasons,
            coordinates: self.tracks(position),
            compared: std::iter::once(force).chain(ahead).collect(),
            laws: models.last().map(|last| self.laws(last)).unwrap_or_default(),
        }
    }

    fn tracks(&self, position: &[f64]) -> Vec<Track> {
        let p = &self.prepared;
        let near = self.nearest_prepared();
        let here = |values: &[f64]| -> Vec<f64> { near.iter().map(|k| values[*k]).collect() };
        let unit = |quantity| self.effort.unit(self.axis, quantity).to_owned();
        let velocity = unit(Quantity::Velocity);
        let track = |name: &str, unit: String, values: Vec<f64>, against_motion: bool| Track {
            name: name.to_owned(),
            unit,
            values,
            against_motion,
        };
        vec![
            track("velocity", velocity.clone(), here(&p.velocity), false),
            track("position", unit(Quantity::Length), position.to_vec(), false),
            track("acceleration", format!("{velocity}/s"), here(&p.acceleration), false),
            track(
                "distance since reversal",
                unit(Quantity::Length),
                here(&since_reversal(p)),
                true,
            ),
        ]
    }
}

/// Different texts in the order in which they occur, and the place of each among them.
fn indexed(texts: impl Iterator<Item = Option<String>>) -> (Vec<String>, Vec<Option<usize>>) {
    let mut names: Vec<String> = Vec::new();
    let places = texts.map(|text| {
        let text = text?;
        Some(names.iter().position(|name| *name == text).unwrap_or_else(|| {
            names.push(text);
            names.len() - 1
        }))
    });
    let places = places.collect();
    (names, places)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::{Hide, Level, generate};
    use crate::family::Options;

    #[test]
    fn samples_have_every_sample_of_every_model_and_what_its_effects_contribute() {
        let hidden = Hide::Effect("stribeck".to_owned());
        let made = generate(&hidden, 1, Level::Clear).unwrap();
        let family = FrictionFamily::new(&made.recording, &Options::default()).unwrap();
        let truth = family.fitted(&made.truth.model).unwrap();
        let drawn = family.samples(std::slice::from_ref(&truth), Decides::Prediction);
        let count = made.recording.len();
        assert_eq!((drawn.time.len(), drawn.regime.len()), (count, count));
        assert!(drawn.coordinates.iter().all(|track| track.values.len() == count));
        let names: Vec<(&str, bool)> =
            drawn.compared.iter().map(|c| (c.name.as_str(), c.decides)).collect();
        assert_eq!(names, [("force", false), ("position", true)]);
        for compared in &drawn.compared {
            assert_eq!((compared.measured.len(), compared.left_out.len()), (count, count));
            assert!(compared.predicted.iter().all(|series| series.len() == count));
        }
        // Where a force is not compared, a reason is given.
        let force = &drawn.compared[0];
        let unknown = force.measured.iter().zip(&force.left_out);
        assert!(unknown.clone().all(|(value, why)| value.is_nan() == why.is_some()));
        assert!(unknown.clone().any(|(_, why)| why.is_some()));
        let law = drawn.laws.iter().find(|law| law.effect == "stribeck").unwrap();
        let (law_size, apart) = law.bins.iter().fold((0.0f64, 0.0f64), |(size, apart), bin| {
            (size.max(bin.law.abs()), apart.max((bin.law - bin.data).abs()))
        });
        // The model that made the recording leaves nothing to speak of beside what its effect contributes.
        assert!(law_size > 1.0 && apart < 0.25 * law_size, "{law_size} {apart}");
    }
}
