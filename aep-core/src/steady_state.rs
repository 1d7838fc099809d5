//! Asynchronous search: a cost is told as soon as it is known, and who is slow holds up nobody.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::best::BestSoFar;
use crate::engine::signature;
use crate::random::{Purpose, Streams};
use crate::{
    Best, CheckpointError, Child, ConfigError, Domain, Individual, Mutation, OneToOne, Points,
    Population, Scalar, Start, TellError,
};

/// An optimizer whose individuals go on by themselves: as soon as the cost of a child is told, its individual may be asked for
/// the next one. [`crate::Method::start_steady_state`] starts one.
///
/// Where a child competes with its own parent only, nothing in a generation waits for anything else in it but the steps, which
/// are measured in the population as it is when a child is made. So the rules stay; what is lost is that a seed fixes the run,
/// which depends on the order in which costs come. With the same order it is the same to the bit.
///
/// ```
/// use aep_core::{Aep, Domain, Method, Start};
///
/// let domain = Domain::cube(3, -6.0, 6.0)?;
/// let mut run = Aep::practical().start_steady_state(&Start::new(&domain, 1)).unwrap()?;
/// // Always three at work; here they come back in the order in which they were sent.
/// let mut away = std::collections::VecDeque::new();
/// while run.told() < 8_000 {
///     while away.len() < 3 {
///         let (individual, x) = run.ask().unwrap();
///         away.push_back((individual, x.iter().map(|v| v * v).sum::<f64>()));
///     }
///     let (individual, cost) = away.pop_front().unwrap();
///     run.tell(individual, cost)?;
/// }
/// assert!(run.best().unwrap().cost < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait SteadyState<T: Scalar = f64>: Send {
    /// Everything that fixes the run but the order of its costs: see [`crate::Algorithm::signature`].
    fn signature(&self) -> String;

    /// The individual whose turn it is and the position to be evaluated for it, in problem coordinates; None while a cost of
    /// every individual is awaited.
    fn ask(&mut self) -> Option<(usize, &[T])>;

    /// The cost of the position that was asked for an individual. What is not finite counts as the worst.
    ///
    /// # Errors
    /// No cost of that individual is awaited; the run is as before then.
    fn tell(&mut self, individual: usize, cost: T) -> Result<(), TellError>;

    /// The best position so far; none before the first finite cost.
    fn best(&self) -> Option<Best<'_, T>>;

    /// Number of individuals, and of costs that can be awaited at the same time.
    fn individuals(&self) -> usize;

    /// Costs told.
    fn told(&self) -> u64;

    /// The whole state, for a checkpoint. Costs that are awaited are not part of it: their positions are made anew.
    ///
    /// # Errors
    /// When the state cannot be encoded.
    fn save(&self) -> Result<Vec<u8>, CheckpointError>;

    /// Takes over a state saved by an optimizer built with the same configuration.
    ///
    /// # Errors
    /// When `state` cannot be decoded or is of another size; the run is as before then.
    fn restore(&mut self, state: &[u8]) -> Result<(), CheckpointError>;
}

/// A mutation and the contest of a child with its parent, one individual at a time.
pub(crate) struct OneByOne<T: Scalar, M: Mutation<T>> {
    signature: String,
    domain: Domain<T>,
    seed: u64,
    mutation: M,
    contest: OneToOne,
    state: State<T, M::Individual>,
    children: Population<T, M::Individual>,
    /// Whose cost is awaited.
    away: Vec<bool>,
    /// The position asked last, in problem coordinates.
    asked: Vec<T>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "I: Individual<T>")]
struct State<T: Scalar, I> {
    parents: Population<T, I>,
    /// Costs told of each individual; 0 while its first position has none.
    told: Vec<u64>,
    /// Who is asked next.
    waiting: VecDeque<usize>,
    best: BestSoFar<T>,
}

impl<T: Scalar, M: Mutation<T>> OneByOne<T, M> {
    /// A run of `count` individuals from `start`, by `configuration`.
    pub fn new(
        name: &str,
        start: &Start<'_, T>,
        count: usize,
        (mutation, contest): (M, OneToOne),
        configuration: impl std::fmt::Debug,
    ) -> Result<Self, ConfigError> {
        let hint = "at least one individual is needed";
        ConfigError::require(count > 0, "engine", "population", count as f64, hint)?;
        let domain = start.domain.clone();
        let positions = start.population(count)?;
        let streams = Streams::new(start.seed, Purpose::Individual, 0);
        let individuals: Vec<_> =
            (0..count).map(|i| mutation.individual(&domain, &mut streams.stream(i))).collect();
        let costs = vec![T::infinity(); count];
        let children = Population {
            positions: Points::zeros(count, domain.dimension()),
            costs: costs.clone(),
            individuals: individuals.clone(),
        };
        let parents = Population { positions, costs, individuals };
        let signature = signature(name, &domain, start.seed, count);
        Ok(Self {
            signature: format!("{signature}, {configuration:?}, asynchronous"),
            seed: start.seed,
            mutation,
            contest,
            state: State {
                parents,
                told: vec![0; count],
                waiting: (0..count).collect(),
                best: BestSoFar::new(domain.dimension()),
            },
            children,
            away: vec![false; count],
            asked: vec![T::zero(); domain.dimension()],
            domain,
        })
    }

    /// A child of individual `i`: its stream is named by how many it has had, so that it draws what it would in generations.
    fn make_child(&mut self, i: usize) {
        let parents = &self.state.parents;
        self.mutation.prepare(parents, &self.domain);
        let streams = Streams::new(self.seed, Purpose::Mutation, self.state.told[i]);
        let position = self.children.positions.row_mut(i);
        let child = Child { position, individual: &mut self.children.individuals[i] };
        self.mutation.mutate(i, parents, &self.domain, &mut streams.stream(i), child);
    }

    /// The position whose cost is awaited of individual `i`, in search coordinates.
    fn pending(&self, i: usize) -> &[T] {
        let first = self.state.told[i] == 0;
        if first { self.state.parents.positions.row(i) } else { self.children.positions.row(i) }
    }
}

impl<T: Scalar, M: Mutation<T>> SteadyState<T> for OneByOne<T, M> {
    fn signature(&self) -> String {
        self.signature.clone()
    }

    fn ask(&mut self) -> Option<(usize, &[T])> {
        let i = self.state.waiting.pop_front()?;
        if self.state.told[i] > 0 {
            self.make_child(i);
        }
        self.away[i] = true;
        let mut asked = std::mem::take(&mut self.asked);
        self.domain.decode(self.pending(i), &mut asked);
        self.asked = asked;
        Some((i, &self.asked))
    }

    fn tell(&mut self, individual: usize, cost: T) -> Result<(), TellError> {
        let i = individual;
        if !self.away.get(i).is_some_and(|away| *away) {
            return Err(TellError::NotAsked);
        }
        self.away[i] = false;
        let cost = if cost.is_finite() { cost } else { T::infinity() };
        let State { parents, told, waiting, best } = &mut self.state;
        let of = if told[i] == 0 { &*parents } else { &self.children };
        best.note(&[cost], |_, x| self.domain.decode(of.positions.row(i), x));
        if told[i] == 0 {
            parents.costs[i] = cost;
        } else {
            self.children.costs[i] = cost;
            self.contest.compete(parents, &mut self.children, i);
        }
        told[i] += 1;
        waiting.push_back(i);
        Ok(())
    }

    fn best(&self) -> Option<Best<'_, T>> {
        self.state.best.get()
    }

    fn individuals(&self) -> usize {
        self.away.len()
    }

    fn told(&self) -> u64 {
        self.state.told.iter().sum()
    }

    fn save(&self) -> Result<Vec<u8>, CheckpointError> {
        let State { parents, told, waiting, best } = &self.state;
        // Who is away is asked first: nobody will tell its cost any more.
        let away = (0..self.away.len()).filter(|i| self.away[*i]);
        let waiting: VecDeque<usize> = away.chain(waiting.iter().copied()).collect();
        crate::checkpoint::encode(&(parents, told, waiting, best))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), CheckpointError> {
        let state: State<T, M::Individual> = crate::checkpoint::decode(bytes)?;
        let mut slots: Vec<usize> = state.waiting.iter().copied().collect();
        slots.sort_unstable();
        let whole = slots.into_iter().eq(0..self.away.len());
        if !state.parents.is_like(&self.state.parents)
            || state.told.len() != self.state.told.len()
            || state.best.dimension() != self.domain.dimension()
            || !whole
        {
            return Err(CheckpointError::Mismatch { what: "population size or dimension" });
        }
        self.state = state;
        self.away.fill(false);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Aep, CmaEs, De, Method};

    fn valley(x: &[f64]) -> f64 {
        100.0 * (x[0] * x[0] - x[1]).powi(2) + (1.0 - x[0]).powi(2)
    }

    fn begun(method: &dyn Method, seed: u64) -> Box<dyn SteadyState> {
        let domain = Domain::cube(2, -6.0, 6.0).unwrap();
        method.start_steady_state(&Start::new(&domain, seed)).unwrap().unwrap()
    }

    /// Goes on to `most` costs with `width` at work; each takes as long as `hours` says, and the first to be ready is told first.
    fn go_on(
        run: &mut dyn SteadyState,
        most: u64,
        width: usize,
        hours: impl Fn(u64) -> u64,
    ) -> u64 {
        let (mut away, mut sent, mut now) = (Vec::new(), 0, 0);
        while run.told() < most {
            while away.len() < width {
                let Some((individual, x)) = run.ask() else { break };
                away.push((now + hours(sent), sent, individual, valley(x)));
                sent += 1;
            }
            away.sort_by_key(|(ready, sent, ..)| (*ready, *sent));
            let (ready, _, individual, cost) = away.remove(0);
            now = ready;
            run.tell(individual, cost).unwrap();
        }
        now
    }

    #[test]
    fn the_minimum_is_found_whoever_is_slow() {
        for method in [&Aep::practical() as &dyn Method, &De::default()] {
            let mut run = begun(method, 3);
            go_on(&mut *run, 12_000, 16, |sent| 1 + 40 * u64::from(sent % 7 == 0));
            let best = run.best().unwrap();
            assert!(best.cost < 1e-6, "{} {}", method.name(), best.cost);
            assert!((valley(best.position) - best.cost).abs() < 1e-12);
        }
    }

    #[test]
    fn a_seed_and_an_order_fix_the_run() {
        let end = |seed, slow: u64| {
            let mut run = begun(&Aep::practical(), seed);
            go_on(&mut *run, 500, 8, |sent| 1 + sent % slow);
            run.best().unwrap().position.to_vec()
        };
        assert_eq!(end(1, 5), end(1, 5));
        assert_ne!(end(1, 5), end(2, 5));
        assert_ne!(end(1, 5), end(1, 3));
    }

    #[test]
    fn nobody_is_asked_twice_and_what_was_not_asked_cannot_be_told() {
        let mut run = begun(&De::default().with_population(5), 1);
        let mut asked: Vec<usize> = std::iter::from_fn(|| run.ask().map(|(i, _)| i)).collect();
        asked.sort_unstable();
        assert_eq!(asked, [0, 1, 2, 3, 4]);
        assert!(run.ask().is_none());
        run.tell(3, f64::NAN).unwrap();
        assert_eq!(run.tell(3, 1.0), Err(TellError::NotAsked));
        assert_eq!(run.tell(5, 1.0), Err(TellError::NotAsked));
        assert_eq!((run.told(), run.best().is_none()), (1, true));
        assert_eq!(run.ask().unwrap().0, 3);
    }

    #[test]
    fn a_run_goes_on_from_its_bytes_and_those_away_are_asked_again() {
        let mut run = begun(&Aep::practical().with_population(6), 1);
        go_on(&mut *run, 50, 4, |sent| 1 + sent % 3);
        while run.ask().is_some() {}
        let bytes = run.save().unwrap();
        let mut again = begun(&Aep::practical().with_population(6), 1);
        again.restore(&bytes).unwrap();
        assert_eq!((again.told(), again.best()), (run.told(), run.best()));
        assert_eq!(std::iter::from_fn(|| again.ask().map(|(i, _)| i)).count(), 6);
        assert!(begun(&Aep::practical(), 1).restore(&bytes).is_err());
    }

    #[test]
    fn methods_that_need_whole_generations_say_so() {
        let domain = Domain::cube(2, -6.0, 6.0).unwrap();
        assert!(CmaEs::default().start_steady_state(&Start::new(&domain, 1)).is_none());
        let none = De::default().with_population(2);
        assert!(none.start_steady_state(&Start::new(&domain, 1)).unwrap().is_err());
    }
}
