//! An optimizer that knows when to end.

use aep_core::{
    Algorithm, Batch, Best, CheckpointError, ConfigError, Domain, Method, Start, TellError,
};

use crate::stop::Watch;

/// `method`, exhausted as soon as its watch is over: the best position so far is its result.
pub struct Stoppable<'a> {
    /// The optimizer.
    pub method: &'a dyn Method<f64>,
    /// What ends it.
    pub watch: Watch,
}

impl Method<f64> for Stoppable<'_> {
    fn name(&self) -> String {
        self.method.name()
    }

    fn start(&self, start: &Start<'_, f64>) -> Result<Box<dyn Algorithm<f64>>, ConfigError> {
        Ok(Box::new(Watched { algorithm: self.method.start(start)?, watch: self.watch }))
    }
}

struct Watched {
    algorithm: Box<dyn Algorithm<f64>>,
    watch: Watch,
}

impl Algorithm<f64> for Watched {
    fn name(&self) -> &str {
        self.algorithm.name()
    }

    fn signature(&self) -> String {
        self.algorithm.signature()
    }

    fn domain(&self) -> &Domain<f64> {
        self.algorithm.domain()
    }

    fn ask(&mut self) -> Batch<'_, f64> {
        self.algorithm.ask()
    }

    fn tell(&mut self, costs: &[f64]) -> Result<(), TellError> {
        self.algorithm.tell(costs)
    }

    fn best(&self) -> Option<Best<'_, f64>> {
        self.algorithm.best()
    }

    fn generation(&self) -> u64 {
        self.algorithm.generation()
    }

    fn exhausted(&self) -> Option<&str> {
        if self.watch.is_over() { Some("told to stop") } else { self.algorithm.exhausted() }
    }

    fn save(&self) -> Result<Vec<u8>, CheckpointError> {
        self.algorithm.save()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), CheckpointError> {
        self.algorithm.restore(state)
    }
}
