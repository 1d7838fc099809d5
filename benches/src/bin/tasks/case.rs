//! What is to be solved, and the count of who solves it.

use std::sync::{Mutex, MutexGuard, PoisonError};

use aep_core::methods::Facts;
use aep_core::{Domain, LeastSquares, Problem, Purpose, Streams};
use aep_problems::TestProblem;
use aep_problems::tasks::{self, Identification};

use crate::Result;
use crate::result::Trial;

/// A task, or a test function.
pub struct Case {
    pub name: String,
    pub facts: Facts,
    target: f64,
    kind: Kind,
}

enum Kind {
    Task(Identification),
    Function(TestProblem),
}

/// The tasks, then De Jong's functions as printed and with the optimum elsewhere.
pub fn all() -> Vec<Case> {
    let task = |task: &'static tasks::Task| {
        let problem = task.problem();
        Case {
            name: task.name.into(),
            facts: Facts::new(task.parameters.len()).with_residuals().with_noise(task.noise > 0.0),
            target: problem.target(),
            kind: Kind::Task(problem),
        }
    };
    let function = |problem: TestProblem, name: String| Case {
        name,
        facts: Facts::new(problem.optimum().len()),
        target: problem.target(),
        kind: Kind::Function(problem),
    };
    let names = ["f1", "f2", "f3", "f4", "f5"];
    let de_jong = names.iter().filter_map(|name| aep_problems::find(name));
    tasks::ALL
        .iter()
        .map(task)
        .chain(de_jong.clone().map(|f| function(f.usual(), f.name.into())))
        .chain(
            de_jong
                .map(|f| function(f.usual().with_random_shift(1), format!("{} shifted", f.name))),
        )
        .collect()
}

impl Case {
    pub fn problem(&self) -> &dyn Problem {
        match &self.kind {
            Kind::Task(task) => task,
            Kind::Function(function) => function,
        }
    }

    pub fn domain(&self) -> &Domain {
        self.problem().domain()
    }

    /// How many residuals a position has; 0 for a test function.
    pub fn residuals(&self) -> usize {
        match &self.kind {
            Kind::Task(task) => task.residuals(self.domain().lower()).len(),
            Kind::Function(_) => 0,
        }
    }

    /// From the cube of width 1 into the domain; what lies outside is mirrored.
    pub fn in_domain(&self, unit: &[f64]) -> Vec<f64> {
        let domain = self.domain();
        let limits = domain.search_lower().iter().zip(domain.search_upper());
        let search: Vec<f64> =
            unit.iter().zip(limits).map(|(u, (lo, hi))| lo + mirrored(*u) * (hi - lo)).collect();
        let mut x = vec![0.0; search.len()];
        domain.decode(&search, &mut x);
        x
    }

    pub fn budget(&self, per_parameter: u64) -> u64 {
        per_parameter * self.domain().dimension() as u64
    }

    /// The seed of a trial in the table of `seed`.
    pub fn seed(seed: u64, trial: usize) -> u64 {
        Streams::new(seed, Purpose::Trial, 0).word(trial)
    }

    /// The initial population of a seed, in the cube of width 1.
    pub fn population(&self, seed: u64, count: usize) -> Result<Vec<Vec<f64>>> {
        benches::peers::population(self.domain(), seed, count)
    }

    pub fn tally(&self, budget: u64) -> Tally<'_> {
        Tally { case: self, budget, count: Mutex::default() }
    }
}

#[derive(Default)]
struct Count {
    used: u64,
    solved: bool,
}

/// Evaluations made and allowed, and whether one of them was at the target.
pub struct Tally<'a> {
    case: &'a Case,
    budget: u64,
    count: Mutex<Count>,
}

impl Tally<'_> {
    fn count(&self) -> MutexGuard<'_, Count> {
        self.count.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, exact: f64) {
        let mut count = self.count();
        count.used += 1;
        count.solved |= exact <= self.case.target;
    }

    /// The cost of `x`, in problem coordinates; nothing is evaluated once it is over.
    pub fn cost(&self, x: &[f64]) -> f64 {
        if self.is_over() {
            return f64::INFINITY;
        }
        let cost = self.case.problem().evaluate(x);
        self.note(match &self.case.kind {
            Kind::Task(task) if self.case.facts.noisy => task.exact(x),
            _ => cost,
        });
        cost
    }

    /// The cost of a position in the cube of width 1, for those who know no other; large where it fails.
    pub fn cost_in_cube(&self, unit: &[f64]) -> f64 {
        let cost = self.cost(&self.case.in_domain(unit));
        if cost.is_finite() { cost } else { FAILED }
    }

    /// The residuals of `x`, one evaluation; none for a test function, NaN once it is over.
    pub fn residuals(&self, x: &[f64]) -> Vec<f64> {
        let Kind::Task(task) = &self.case.kind else { return Vec::new() };
        let mut residuals = task.residuals(x);
        if self.is_over() {
            residuals.fill(f64::NAN);
        } else {
            self.note(task.exact(x));
        }
        residuals
    }

    pub fn used(&self) -> u64 {
        self.count().used
    }

    pub fn left(&self) -> u64 {
        self.budget.saturating_sub(self.used())
    }

    pub fn is_over(&self) -> bool {
        let count = self.count();
        count.solved || count.used >= self.budget
    }

    pub fn trial(&self) -> Trial {
        let Count { used, solved } = *self.count();
        Trial { evaluations: used, solved }
    }
}

/// What those are told who know no infinity.
const FAILED: f64 = 1e99;

/// Into the cube, for methods without limits.
fn mirrored(u: f64) -> f64 {
    let folded = u.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}
