//! One lineage: a parent, its direction, its age, and the distribution of its children.

use serde::{Deserialize, Serialize};

use super::distribution::{Distribution, Ranked};
use super::guess::{Guess, Ration};
use super::triangular;
use super::weights::Weights;
use super::{Ingredient, Lineages};
use crate::random::{self, Purpose, Streams};

/// Farthest that the minimum of a model is followed, in deviations per root of a component.
const TRUST: f64 = 2.0;
/// Relative difference of costs below which they no longer differ.
const FLAT: f64 = 1e-12;
/// Reach, in first steps, below which a lineage has converged.
const LEAST_REACH: f64 = 1e-12;
/// Limit of age in windows of costs.
const MOST_AGE: usize = 3;
/// Age, in generations, at which the lowest cost is doubted.
const DOUBTED_AT: usize = 10;

#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Lineage {
    lambda: usize,
    distribution: Distribution,
    first_sigma: f64,
    guess: Option<Guess>,
    /// The generation that is being evaluated.
    open: Option<Open>,
    /// Lowest level of the lineage, see [`level`].
    best: f64,
    /// Position and cost of the lowest cost.
    lowest: (Vec<f64>, f64),
    /// Whether that has been evaluated once more.
    repeated: bool,
    /// Generations since it became lower.
    age: usize,
    /// Level of each generation, the latest ones.
    history: Vec<f64>,
    evaluations: u64,
    ended: bool,
    #[serde(skip)]
    children: Children,
    #[serde(skip)]
    weights: Option<Weights>,
}

/// A generation in parts: those that the model thinks best are evaluated first.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Open {
    /// Generation of the streams that the children are drawn from.
    drawn: u64,
    /// The minimum of the model: the place of the last child.
    minimum: Option<Vec<f64>>,
    /// Children and their costs.
    evaluated: Vec<(usize, f64)>,
    /// Children without cost, the next ones first.
    waiting: Vec<usize>,
    /// How many are next.
    next: usize,
}

/// The children of the open generation, drawn again after a resumption.
#[derive(Clone, Debug, Default)]
struct Children {
    /// One row each: what was drawn from N(0, 1), and the step that it makes.
    z: Vec<f64>,
    steps: Vec<f64>,
    /// What the model that was fitted to so many entries makes of each.
    values: Option<(u64, Vec<f64>)>,
}

/// What a lineage needs of its run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting<'a> {
    pub config: &'a Lineages,
    pub seed: u64,
    /// Tells of the run so far.
    pub generation: u64,
    /// Lowest cost of all lineages.
    pub lowest: f64,
    /// Whether the same position can have another cost.
    pub noisy: bool,
}

impl Lineage {
    pub fn new(config: &Lineages, mean: Vec<f64>, sigma: f64, lambda: usize) -> Self {
        let models = config.uses(Ingredient::Model) && Guess::pays(mean.len(), lambda);
        Self {
            lambda,
            distribution: Distribution::new(mean, sigma),
            first_sigma: sigma,
            guess: models.then(Guess::default),
            open: None,
            best: f64::INFINITY,
            lowest: (Vec::new(), f64::INFINITY),
            repeated: false,
            age: 0,
            history: Vec::new(),
            evaluations: 0,
            ended: false,
            children: Children::default(),
            weights: None,
        }
    }

    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    pub fn ended(&self) -> bool {
        self.ended
    }

    /// The position of the lowest cost, and the cost, once that is to be doubted.
    pub fn doubted(&self) -> Option<(&[f64], f64)> {
        let (position, cost) = &self.lowest;
        let old = self.age >= DOUBTED_AT && cost.is_finite();
        (old && !self.repeated).then_some((position, *cost))
    }

    /// It has been evaluated once more; with `noisy` nothing that was judged by the lowest cost holds.
    pub fn note_repeated(&mut self, noisy: bool) {
        self.repeated = true;
        if noisy {
            self.best = f64::INFINITY;
            self.age = 0;
            self.history.clear();
        }
    }

    /// The positions to be evaluated next, not yet mirrored into the domain.
    pub fn ask(&mut self, setting: Setting<'_>, ration: &mut Ration, points: &mut Vec<f64>) {
        let open = match self.open.take() {
            Some(open) => {
                if self.children.z.is_empty() {
                    self.draw(setting.seed, open.drawn, open.minimum.as_deref());
                }
                open
            }
            None => self.begin(setting, ration),
        };
        for child in &open.waiting[..open.next] {
            points
                .extend(self.distribution.position(self.children.step(*child, &self.distribution)));
        }
        self.open = Some(open);
    }

    fn begin(&mut self, setting: Setting<'_>, ration: &mut Ration) -> Open {
        let drawn = setting.generation + 1;
        let mut open = Open {
            drawn,
            minimum: None,
            evaluated: Vec::new(),
            waiting: (0..self.lambda).collect(),
            next: self.lambda,
        };
        let guess = self.guess.as_mut();
        let model = guess.and_then(|guess| guess.model(&self.distribution, ration));
        if let Some((model, _)) = model {
            open.minimum = model.minimum();
            open.next = 1;
        }
        self.draw(setting.seed, drawn, open.minimum.as_deref());
        if let Some(values) = self.values(ration) {
            open.waiting.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        }
        open
    }

    fn draw(&mut self, seed: u64, generation: u64, minimum: Option<&[f64]>) {
        let n = self.distribution.dimension();
        let streams = Streams::new(seed, Purpose::Mutation, generation);
        let Children { z, steps, .. } = &mut self.children;
        z.resize(n * self.lambda, 0.0);
        steps.resize(n * self.lambda, 0.0);
        for (i, z) in z.chunks_exact_mut(n).enumerate() {
            match minimum {
                Some(minimum) if i + 1 == self.lambda => {
                    self.distribution.whiten(minimum, z);
                    let most = TRUST * (n as f64).sqrt() / triangular::norm(z);
                    for z in z.iter_mut() {
                        *z *= most.min(1.0);
                    }
                }
                _ => random::fill_normal(&mut streams.stream(i), z),
            }
        }
        for (z, step) in z.chunks_exact(n).zip(steps.chunks_exact_mut(n)) {
            self.distribution.step(z, step);
        }
    }

    /// What the model makes of each child.
    fn values(&mut self, ration: &mut Ration) -> Option<Vec<f64>> {
        let n = self.distribution.dimension();
        let (model, fitted) = self.guess.as_mut()?.model(&self.distribution, ration)?;
        if let Some((of, values)) = &self.children.values
            && *of == fitted
        {
            return Some(values.clone());
        }
        let mut position = Vec::with_capacity(n);
        let value = |step: &[f64]| {
            position.clear();
            position.extend(self.distribution.position(step));
            model.value(&position)
        };
        let values: Vec<f64> = self.children.steps.chunks_exact(n).map(value).collect();
        self.children.values = Some((fitted, values.clone()));
        Some(values)
    }

    /// Takes the costs of what was asked; one that failed is infinite.
    pub fn tell(&mut self, setting: Setting<'_>, ration: &mut Ration, costs: &[f64]) {
        let Some(mut open) = self.open.take() else { return };
        self.evaluations += costs.len() as u64;
        ration.earn(costs.len());
        for (child, cost) in open.waiting.drain(..costs.len()).zip(costs) {
            open.evaluated.push((child, *cost));
            let better = *cost < self.lowest.1;
            if !better && self.guess.is_none() {
                continue;
            }
            let step = self.children.step(child, &self.distribution);
            let position: Vec<f64> = self.distribution.position(step).collect();
            if let Some(guess) = &mut self.guess {
                guess.note(&position, *cost);
            }
            if better {
                self.lowest = (position, *cost);
                self.repeated = false;
            }
        }
        match self.ranking(&mut open, ration) {
            Some(order) => self.end_generation(setting, &open.evaluated, &order),
            None => self.open = Some(open),
        }
    }

    /// The children from the best to the worst, once that is known or believed to be known; otherwise
    /// how many more are evaluated is decided.
    fn ranking(&mut self, open: &mut Open, ration: &mut Ration) -> Option<Vec<usize>> {
        let mut ranks = vec![f64::INFINITY; self.lambda];
        if open.waiting.is_empty() {
            open.evaluated.iter().for_each(|(child, cost)| ranks[*child] = *cost);
        } else {
            let values = self.values(ration);
            let guess = self.guess.as_mut()?;
            let Some(values) = values else {
                open.next = open.waiting.len();
                return None;
            };
            if !guess.is_believed(open.evaluated.len(), self.lambda) {
                open.waiting.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
                open.next = open.evaluated.len().div_ceil(2).min(open.waiting.len());
                return None;
            }
            ranks = values;
            let failed = open.evaluated.iter().filter(|(_, cost)| cost.is_infinite());
            failed.for_each(|(child, _)| ranks[*child] = f64::INFINITY);
        }
        let mut order: Vec<usize> = (0..self.lambda).collect();
        order.sort_by(|a, b| ranks[*a].total_cmp(&ranks[*b]));
        Some(order)
    }

    fn end_generation(
        &mut self,
        setting: Setting<'_>,
        evaluated: &[(usize, f64)],
        order: &[usize],
    ) {
        let costs = || evaluated.iter().map(|(_, cost)| *cost);
        let level = level(costs(), setting.noisy);
        self.age = if level < self.best { 0 } else { self.age + 1 };
        self.best = self.best.min(level);
        let n = self.distribution.dimension();
        let window = 10 + 30 * n / self.lambda;
        if costs().any(f64::is_finite) {
            self.history.push(level);
            if self.history.len() > window {
                self.history.remove(0);
            }
            let children = &self.children;
            let ranked = order.iter().map(|child| {
                let z = &children.z[child * n..(child + 1) * n];
                let length = triangular::dot(z, z);
                Ranked { step: children.step(*child, &self.distribution), length }
            });
            let ranked: Vec<Ranked<'_>> = ranked.collect();
            let config = setting.config;
            let weights = self.weights.get_or_insert_with(|| Weights::new(config, n, self.lambda));
            // What was ranked borrows the children only.
            self.distribution.update(weights, &ranked);
        }
        self.children = Children::default();
        self.ended = self.is_at_its_end(setting, window, costs());
    }

    fn is_at_its_end(
        &self,
        setting: Setting<'_>,
        window: usize,
        costs: impl Iterator<Item = f64>,
    ) -> bool {
        let too_old = setting.config.uses(Ingredient::Age) && self.age > MOST_AGE * window;
        let converged = self.distribution.reach() < LEAST_REACH * self.first_sigma;
        if too_old || converged || self.distribution.is_degenerate() {
            return true;
        }
        if self.history.len() < window {
            return false;
        }
        let recent = self.history.iter().copied().chain(costs);
        let (low, high) = recent.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), cost| {
            (low.min(cost), high.max(cost))
        });
        let flat = high - low <= FLAT * low.abs().min(1.0);
        let behind = self.best.min(low) - setting.lowest;
        // Noise alone makes costs differ.
        let contest = setting.config.uses(Ingredient::Contest) && !setting.noisy;
        let beaten = contest && high - low < behind;
        flat || beaten
    }
}

/// What a generation is judged by: its lowest cost. Under noise that is chance's, and the more so the longer a lineage lives;
/// there it is the median.
fn level(costs: impl Iterator<Item = f64>, noisy: bool) -> f64 {
    if !noisy {
        return costs.fold(f64::INFINITY, f64::min);
    }
    let mut costs: Vec<f64> = costs.filter(|cost| cost.is_finite()).collect();
    costs.sort_unstable_by(f64::total_cmp);
    costs.get(costs.len() / 2).copied().unwrap_or(f64::INFINITY)
}

impl Children {
    fn step(&self, child: usize, of: &Distribution) -> &[f64] {
        let n = of.dimension();
        &self.steps[child * n..(child + 1) * n]
    }
}
