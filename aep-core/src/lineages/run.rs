//! The run: phases one after the other on the unit cube.

use serde::{Deserialize, Serialize};

use super::companions::Companions;
use super::components::ComponentSearch;
use super::descent::End;
use super::descents::Descents;
use super::exchange::{Exchange, Verdict};
use super::guess::Ration;
use super::lineage::{Lineage, Setting};
use super::repeats::Repeats;
use super::schedule::{Next, Schedule};
use super::{Ingredient, Lineages, NAME};
use crate::best::BestSoFar;
use crate::cube::Cube;
use crate::random::{self, Purpose, Streams};
use crate::turn::Turn;
use crate::{
    Algorithm, Batch, Best, CheckpointError, ConfigError, Domain, Points, Scalar, Start, TellError,
    checkpoint,
};

pub(super) struct Run<T: Scalar> {
    signature: String,
    config: Lineages,
    domain: Domain<T>,
    seed: u64,
    /// The initial population on the unit cube.
    initial: Vec<f64>,
    /// What is asked, on the unit cube, before mirroring.
    drawn: Vec<f64>,
    /// The same in problem coordinates.
    points: Points<T>,
    cube: Cube,
    turn: Turn,
    exhausted: Option<String>,
    state: State<T>,
}

#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct State<T: Scalar> {
    /// How often costs were told.
    told: u64,
    phase: Phase,
    schedule: Schedule,
    ration: Ration,
    repeats: Repeats,
    best: BestSoFar<T>,
    /// Where the problem has residuals.
    descents: Option<Box<Descents>>,
}

impl<T: Scalar> State<T> {
    fn lowest(&self) -> f64 {
        self.best.get().map_or(f64::INFINITY, |best| best.cost.as_f64())
    }
}

#[derive(Serialize, Deserialize)]
enum Phase {
    Initial,
    /// The first lineage waits for the verdict.
    Exchange(Exchange, Box<Lineage>),
    Components(ComponentSearch),
    Lineage(Box<Lineage>),
    Population(Box<Companions>),
}

impl<T: Scalar> Run<T> {
    pub fn new(config: &Lineages, start: &Start<'_, T>) -> Result<Self, ConfigError> {
        let n = start.domain.dimension();
        let lambda = config.lambda(n);
        let signature = crate::engine::signature(NAME, start.domain, start.seed, lambda);
        let first = start.population(lambda)?;
        let initial = (0..lambda).flat_map(|i| Cube::shares(start.domain, first.row(i))).collect();
        Ok(Self {
            signature: format!("{signature}, {config:?}"),
            config: config.clone(),
            domain: start.domain.clone(),
            seed: start.seed,
            initial,
            drawn: Vec::new(),
            points: Points::zeros(0, n),
            cube: Cube::new(n),
            turn: Turn::default(),
            exhausted: None,
            state: State {
                told: 0,
                phase: Phase::Initial,
                schedule: Schedule::new(n, lambda),
                ration: Ration::new(n),
                repeats: Repeats::new(config.uses(Ingredient::Reevaluation)),
                best: BestSoFar::new(n),
                descents: None,
            },
        })
    }

    /// Writes what was drawn to `points`, mirrored into the domain.
    fn place(&mut self) {
        let n = self.domain.dimension();
        if self.points.len() != self.drawn.len() / n {
            self.points = Points::zeros(self.drawn.len() / n, n);
        }
        for (i, drawn) in self.drawn.chunks_exact(n).enumerate() {
            self.cube.place(&self.domain, drawn, self.points.row_mut(i));
        }
    }

    fn lambda(&self) -> usize {
        self.config.lambda(self.domain.dimension())
    }

    fn first_lineage(&self, mean: Vec<f64>) -> Box<Lineage> {
        Box::new(Lineage::new(&self.config, mean, self.config.sigma, self.lambda()))
    }

    /// What follows the initial population.
    fn begin(&self, costs: &[f64]) -> Phase {
        let n = self.domain.dimension();
        let mut order: Vec<usize> = (0..costs.len()).collect();
        order.sort_by(|a, b| costs[*a].total_cmp(&costs[*b]));
        let row = |i: usize| &self.initial[i * n..(i + 1) * n];
        let (best, second) = (order[0], order[1]);
        let lineage = self.first_lineage(row(best).to_vec());
        if !self.config.uses(Ingredient::Components) || !costs[second].is_finite() {
            return Phase::Lineage(lineage);
        }
        if n == 1 {
            return Phase::Components(ComponentSearch::new(row(best).to_vec(), costs[best]));
        }
        let exchange = Exchange::new([row(best), row(second)], [costs[best], costs[second]]);
        Phase::Exchange(exchange, lineage)
    }

    /// What follows a lineage or a population that has spent so many evaluations.
    fn begin_next(&mut self, spent: u64) -> Result<Phase, ConfigError> {
        let n = self.domain.dimension();
        let streams = Streams::new(self.seed, Purpose::Restart, self.state.told);
        let mut rng = streams.stream(0);
        let next = self.state.schedule.next(&self.config, self.lambda(), spent, &mut rng);
        Ok(match next {
            Next::Lineage { lambda, sigma } => {
                let mean = (0..n).map(|_| random::uniform::<f64>(&mut rng)).collect();
                Phase::Lineage(Box::new(Lineage::new(&self.config, mean, sigma, lambda)))
            }
            Next::Population { size } => {
                let companions = Companions::new(&self.config, n, size, streams.word(1))?;
                Phase::Population(Box::new(companions))
            }
        })
    }

    /// Whether descents are asked next, not the search.
    fn descents_next(&self) -> bool {
        self.state.descents.as_ref().is_some_and(|descents| descents.are_next())
    }

    /// Notes the best of what was asked; costs as the search takes them.
    fn note(&mut self, costs: &[T]) -> Vec<f64> {
        let points = &self.points;
        self.state.best.note(costs, |i, x| x.copy_from_slice(points.row(i)));
        let usable = |cost: &T| if cost.is_finite() { cost.as_f64() } else { f64::INFINITY };
        costs.iter().map(usable).collect()
    }

    /// How many of the positions asked are evaluated once more.
    fn once_more(&self) -> usize {
        match &self.state.phase {
            Phase::Lineage(lineage) => {
                self.state.repeats.asked(lineage).len() / self.domain.dimension()
            }
            _ => 0,
        }
    }

    /// Takes costs into the search.
    fn search(&mut self, costs: &[f64]) {
        let children = costs.len() - self.once_more();
        if let Some(descents) = &mut self.state.descents {
            // Whose turn it is does not depend on what is evaluated once more.
            let costs = &costs[..children];
            let best = (0..costs.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b]));
            let best = best.filter(|best| costs[*best].is_finite()).map(|best| {
                let mut search = vec![T::zero(); self.domain.dimension()];
                self.domain.encode(self.points.row(best), &mut search);
                End { at: Cube::shares(&self.domain, &search), cost: costs[best] }
            });
            descents.note(costs.len(), best);
        }
        let ended = self.advance(costs);
        self.state.told += 1;
        if let Some(spent) = ended {
            match self.begin_next(spent) {
                Ok(phase) => self.state.phase = phase,
                Err(error) => self.exhausted = Some(error.to_string()),
            }
        }
    }

    /// Takes costs into the present phase; the evaluations of one that has ended.
    fn advance(&mut self, costs: &[f64]) -> Option<u64> {
        let epsilon = T::epsilon().as_f64();
        let setting = setting(&self.config, self.seed, &self.state);
        let ration = &mut self.state.ration;
        match &mut self.state.phase {
            Phase::Initial => {
                self.state.phase = self.begin(costs);
                None
            }
            Phase::Exchange(exchange, lineage) => {
                let next = match exchange.tell(costs, epsilon) {
                    Verdict::Undecided => return None,
                    Verdict::NoSum => Phase::Lineage(lineage.clone()),
                    Verdict::Sum => {
                        let (parent, cost) = exchange.first();
                        Phase::Components(ComponentSearch::new(parent.to_vec(), cost))
                    }
                };
                self.state.phase = next;
                None
            }
            Phase::Components(search) => {
                search.tell(costs, epsilon);
                if search.ended() {
                    let parent = search.parent().to_vec();
                    self.state.phase = Phase::Lineage(self.first_lineage(parent));
                }
                None
            }
            Phase::Lineage(lineage) => {
                let costs = self.state.repeats.compare(lineage, costs, epsilon);
                let noisy = self.state.repeats.noisy();
                lineage.tell(Setting { noisy, ..setting }, ration, costs);
                let spent = lineage.evaluations();
                let over = lineage.ended() || !self.state.schedule.allows(spent);
                over.then_some(spent)
            }
            Phase::Population(companions) => {
                companions.tell(costs);
                let spent = companions.evaluations();
                companions.ended(&self.config, setting.lowest).then_some(spent)
            }
        }
    }
}

fn setting<'a, T: Scalar>(config: &'a Lineages, seed: u64, state: &State<T>) -> Setting<'a> {
    let noisy = state.repeats.noisy();
    Setting { config, seed, generation: state.told, lowest: state.lowest(), noisy }
}

impl<T: Scalar> Algorithm<T> for Run<T> {
    fn name(&self) -> &'static str {
        NAME
    }

    fn signature(&self) -> String {
        self.signature.clone()
    }

    fn domain(&self) -> &Domain<T> {
        &self.domain
    }

    fn ask(&mut self) -> Batch<'_, T> {
        if self.turn.ask() {
            self.drawn.clear();
            if self.descents_next() {
                self.drawn.extend_from_slice(
                    self.state.descents.as_ref().map_or(&[], |descents| descents.asked()),
                );
                self.place();
                return self.points.batch();
            }
            let setting = setting(&self.config, self.seed, &self.state);
            let (ration, drawn) = (&mut self.state.ration, &mut self.drawn);
            match &mut self.state.phase {
                Phase::Initial => drawn.extend_from_slice(&self.initial),
                Phase::Exchange(exchange, _) => {
                    let streams = Streams::new(self.seed, Purpose::Mutation, self.state.told);
                    exchange.ask(&mut streams.stream(0), drawn);
                }
                Phase::Components(search) => search.ask(drawn),
                Phase::Lineage(lineage) => {
                    lineage.ask(setting, ration, drawn);
                    drawn.extend_from_slice(self.state.repeats.asked(lineage));
                }
                Phase::Population(companions) => companions.ask(drawn),
            }
            self.place();
        }
        self.points.batch()
    }

    fn tell(&mut self, costs: &[T]) -> Result<(), TellError> {
        self.turn.tell(costs.len(), self.points.len())?;
        let costs = self.note(costs);
        if self.descents_next() {
            // Whoever evaluates has no residuals after all.
            self.state.descents = None;
            self.state.told += 1;
        } else {
            self.search(&costs);
        }
        Ok(())
    }

    fn wants_residuals(&self) -> bool {
        let first = matches!(self.state.phase, Phase::Initial);
        first && self.config.uses(Ingredient::Descents) || self.descents_next()
    }

    fn tell_residuals(&mut self, costs: &[T], residuals: &[Vec<f64>]) -> Result<(), TellError> {
        if !self.wants_residuals()
            || residuals.iter().all(Vec::is_empty) && self.state.descents.is_none()
        {
            return self.tell(costs);
        }
        if residuals.len() != costs.len() {
            return Err(TellError::Residuals { found: residuals.len(), expected: costs.len() });
        }
        self.turn.tell(costs.len(), self.points.len())?;
        let costs = self.note(costs);
        let lowest = self.state.lowest();
        let mut rng = Streams::new(self.seed, Purpose::Restart, self.state.told).stream(0);
        if let Some(descents) = &mut self.state.descents {
            descents.tell(&costs, residuals, lowest, &mut rng);
            self.state.told += 1;
        } else {
            let n = self.domain.dimension();
            let told = (&costs[..], residuals);
            let descents = Descents::new(n, self.initial.clone(), told, &mut rng);
            self.search(&costs);
            self.state.descents = Some(Box::new(descents));
        }
        Ok(())
    }

    fn best(&self) -> Option<Best<'_, T>> {
        self.state.best.get()
    }

    fn generation(&self) -> u64 {
        self.state.told.saturating_sub(1)
    }

    fn exhausted(&self) -> Option<&str> {
        self.exhausted.as_deref()
    }

    fn save(&self) -> Result<Vec<u8>, CheckpointError> {
        checkpoint::encode(&self.state)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), CheckpointError> {
        let state: State<T> = checkpoint::decode(bytes)?;
        if state.best.dimension() != self.domain.dimension() {
            return Err(CheckpointError::Mismatch { what: "dimension" });
        }
        self.state = state;
        self.turn = Turn::default();
        Ok(())
    }
}
