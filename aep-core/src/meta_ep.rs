//! Meta evolutionary programming with log-normal self-adaptation.

use serde::{Deserialize, Serialize};

use crate::random::{self, Stream};
use crate::{
    Algorithm, Border, Child, ConfigError, Domain, Engine, Individual, Method, Mutation,
    Population, Scalar, Start, Tournament,
};

/// Which of position and step size is mutated first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UpdateOrder {
    /// The parent's step size moves the position, then mutates (habit of evolutionary programming).
    PositionFirst,
    /// The step size mutates, the new one moves the position (habit of evolution strategies).
    SigmaFirst,
}

/// What the step size at the start is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SigmaUnit {
    /// As it is, by the paper.
    Absolute,
    /// In widths of the domain (in search coordinates), per component.
    Domain,
}

/// What counts as n in the learning rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LearningRate {
    /// The number of components.
    Dimension,
    /// The population size, as the paper prints for f5.
    Population,
}

/// Evolutionary programming with log-normal step sizes ("meta-EP", the paper's `MetaLN EP`),
/// its yardstick.
///
/// Individual: position z and one step size `sigma_j` per component. With one N common to all
/// components and one `N_j` each,
///
/// `z'_j` = `z_j` + `sigma_j` `N_j`(0, 1),
/// `sigma'_j` = `sigma_j` exp(tau' N(0, 1) + tau `N_j`(0, 1)),
/// tau = 1 / sqrt(2 sqrt n), tau' = 1 / sqrt(2 n).
///
/// Each parent has one child; a [`Tournament`] over parents and children selects.
///
/// | setting | paper | meaning |
/// |---|---|---|
/// | population | 40 | individuals |
/// | `sigma` | 2.5 (f4: 0.25; f5: also 30) | step size at the start |
/// | `tournament.opponents` | 10 | encounters of each candidate |
/// | [`UpdateOrder`], [`Border`], ties | not said | readings of the paper's text |
///
/// **Limits.** Step sizes can shrink faster than the distance to the optimum and then stall; the
/// start value matters (the paper's f5). [`SigmaUnit::Domain`] makes it relative to the domain.
///
/// Reference: N. Saravanan, D. B. Fogel, "Learning Strategy Parameters in Evolutionary Programming:
/// An Empirical Study", Proc. 3rd Annual Conference on Evolutionary Programming, 1994.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MetaEp {
    /// Number of individuals.
    pub population: usize,
    /// Step size at the start, in units of `unit`.
    pub sigma: f64,
    /// What the step size at the start is measured in.
    pub unit: SigmaUnit,
    /// Which is mutated first.
    pub order: UpdateOrder,
    /// What counts as n in tau and tau'.
    pub learning_rate: LearningRate,
    /// Which rate is common to all components.
    pub common_rate: CommonRate,
    /// What happens outside the domain.
    pub border: Border,
    /// Who survives.
    pub opponents: usize,
    /// Order of candidates with equally many wins.
    pub ties: crate::Ties,
}

/// Which of the two learning rates belongs to the number common to all components.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CommonRate {
    /// tau' = 1 / sqrt(2 n), the smaller one (Baeck & Schwefel 1993).
    TauPrime,
    /// tau = 1 / sqrt(2 sqrt n), the larger one.
    Tau,
}

impl MetaEp {
    /// The paper's settings, in the reading that comes closest to its printed results.
    pub fn paper() -> Self {
        Self {
            population: 40,
            sigma: 2.5,
            unit: SigmaUnit::Absolute,
            order: UpdateOrder::PositionFirst,
            learning_rate: LearningRate::Dimension,
            common_rate: CommonRate::Tau,
            border: Border::Reflect,
            opponents: 10,
            ties: crate::Ties::Cost,
        }
    }

    /// Settings for real tasks: the first steps are a fifth of the domain in every component.
    pub fn practical() -> Self {
        Self { sigma: 0.2, unit: SigmaUnit::Domain, ..Self::paper() }
    }

    /// The same with another population size.
    #[must_use]
    pub fn with_population(self, population: usize) -> Self {
        Self { population, ..self }
    }

    /// The same with another step size at the start.
    #[must_use]
    pub fn with_sigma(self, sigma: f64) -> Self {
        Self { sigma, ..self }
    }

    /// The same with another order of the two mutations.
    #[must_use]
    pub fn with_order(self, order: UpdateOrder) -> Self {
        Self { order, ..self }
    }

    /// The same with another border.
    #[must_use]
    pub fn with_border(self, border: Border) -> Self {
        Self { border, ..self }
    }

    /// The same with another rate common to all components.
    #[must_use]
    pub fn with_common_rate(self, common_rate: CommonRate) -> Self {
        Self { common_rate, ..self }
    }

    /// The same with another n in the learning rates.
    #[must_use]
    pub fn with_learning_rate(self, learning_rate: LearningRate) -> Self {
        Self { learning_rate, ..self }
    }

    fn check(&self) -> Result<(), ConfigError> {
        let valid = self.sigma > 0.0 && self.sigma.is_finite();
        let hint = "must be positive and finite";
        ConfigError::require(valid, "meta-ep", "sigma", self.sigma, hint)
    }
}

impl<T: Scalar> Method<T> for MetaEp {
    fn name(&self) -> String {
        let practical = *self == Self::practical().with_population(self.population);
        if practical { "meta-ep-practical".into() } else { "meta-ep".into() }
    }

    fn start(&self, start: &Start<'_, T>) -> Result<Box<dyn Algorithm<T>>, ConfigError> {
        self.check()?;
        let selection = Tournament { opponents: self.opponents, ties: self.ties };
        let mutation = MetaEpMutation::new(self.clone(), start.domain.dimension());
        let engine = Engine::new("meta-ep", start, self.population, mutation, selection)?;
        Ok(Box::new(engine.with_configuration(self)))
    }
}

/// Step sizes, one per component, in search coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct StepSizes<T: Scalar>(pub Vec<T>);

impl<T: Scalar> Individual<T> for StepSizes<T> {
    fn fits(&self, dimension: usize) -> bool {
        self.0.len() == dimension
    }
}

/// The mutation of [`MetaEp`].
#[derive(Clone, Debug)]
pub struct MetaEpMutation<T> {
    config: MetaEp,
    /// Of one component's own number.
    rate: T,
    /// Of the number common to all components.
    common_rate: T,
}

impl<T: Scalar> MetaEpMutation<T> {
    /// The mutation that `config` describes, for `dimension` components.
    pub fn new(config: MetaEp, dimension: usize) -> Self {
        let n = match config.learning_rate {
            LearningRate::Dimension => dimension as f64,
            LearningRate::Population => config.population as f64,
        };
        let (tau, tau_prime) = ((2.0 * n.sqrt()).sqrt().recip(), (2.0 * n).sqrt().recip());
        let (own, common) = match config.common_rate {
            CommonRate::TauPrime => (tau, tau_prime),
            CommonRate::Tau => (tau_prime, tau),
        };
        Self { config, rate: T::of(own), common_rate: T::of(common) }
    }
}

impl<T: Scalar> Mutation<T> for MetaEpMutation<T> {
    type Individual = StepSizes<T>;

    fn individual(&self, domain: &Domain<T>, _: &mut Stream) -> StepSizes<T> {
        let limits = domain.search_lower().iter().zip(domain.search_upper());
        let unit = |(lo, hi): (&T, &T)| match self.config.unit {
            SigmaUnit::Domain => *hi - *lo,
            SigmaUnit::Absolute => T::one(),
        };
        StepSizes(limits.map(|limits| unit(limits) * T::of(self.config.sigma)).collect())
    }

    fn mutate(
        &self,
        parent: usize,
        population: &Population<T, StepSizes<T>>,
        domain: &Domain<T>,
        rng: &mut Stream,
        child: Child<'_, T, StepSizes<T>>,
    ) {
        let base = population.positions.row(parent);
        let sigma = &population.individuals[parent].0;
        let common = self.common_rate * random::normal::<T>(rng);
        let (position, mutated) = (child.position, &mut child.individual.0);
        for j in 0..base.len() {
            mutated[j] = sigma[j] * (common + self.rate * random::normal::<T>(rng)).exp();
        }
        let moving = match self.config.order {
            UpdateOrder::PositionFirst => sigma,
            UpdateOrder::SigmaFirst => &*mutated,
        };
        random::fill_normal(rng, position);
        for j in 0..base.len() {
            position[j] = base[j] + moving[j] * position[j];
        }
        let limits = (domain.search_lower(), domain.search_upper());
        let again = |j: usize| base[j] + moving[j] * random::normal::<T>(rng);
        self.config.border.settle(position, base, limits, again);
    }
}
