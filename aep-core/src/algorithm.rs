//! What the driver needs of an optimizer.

use crate::{Batch, CheckpointError, ConfigError, Domain, Points, Scalar, SteadyState, TellError};

/// The best position found so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Best<'a, T: Scalar> {
    /// Its position in problem coordinates.
    pub position: &'a [T],
    /// Its cost.
    pub cost: T,
}

/// An optimizer in the middle of a run: ask for positions, evaluate them anywhere, tell the costs.
///
/// ```
/// use aep_core::{Aep, Domain, Start, Method};
///
/// let domain = Domain::cube(3, -6.0, 6.0)?;
/// let mut optimizer = Aep::paper().start(&Start::new(&domain, 1))?;
/// for _ in 0..200 {
///     let costs: Vec<f64> = optimizer.ask().rows().map(|x| x.iter().map(|v| v * v).sum()).collect();
///     optimizer.tell(&costs)?;
/// }
/// assert!(optimizer.best().unwrap().cost < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Algorithm<T: Scalar = f64>: Send {
    /// Its name, for reports and checkpoints.
    fn name(&self) -> &str;

    /// Everything that fixes the run (configuration, seed, domain): a checkpoint is only taken over
    /// by a run with the same signature.
    fn signature(&self) -> String;

    /// Where it searches.
    fn domain(&self) -> &Domain<T>;

    /// The positions to be evaluated next, in problem coordinates. Asking again before telling
    /// gives the same positions.
    fn ask(&mut self) -> Batch<'_, T>;

    /// The costs of the last [`Algorithm::ask`], in its order. A cost that is not finite counts as
    /// the worst.
    ///
    /// # Errors
    /// When nothing was asked, or not as many costs are told as positions were asked. The run is as
    /// before then.
    fn tell(&mut self, costs: &[T]) -> Result<(), TellError>;

    /// Whether the positions of the next [`Algorithm::ask`] are wanted with their residuals.
    fn wants_residuals(&self) -> bool {
        false
    }

    /// The same as [`Algorithm::tell`] with the residuals of each position, where the problem has them: an empty row
    /// where there are none.
    ///
    /// # Errors
    /// As [`Algorithm::tell`].
    fn tell_residuals(&mut self, costs: &[T], residuals: &[Vec<f64>]) -> Result<(), TellError> {
        let _ = residuals;
        self.tell(costs)
    }

    /// The best position so far; none before the first [`Algorithm::tell`].
    fn best(&self) -> Option<Best<'_, T>>;

    /// Generations completed; the initial population is generation 0.
    fn generation(&self) -> u64;

    /// Why going on is pointless, if the algorithm knows.
    fn exhausted(&self) -> Option<&str> {
        None
    }

    /// The whole state, for a checkpoint. Between `ask` and `tell` the state before the `ask`.
    ///
    /// # Errors
    /// When the state cannot be encoded.
    fn save(&self) -> Result<Vec<u8>, CheckpointError>;

    /// Takes over a state saved by an optimizer built with the same configuration.
    ///
    /// # Errors
    /// When `state` cannot be decoded or is of another size; the run is as before then.
    fn restore(&mut self, state: &[u8]) -> Result<(), CheckpointError>;
}

/// What a run starts from.
#[derive(Clone, Debug)]
pub struct Start<'a, T: Scalar = f64> {
    /// Where to search.
    pub domain: &'a Domain<T>,
    /// Fixes every random number of the run.
    pub seed: u64,
    /// Positions (problem coordinates) that take the first slots of the initial population; the
    /// rest is drawn uniformly. Those beyond the population size are left out.
    pub initial: &'a [Vec<T>],
}

impl<'a, T: Scalar> Start<'a, T> {
    /// A start with a random initial population.
    pub fn new(domain: &'a Domain<T>, seed: u64) -> Self {
        Self { domain, seed, initial: &[] }
    }

    /// A start whose first individuals are given, for example by an earlier fit.
    #[must_use]
    pub fn with_initial(mut self, initial: &'a [Vec<T>]) -> Self {
        self.initial = initial;
        self
    }

    /// The initial population in search coordinates: for a given domain, seed and size the same
    /// whatever the algorithm.
    ///
    /// # Errors
    /// When an initial point is outside the domain or has not one entry per component, or that many individuals do not
    /// fit into memory.
    pub fn population(&self, count: usize) -> Result<Points<T>, ConfigError> {
        ConfigError::require_fits("population", count, self.domain.dimension())?;
        let mut points = Points::zeros(count, self.domain.dimension());
        let streams = crate::Streams::new(self.seed, crate::Purpose::Initial, 0);
        for i in 0..count {
            self.domain.sample(&mut streams.stream(i), points.row_mut(i));
        }
        for (i, x) in self.initial.iter().enumerate().take(count) {
            self.check(i, x)?;
            self.domain.encode(x, points.row_mut(i));
        }
        Ok(points)
    }

    fn check(&self, point: usize, x: &[T]) -> Result<(), ConfigError> {
        let expected = self.domain.dimension();
        if x.len() != expected {
            return Err(ConfigError::Length { what: "initial point", found: x.len(), expected });
        }
        let limits = self.domain.lower().iter().zip(self.domain.upper());
        for (component, (x, (lo, hi))) in x.iter().zip(limits).enumerate() {
            if !(lo <= x && x <= hi) {
                return Err(ConfigError::InitialPoint { point, component, value: x.as_f64() });
            }
        }
        Ok(())
    }
}

/// An optimizer as a choice: configuration that can start any number of runs.
pub trait Method<T: Scalar = f64>: Send + Sync {
    /// Its name, for tables.
    fn name(&self) -> String;

    /// A fresh run.
    ///
    /// # Errors
    /// When a setting is outside its range or an initial point outside the domain.
    fn start(&self, start: &Start<'_, T>) -> Result<Box<dyn Algorithm<T>>, ConfigError>;

    /// A fresh run whose individuals wait for nobody; None where the method needs whole generations.
    fn start_steady_state(&self, start: &Start<'_, T>) -> Option<StartedSteadyState<T>> {
        let _ = start;
        None
    }
}

/// A run of [`Method::start_steady_state`], or why it cannot begin.
pub type StartedSteadyState<T> = Result<Box<dyn SteadyState<T>>, ConfigError>;
