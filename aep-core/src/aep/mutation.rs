//! Rule 2: how an AEP child is made.

use super::step::{Steps, add_scaled};
use super::{Aep, AepIndividual, AgeLimit, Components, Division, Spread, StepUnit};
use crate::random::{self, Stream};
use crate::wide;
use crate::{Child, Domain, Mutation, Population, Scalar};

/// The mutation of AEP, as configured by [`Aep`].
#[derive(Clone, Debug)]
pub struct AepMutation<T: Scalar> {
    config: Aep,
    steps: Steps<T>,
}

impl<T: Scalar> AepMutation<T> {
    /// The mutation that `config` describes.
    pub fn new(config: Aep) -> Self {
        let steps = Steps::new(config.step_scale);
        Self { config, steps }
    }

    /// Length of a step of an individual with this cost and age, in step units.
    fn sigma(&self, cost: T, age: u32, dimension: usize) -> T {
        let scale = self.steps.scale(cost);
        let s = if age == 1 {
            T::of(self.config.beta1) * scale
        } else {
            T::of(self.config.beta2) * scale * T::of(f64::from(self.counted_age(age)))
        };
        let s = match self.config.division {
            Division::Whole => s,
            Division::PerComponent => s / T::of(dimension as f64),
        };
        match self.config.spread {
            Spread::StandardDeviation => s,
            Spread::Variance => s.sqrt(),
        }
    }

    fn counted_age(&self, age: u32) -> u32 {
        match self.config.age_limit {
            AgeLimit::Unlimited => age,
            AgeLimit::Saturate(limit) | AgeLimit::Adopt(limit) => age.min(limit),
        }
    }

    /// Whose position the child starts from, and the age that its step is made with.
    fn ancestor<I>(
        &self,
        parent: usize,
        age: u32,
        population: &Population<T, I>,
        rng: &mut Stream,
    ) -> (usize, u32) {
        match self.config.age_limit {
            AgeLimit::Adopt(limit) if age > limit => {
                let other = random::index(rng, population.len());
                let better = population.costs[other] < population.costs[parent];
                if better { (other, 2) } else { (parent, limit) }
            }
            _ => (parent, age),
        }
    }
}

impl<T: Scalar> Mutation<T> for AepMutation<T> {
    type Individual = AepIndividual;

    fn individual(&self, domain: &Domain<T>, rng: &mut Stream) -> AepIndividual {
        AepIndividual::random(domain.dimension(), rng)
    }

    fn prepare(&mut self, population: &Population<T, AepIndividual>, domain: &Domain<T>) {
        self.steps.update((self.config.step_scale, self.config.step_unit), population, domain);
    }

    /// An individual without a finite cost has no step length: its child is drawn uniformly in the
    /// domain.
    fn mutate(
        &self,
        parent: usize,
        population: &Population<T, AepIndividual>,
        domain: &Domain<T>,
        rng: &mut Stream,
        child: Child<'_, T, AepIndividual>,
    ) {
        let own = &population.individuals[parent];
        child.individual.copy_from(own);
        let (ancestor, age) = self.ancestor(parent, own.age(), population, rng);
        let cost = population.costs[ancestor];
        if !cost.is_finite() {
            return domain.sample(rng, child.position);
        }
        let sigma = self.sigma(cost, age, domain.dimension());
        let base = population.positions.row(ancestor);
        let directions = (age == 1).then(|| own.directions());
        let step = Step { base, directions, sigma, domain };
        match self.config.step_unit {
            StepUnit::Covariance { .. } => self.move_together(&step, rng, child.position),
            _ => self.move_components(&step, rng, child.position),
        }
        self.keep_components(base, rng, child.position);
    }
}

/// One step to be made.
struct Step<'a, T: Scalar> {
    base: &'a [T],
    /// Given at age 1.
    directions: Option<&'a [i8]>,
    sigma: T,
    domain: &'a Domain<T>,
}

impl<T: Scalar> AepMutation<T> {
    /// Every component by itself.
    #[inline]
    fn move_components(&self, step: &Step<'_, T>, rng: &mut Stream, child: &mut [T]) {
        let n = child.len();
        let (base, units) = (&step.base[..n], &self.steps.units[..n]);
        random::fill_normal(rng, child);
        match step.directions {
            None => wide::step(child, base, units, step.sigma),
            Some(directions) => wide::step_along(child, base, units, step.sigma, directions),
        }
        self.settle(step, step.sigma, rng, child);
    }

    /// All components by one vector from N(0, sigma^2 C).
    fn move_together(&self, step: &Step<'_, T>, rng: &mut Stream, child: &mut [T]) {
        child.fill(T::zero());
        for deviation in self.steps.deviations.chunks_exact(child.len()) {
            add_scaled(child, deviation, random::normal::<T>(rng));
        }
        let against = step.directions.is_some_and(|d| self.along(child, d) < T::zero());
        let sigma = if against { -step.sigma } else { step.sigma };
        for (child, base) in child.iter_mut().zip(step.base) {
            *child = *base + sigma * *child;
        }
        self.settle(step, sigma, rng, child);
    }

    /// Treats the components that left the domain; a repeated step keeps its direction.
    #[inline]
    fn settle(&self, step: &Step<'_, T>, sigma: T, rng: &mut Stream, child: &mut [T]) {
        let limits = (step.domain.search_lower(), step.domain.search_upper());
        self.config.border.settle(child, step.base, limits, |j| {
            let length = sigma * self.steps.units[j] * random::normal::<T>(rng);
            let length = match step.directions {
                Some(directions) => length.abs() * T::of(f64::from(directions[j])),
                None => length,
            };
            step.base[j] + length
        });
    }

    /// How far a vector points along the directions, every component in its own unit.
    fn along(&self, vector: &[T], directions: &[i8]) -> T {
        let units = self.steps.units.iter();
        vector.iter().zip(directions).zip(units).fold(T::zero(), |sum, ((v, d), unit)| {
            let length = if *unit > T::zero() { *v / *unit } else { T::zero() };
            sum + if *d < 0 { -length } else { length }
        })
    }

    /// Takes back the move of the components that are not to change.
    #[inline]
    fn keep_components(&self, base: &[T], rng: &mut Stream, child: &mut [T]) {
        let Components::Mixed { probability, share } = self.config.components else { return };
        if random::uniform::<f64>(rng) >= probability {
            return;
        }
        let certain = random::index(rng, base.len());
        for (j, (child, base)) in child.iter_mut().zip(base).enumerate() {
            if j != certain && random::uniform::<f64>(rng) >= share {
                *child = *base;
            }
        }
    }
}
