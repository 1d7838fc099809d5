//! Windows with fitted starts, one candidate after the other: its windows are the lanes.

use std::ops::Range;

use missing_physics::Recording;

use super::IdentifyError;
use crate::model::Model;
use crate::windows::{Data, Fitter, TOGETHER, WindowError, WindowErrors, WindowOptions};

/// Windows of one recording.
#[derive(Clone)]
pub(super) struct Windowed<'a> {
    data: Data<'a>,
    model: Model,
    cut: Vec<(usize, Range<usize>)>,
    /// Mean square of the motion within a window, m^2 or rad^2.
    scale: f64,
}

impl<'a> Windowed<'a> {
    pub fn new(
        model: &Model,
        recording: &'a Recording,
        options: &WindowOptions,
    ) -> Result<Self, IdentifyError> {
        let data = Data::new(recording, options)?;
        let cut = data.cut();
        if cut.is_empty() {
            return Err(WindowError::TooShort { length: options.length }.into());
        }
        let spread = |range: &Range<usize>| -> f64 {
            let x = &data.position[range.clone()];
            let mean = x.iter().sum::<f64>() / x.len() as f64;
            x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / x.len() as f64
        };
        let scale = cut.iter().map(|(_, range)| spread(range)).sum::<f64>() / cut.len() as f64;
        let scale = scale.max(data.noise * data.noise).max(f64::MIN_POSITIVE);
        Ok(Self { data, model: model.clone(), cut, scale })
    }

    /// Mean sampling time, s.
    pub fn sample_time(&self) -> f64 {
        self.data.sample_time()
    }

    /// The same with `times` as many steps.
    pub fn finer(&self, times: usize) -> Self {
        let mut finer = self.clone();
        finer.data.steps *= times;
        finer
    }

    /// Mean square of the motion and of the position's noise.
    pub fn scales(&self) -> (f64, f64) {
        (self.scale, self.data.noise * self.data.noise)
    }

    /// Robust mean square error of each candidate over that of the motion.
    pub fn costs(&self, candidates: &[Vec<f64>], costs: &mut [f64]) {
        let mut fitter = Fitter::new(&self.model, &self.data);
        for (values, cost) in candidates.iter().zip(costs) {
            fitter.set_values(values);
            let windows = self.cut.chunks(TOGETHER).flat_map(|cut| fitter.fit(cut)).collect();
            let errors = WindowErrors { length: self.data.options.length, windows };
            *cost = errors.robust_rms().powi(2) / self.scale;
        }
    }

    /// Errors at every sample for each candidate; 0 outside the windows.
    pub fn residuals(&self, candidates: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut fitter = Fitter::new(&self.model, &self.data);
        let mut of = |values: &Vec<f64>| {
            fitter.set_values(values);
            let mut errors = vec![0.0; self.data.time.len()];
            for cut in self.cut.chunks(TOGETHER) {
                fitter.fit(cut);
                for (w, (_, samples)) in cut.iter().enumerate() {
                    fitter.errors(w, &mut errors[samples.clone()]);
                }
            }
            errors
        };
        candidates.iter().map(&mut of).collect()
    }
}
