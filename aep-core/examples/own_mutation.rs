//! A mutation of one's own under an existing selection, compared with AEP.
//! `cargo run --release -p aep-core --example own_mutation`

use aep_core::random::{self, Stream};
use aep_core::trials::Plan;
use aep_core::{
    Aep, Algorithm, Budget, Child, ConfigError, Domain, Engine, FnProblem, Method, Mutation,
    OneToOne, Population, Start,
};

/// Heavy-tailed steps: a Cauchy number per component, in hundredths of the domain.
struct Cauchy;

impl Mutation<f64> for Cauchy {
    type Individual = ();

    fn individual(&self, _: &Domain, _: &mut Stream) {}

    fn mutate(
        &self,
        parent: usize,
        population: &Population<f64, ()>,
        domain: &Domain,
        rng: &mut Stream,
        child: Child<'_, f64, ()>,
    ) {
        for (j, z) in population.positions.row(parent).iter().enumerate() {
            let (low, high) = (domain.search_lower()[j], domain.search_upper()[j]);
            let step = random::normal::<f64>(rng) / random::normal::<f64>(rng);
            child.position[j] = (z + 0.01 * (high - low) * step).clamp(low, high);
        }
    }
}

/// Makes the mutation a method that can be compared with others.
struct CauchyEp;

impl Method for CauchyEp {
    fn name(&self) -> String {
        "cauchy".into()
    }

    fn start(&self, start: &Start<'_>) -> Result<Box<dyn Algorithm>, ConfigError> {
        Ok(Box::new(Engine::new("cauchy", start, 40, Cauchy, OneToOne::Strict)?))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let domain = Domain::cube(5, -5.12, 5.12)?;
    let rastrigin = FnProblem::new(domain, |x: &[f64]| {
        x.iter().map(|x| 10.0 + x * x - 10.0 * (std::f64::consts::TAU * x).cos()).sum()
    });
    let plan = Plan::new(20, Budget::evaluations(20_000));
    for method in [&CauchyEp as &dyn Method, &Aep::practical()] {
        let summary = plan.run(method, |_| &rastrigin)?.summary(1e-2);
        let (solved, trials, median) = (summary.successes, summary.trials, summary.median);
        println!("{}: {solved} of {trials} solved, median {median:.2e}", summary.method);
    }
    Ok(())
}
