//! Rule 2: how an AEP child is made.

use super::step::Steps;
use super::{Aep, AepIndividual, AgeLimit, Division, Spread};
use crate::random::{self, Stream};
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
        Self { config, steps: Steps::new() }
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
        self.move_components(base, directions, sigma, domain, rng, child.position);
    }
}

impl<T: Scalar> AepMutation<T> {
    fn move_components(
        &self,
        base: &[T],
        directions: Option<&[i8]>,
        sigma: T,
        domain: &Domain<T>,
        rng: &mut Stream,
        child: &mut [T],
    ) {
        let n = base.len();
        let (lower, upper) = (&domain.search_lower()[..n], &domain.search_upper()[..n]);
        let (units, child) = (&self.steps.units[..n], &mut child[..n]);
        for j in 0..n {
            let mut propose = || {
                let step = sigma * units[j] * random::normal::<T>(rng);
                match directions {
                    None => base[j] + step,
                    Some(directions) if directions[j] < 0 => base[j] - step.abs(),
                    Some(_) => base[j] + step.abs(),
                }
            };
            let proposal = propose();
            child[j] = self.config.border.settle(proposal, base[j], (lower[j], upper[j]), propose);
        }
    }
}
