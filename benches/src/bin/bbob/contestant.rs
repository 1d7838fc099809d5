//! Who is compared.

use std::sync::Arc;

use aep_core::random::{Purpose, Streams, uniform};
use aep_core::{Domain, Ingredient, Lineages, Method, Start, methods};
use benches::peers::{cmaes_bipop, fcmaes_cma, population};
use benches::python::{Asked, INDIVIDUALS, Pool, Request};
use fcmaes_core::CmaesParams;

use crate::Result;
use crate::task::Task;

/// A method of ours, or a peer.
pub struct Contestant {
    name: String,
    kind: Kind,
}

enum Kind {
    Ours(Box<dyn Method>),
    /// The crate `cmaes`: BIPOP.
    CmaesCrate,
    /// CMA-ES of the crate `fcmaes-core`, restarted with twice the population.
    FcmaesCma,
    /// A method of Python, by its name there.
    Python(&'static str, Arc<Pool>),
}

/// Methods of Python, by their names here and there.
pub const PYTHON: [(&str, &str); 4] = [
    ("pycma", "pycma BIPOP"),
    ("scipy-de", "scipy differential_evolution"),
    ("scipy-annealing", "scipy dual_annealing"),
    (ONLY_NAMED, "nevergrad NGOpt"),
];
/// Takes milliseconds of its own for each evaluation: runs where it is asked for by name only.
pub const ONLY_NAMED: &str = "ngopt";

impl Contestant {
    pub fn named(name: &str, pool: &Arc<Pool>) -> Result<Self> {
        let python = PYTHON.into_iter().find(|(here, _)| *here == name);
        if let Some((_, there)) = python {
            return Ok(Self { name: name.into(), kind: Kind::Python(there, Arc::clone(pool)) });
        }
        let kind = match name {
            "cmaes-crate" => Kind::CmaesCrate,
            "fcmaes-cma" => Kind::FcmaesCma,
            _ => {
                let named =
                    methods::find(name).ok_or_else(|| format!("no method is called {name}"))?;
                Kind::Ours((named.build)(0))
            }
        };
        Ok(Self { name: name.into(), kind })
    }

    /// `aep-lineages`, and what it is without each of its ingredients that counts here: BBOB tells no residuals.
    pub fn ablation() -> Vec<Self> {
        let ours = |name: String, method| Self { name, kind: Kind::Ours(Box::new(method)) };
        let mut all = vec![ours("aep-lineages".into(), Lineages::default())];
        let counts = |ingredient: &Ingredient| *ingredient != Ingredient::Descents;
        for ingredient in Ingredient::ALL.into_iter().filter(counts) {
            let method = Lineages::default().without(ingredient);
            all.push(ours(format!("without {}", ingredient.name()), method));
        }
        all
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    /// Works on `task` until it is over or nothing more is to be done.
    pub fn solve(&self, task: &mut Task<'_>, seed: u64) -> Result<()> {
        match &self.kind {
            Kind::Ours(method) => ours(&**method, task, seed),
            Kind::CmaesCrate | Kind::FcmaesCma if !task.whole().is_empty() => {
                Err(format!("{} searches cubes: leave it out of --methods", self.name).into())
            }
            Kind::CmaesCrate => cmaes_crate(task, seed),
            Kind::FcmaesCma => {
                fcmaes_crate(task, seed);
                Ok(())
            }
            Kind::Python(peer, pool) => python(peer, pool, task, seed),
        }
    }
}

fn ours(method: &dyn Method, task: &mut Task<'_>, seed: u64) -> Result<()> {
    let (lower, upper) = task.limits();
    let domain = Domain::new(lower, upper)?;
    let mut optimizer = method.start(&Start::new(&domain, seed))?;
    while !task.is_over() && optimizer.exhausted().is_none() {
        let costs: Vec<f64> = optimizer.ask().rows().map(|x| task.evaluate(x)).collect();
        optimizer.tell(&costs)?;
    }
    Ok(())
}

fn cmaes_crate(task: &mut Task<'_>, seed: u64) -> Result<()> {
    let (lower, upper) = task.limits();
    let (budget, target) = (task.budget(), task.is_exact().then(|| task.target()));
    let cube = (lower.len(), lower[0]..=upper[0]);
    cmaes_bipop(cube, budget, target, seed, |x| task.evaluate(x))
}

/// First step of all, in widths of the domain.
const SIGMA: f64 = 0.2;

/// From a random place, which later runs change.
fn fcmaes_crate(task: &mut Task<'_>, seed: u64) {
    let (lower, upper) = task.limits();
    let first = 4 + (3.0 * (lower.len() as f64).ln()) as i32;
    for run in 0.. {
        let mut rng = Streams::new(seed, Purpose::Restart, run).stream(0);
        let limits = lower.iter().zip(&upper);
        let guess: Vec<f64> =
            limits.map(|(lo, hi)| lo + (hi - lo) * uniform::<f64>(&mut rng)).collect();
        let settings = CmaesParams {
            popsize: first << run.min(12),
            max_evaluations: task.budget(),
            seed,
            runid: run as i64,
            ..CmaesParams::default()
        };
        let sigma = SIGMA * (upper[0] - lower[0]);
        let mut search = fcmaes_cma((&lower, &upper), &guess, sigma, &settings);
        while search.stop() == 0 {
            let costs: Vec<f64> = search.ask().iter().map(|x| task.evaluate(x)).collect();
            if task.is_over() {
                return;
            }
            search.tell(&costs);
        }
    }
}

impl Asked for Task<'_> {
    fn cost(&mut self, unit: &[f64]) -> f64 {
        self.evaluate_in_cube(unit)
    }

    fn residuals(&mut self, _: &[f64]) -> Vec<f64> {
        Vec::new()
    }

    fn is_over(&self) -> bool {
        Task::is_over(self)
    }
}

/// From the places where ours begin; one that gives up begins again.
fn python(peer: &str, pool: &Pool, task: &mut Task<'_>, seed: u64) -> Result<()> {
    let (lower, upper) = task.limits();
    let domain = Domain::new(lower, upper)?;
    let whole = task.whole();
    for again in 0.. {
        let before = task.used();
        let (seed, budget) = (seed + 1000 * again, task.budget() - before);
        let population = population(&domain, seed, INDIVIDUALS * domain.dimension())?;
        let (whole, sigma) = (&whole[..], SIGMA);
        let request = Request { peer, seed, budget, residuals: 0, sigma, whole, population };
        pool.run(&request, task)?;
        if task.is_over() || task.used() == before {
            break;
        }
    }
    Ok(())
}
