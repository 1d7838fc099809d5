//! Differential evolution, as a yardstick.

use serde::{Deserialize, Serialize};

use crate::random::{self, Stream};
use crate::steady_state::OneByOne;
use crate::{
    Algorithm, Border, Child, ConfigError, Domain, Engine, Individual, Method, Mutation, OneToOne,
    Population, Scalar, Start, StartedSteadyState,
};

/// Where the factors F and CR come from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Control {
    /// The same for all (Storn & Price 1997).
    Fixed {
        /// Factor of the difference, in (0, 2].
        factor: f64,
        /// Probability that a component comes from the mutant, in [0, 1].
        crossover: f64,
    },
    /// Each individual carries its own and draws new ones with probability 0.1: F uniform in
    /// [0.1, 1], CR uniform in [0, 1] (jDE, Brest et al. 2006).
    SelfAdaptive,
}

/// Differential evolution, DE/rand/1/bin.
///
/// mutant = `z_a` + F (`z_b` - `z_c`) with three different individuals a, b, c drawn at random, none of
/// them the parent; each component of the child comes from the mutant with probability CR, at
/// least one does. The better of parent and child stays, the child on a tie.
///
/// | setting | default | meaning |
/// |---|---|---|
/// | population | 40 | individuals, at least 4 |
/// | [`Control`] | self-adaptive | F and CR |
/// | [`Border`] | reflect | what happens outside the domain |
///
/// **Limits.** Population-wide steps need all individuals to follow: slow in more than some 30
/// components, and stuck once the population has lost its spread.
///
/// References: R. Storn, K. Price, J. Global Optimization 11, 1997; J. Brest et al., IEEE Trans.
/// Evolutionary Computation 10(6), 2006.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct De {
    /// Number of individuals.
    pub population: usize,
    /// Where F and CR come from.
    pub control: Control,
    /// What happens outside the domain.
    pub border: Border,
}

impl Default for De {
    fn default() -> Self {
        Self { population: 40, control: Control::SelfAdaptive, border: Border::Reflect }
    }
}

impl De {
    /// The same with another population size.
    #[must_use]
    pub fn with_population(self, population: usize) -> Self {
        Self { population, ..self }
    }

    /// The same with fixed factors.
    #[must_use]
    pub fn with_fixed(self, factor: f64, crossover: f64) -> Self {
        Self { control: Control::Fixed { factor, crossover }, ..self }
    }

    fn check(&self) -> Result<(), ConfigError> {
        let count = self.population as f64;
        let hint = "differences need at least four individuals";
        ConfigError::require(self.population >= 4, "de", "population", count, hint)?;
        if let Control::Fixed { factor, crossover } = self.control {
            let valid = factor > 0.0 && factor <= 2.0;
            ConfigError::require(valid, "de", "factor", factor, "must be in (0, 2]")?;
            let valid = (0.0..=1.0).contains(&crossover);
            ConfigError::require(valid, "de", "crossover", crossover, "must be in [0, 1]")?;
        }
        Ok(())
    }
}

impl<T: Scalar> Method<T> for De {
    fn name(&self) -> String {
        match self.control {
            Control::SelfAdaptive => "de".into(),
            Control::Fixed { .. } => "de-fixed".into(),
        }
    }

    fn start(&self, start: &Start<'_, T>) -> Result<Box<dyn Algorithm<T>>, ConfigError> {
        self.check()?;
        let selection = OneToOne::AcceptEqual;
        let engine = Engine::new("de", start, self.population, self.clone(), selection)?;
        Ok(Box::new(engine.with_configuration(self)))
    }

    fn start_steady_state(&self, start: &Start<'_, T>) -> Option<StartedSteadyState<T>> {
        let rules = (self.clone(), OneToOne::AcceptEqual);
        let run = || -> StartedSteadyState<T> {
            self.check()?;
            Ok(Box::new(OneByOne::new("de", start, self.population, rules, self)?))
        };
        Some(run())
    }
}

/// The factors that an individual was made with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Factors<T: Scalar> {
    /// Factor of the difference, F.
    pub factor: T,
    /// Crossover probability, CR.
    pub crossover: T,
}

impl<T: Scalar> Individual<T> for Factors<T> {}

impl De {
    fn factors<T: Scalar>(&self, parent: Factors<T>, rng: &mut Stream) -> Factors<T> {
        let Control::SelfAdaptive = self.control else { return parent };
        let renew = |rng: &mut Stream| random::uniform::<f64>(rng) < 0.1;
        let factor =
            if renew(rng) { T::of(0.1 + 0.9 * random::uniform::<f64>(rng)) } else { parent.factor };
        let crossover = if renew(rng) { random::uniform(rng) } else { parent.crossover };
        Factors { factor, crossover }
    }
}

/// Three different slots, none of them `parent`.
fn three_others(parent: usize, count: usize, rng: &mut Stream) -> [usize; 3] {
    let mut chosen = [parent; 3];
    for k in 0..3 {
        while chosen[k] == parent || chosen[..k].contains(&chosen[k]) {
            chosen[k] = random::index(rng, count);
        }
    }
    chosen
}

impl<T: Scalar> Mutation<T> for De {
    type Individual = Factors<T>;

    fn individual(&self, _: &Domain<T>, _: &mut Stream) -> Factors<T> {
        let (factor, crossover) = match self.control {
            Control::Fixed { factor, crossover } => (factor, crossover),
            Control::SelfAdaptive => (0.5, 0.9),
        };
        Factors { factor: T::of(factor), crossover: T::of(crossover) }
    }

    fn mutate(
        &self,
        parent: usize,
        population: &Population<T, Factors<T>>,
        domain: &Domain<T>,
        rng: &mut Stream,
        child: Child<'_, T, Factors<T>>,
    ) {
        let factors = self.factors(population.individuals[parent], rng);
        *child.individual = factors;
        let [a, b, c] = three_others(parent, population.len(), rng);
        let row = |i| population.positions.row(i);
        let (own, a, b, c) = (row(parent), row(a), row(b), row(c));
        let certain = random::index(rng, own.len());
        for j in 0..own.len() {
            let crossed = j == certain || random::uniform::<T>(rng) < factors.crossover;
            child.position[j] =
                if crossed { a[j] + factors.factor * (b[j] - c[j]) } else { own[j] };
        }
        let limits = (domain.search_lower(), domain.search_upper());
        // Without randomness of its own a component cannot be drawn again; a random place does the
        // same service.
        self.border.settle(child.position, own, limits, |j| {
            limits.0[j] + (limits.1[j] - limits.0[j]) * random::uniform(rng)
        });
    }
}
