//! Beginning again when a run no longer gets anywhere.

mod runs;

use std::fmt;
use std::sync::Arc;

pub(crate) use runs::{Attempt, Runs};

use crate::random::{Purpose, Streams};
use crate::{Algorithm, ConfigError, Method, Scalar, Stagnation, Start};

type Make<T> = Arc<dyn Fn(u32) -> Box<dyn Method<T>> + Send + Sync>;

/// Runs a method again and again until the budget is used up.
///
/// A run that stagnates ([`Stagnation`]) or is exhausted ends; the next one starts from a new random
/// population with the method that `make` gives for its number, usually with a larger population.
/// The best of all runs is kept. Given initial positions only go into the first run.
///
/// | setting | preset | meaning |
/// |---|---|---|
/// | `make` | [`crate::Aep::practical`], 40, 80, 160, ... individuals | the method of run 0, 1, 2, ... |
/// | `patience` | 100 generations, 1e-15 | when a run counts as stuck |
///
/// **Limits.** Worth it where runs get stuck in local minima and the budget allows for several; a
/// patience that is too short ends runs that would still have crossed a plateau.
///
/// ```
/// use aep_core::{Aep, Budget, Domain, FnProblem, Restarting, minimize};
///
/// let domain = Domain::cube(5, -5.12, 5.12)?;
/// let rastrigin = FnProblem::new(domain, |x: &[f64]| {
///     x.iter().map(|x| 10.0 + x * x - 10.0 * (std::f64::consts::TAU * x).cos()).sum()
/// });
/// let method = Restarting::doubling(Aep::practical(), Aep::with_population);
/// let budget = Budget::evaluations(200_000).with_target(1e-6);
/// assert!(minimize(&rastrigin, &method, budget, 1)?.cost <= 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Restarting<T: Scalar = f64> {
    name: String,
    make: Make<T>,
    patience: Stagnation,
}

impl<T: Scalar> Restarting<T> {
    /// Runs `make(0)`, then `make(1)`, and so on.
    pub fn new(
        name: impl Into<String>,
        make: impl Fn(u32) -> Box<dyn Method<T>> + Send + Sync + 'static,
        patience: Stagnation,
    ) -> Self {
        Self { name: name.into(), make: Arc::new(make), patience }
    }

    /// Runs `method` with 40 individuals, then 80, 160, ..., at most 40,960.
    pub fn doubling<M: Method<T> + Clone + 'static>(
        method: M,
        resize: impl Fn(M, usize) -> M + Send + Sync + 'static,
    ) -> Self {
        let name = format!("{}-restarts", method.name());
        let make = move |run: u32| -> Box<dyn Method<T>> {
            Box::new(resize(method.clone(), 40 << run.min(10)))
        };
        Self::new(name, make, Stagnation { generations: 100, tolerance: 1e-15 })
    }

    /// The same with another patience.
    #[must_use]
    pub fn with_patience(self, patience: Stagnation) -> Self {
        Self { patience, ..self }
    }
}

impl<T: Scalar> fmt::Debug for Restarting<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} with {:?}", self.name, self.patience)
    }
}

impl<T: Scalar> Method<T> for Restarting<T> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn start(&self, start: &Start<'_, T>) -> Result<Box<dyn Algorithm<T>>, ConfigError> {
        let hint = "at least one generation is needed";
        let patience = self.patience.generations;
        ConfigError::require(patience > 0, "restarts", "patience", patience as f64, hint)?;
        let (domain, seed) = (start.domain.clone(), start.seed);
        let (make, initial) = (self.make.clone(), start.initial.to_vec());
        let begin = move |attempt: Attempt| {
            let run = attempt.run;
            if run == 0 {
                let first = Start::new(&domain, seed).with_initial(&initial);
                return make(0).start(&first);
            }
            let seed = Streams::new(seed, Purpose::Restart, 0).word(run as usize);
            make(run).start(&Start::new(&domain, seed))
        };
        let (prefix, patience) = (format!("{self:?}, "), Some(self.patience));
        Ok(Box::new(Runs::new(self.name.clone(), &prefix, patience, Box::new(begin))?))
    }
}
