//! Covariance matrix adaptation, as a yardstick.

mod distribution;

use serde::{Deserialize, Serialize};

use distribution::Distribution;

use crate::best::BestSoFar;
use crate::cube::Cube;
use crate::random::{self, Purpose, Streams};
use crate::restart::{Attempt, Runs};
use crate::turn::Turn;
use crate::{
    Algorithm, Batch, Best, CheckpointError, ConfigError, Domain, Method, Points, Scalar, Start,
    TellError, checkpoint,
};

/// What happens when the distribution has converged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Restarts {
    /// The run ends, [`crate::StopReason::Exhausted`].
    Never,
    /// It starts again at a random place with twice the population (IPOP, Auger & Hansen 2005), up to 1,024 times the first.
    DoublePopulation,
}

/// How often the population is doubled at most. Where runs end at once, as on a constant cost, one that always doubles
/// outgrows any memory within some hundred generations.
const MOST_DOUBLINGS: u32 = 10;

/// Covariance matrix adaptation evolution strategy, (`mu/mu_w`, lambda)-CMA-ES.
///
/// Each generation draws lambda positions from N(m, sigma^2 C), moves m to the weighted mean of the
/// better half, and adapts C by the rank-one and rank-mu updates and sigma by cumulative step-size
/// control, with the default constants of Hansen's tutorial (no negative weights). It works in
/// search coordinates scaled to the domain's width; what leaves the domain is mirrored back into it
/// before it is evaluated. The first generation is the same random population that the other
/// algorithms start from; its best individual becomes m.
///
/// | setting | default | meaning |
/// |---|---|---|
/// | population | 0: 4 + 3 ln n | lambda |
/// | `sigma` | 0.3 | first step size in widths of the domain |
/// | [`Restarts`] | double the population | what happens on convergence |
///
/// **Limits.** n^2 memory and n^3 time per eigendecomposition: up to a few hundred components; beyond
/// some 11,000 a matrix does not fit and is refused.
///
/// Reference: N. Hansen, "The CMA Evolution Strategy: A Tutorial", arXiv:1604.00772, 2016.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CmaEs {
    /// Candidates of a generation; 0 for 4 + 3 ln n.
    pub population: usize,
    /// First step size in widths of the domain.
    pub sigma: f64,
    /// What happens on convergence.
    pub restarts: Restarts,
}

impl Default for CmaEs {
    fn default() -> Self {
        Self { population: 0, sigma: 0.3, restarts: Restarts::DoublePopulation }
    }
}

impl CmaEs {
    /// The same with another population size.
    #[must_use]
    pub fn with_population(self, population: usize) -> Self {
        Self { population, ..self }
    }

    /// The same with another first step size.
    #[must_use]
    pub fn with_sigma(self, sigma: f64) -> Self {
        Self { sigma, ..self }
    }

    /// The same with another behaviour on convergence.
    #[must_use]
    pub fn with_restarts(self, restarts: Restarts) -> Self {
        Self { restarts, ..self }
    }
}

impl<T: Scalar> Method<T> for CmaEs {
    fn name(&self) -> String {
        "cma-es".into()
    }

    fn start(&self, start: &Start<'_, T>) -> Result<Box<dyn Algorithm<T>>, ConfigError> {
        let n = start.domain.dimension();
        let usual = 4 + (3.0 * (n as f64).ln()) as usize;
        let lambda = if self.population == 0 { usual } else { self.population };
        let hint = "at least four candidates are needed (0 takes 4 + 3 ln n)";
        ConfigError::require(lambda >= 4, "cma-es", "population", lambda as f64, hint)?;
        let valid = self.sigma > 0.0 && self.sigma.is_finite();
        let hint = "must be positive and finite";
        ConfigError::require(valid, "cma-es", "sigma", self.sigma, hint)?;
        ConfigError::require_fits("covariance", n, n)?;
        let (config, domain, seed) = (self.clone(), start.domain.clone(), start.seed);
        match self.restarts {
            Restarts::Never => Ok(Box::new(Run::first(&config, start, lambda)?)),
            Restarts::DoublePopulation => {
                let initial = start.initial.to_vec();
                let begin = move |attempt: Attempt| -> Result<Box<dyn Algorithm<T>>, ConfigError> {
                    let start = Start::new(&domain, seed).with_initial(&initial);
                    Ok(Box::new(match attempt.run {
                        0 => Run::first(&config, &start, lambda)?,
                        run => {
                            let doubled = lambda.saturating_mul(1 << run.min(MOST_DOUBLINGS));
                            ConfigError::require_fits("population", doubled, n)?;
                            Run::again(&config, &start, doubled, attempt.generation)
                        }
                    }))
                };
                Ok(Box::new(Runs::new("cma-es".into(), "", None, Box::new(begin))?))
            }
        }
    }
}

/// One distribution until it has converged.
#[derive(Debug)]
struct Run<T: Scalar> {
    signature: String,
    domain: Domain<T>,
    seed: u64,
    sigma: f64,
    /// Candidates of a generation.
    lambda: usize,
    /// The initial population, in search coordinates; empty for a run that begins with a distribution.
    first: Points<T>,
    /// What was asked, in problem coordinates.
    points: Points<T>,
    /// What was drawn, scaled to the domain's width, before mirroring.
    genotypes: Vec<Vec<f64>>,
    cube: Cube,
    turn: Turn,
    state: State<T>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
struct State<T: Scalar> {
    generation: u64,
    /// None until the initial population has been evaluated.
    distribution: Option<Distribution>,
    best: BestSoFar<T>,
    exhausted: Option<String>,
}

impl<T: Scalar> Run<T> {
    /// A run that evaluates the initial population of `start` first.
    fn first(config: &CmaEs, start: &Start<'_, T>, lambda: usize) -> Result<Self, ConfigError> {
        let first = start.population(lambda)?;
        Ok(Self { first, ..Self::new(config, start, lambda) })
    }

    /// A run from a random mean that goes on counting after `generation`, so that no random number
    /// of the run before is drawn again.
    fn again(config: &CmaEs, start: &Start<'_, T>, lambda: usize, generation: u64) -> Self {
        let mut run = Self::new(config, start, lambda);
        let mut rng = Streams::new(start.seed, Purpose::Individual, generation + 1).stream(0);
        let dimension = start.domain.dimension();
        let mean = (0..dimension).map(|_| random::uniform::<f64>(&mut rng)).collect();
        run.state.distribution = Some(Distribution::new(mean, config.sigma, lambda));
        run.state.generation = generation;
        run
    }

    fn new(config: &CmaEs, start: &Start<'_, T>, lambda: usize) -> Self {
        let signature = crate::engine::signature("cma-es", start.domain, start.seed, lambda);
        let dimension = start.domain.dimension();
        Self {
            signature: format!("{signature}, {config:?}"),
            domain: start.domain.clone(),
            seed: start.seed,
            sigma: config.sigma,
            lambda,
            first: Points::zeros(0, dimension),
            points: Points::zeros(lambda, dimension),
            genotypes: Vec::new(),
            cube: Cube::new(dimension),
            turn: Turn::default(),
            state: State {
                generation: 0,
                distribution: None,
                best: BestSoFar::new(dimension),
                exhausted: None,
            },
        }
    }

    fn sample(&mut self) {
        let Some(distribution) = &self.state.distribution else { return };
        let streams = Streams::new(self.seed, Purpose::Mutation, self.state.generation + 1);
        self.genotypes =
            (0..self.lambda).map(|i| distribution.sample(&mut streams.stream(i))).collect();
        for (i, genotype) in self.genotypes.iter().enumerate() {
            self.cube.place(&self.domain, genotype, self.points.row_mut(i));
        }
    }

    /// The first generation: its best individual is the first mean.
    fn begin(&mut self, costs: &[T]) {
        let best = (0..costs.len()).reduce(|a, b| if costs[b] < costs[a] { b } else { a });
        let row = self.first.row(best.unwrap_or(0));
        let mean = Cube::shares(&self.domain, row);
        let fresh = Distribution::new(mean, self.sigma, self.lambda);
        self.state.distribution = Some(fresh);
    }

    fn adapt(&mut self, costs: &[T]) {
        let Some(distribution) = &mut self.state.distribution else { return };
        let worst = f64::INFINITY;
        let costs: Vec<f64> =
            costs.iter().map(|c| if c.is_finite() { c.as_f64() } else { worst }).collect();
        distribution.update(&self.genotypes, &costs);
        self.state.exhausted = distribution.converged().map(Into::into);
    }
}

impl<T: Scalar> Algorithm<T> for Run<T> {
    fn name(&self) -> &'static str {
        "cma-es"
    }

    fn signature(&self) -> String {
        self.signature.clone()
    }

    fn domain(&self) -> &Domain<T> {
        &self.domain
    }

    fn ask(&mut self) -> Batch<'_, T> {
        if self.turn.ask() {
            if self.state.distribution.is_some() {
                self.sample();
            } else {
                for i in 0..self.first.len() {
                    self.domain.decode(self.first.row(i), self.points.row_mut(i));
                }
            }
        }
        self.points.batch()
    }

    fn tell(&mut self, costs: &[T]) -> Result<(), TellError> {
        self.turn.tell(costs.len(), self.lambda)?;
        let points = &self.points;
        self.state.best.note(costs, |i, x| x.copy_from_slice(points.row(i)));
        if self.state.distribution.is_some() {
            self.adapt(costs);
            self.state.generation += 1;
        } else {
            self.begin(costs);
        }
        Ok(())
    }

    fn best(&self) -> Option<Best<'_, T>> {
        self.state.best.get()
    }

    fn generation(&self) -> u64 {
        self.state.generation
    }

    fn exhausted(&self) -> Option<&str> {
        self.state.exhausted.as_deref()
    }

    fn save(&self) -> Result<Vec<u8>, CheckpointError> {
        checkpoint::encode(&self.state)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), CheckpointError> {
        let state: State<T> = checkpoint::decode(bytes)?;
        let dimension = self.domain.dimension();
        let fits = state.distribution.as_ref().is_none_or(|d| d.fits(dimension, self.lambda));
        if state.best.dimension() != dimension || !fits {
            return Err(CheckpointError::Mismatch { what: "dimension" });
        }
        self.state = state;
        self.turn = Turn::default();
        Ok(())
    }
}
