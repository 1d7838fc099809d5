//! The variants of AEP on costs as they occur: smallest cost not 0, parameters that differ in
//! magnitude and depend on each other, several minima.
//!
//! `cargo run --release -p aep-problems --example variants` prints, for each variant and problem,
//! the solved trials of 20 and the expected running time in evaluations. Solved is a cost within
//! 1e-5 (relative) of the smallest: 1 for the four test functions, which are raised by 1; for the
//! two fits the best that any run of any method found.

use aep_core::random::{self, Streams};
use aep_core::trials::{Plan, Trials};
use aep_core::{
    Aep, AgeLimit, Budget, Components, Domain, FnProblem, Method, Problem, Purpose, Scale,
    StepScale, StepUnit, methods,
};

type Cost = Box<dyn Fn(&[f64]) -> f64 + Sync>;
type Task = (&'static str, FnProblem<Cost>, Option<f64>);
type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const TRIALS: usize = 20;
const EVALUATIONS: u64 = 20_000;

/// A place for the optimum away from the middle.
fn place(i: usize) -> f64 {
    ((i * 7 + 3) % 11) as f64 / 11.0 * 4.0 - 2.0
}

/// Ellipsoid of the given condition; rotated by a reflection that mixes all components.
fn ellipsoid(x: &[f64], condition: f64, rotated: bool) -> f64 {
    let last = (x.len() - 1) as f64;
    let mut z: Vec<f64> = x.iter().enumerate().map(|(i, x)| x - place(i)).collect();
    if rotated {
        let axis: Vec<f64> = (0..z.len()).map(|i| 1.0 + 0.3 * i as f64).collect();
        let length: f64 = axis.iter().map(|a| a * a).sum();
        let along: f64 = axis.iter().zip(&z).map(|(a, z)| a * z).sum();
        z.iter_mut().zip(&axis).for_each(|(z, a)| *z -= 2.0 * a * along / length);
    }
    z.iter().enumerate().map(|(i, z)| condition.powf(i as f64 / last) * z * z).sum()
}

fn rms(residuals: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = residuals.len() as f64;
    (residuals.map(|r| r * r).sum::<f64>() / count).sqrt()
}

/// Friction against velocity: Coulomb, Stribeck peak, its velocity, viscous, offset, asymmetry.
fn friction(p: &[f64], v: f64) -> f64 {
    let level = (p[0] + p[1] * (-(v / p[2]).powi(2)).exp()) * v.signum();
    level * (1.0 + p[5] * v.signum()) + p[3] * v + p[4]
}

fn friction_fit() -> Result<FnProblem<Cost>> {
    let mut rng = Streams::new(9, Purpose::Trial, 3).stream(0);
    let truth = [20.0, 8.0, 0.004, 200.0, 1.5, 0.1];
    let velocity = |i: f64| 0.12 * (0.0731 * i).sin() * (0.3 + 0.7 * (0.011 * i).cos().abs());
    let samples: Vec<(f64, f64)> = (0..300)
        .map(|i| velocity(f64::from(i)))
        .map(|v| (v, friction(&truth, v) + 0.5 * random::normal::<f64>(&mut rng)))
        .collect();
    let linear = Scale::Linear;
    let domain = Domain::new(
        vec![0.0, 0.0, 1e-5, 0.0, -20.0, -0.5],
        vec![200.0, 200.0, 1.0, 5_000.0, 20.0, 0.5],
    )?
    .with_scales(vec![linear, linear, Scale::Log, linear, linear, linear])?;
    let cost = move |p: &[f64]| rms(samples.iter().map(|(v, force)| friction(p, *v) - force));
    Ok(FnProblem::new(domain, Box::new(cost)))
}

/// The sum of two decays, all parameters on a logarithmic scale.
fn decay_fit() -> Result<FnProblem<Cost>> {
    let mut rng = Streams::new(9, Purpose::Trial, 4).stream(0);
    let model = |p: &[f64], t: f64| p[0] * (-p[1] * t).exp() + p[2] * (-p[3] * t).exp();
    let samples: Vec<(f64, f64)> = (0..100)
        .map(|i| 0.1 * f64::from(i))
        .map(|t| (t, model(&[3.0, 0.4, 2.0, 1.7], t) + 0.02 * random::normal::<f64>(&mut rng)))
        .collect();
    let domain = Domain::cube(4, 1e-3, 1e3)?.with_scales(vec![Scale::Log; 4])?;
    let cost = move |p: &[f64]| rms(samples.iter().map(|(t, y)| model(p, *t) - y));
    Ok(FnProblem::new(domain, Box::new(cost)))
}

fn tasks() -> Result<Vec<Task>> {
    let function = |n: usize, limits: (f64, f64), cost: Cost| -> Result<FnProblem<Cost>> {
        Ok(FnProblem::new(Domain::cube(n, limits.0, limits.1)?, cost))
    };
    let raised = Some(1.0);
    let rastrigin =
        |x: &[f64]| -> Vec<f64> { x.iter().enumerate().map(|(i, x)| x - place(i)).collect() };
    Ok(vec![
        (
            "ellipsoid 6-D",
            function(6, (-5.0, 5.0), Box::new(|x| 1.0 + ellipsoid(x, 1e6, false)))?,
            raised,
        ),
        (
            "rotated 8-D",
            function(8, (-5.0, 5.0), Box::new(|x| 1.0 + ellipsoid(x, 1e4, true)))?,
            raised,
        ),
        (
            "valley 6-D",
            function(6, (-5.0, 10.0), Box::new(|x| 1.0 + (aep_problems::ROSENBROCK.cost)(x)))?,
            raised,
        ),
        (
            "Rastrigin 5-D",
            function(
                5,
                (-5.12, 5.12),
                Box::new(move |x| 1.0 + (aep_problems::RASTRIGIN.cost)(&rastrigin(x))),
            )?,
            raised,
        ),
        ("friction fit", friction_fit()?, None),
        ("decay fit", decay_fit()?, None),
    ])
}

/// The variants, one change after the other, and the yardsticks.
fn variants() -> Vec<(&'static str, Box<dyn Method>)> {
    let paper = Aep::paper();
    let relative = StepScale::Relative { floor: 0.1 };
    let diagonal = StepUnit::Population { share: 0.75 };
    let practical = Aep::practical();
    let mut all: Vec<(&'static str, Box<dyn Method>)> = Vec::new();
    let mut add = |name, aep: &Aep| all.push((name, Box::new(aep.clone())));
    add("paper", &paper);
    let above = paper.clone().with_steps(StepScale::AboveReference(1.0), StepUnit::Absolute);
    add("cost above 1", &above);
    let by_domain = paper.with_beta(0.05, 0.0005).with_steps(relative, StepUnit::Domain);
    add("relative cost, domain", &by_domain);
    add("... age at most 10", &by_domain.clone().with_age_limit(AgeLimit::Saturate(10)));
    let all_components = practical.clone().with_components(Components::All);
    add("relative cost, spread", &all_components.clone().with_steps(relative, diagonal));
    add("constant, spread", &all_components.clone().with_steps(StepScale::Constant, diagonal));
    add("constant, covariance", &all_components);
    add("... without adoption", &all_components.with_age_limit(AgeLimit::Saturate(3)));
    add("practical", &practical);
    for name in ["meta-ep-practical", "de", "de-fixed", "cma-es"] {
        all.extend(methods::find(name).map(|named| (name, (named.build)(0))));
    }
    all
}

fn main() -> Result<()> {
    let (tasks, variants) = (tasks()?, variants());
    let names: Vec<&str> = tasks.iter().map(|(name, ..)| *name).collect();
    println!("| variant | {} |\n|---|{}", names.join(" | "), "---:|".repeat(names.len()));
    let mut cells = vec![Vec::new(); variants.len()];
    for (_, problem, smallest) in &tasks {
        let plan = Plan::new(TRIALS, Budget::evaluations(EVALUATIONS));
        let runs =
            variants.iter().map(|(_, method)| plan.run(&**method, |_| problem as &dyn Problem));
        let runs: Vec<Trials> = runs.collect::<std::result::Result<_, _>>()?;
        let found = runs.iter().flat_map(|run| run.trials.iter().map(|trial| trial.cost));
        let smallest = smallest.unwrap_or(found.fold(f64::INFINITY, f64::min));
        for (cell, run) in cells.iter_mut().zip(&runs) {
            let summary = run.summary(smallest * (1.0 + 1e-5));
            let time = summary.expected_running_time;
            let time = time.map_or("-".to_owned(), |time| format!("{time:.0}"));
            cell.push(format!("{}/{TRIALS}, {time}", summary.successes));
        }
    }
    for ((name, _), cell) in variants.iter().zip(&cells) {
        println!("| {name} | {} |", cell.join(" | "));
    }
    Ok(())
}
