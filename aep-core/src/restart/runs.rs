//! One run after the other, as one algorithm.

use serde::{Deserialize, Serialize};

use crate::best::BestSoFar;
use crate::turn::Turn;
use crate::{
    Algorithm, Batch, Best, CheckpointError, ConfigError, Domain, Scalar, Stagnation, TellError,
    checkpoint,
};

/// Which run is to begin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Attempt {
    /// Its number; 0 is the first.
    pub run: u32,
    /// Generations completed by all runs before it.
    pub generation: u64,
}

/// How every run begins.
pub(crate) type Begin<T> =
    Box<dyn Fn(Attempt) -> Result<Box<dyn Algorithm<T>>, ConfigError> + Send>;

/// Begins a run whenever the one before is exhausted, or stagnates where `patience` is given. The
/// best of all runs is kept.
pub(crate) struct Runs<T: Scalar> {
    name: String,
    signature: String,
    domain: Domain<T>,
    begin: Begin<T>,
    patience: Option<Stagnation>,
    inner: Box<dyn Algorithm<T>>,
    exhausted: Option<String>,
    turn: Turn,
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
    best: BestSoFar<T>,
}

impl<T: Scalar> Runs<T> {
    /// Runs that `begin` begins. What precedes the first run's own signature is `prefix`.
    pub fn new(
        name: String,
        prefix: &str,
        patience: Option<Stagnation>,
        begin: Begin<T>,
    ) -> Result<Self, ConfigError> {
        let inner = begin(Attempt { run: 0, generation: 0 })?;
        let best = BestSoFar::new(inner.domain().dimension());
        Ok(Self {
            name,
            signature: format!("{prefix}{}", inner.signature()),
            domain: inner.domain().clone(),
            begin,
            patience,
            inner,
            exhausted: None,
            turn: Turn::default(),
            state: State { run: 0, told: 0, progress: (T::infinity(), 0), best },
        })
    }

    fn stuck(&self) -> bool {
        let waited = self.state.told.saturating_sub(self.state.progress.1);
        let stagnates = self.patience.is_some_and(|patience| waited > patience.generations);
        stagnates || self.inner.exhausted().is_some()
    }

    fn fresh(&self, run: u32) -> Result<Box<dyn Algorithm<T>>, ConfigError> {
        (self.begin)(Attempt { run, generation: self.generation() })
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
        let tolerance = T::of(self.patience.map_or(0.0, |patience| patience.tolerance));
        if reference.is_infinite() || best.cost < reference - tolerance * reference.abs() {
            self.state.progress = (best.cost, self.state.told);
        }
        self.state.best.note(&[best.cost], |_, x| x.copy_from_slice(best.position));
    }
}

impl<T: Scalar> Algorithm<T> for Runs<T> {
    fn name(&self) -> &str {
        &self.name
    }

    fn signature(&self) -> String {
        self.signature.clone()
    }

    fn domain(&self) -> &Domain<T> {
        &self.domain
    }

    fn ask(&mut self) -> Batch<'_, T> {
        if self.turn.ask() && self.stuck() {
            self.restart();
        }
        self.inner.ask()
    }

    fn tell(&mut self, costs: &[T]) -> Result<(), TellError> {
        // The inner run knows how many are expected, and refuses the rest.
        self.inner.tell(costs)?;
        self.turn = Turn::default();
        self.state.told += 1;
        self.note();
        Ok(())
    }

    fn best(&self) -> Option<Best<'_, T>> {
        self.state.best.get()
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
        if state.best.dimension() != self.domain.dimension() {
            return Err(CheckpointError::Mismatch { what: "dimension" });
        }
        if state.run > 0 {
            let refused = |_| CheckpointError::Mismatch { what: "method" };
            self.inner = self.fresh(state.run).map_err(refused)?;
        }
        self.inner.restore(&inner)?;
        self.state = state;
        self.turn = Turn::default();
        Ok(())
    }
}
