//! The error of a drive's model in several views side by side, each with what it is worth.

use std::ops::Range;

use missing_physics::diagnosis::views::disagreements;
use missing_physics::diagnosis::{self, noise};
use missing_physics::fit::{Fit, Until};
use missing_physics::report::{Caveat, Compares, Disagreement, Metrics, SplitMetrics, View};
use missing_physics::statistics::metrics::Sums;
use missing_physics::statistics::split::Split;
use missing_physics::{Coordinate, Discovery, Fitted, ModelFamily};

use super::FrictionFamily;
use super::views::{held_out, parted};
use crate::axis::Quantity;
use crate::model::{Model, ModelError};
use crate::simulator::{Input, Start, simulate};
use crate::windows::{Window, WindowErrors, WindowOptions, window_errors};

mod no_view;
mod tracking;

pub use no_view::NoView;

/// Lengths of restarted windows, s.
const LENGTHS: [f64; 3] = [0.05, 0.1, 0.2];
/// Fewest samples of a window.
const SAMPLES: f64 = 10.0;
/// A free run whose error is this many times that of the longest windows has drifted.
const DRIFTED: f64 = 5.0;

/// The views of a model, and why some are missing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SideBySide {
    /// The views, those that decide first.
    pub views: Vec<View>,
    /// Views that there are none of, and why.
    pub missing: Vec<NoView>,
}

/// Given models on one recording.
pub struct GivenModels {
    /// What is told of the first model.
    pub discovery: Discovery,
    /// Every model that there was time for, with its views.
    pub models: Vec<(String, Vec<View>)>,
    /// Where views prefer different models.
    pub between: Vec<Disagreement>,
    /// Views that there are none of, and why.
    pub missing: Vec<NoView>,
}

impl FrictionFamily {
    /// Given models, each with its name, on this recording: everything of the first one, the views of each. Once `until` is
    /// over what takes long is left out. Nothing without a model.
    ///
    /// # Errors
    /// Terms of a model do not fit together.
    pub fn compared(
        &self,
        models: &[(String, Fit)],
        seed: u64,
        until: Until<'_>,
    ) -> Result<Option<GivenModels>, ModelError> {
        let Some((_, first)) = models.first() else { return Ok(None) };
        let (over, rung) = (|| until.is_over(), diagnosis::rung(self, first, &[]));
        let mut discovery = diagnosis::comparison(self, (first, first), vec![rung], seed, &over);
        let (mut views, mut missing) = (Vec::new(), Vec::new());
        for (name, fit) in models.iter().take_while(|_| !over()) {
            let all = self.side_by_side(&fit.model)?;
            views.push((name.clone(), all.views));
            for none in all.missing {
                if !missing.contains(&none) {
                    missing.push(none);
                }
            }
        }
        discovery.views = views.first().map(|(_, views)| views.clone()).unwrap_or_default();
        discovery.stopped |= over();
        let between = disagreements(&views);
        Ok(Some(GivenModels { discovery, models: views, between, missing }))
    }

    /// The error of `fitted` as force along the measured motion, over restarted windows of 0.05, 0.1 and
    /// 0.2 s, in a free run and, where the recording has a channel `reference`, in the closed loop.
    ///
    /// # Errors
    /// The terms do not fit together.
    pub fn side_by_side(&self, fitted: &Fitted) -> Result<SideBySide, ModelError> {
        let model = self.model(fitted)?;
        let split = Split::new(self.target.len(), self.blocks.clone());
        let mut all = SideBySide { views: vec![self.force_view(fitted, &split)], ..<_>::default() };
        let lengths =
            lengths(self.recording.interval()).into_iter().filter(|_| self.given.is_none());
        for length in lengths {
            match self.windows(&model, length, &split) {
                Ok(view) => all.views.push(view),
                Err(none) => all.missing.push(none),
            }
        }
        if self.given.is_some() {
            // A force that is given over time moves nothing.
            all.missing.push(NoView::ForceGiven);
            return Ok(all);
        }
        let longest = all.views.last().map_or(f64::NAN, |view| view.metrics.validation.rms);
        match self.free_run(&model, longest, &split) {
            Ok(view) => all.views.push(view),
            Err(none) => all.missing.push(none),
        }
        match tracking::view(self, &model, &split) {
            Ok(view) => all.views.push(view),
            Err(none) => all.missing.push(none),
        }
        Ok(all)
    }

    fn force_view(&self, fitted: &Fitted, split: &Split) -> View {
        let prediction = missing_physics::fit::predict(self, fitted);
        let residual = missing_physics::fit::residual(self, &prediction);
        let state: Vec<Coordinate> = self.coordinates.iter().filter(|c| c.state).cloned().collect();
        let quantity = self.quantity();
        View {
            name: format!("{} residual", quantity.name),
            compares: Compares::Residual {
                quantity: quantity.name,
                bandwidth: self.prepared.bandwidth,
            },
            unit: quantity.unit,
            metrics: SplitMetrics::of(&residual, &self.target, split),
            floor: Some(noise::floor(&residual, &state)).filter(|floor| *floor > 0.0),
            decides: true,
            caveat: None,
        }
    }

    fn windows(&self, model: &Model, length: f64, split: &Split) -> Result<View, NoView> {
        let text = format!("{length:.3}");
        let name = format!("windows of {} s", text.trim_end_matches('0'));
        let errors = window_errors(model, &self.recording, &WindowOptions::new(length))
            .map_err(|source| NoView::Windows { length, source })?;
        let parts = (self.time.as_slice(), split);
        let (fit, validation) = parted(errors.windows, self.recording.time(), parts);
        let position = self.recording.require("position")?;
        let part = |windows: Vec<Window>| of_windows(length, windows, position);
        let metrics = SplitMetrics { fit: part(fit), validation: part(validation) };
        if !(metrics.fit.rms.is_finite() && metrics.validation.rms.is_finite()) {
            return Err(NoView::NoWindows { length });
        }
        Ok(View {
            name,
            compares: Compares::Windows { length },
            unit: self.axis.unit(Quantity::Length).to_owned(),
            metrics,
            floor: Some(self.prepared.position_noise).filter(|floor| *floor > 0.0),
            decides: true,
            caveat: None,
        })
    }

    fn free_run(&self, model: &Model, longest: f64, split: &Split) -> Result<View, NoView> {
        let error = self.free_run_error(model)?;
        let position = self.recording.require("position")?;
        let metrics = self.by_blocks(&error, position, 0..error.len(), split);
        let unit = self.axis.unit(Quantity::Length);
        let times = metrics.validation.rms / longest;
        Ok(View {
            name: "free run".into(),
            compares: Compares::FreeRun,
            unit: unit.to_owned(),
            metrics,
            floor: None,
            decides: false,
            caveat: (times > DRIFTED).then_some(Caveat::Drifted { times }),
        })
    }

    /// Measured less simulated position, sample by sample.
    fn free_run_error(&self, model: &Model) -> Result<Vec<f64>, NoView> {
        let recording = &self.recording;
        let force = recording.require("force")?;
        let position = recording.require("position")?;
        let mut error = Vec::with_capacity(position.len());
        for (range, prepared) in recording.segments().iter().zip(&self.prepared.segments) {
            let first = prepared.start;
            let start = Start {
                velocity: self.prepared.velocity[first],
                command: force[range.start],
                ..Start::at(self.prepared.position[first], 0.0)
            };
            let (time, force) = (&recording.time()[range.clone()], &force[range.clone()]);
            let run = simulate(model, &Input::new(time, force, recording.hold()), &start)?;
            error.extend(position[range.clone()].iter().zip(&run.position).map(|(a, b)| a - b));
        }
        Ok(error)
    }

    /// Measures of an error over `samples` of the recording; `error` begins with the first of them.
    fn by_blocks(
        &self,
        error: &[f64],
        measured: &[f64],
        samples: Range<usize>,
        split: &Split,
    ) -> SplitMetrics {
        let (mut fit, mut validation) = (Sums::default(), Sums::default());
        let time = self.recording.time();
        for (k, error) in samples.zip(error) {
            match held_out(time[k], &self.time, split) {
                Some(true) => validation.add(&[*error], &[measured[k]]),
                Some(false) => fit.add(&[*error], &[measured[k]]),
                None => {}
            }
        }
        SplitMetrics { fit: fit.metrics(), validation: validation.metrics() }
    }
}

/// Window lengths with enough samples, each once.
fn lengths(interval: f64) -> Vec<f64> {
    let mut lengths: Vec<f64> =
        LENGTHS.iter().map(|length| length.max(SAMPLES * interval)).collect();
    lengths.dedup();
    lengths
}

/// Measures over windows. Only the root mean square of each window is known, so that the variance
/// accounted for is a lower limit; both percentages refer to the motion inside a window.
fn of_windows(length: f64, windows: Vec<Window>, position: &[f64]) -> Metrics {
    let mut inside = Sums::default();
    for window in &windows {
        let positions = &position[window.samples.clone()];
        let mean = positions.iter().sum::<f64>() / positions.len().max(1) as f64;
        let motion: Vec<f64> = positions.iter().map(|x| x - mean).collect();
        inside.add(&vec![0.0; motion.len()], &motion);
    }
    let points = inside.metrics().points;
    let motion = inside.size();
    let rms = WindowErrors { length, windows }.robust_rms();
    let share = (motion > 0.0).then(|| rms / motion);
    Metrics {
        rms,
        relative: share,
        fit_percent: share.map(|share| 100.0 * (1.0 - share)),
        variance_accounted_for_percent: share.map(|share| 100.0 * (1.0 - share * share)),
        points,
    }
}

#[cfg(test)]
mod tests;
