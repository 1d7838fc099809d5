//! A recording point by point: what was measured, and what models predict at each sample.

use missing_physics::ahead::fit::best_setting;
use missing_physics::diagnosis::fitted_blocks;
use missing_physics::{Fitted, ModelFamily};

use super::{FrictionFamily, regimes};
use crate::axis::Axis;

/// Why a sample takes no part in a comparison of forces.
const AT_REST: &str = "at rest, where friction holds any force";
const AT_AN_END: &str = "end of a piece";
const HELD_OUT: &str = "held out of the fit";

/// What decides which samples take part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decides {
    /// Prediction errors one sample ahead, where the family has them.
    Prediction,
    /// The force along the measured motion.
    Force,
    /// The same, of which some blocks are held out.
    FittedForce,
}

/// All samples of a recording, in order; no number where nothing is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// The piece of the recording, from 1.
    pub piece: Vec<i64>,
    /// The force as it is compared: low-passed, without what is at rest.
    pub compared_force: Vec<f64>,
    /// The regime of the motion.
    pub regime: Vec<&'static str>,
    /// Why a sample takes no part in what decides; nothing where it does.
    pub left_out: Vec<Option<&'static str>>,
    /// What each model predicts.
    pub models: Vec<ModelPoints>,
}

/// What a model predicts at each sample.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelPoints {
    /// The position one sample ahead; empty where the family does not predict so.
    pub position: Vec<f64>,
    /// The force along the measured motion, to be held against [`Points::compared_force`].
    pub force: Vec<f64>,
}

/// The values of a column of [`FrictionFamily::columns_of_points`].
#[derive(Clone, Debug, PartialEq)]
pub enum PointValues {
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Texts, nothing where there is none.
    Texts(Vec<&'static str>),
}

impl FrictionFamily {
    /// The recording point by point as a table, with what `models`, each with its name, predict and leave: columns with
    /// their names, SI units in them.
    pub fn columns_of_points(
        &self,
        models: &[(String, Fitted)],
        decides: Decides,
    ) -> Vec<(String, PointValues)> {
        let fitted: Vec<Fitted> = models.iter().map(|(_, model)| model.clone()).collect();
        let points = self.points(&fitted, decides);
        let channel = |name: &str| {
            self.recording.channel(name).map_or_else(Vec::new, |channel| channel.values.clone())
        };
        let (position, force) = (channel("position"), channel("force"));
        let quantity = self.quantity();
        let force_name = format!("{}_{}", quantity.name, quantity.unit);
        let position_name = match self.axis {
            Axis::Linear => "position_m",
            Axis::Rotary => "angle_rad",
        };
        let left = |measured: &[f64], predicted: &[f64]| {
            PointValues::Numbers(measured.iter().zip(predicted).map(|(m, p)| m - p).collect())
        };
        let took_part = points.left_out.iter().map(|why| i64::from(why.is_none())).collect();
        let why_not = points.left_out.iter().map(|why| why.unwrap_or("")).collect();
        let mut of_models = Vec::new();
        for ((name, _), model) in models.iter().zip(points.models) {
            if !model.position.is_empty() {
                let residual = left(&position, &model.position);
                of_models.push((
                    format!("{name}.{position_name}"),
                    PointValues::Numbers(model.position),
                ));
                of_models.push((format!("{name}.residual_{position_name}"), residual));
            }
            let residual = left(&points.compared_force, &model.force);
            of_models.push((format!("{name}.{force_name}"), PointValues::Numbers(model.force)));
            of_models.push((format!("{name}.residual_{force_name}"), residual));
        }
        let measured = [
            ("time_s".to_owned(), PointValues::Numbers(self.recording.time().to_vec())),
            ("piece".to_owned(), PointValues::Whole(points.piece)),
            ("regime".to_owned(), PointValues::Texts(points.regime)),
            ("took_part".to_owned(), PointValues::Whole(took_part)),
            ("why_not".to_owned(), PointValues::Texts(why_not)),
            (position_name.to_owned(), PointValues::Numbers(position)),
            (force_name.clone(), PointValues::Numbers(force)),
            (format!("compared_{force_name}"), PointValues::Numbers(points.compared_force)),
        ];
        measured.into_iter().chain(of_models).collect()
    }

    /// The recording point by point, with what `models` predict. Where the data hardly tell what the force does between
    /// samples, it is read in the way in which the last model predicts better, as a search reads it.
    pub fn points(&self, models: &[Fitted], decides: Decides) -> Points {
        self.as_read_by(models.last()).points_as_read(models, decides)
    }

    /// The family with the force between samples read in the way in which a model predicts better.
    pub(super) fn as_read_by(&self, last: Option<&Fitted>) -> &Self {
        match (&self.other_hold, last) {
            (Some(other), Some(last)) if other.size(last) < self.size(last) => other,
            _ => self,
        }
    }

    /// Prediction error of a model on a part of the recording, at the setting that suits it best.
    fn size(&self, model: &Fitted) -> f64 {
        let Some(ahead) = self.ahead_in_part().or_else(|| self.ahead()) else {
            return f64::INFINITY;
        };
        let setting = best_setting(&*ahead, model);
        let errors = ahead.errors(&[(model.clone(), setting)]).swap_remove(0);
        missing_physics::ahead::statistics::rms(&errors, f64::INFINITY)
    }

    pub(super) fn points_as_read(&self, models: &[Fitted], decides: Decides) -> Points {
        let p = &self.prepared;
        let recording = &self.recording;
        let near = self.nearest_prepared();
        let here = |values: &[f64]| -> Vec<f64> { near.iter().map(|k| values[*k]).collect() };
        let force = here(&p.compare_everywhere(&p.force));
        let each = models.iter().map(|model| ModelPoints {
            position: self.shown(model),
            force: self
                .required(model)
                .map_or_else(|_| vec![f64::NAN; near.len()], |f| here(&p.compare_everywhere(&f))),
        });
        let models = each.collect();
        let left_out = match (&self.ahead, decides) {
            (Some(ahead), Decides::Prediction) => ahead.predictor.left_out(),
            _ => self.left_out_of_forces(&near, &force, decides),
        };
        let regime = regimes::names(p, self.stroke, &near);
        let pieces = recording.segments().iter().enumerate();
        let piece = pieces.flat_map(|(piece, range)| vec![piece as i64 + 1; range.len()]).collect();
        Points { piece, compared_force: force, regime, left_out, models }
    }

    /// The sample of the prepared motion next to each sample of the recording.
    pub(super) fn nearest_prepared(&self) -> Vec<usize> {
        let (p, recording) = (&self.prepared, &self.recording);
        let pieces = recording.segments().iter().enumerate();
        let near = pieces.flat_map(|(piece, range)| {
            range.clone().map(move |k| p.nearest(piece, recording.time()[k]))
        });
        near.collect()
    }

    /// The position that a model shows one sample ahead.
    fn shown(&self, model: &Fitted) -> Vec<f64> {
        let (Some(ahead), Some(view)) = (&self.ahead, self.ahead()) else { return Vec::new() };
        let setting = best_setting(&*view, model);
        let plant = self.model(model);
        plant.map_or_else(
            |_| vec![f64::NAN; self.recording.len()],
            |plant| ahead.predictor.shown(&plant, setting),
        )
    }

    pub(super) fn left_out_of_forces(
        &self,
        near: &[usize],
        force: &[f64],
        decides: Decides,
    ) -> Vec<Option<&'static str>> {
        let p = &self.prepared;
        let fitted = fitted_blocks(self);
        let is_held_out = |k: usize| {
            let after = p.grid.partition_point(|point| *point < k).min(p.grid.len() - 1);
            let before = after.saturating_sub(1);
            let nearer = if p.grid[after].abs_diff(k) <= p.grid[before].abs_diff(k) {
                after
            } else {
                before
            };
            decides == Decides::FittedForce && fitted[nearer] == 0.0
        };
        let each = near.iter().zip(force).map(|(&k, force)| match () {
            () if force.is_nan() && p.moving[k] == 0.0 => Some(AT_REST),
            () if force.is_nan() => Some(AT_AN_END),
            () if is_held_out(k) => Some(HELD_OUT),
            () => None,
        });
        each.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::{Hide, Level, generate};
    use crate::family::Options;

    #[test]
    fn the_model_that_made_a_recording_is_as_near_to_it_as_the_encoder_allows() {
        let made = generate(&Hide::Nothing, 1, Level::Clear).unwrap();
        let family = FrictionFamily::new(&made.recording, &Options::default()).unwrap();
        let truth = family.fitted(&made.truth.model).unwrap();
        let points = family.points(&[truth], Decides::Prediction);
        let position = made.recording.require("position").unwrap();
        let mut errors: Vec<f64> = (0..position.len())
            .filter(|k| points.left_out[*k].is_none())
            .map(|k| (position[k] - points.models[0].position[k]).abs())
            .collect();
        assert!(errors.len() > position.len() / 2);
        errors.sort_unstable_by(f64::total_cmp);
        assert!(errors[errors.len() / 2] < 2e-6, "{}", errors[errors.len() / 2]);
        let force = &points.models[0].force;
        let off = |k: &usize| (points.compared_force[*k] - force[*k]).abs();
        let known: Vec<usize> = (0..force.len()).filter(|k| force[*k].is_finite()).collect();
        let mean = known.iter().map(off).sum::<f64>() / known.len() as f64;
        let size = known.iter().map(|k| force[*k].abs()).sum::<f64>() / known.len() as f64;
        assert!(mean < 0.05 * size, "{mean} of {size}");
    }

    #[test]
    fn what_is_at_rest_or_held_out_takes_no_part_in_a_fit_of_forces() {
        let made = generate(&Hide::Nothing, 1, Level::Clear).unwrap();
        let family = FrictionFamily::new(&made.recording, &Options::default()).unwrap();
        let points = family.points(&[], Decides::FittedForce);
        for why in [AT_REST, HELD_OUT] {
            assert!(points.left_out.contains(&Some(why)), "{why}");
        }
        let all = points.left_out.iter().zip(&points.regime);
        assert!(all.clone().all(|(why, regime)| *why != Some(AT_REST) || *regime == "stick"));
    }
}
