//! A population of individuals by AEP's rules.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

use super::{Ingredient, Lineages};
use crate::random::{self, Stream, Streams};
use crate::{
    Aep, AepIndividual, AepMutation, AgeLimit, Algorithm, Border, Child, ConfigError, Domain,
    Engine, Mutation, OneToOne, Population, Selection, Start, Tournament,
};

/// Generations without a better best after which a population ends.
const MOST_AGE: u64 = 100;
/// Relative difference of costs below which they no longer differ.
const FLAT: f64 = 1e-12;

/// [`Aep::practical`] on the unit cube, until it no longer gets anywhere.
#[derive(Debug)]
pub(super) struct Companions {
    origin: Origin,
    engine: Engine<f64, Rules, Contest>,
    evaluations: u64,
    best: f64,
    age: u64,
}

/// What a population is built from.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Origin {
    dimension: usize,
    size: usize,
    seed: u64,
    left_out: Vec<Ingredient>,
}

impl Companions {
    pub fn new(
        config: &Lineages,
        dimension: usize,
        size: usize,
        seed: u64,
    ) -> Result<Self, ConfigError> {
        Self::from(Origin { dimension, size, seed, left_out: config.left_out.clone() })
    }

    fn from(origin: Origin) -> Result<Self, ConfigError> {
        let uses = |ingredient| !origin.left_out.contains(&ingredient);
        let mut aep = Aep::practical();
        if !uses(Ingredient::Age) {
            aep = aep.with_age_limit(AgeLimit::Saturate(1));
        }
        let rules =
            Rules { mutation: AepMutation::new(aep), directed: uses(Ingredient::Direction) };
        let contest = Contest { with_parent: uses(Ingredient::Contest) };
        let cube = Domain::cube(origin.dimension, 0.0, 1.0)?;
        let start = Start::new(&cube, origin.seed);
        let engine = Engine::new("companions", &start, origin.size, rules, contest)?;
        Ok(Self { origin, engine, evaluations: 0, best: f64::INFINITY, age: 0 })
    }

    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    pub fn ask(&mut self, points: &mut Vec<f64>) {
        points.extend_from_slice(self.engine.ask().as_slice());
    }

    /// Takes the costs of what was asked, as many as that was.
    pub fn tell(&mut self, costs: &[f64]) {
        // Cannot be refused: the run has counted them.
        let _ = self.engine.tell(costs);
        self.evaluations += costs.len() as u64;
        let best = self.engine.best().map_or(f64::INFINITY, |best| best.cost);
        self.age = if best < self.best { 0 } else { self.age + 1 };
        self.best = best;
    }

    /// Whether it gets nowhere, or no longer below `lowest`.
    pub fn ended(&self, config: &Lineages, lowest: f64) -> bool {
        let costs = self.engine.population().costs.iter().filter(|cost| cost.is_finite());
        let range = costs.fold(f64::NEG_INFINITY, |most, cost| most.max(*cost)) - self.best;
        let flat = range <= FLAT * self.best.abs().min(1.0);
        let beaten = config.uses(Ingredient::Contest) && range < BEATEN * (self.best - lowest);
        flat || beaten || self.age > MOST_AGE
    }
}

/// Range of a population's costs, in what it is behind, from which on it is given up. Less than a lineage's: the
/// range is that of its latest survivors, not of all its children.
const BEATEN: f64 = 0.1;

impl Serialize for Companions {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let engine = self.engine.save().map_err(serde::ser::Error::custom)?;
        (&self.origin, engine, self.evaluations, self.best, self.age).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Companions {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let saved = <(Origin, Vec<u8>, u64, f64, u64)>::deserialize(deserializer)?;
        let (origin, engine, evaluations, best, age) = saved;
        let mut companions = Self::from(origin).map_err(D::Error::custom)?;
        companions.engine.restore(&engine).map_err(D::Error::custom)?;
        Ok(Self { evaluations, best, age, ..companions })
    }
}

/// The mutation of AEP, its direction left out where that is asked.
#[derive(Debug)]
struct Rules {
    mutation: AepMutation<f64>,
    directed: bool,
}

impl Mutation<f64> for Rules {
    type Individual = AepIndividual;

    fn individual(&self, domain: &Domain, rng: &mut Stream) -> AepIndividual {
        self.mutation.individual(domain, rng)
    }

    fn prepare(&mut self, population: &Population<f64, AepIndividual>, domain: &Domain) {
        self.mutation.prepare(population, domain);
    }

    fn mutate(
        &self,
        parent: usize,
        population: &Population<f64, AepIndividual>,
        domain: &Domain,
        rng: &mut Stream,
        child: Child<'_, f64, AepIndividual>,
    ) {
        let Child { position, individual } = child;
        let made = Child { position: &mut *position, individual };
        self.mutation.mutate(parent, population, domain, rng, made);
        let young = population.individuals[parent].age() == 1;
        if !self.directed && young && random::coin(rng) {
            let base = population.positions.row(parent);
            position.iter_mut().zip(base).for_each(|(x, base)| *x = base + base - *x);
            let limits = (domain.search_lower(), domain.search_upper());
            Border::Reflect.settle(position, base, limits, |j| base[j]);
        }
    }
}

/// Child against parent, or all against all.
#[derive(Debug)]
struct Contest {
    with_parent: bool,
}

impl Selection<f64, AepIndividual> for Contest {
    fn select(
        &self,
        parents: &mut Population<f64, AepIndividual>,
        children: &mut Population<f64, AepIndividual>,
        streams: Streams,
    ) {
        if self.with_parent {
            OneToOne::Strict.select(parents, children, streams);
        } else {
            Tournament::default().select(parents, children, streams);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checkpoint;

    #[test]
    fn a_population_goes_on_from_its_bytes() {
        let cost = |x: &[f64]| x.iter().map(|x| (x - 0.4).powi(2)).sum::<f64>();
        let step = |companions: &mut Companions| {
            let mut points = Vec::new();
            companions.ask(&mut points);
            let costs: Vec<f64> = points.chunks(2).map(cost).collect();
            companions.tell(&costs);
            points
        };
        let mut whole = Companions::new(&Lineages::default(), 2, 10, 3).unwrap();
        (0..5).for_each(|_| drop(step(&mut whole)));
        let bytes = checkpoint::encode(&whole).unwrap();
        let mut again: Companions = checkpoint::decode(&bytes).unwrap();
        assert_eq!(step(&mut whole), step(&mut again));
        assert_eq!(whole.evaluations(), again.evaluations());
    }
}
