//! Identification by simulation: the parameters with which a model's motion is the recorded one.
//!
//! The force along a measured motion is the quickest horizon and has a module of its own
//! ([`crate::family`]). Here the model is simulated under the recorded command: over the whole
//! recording ([`Horizon::FreeRun`]) or over short windows with fitted starts ([`Horizon::Windows`]), or
//! under a known controller that follows the recorded reference ([`Horizon::ClosedLoop`]).

use aep_core::{
    Batch, Budget, ConfigError, Domain, Driver, Method, Outcome, Problem, RunError, Scale,
    Start as SearchStart,
};
use missing_physics::fit::Until;
use missing_physics::{DiscoverError, Recording, RecordingError};
use rayon::prelude::*;

use crate::closed_loop::Pd;
use crate::effects::{Effect, ParameterRole};
use crate::model::{MASS, Model, ModelError};
use crate::simulator::SimulationError;
use crate::windows::{WindowError, WindowOptions};

mod free_run;
mod intervals;
mod refine;
mod several;
mod windowed;

pub use aep_core::Refined;
pub use intervals::{Interval, intervals, intervals_over};
pub use several::{FoundParameter, Searched};

use free_run::FreeRun;
use windowed::Windowed;

/// What a model is compared with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Horizon {
    /// The whole of every segment, from its first sample.
    FreeRun {
        /// Longest step of the simulation, s.
        max_step: f64,
    },
    /// Windows with fitted starts.
    Windows(WindowOptions),
    /// The whole of every segment under a known controller, which follows the channel `reference`. The
    /// controller hides most of what a model lacks: all other horizons tell more.
    ClosedLoop {
        /// The controller, as it was.
        controller: Pd,
        /// Resolution of the encoder that the controller sees, m or rad; 0 for none.
        encoder_resolution: f64,
        /// Longest step of the simulation, s.
        max_step: f64,
    },
}

/// A parameter that is searched.
#[derive(Clone, Debug, PartialEq)]
pub struct Free {
    /// Its address in the model.
    pub address: String,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Scale of the search.
    pub scale: Scale,
}

impl Free {
    /// A parameter searched on a linear scale.
    pub fn linear(address: &str, low: f64, high: f64) -> Self {
        Self { address: address.to_owned(), low, high, scale: Scale::Linear }
    }

    /// A parameter searched on a logarithmic scale.
    pub fn log(address: &str, low: f64, high: f64) -> Self {
        Self { address: address.to_owned(), low, high, scale: Scale::Log }
    }
}

/// Every parameter of `model` that its effects' tables call an amplitude or a shape, within the
/// tables' bounds; the mass within a factor of 20 of its value.
pub fn all_free(model: &Model) -> Vec<Free> {
    let tabled = |address: String| {
        let Some(parameter) = model.parameter(&address) else {
            return Some(Free::log(MASS, model.mass() / 20.0, model.mass() * 20.0));
        };
        let (low, high) = parameter.range(model.axis());
        let scale = parameter.scale;
        (parameter.role != ParameterRole::Fixed).then_some(Free { address, low, high, scale })
    };
    model.addresses().into_iter().filter_map(tabled).collect()
}

/// Where a search of a model of `effects` begins: at the values of `known` where that has them, at typical ones for what
/// it lacks. Effects whose law reads columns get those of `recording`.
///
/// # Errors
/// Effects that do not fit together.
pub fn first_guess(
    known: &Model,
    effects: &[&'static dyn Effect],
    recording: &Recording,
) -> Result<Model, ModelError> {
    let mut model = Model::new(known.axis(), known.mass())?;
    for effect in effects {
        model = model.with_effect(effect.bound(recording).unwrap_or(*effect))?;
        for address in model.addresses() {
            if let Ok(value) = known.get(&address) {
                model.set(&address, value)?;
            }
        }
    }
    Ok(model)
}

/// Why an identification is not possible.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IdentifyError {
    /// A channel is missing.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// An effect that the comparison of forces, where the search begins, does not have.
    #[error(transparent)]
    Term(#[from] DiscoverError),
    /// A free parameter is not one of the model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Steps or times make no sense.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// There are no windows.
    #[error(transparent)]
    Window(#[from] WindowError),
    /// Bounds that no search can use.
    #[error(transparent)]
    Domain(#[from] ConfigError),
    /// The search failed.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// The identification as a task for an optimizer. The cost is the mean square of the position error
/// over that of the motion: 0 for a perfect model, about 1 for one that does not move.
pub struct Identification<'a> {
    domain: Domain,
    values: Vec<f64>,
    /// Index in `values` of each free parameter.
    places: Vec<usize>,
    free: Vec<Free>,
    model: Model,
    comparison: Comparison<'a>,
    until: Until<'a>,
}

enum Comparison<'a> {
    FreeRun(FreeRun<'a>),
    Windows(Windowed<'a>),
}

impl<'a> Identification<'a> {
    /// `free` parameters of `model` on `recording` (channels `force` and `position`).
    ///
    /// # Errors
    /// A channel, a parameter or the bounds do not fit.
    pub fn new(
        model: &Model,
        recording: &'a Recording,
        free: &[Free],
        horizon: Horizon,
    ) -> Result<Self, IdentifyError> {
        let addresses = model.addresses();
        let place = |free: &Free| -> Result<usize, ModelError> {
            model.get(&free.address)?;
            Ok(addresses.iter().position(|address| *address == free.address).unwrap_or(0))
        };
        let places = free.iter().map(place).collect::<Result<_, _>>()?;
        let scales = free.iter().map(|free| free.scale);
        let domain = Domain::new(
            free.iter().map(|free| free.low).collect(),
            free.iter().map(|free| free.high).collect(),
        )?
        .with_scales(scales.collect())?
        .with_names(free.iter().map(|free| free.address.clone()))?;
        let comparison = match horizon {
            Horizon::FreeRun { max_step } => {
                Comparison::FreeRun(FreeRun::new(model, recording, max_step)?)
            }
            Horizon::ClosedLoop { controller, encoder_resolution, max_step } => {
                let run = FreeRun::new(model, recording, max_step)?;
                Comparison::FreeRun(run.under(recording, controller, encoder_resolution)?)
            }
            Horizon::Windows(options) => {
                Comparison::Windows(Windowed::new(model, recording, &options)?)
            }
        };
        let (values, free, model) = (model.values(), free.to_vec(), model.clone());
        Ok(Self { domain, values, places, free, model, comparison, until: Until::default() })
    }

    /// The same, ended early: what was found is kept.
    #[must_use]
    pub fn until(self, until: Until<'a>) -> Self {
        Self { until, ..self }
    }

    /// Whether it was told to end early.
    pub fn is_stopped(&self) -> bool {
        self.until.is_over()
    }

    /// The model with the free parameters at `x`.
    ///
    /// # Errors
    /// A value that no model can have.
    pub fn model(&self, x: &[f64]) -> Result<Model, ModelError> {
        let mut model = self.model.clone();
        model.set_values(&self.full(x))?;
        Ok(model)
    }

    /// Values of the free parameters in the model that this was made with.
    pub fn start(&self) -> Vec<f64> {
        self.places.iter().map(|place| self.values[*place]).collect()
    }

    /// The free parameters.
    pub fn free(&self) -> &[Free] {
        &self.free
    }

    /// All values of the model with the free ones at `x`.
    fn full(&self, x: &[f64]) -> Vec<f64> {
        let mut values = self.values.clone();
        for (place, x) in self.places.iter().zip(x) {
            values[*place] = *x;
        }
        values
    }

    /// Position errors (measured minus simulated) at every sample with the free parameters at `x`, m
    /// or rad.
    pub fn errors(&self, x: &[f64]) -> Vec<f64> {
        self.residuals(&[x.to_vec()]).pop().unwrap_or_default()
    }

    /// Position errors at every sample for each candidate, m or rad.
    fn residuals(&self, candidates: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let full: Vec<Vec<f64>> = candidates.iter().map(|x| self.full(x)).collect();
        full.par_chunks(self.batch_size())
            .flat_map_iter(|full| match &self.comparison {
                Comparison::FreeRun(run) => run.residuals(full),
                Comparison::Windows(windows) => windows.residuals(full),
            })
            .collect()
    }

    /// Mean square by which the motion of `x` differs where every step is divided into `parts`: what
    /// the integration adds to the errors.
    fn step_error(&self, x: &[f64], parts: usize) -> f64 {
        let full = [self.full(x)];
        let (coarse, fine) = match &self.comparison {
            Comparison::FreeRun(run) => (run.residuals(&full), run.finer(parts).residuals(&full)),
            Comparison::Windows(windows) => {
                (windows.residuals(&full), windows.finer(parts).residuals(&full))
            }
        };
        let pairs = coarse[0].iter().zip(&fine[0]);
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / coarse[0].len().max(1) as f64
    }

    /// Mean sampling time, s.
    fn sample_time(&self) -> f64 {
        match &self.comparison {
            Comparison::FreeRun(run) => run.sample_time(),
            Comparison::Windows(windows) => windows.sample_time(),
        }
    }

    /// Mean square of the recorded motion, and of what its encoder cannot resolve.
    fn scales(&self) -> (f64, f64) {
        match &self.comparison {
            Comparison::FreeRun(run) => (run.scale, run.noise * run.noise),
            Comparison::Windows(windows) => windows.scales(),
        }
    }

    /// Searches within `budget`; the same seed gives the same result to the bit, whatever the
    /// number of threads.
    ///
    /// # Errors
    /// The method does not fit the domain.
    pub fn run(
        &self,
        method: &dyn Method,
        budget: Budget,
        seed: u64,
    ) -> Result<Outcome, IdentifyError> {
        self.run_from(&[], method, budget, seed)
    }

    /// The same with `initial` points among the first individuals, moved into the bounds.
    ///
    /// # Errors
    /// As [`Identification::run`].
    pub fn run_from(
        &self,
        initial: &[Vec<f64>],
        method: &dyn Method,
        budget: Budget,
        seed: u64,
    ) -> Result<Outcome, IdentifyError> {
        let within = |x: &Vec<f64>| -> Vec<f64> {
            x.iter().zip(&self.free).map(|(x, free)| x.clamp(free.low, free.high)).collect()
        };
        let initial: Vec<Vec<f64>> = initial.iter().map(within).collect();
        let start = SearchStart::new(&self.domain, seed).with_initial(&initial);
        let mut algorithm = method.start(&start).map_err(RunError::from)?;
        let budget = self.until.left().into_iter().fold(budget, Budget::with_time);
        let driver = Driver::new(budget).in_parallel();
        let mut driver = self.until.stop.into_iter().fold(driver, Driver::with_stop_flag);
        Ok(driver.run(&mut *algorithm, self)?)
    }
}

impl Problem for Identification<'_> {
    fn domain(&self) -> &Domain {
        &self.domain
    }

    fn evaluate(&self, x: &[f64]) -> f64 {
        let mut cost = [f64::INFINITY];
        self.evaluate_batch(Batch::new(x.len(), x), &mut cost);
        cost[0]
    }

    fn evaluate_batch(&self, points: Batch<'_>, costs: &mut [f64]) {
        let full: Vec<Vec<f64>> = points.rows().map(|x| self.full(x)).collect();
        match &self.comparison {
            Comparison::FreeRun(run) => run.costs(&full, costs),
            Comparison::Windows(windows) => windows.costs(&full, costs),
        }
    }

    fn batch_size(&self) -> usize {
        match &self.comparison {
            Comparison::FreeRun(run) => run.together(),
            Comparison::Windows(_) => 1,
        }
    }
}

#[cfg(test)]
mod tests;
