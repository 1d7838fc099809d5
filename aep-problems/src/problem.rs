//! A test function as a problem.

use aep_core::random::{self, Streams};
use aep_core::{ConfigError, Domain, Problem, Purpose};

use crate::noise::stream_at;
use crate::{Definition, Shift};

/// A test function in a chosen dimension, on request with a moved optimum and with noise.
///
/// ```
/// use aep_core::Problem;
/// let plain = aep_problems::find("rastrigin").unwrap().in_dimension(5)?;
/// assert_eq!(plain.evaluate(&[0.0; 5]), 0.0);
/// let moved = plain.with_random_shift(7);
/// assert!(moved.evaluate(moved.optimum()) < 1e-12);
/// # Ok::<(), aep_problems::ProblemError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TestProblem {
    definition: &'static Definition,
    domain: Domain,
    shift: Option<Vec<f64>>,
    noise: Option<u64>,
    optimum: Vec<f64>,
}

/// Why a test problem cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// The function is not defined for that many components.
    #[error("{name} is defined for {dimension} components, not for {asked}")]
    Dimension {
        /// Name of the function.
        name: &'static str,
        /// What it is defined for.
        dimension: crate::Dimension,
        /// What was asked for.
        asked: usize,
    },
    /// The shift does not fit.
    #[error(transparent)]
    Config(#[from] ConfigError),
}

impl Definition {
    /// The problem with the usual number of components.
    pub fn usual(&'static self) -> TestProblem {
        self.build(self.dimension.usual())
    }

    /// The problem with `n` components.
    ///
    /// # Errors
    /// When the function is not defined for `n` components.
    pub fn in_dimension(&'static self, n: usize) -> Result<TestProblem, ProblemError> {
        if self.dimension.admits(n) {
            return Ok(self.build(n));
        }
        let (name, dimension) = (self.name, self.dimension);
        Err(ProblemError::Dimension { name, dimension, asked: n })
    }

    fn build(&'static self, n: usize) -> TestProblem {
        let (lower, upper) = self.limits;
        let domain = Domain::cube(n, lower, upper).expect("limits in this crate are valid");
        let optimum = (self.optimum)(n);
        TestProblem { definition: self, domain, shift: None, noise: None, optimum }
    }
}

impl TestProblem {
    /// What is known of the function.
    pub fn definition(&self) -> &'static Definition {
        self.definition
    }

    /// A position with the smallest cost.
    pub fn optimum(&self) -> &[f64] {
        &self.optimum
    }

    /// The smallest cost, without noise.
    pub fn optimal_cost(&self) -> f64 {
        (self.definition.cost)(&(self.definition.optimum)(self.domain.dimension()))
    }

    /// The cost at which a run counts as successful.
    pub fn target(&self) -> f64 {
        self.optimal_cost() + self.definition.tolerance
    }

    /// Moves the optimum by `shift`.
    ///
    /// # Errors
    /// When `shift` has not one entry per component.
    pub fn with_shift(mut self, shift: Vec<f64>) -> Result<Self, ProblemError> {
        let expected = self.domain.dimension();
        if shift.len() != expected {
            let found = shift.len();
            return Err(ConfigError::Length { what: "shift", found, expected }.into());
        }
        let unmoved = (self.definition.optimum)(expected);
        self.optimum = unmoved.iter().zip(&shift).map(|(z, s)| self.moved(z + s)).collect();
        self.shift = Some(shift);
        Ok(self)
    }

    /// Moves the optimum to a place drawn uniformly from the middle four fifths of the domain.
    #[must_use]
    pub fn with_random_shift(self, seed: u64) -> Self {
        let mut rng = Streams::new(seed, Purpose::Trial, 0).stream(0);
        let (lower, upper) = self.definition.limits;
        let unmoved = (self.definition.optimum)(self.domain.dimension());
        let place =
            |rng: &mut _| lower + (upper - lower) * (0.1 + 0.8 * random::uniform::<f64>(rng));
        let shift = unmoved.iter().map(|z| place(&mut rng) - z).collect();
        self.with_shift(shift).expect("the shift has the problem's dimension")
    }

    /// Adds a number from N(0, 1) to every cost. The number is a function of `seed` and of the
    /// position, so that a noisy run can be repeated too.
    #[must_use]
    pub fn with_noise(mut self, seed: u64) -> Self {
        self.noise = Some(seed);
        self
    }

    /// Whether noise was added.
    pub fn is_noisy(&self) -> bool {
        self.noise.is_some()
    }

    /// A component after a shift: as it is, or wrapped into the domain.
    fn moved(&self, z: f64) -> f64 {
        let (lower, upper) = self.definition.limits;
        match self.definition.shift {
            Shift::Wrap if z < lower || z >= upper => lower + (z - lower).rem_euclid(upper - lower),
            _ => z,
        }
    }

    fn noise(&self, z: &[f64]) -> f64 {
        let Some(seed) = self.noise else { return 0.0 };
        random::normal(&mut stream_at(seed, z))
    }
}

impl Problem for TestProblem {
    fn domain(&self) -> &Domain {
        &self.domain
    }

    fn evaluate(&self, z: &[f64]) -> f64 {
        let cost = match &self.shift {
            None => (self.definition.cost)(z),
            Some(shift) => {
                let unmoved: Vec<f64> =
                    z.iter().zip(shift).map(|(z, s)| self.moved(z - s)).collect();
                (self.definition.cost)(&unmoved)
            }
        };
        cost + self.noise(z)
    }

    fn identity(&self) -> String {
        let name = self.definition.name;
        let shift = self.shift.as_ref().map(|_| format!(", optimum at {:?}", self.optimum));
        let noise = self.noise.map(|seed| format!(", noise of seed {seed}"));
        let [shift, noise] = [shift, noise].map(Option::unwrap_or_default);
        format!("{name} in {} components{shift}{noise}", self.optimum.len())
    }
}
