//! The one engine that turns an individual, a mutation and a selection into an optimizer.

use serde::{Deserialize, Serialize};

use crate::algorithm::{Algorithm, Best};
use crate::best::BestSoFar;
use crate::random::{Purpose, Streams};
use crate::turn::Turn;
use crate::{
    Batch, CheckpointError, Child, ConfigError, Domain, Individual, Mutation, Points, Population,
    Scalar, Selection, Start, TellError,
};

/// A population that goes through the cycle mutation, evaluation, selection.
///
/// Any [`Mutation`] works with any [`Selection`] over its individuals:
///
/// ```
/// use aep_core::{Algorithm, Child, Domain, Engine, Mutation, OneToOne, Population, Start};
/// use aep_core::random::{self, Stream};
///
/// /// Steps of one percent of the domain's width.
/// struct Fixed;
///
/// impl Mutation<f64> for Fixed {
///     type Individual = ();
///
///     fn individual(&self, _: &Domain, _: &mut Stream) {}
///
///     fn mutate(
///         &self,
///         parent: usize,
///         population: &Population<f64, ()>,
///         domain: &Domain,
///         rng: &mut Stream,
///         child: Child<'_, f64, ()>,
///     ) {
///         let limits = domain.search_lower().iter().zip(domain.search_upper());
///         for ((z, child), (lo, hi)) in
///             population.positions.row(parent).iter().zip(child.position).zip(limits)
///         {
///             *child = (z + 0.01 * (hi - lo) * random::normal::<f64>(rng)).clamp(*lo, *hi);
///         }
///     }
/// }
///
/// let domain = Domain::cube(2, -6.0, 6.0)?;
/// let mut engine = Engine::new("fixed", &Start::new(&domain, 1), 40, Fixed, OneToOne::Strict)?;
/// for _ in 0..300 {
///     let costs: Vec<f64> = engine.ask().rows().map(|x| x[0].powi(2) + x[1].powi(2)).collect();
///     engine.tell(&costs)?;
/// }
/// assert!(engine.best().unwrap().cost < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Engine<T: Scalar, M: Mutation<T>, S> {
    name: String,
    signature: String,
    domain: Domain<T>,
    seed: u64,
    mutation: M,
    selection: S,
    state: State<T, M::Individual>,
    children: Population<T, M::Individual>,
    /// The positions asked, in problem coordinates; unused when those are the search coordinates.
    decoded: Option<Points<T>>,
    turn: Turn,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "I: Individual<T>")]
struct State<T: Scalar, I> {
    /// Whether the initial population has been evaluated.
    started: bool,
    generation: u64,
    parents: Population<T, I>,
    best: BestSoFar<T>,
}

impl<T: Scalar, M: Mutation<T>, S: Selection<T, M::Individual>> Engine<T, M, S> {
    /// A run of `count` individuals from `start`.
    ///
    /// # Errors
    /// When `count` is 0 or an initial point is outside the domain.
    pub fn new(
        name: impl Into<String>,
        start: &Start<'_, T>,
        count: usize,
        mutation: M,
        selection: S,
    ) -> Result<Self, ConfigError> {
        let name = name.into();
        let hint = "at least one individual is needed";
        ConfigError::require(count > 0, "engine", "population", count as f64, hint)?;
        let domain = start.domain.clone();
        let positions = start.population(count)?;
        let streams = Streams::new(start.seed, Purpose::Individual, 0);
        let individuals =
            (0..count).map(|i| mutation.individual(&domain, &mut streams.stream(i))).collect();
        let parents = Population { positions, costs: vec![T::infinity(); count], individuals };
        let decoded = (!domain.is_linear()).then(|| Points::zeros(count, domain.dimension()));
        Ok(Self {
            signature: signature(&name, &domain, start.seed, count),
            name,
            seed: start.seed,
            mutation,
            selection,
            children: Population {
                positions: Points::zeros(count, domain.dimension()),
                costs: parents.costs.clone(),
                individuals: parents.individuals.clone(),
            },
            state: State {
                started: false,
                generation: 0,
                parents,
                best: BestSoFar::new(domain.dimension()),
            },
            domain,
            decoded,
            turn: Turn::default(),
        })
    }

    /// Adds `configuration` to what a checkpoint must agree with.
    #[must_use]
    pub fn with_configuration(mut self, configuration: impl std::fmt::Debug) -> Self {
        self.signature = format!("{}, {configuration:?}", self.signature);
        self
    }

    /// The population after the last selection.
    pub fn population(&self) -> &Population<T, M::Individual> {
        &self.state.parents
    }

    fn make_children(&mut self) {
        let parents = &self.state.parents;
        self.mutation.prepare(parents, &self.domain);
        let streams = Streams::new(self.seed, Purpose::Mutation, self.state.generation + 1);
        for i in 0..parents.len() {
            let position = self.children.positions.row_mut(i);
            let child = Child { position, individual: &mut self.children.individuals[i] };
            self.mutation.mutate(i, parents, &self.domain, &mut streams.stream(i), child);
        }
    }

    /// The positions whose costs are told next, in search coordinates.
    fn pending(&self) -> &Points<T> {
        if self.state.started { &self.children.positions } else { &self.state.parents.positions }
    }

    fn decode_points(&mut self) {
        let Some(mut decoded) = self.decoded.take() else { return };
        for i in 0..decoded.len() {
            self.domain.decode(self.pending().row(i), decoded.row_mut(i));
        }
        self.decoded = Some(decoded);
    }

    /// Remembers the best of the costs just told, before selection moves positions about.
    fn note_best(&mut self) {
        let state = &mut self.state;
        let told = if state.started { &self.children } else { &state.parents };
        state.best.note(&told.costs, |i, x| self.domain.decode(told.positions.row(i), x));
    }

    fn select(&mut self) {
        let state = &mut self.state;
        state.generation += 1;
        let streams = Streams::new(self.seed, Purpose::Selection, state.generation);
        self.selection.select(&mut state.parents, &mut self.children, streams);
    }
}

pub(crate) fn signature<T: Scalar>(
    name: &str,
    domain: &Domain<T>,
    seed: u64,
    population: usize,
) -> String {
    let kind = std::any::type_name::<T>();
    format!("{name}, seed {seed}, population {population}, {kind}, {domain:?}")
}

/// Costs with everything that is not finite made the worst.
fn take_costs<T: Scalar>(from: &[T], to: &mut [T]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = if from.is_finite() { *from } else { T::infinity() };
    }
}

impl<T: Scalar, M: Mutation<T>, S: Selection<T, M::Individual>> Algorithm<T> for Engine<T, M, S> {
    fn name(&self) -> &str {
        &self.name
    }

    fn signature(&self) -> String {
        self.signature.clone()
    }

    fn domain(&self) -> &Domain<T> {
        &self.domain
    }

    fn ask(&mut self) -> Batch<'_, T> {
        if self.turn.ask() {
            if self.state.started {
                self.make_children();
            }
            self.decode_points();
        }
        match &self.decoded {
            Some(decoded) => decoded.batch(),
            None => self.pending().batch(),
        }
    }

    fn tell(&mut self, costs: &[T]) -> Result<(), TellError> {
        self.turn.tell(costs.len(), self.state.parents.len())?;
        if self.state.started {
            take_costs(costs, &mut self.children.costs);
            self.note_best();
            self.select();
        } else {
            take_costs(costs, &mut self.state.parents.costs);
            self.note_best();
            self.state.started = true;
        }
        Ok(())
    }

    fn best(&self) -> Option<Best<'_, T>> {
        self.state.best.get()
    }

    fn generation(&self) -> u64 {
        self.state.generation
    }

    fn save(&self) -> Result<Vec<u8>, CheckpointError> {
        crate::checkpoint::encode(&self.state)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), CheckpointError> {
        let state: State<T, M::Individual> = crate::checkpoint::decode(bytes)?;
        if !state.parents.is_like(&self.state.parents)
            || state.best.dimension() != self.domain.dimension()
        {
            return Err(CheckpointError::Mismatch { what: "population size or dimension" });
        }
        self.state = state;
        self.turn = Turn::default();
        Ok(())
    }
}
