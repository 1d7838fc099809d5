//! Accelerated evolutionary programming.

mod individual;
mod mutation;
mod step;

use serde::{Deserialize, Serialize};

pub use individual::AepIndividual;
pub use mutation::AepMutation;
pub use step::{AgeLimit, Components, Division, Spread, StepScale, StepUnit};

use crate::steady_state::OneByOne;
use crate::{
    Algorithm, Border, ConfigError, Engine, Method, OneToOne, Scalar, Start, StartedSteadyState,
};

/// Accelerated evolutionary programming (AEP): direction memory, age, one-to-one competition.
///
/// Individual i is a position z, a direction `d_j` in {-1, +1} per component and an age. It starts
/// with z uniform in the domain, d random and age 1.
///
/// - **Rule 1.** If the child beat its parent: `d_j` = sgn(`child_j` - `parent_j`), age = 1.
///   Otherwise age grows by 1.
/// - **Rule 2.** With age = 1: `child_j` = `z_j` + `d_j` |N(0, s)|, s = beta1 f(z).
///   With age > 1: `child_j` = `z_j` + N(0, s), s = beta2 f(z) age.
/// - Each parent has one child; the better of the two stays.
///
/// | setting | paper | meaning |
/// |---|---|---|
/// | population | 40 | individuals |
/// | `beta1` | 5 | step factor after a success |
/// | `beta2` | 0.05 | step factor after failures, times age |
/// | [`Spread`], [`Division`], [`Border`] | not said | readings of the paper's text |
/// | [`StepScale`], [`StepUnit`], [`Components`], [`AgeLimit`] | cost, absolute, all, unlimited | variants for real tasks |
///
/// **Limits.** By the paper's rules the step is proportional to the cost (or its root): the method
/// converges only where the smallest cost is 0, its steps have the same length in every component,
/// and it knows no correlation between components. [`Aep::practical`] removes all three.
///
/// Reference: J.-H. Kim, H.-K. Chae, J.-Y. Jeon, S.-W. Lee, "Identification and Control of Systems
/// with Friction Using Accelerated Evolutionary Programming", IEEE Control Systems Magazine, 1996.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Aep {
    /// Number of individuals.
    pub population: usize,
    /// Step factor at age 1.
    pub beta1: f64,
    /// Step factor at higher ages.
    pub beta2: f64,
    /// What s is in N(0, s).
    pub spread: Spread,
    /// Whether s is divided by the number of components.
    pub division: Division,
    /// What happens outside the domain.
    pub border: Border,
    /// What takes the place of the cost in s.
    pub step_scale: StepScale,
    /// What a step is measured in.
    pub step_unit: StepUnit,
    /// Which components of a child move.
    pub components: Components,
    /// What happens at high age.
    pub age_limit: AgeLimit,
}

impl Aep {
    /// The paper's rules and settings, in the reading that comes closest to its printed results.
    pub fn paper() -> Self {
        Self {
            population: 40,
            beta1: 5.0,
            beta2: 0.05,
            spread: Spread::Variance,
            division: Division::PerComponent,
            border: Border::Reflect,
            step_scale: StepScale::Cost,
            step_unit: StepUnit::Absolute,
            components: Components::All,
            age_limit: AgeLimit::Unlimited,
        }
    }

    /// Settings for real tasks: costs whose smallest value is not 0, parameters that differ in
    /// magnitude and only change well together, several minima.
    ///
    /// The paper's frame (age, direction, one-to-one competition) with three documented changes:
    /// steps come from the covariance of the better three quarters of the population in place of
    /// the cost ([`StepScale::Constant`], [`StepUnit::Covariance`]); an individual older than 3
    /// generations has its next children from a better one ([`AgeLimit::Adopt`]); half of the
    /// children change only a fifth of their components ([`Components::Mixed`]).
    pub fn practical() -> Self {
        Self {
            beta1: 1.0,
            beta2: 0.5,
            spread: Spread::StandardDeviation,
            division: Division::Whole,
            step_scale: StepScale::Constant,
            step_unit: StepUnit::Covariance { share: 0.75 },
            components: Components::Mixed { probability: 0.5, share: 0.2 },
            age_limit: AgeLimit::Adopt(3),
            ..Self::paper()
        }
    }

    /// The same with another population size.
    #[must_use]
    pub fn with_population(self, population: usize) -> Self {
        Self { population, ..self }
    }

    /// The same with other step factors.
    #[must_use]
    pub fn with_beta(self, beta1: f64, beta2: f64) -> Self {
        Self { beta1, beta2, ..self }
    }

    /// The same with another reading of N(0, s).
    #[must_use]
    pub fn with_spread(self, spread: Spread, division: Division) -> Self {
        Self { spread, division, ..self }
    }

    /// The same with another border.
    #[must_use]
    pub fn with_border(self, border: Border) -> Self {
        Self { border, ..self }
    }

    /// The same with another step scale and unit.
    #[must_use]
    pub fn with_steps(self, step_scale: StepScale, step_unit: StepUnit) -> Self {
        Self { step_scale, step_unit, ..self }
    }

    /// The same with another choice of components.
    #[must_use]
    pub fn with_components(self, components: Components) -> Self {
        Self { components, ..self }
    }

    /// The same with another age limit.
    #[must_use]
    pub fn with_age_limit(self, age_limit: AgeLimit) -> Self {
        Self { age_limit, ..self }
    }

    fn check(&self) -> Result<(), ConfigError> {
        let check =
            |valid, setting, value, hint| ConfigError::require(valid, "aep", setting, value, hint);
        for (setting, value) in [("beta1", self.beta1), ("beta2", self.beta2)] {
            let valid = value > 0.0 && value.is_finite();
            check(valid, setting, value, "must be positive and finite")?;
        }
        match self.step_scale {
            StepScale::AboveReference(value) => {
                check(value.is_finite(), "reference", value, "must be finite")?;
            }
            StepScale::Relative { floor } => {
                let valid = floor >= 0.0 && floor.is_finite();
                check(valid, "floor", floor, "must be 0 or positive")?;
            }
            StepScale::Cost | StepScale::Constant => {}
        }
        if let StepUnit::Population { share } | StepUnit::Covariance { share } = self.step_unit {
            check(share > 0.0 && share <= 1.0, "share", share, "must be in (0, 1]")?;
        }
        if let Components::Mixed { probability, share } = self.components {
            let hint = "must be in [0, 1]";
            check((0.0..=1.0).contains(&probability), "probability", probability, hint)?;
            check((0.0..=1.0).contains(&share), "share of components", share, hint)?;
        }
        Ok(())
    }

    /// A fresh run, as the engine itself: gives access to the population.
    ///
    /// # Errors
    /// When a setting is outside its range or an initial point outside the domain.
    pub fn engine<T: Scalar>(
        &self,
        start: &Start<'_, T>,
    ) -> Result<Engine<T, AepMutation<T>, OneToOne>, ConfigError> {
        self.check()?;
        let mutation = AepMutation::new(self.clone());
        Ok(Engine::new("aep", start, self.population, mutation, OneToOne::Strict)?
            .with_configuration(self))
    }
}

impl<T: Scalar> Method<T> for Aep {
    fn name(&self) -> String {
        let practical = *self == Self::practical().with_population(self.population);
        if practical { "aep-practical".into() } else { "aep".into() }
    }

    fn start(&self, start: &Start<'_, T>) -> Result<Box<dyn Algorithm<T>>, ConfigError> {
        Ok(Box::new(self.engine(start)?))
    }

    fn start_steady_state(&self, start: &Start<'_, T>) -> Option<StartedSteadyState<T>> {
        let rules = (AepMutation::new(self.clone()), OneToOne::Strict);
        let run = || -> StartedSteadyState<T> {
            self.check()?;
            Ok(Box::new(OneByOne::new("aep", start, self.population, rules, self)?))
        };
        Some(run())
    }
}
