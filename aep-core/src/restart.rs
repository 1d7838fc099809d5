//! Beginning again when a run no longer gets anywhere.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::random::{Purpose, Streams};
use crate::{
    Algorithm, Batch, Best, CheckpointError, ConfigError, Domain, Method, Scalar, Stagnation,
    Start, TellError, checkpoint,
};

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
        let inner = (self.make)(0).start(start)?;
        let dimension = start.domain.dimension();
        Ok(Box::new(Runs {
            signature: format!("{self:?}, {}", inner.signature()),
            method: self.clone(),
            domain: start.domain.clone(),
            seed: start.seed,
            inner,
            exhausted: None,
            asked: false,
            state: State {
                run: 0,
                told: 0,
                progress: (T::infinity(), 0),
                best_position: vec![T::zero(); dimension],
                best_cost: T::infinity(),
            },
        }))
    }
}

struct Runs<T: Scalar> {
    signature: String,
    method: Restarting<T>,
    domain: Domain<T>,
    seed: u64,
    inner: Box<dyn Algorithm<T>>,
    exhausted: Option<String>,
    asked: bool,
    state: State<T>,
}

#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct State<T: Scalar> {
    /// Number of the present run.
    run: u32,
    /// Generations told, all runs together, initial populations included.
    told: u64,
    /// Best cost of the present run when progress was last seen, and when that was.
    progress: (T, u64),
    best_position: Vec<T>,
    best_cost: T,
}

impl<T: Scalar> Runs<T> {
    fn fresh(&self, run: u32) -> Result<Box<dyn Algorithm<T>>, ConfigError> {
        let seed = Streams::new(self.seed, Purpose::Restart, 0).word(run as usize);
        (self.method.make)(run).start(&Start::new(&self.domain, seed))
    }

    fn stuck(&self) -> bool {
        let waited = self.state.told.saturating_sub(self.state.progress.1);
        waited > self.method.patience.generations || self.inner.exhausted().is_some()
    }

    fn restart(&mut self) {
        match self.fresh(self.state.run + 1) {
            Ok(inner) => {
                self.inner = inner;
                self.state.run += 1;
                self.state.progress = (T::infinity(), self.state.told);
            }
            Err(error) => self.exhausted = Some(error.to_string()),
        }
    }

    fn note(&mut self) {
        let Some(best) = self.inner.best() else { return };
        let (reference, _) = self.state.progress;
        let least = T::of(self.method.patience.tolerance) * reference.abs();
        if reference.is_infinite() || best.cost < reference - least {
            self.state.progress = (best.cost, self.state.told);
        }
        if best.cost < self.state.best_cost {
            self.state.best_cost = best.cost;
            self.state.best_position.copy_from_slice(best.position);
        }
    }
}

impl<T: Scalar> Algorithm<T> for Runs<T> {
    fn name(&self) -> &str {
        &self.method.name
    }

    fn signature(&self) -> String {
        self.signature.clone()
    }

    fn domain(&self) -> &Domain<T> {
        &self.domain
    }

    fn ask(&mut self) -> Batch<'_, T> {
        if !self.asked && self.stuck() {
            self.restart();
        }
        self.asked = true;
        self.inner.ask()
    }

    fn tell(&mut self, costs: &[T]) -> Result<(), TellError> {
        self.inner.tell(costs)?;
        self.asked = false;
        self.state.told += 1;
        self.note();
        Ok(())
    }

    fn best(&self) -> Option<Best<'_, T>> {
        let state = &self.state;
        let found = state.best_cost.is_finite();
        found.then(|| Best { position: &state.best_position, cost: state.best_cost })
    }

    fn generation(&self) -> u64 {
        self.state.told.saturating_sub(1)
    }

    fn exhausted(&self) -> Option<&str> {
        self.exhausted.as_deref()
    }

    fn save(&self) -> Result<Vec<u8>, CheckpointError> {
        checkpoint::encode(&(&self.state, self.inner.save()?))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), CheckpointError> {
        let (state, inner): (State<T>, Vec<u8>) = checkpoint::decode(bytes)?;
        if state.best_position.len() != self.domain.dimension() {
            return Err(CheckpointError::Mismatch { what: "dimension" });
        }
        if state.run > 0 {
            let refused = |_| CheckpointError::Mismatch { what: "method" };
            self.inner = self.fresh(state.run).map_err(refused)?;
        }
        self.inner.restore(&inner)?;
        self.state = state;
        self.asked = false;
        Ok(())
    }
}
