//! A selection of one's own with AEP's mutation: the better half of parents and children survives.
//! `cargo run --release -p aep-core --example own_selection`

use aep_core::{
    Aep, AepMutation, Budget, Domain, Driver, Engine, FnProblem, Individual, Population, Problem,
    Scalar, Selection, Start, Streams,
};

/// Plus selection: the best of both generations.
struct Plus;

impl<T: Scalar, I: Individual<T>> Selection<T, I> for Plus {
    fn select(&self, parents: &mut Population<T, I>, children: &mut Population<T, I>, _: Streams) {
        for i in 0..parents.len() {
            if children.costs[i] < parents.costs[i] {
                let (from, to) = (parents.positions.row(i), children.positions.row(i));
                children.individuals[i].won(from, to);
            } else {
                children.individuals[i].survived();
            }
            parents.individuals[i].survived();
        }
        let (mut worst_first, best_first) = (parents.ranking(), children.ranking());
        worst_first.reverse();
        for (slot, child) in worst_first.into_iter().zip(best_first) {
            if children.costs[child] < parents.costs[slot] {
                parents.take(slot, children, child);
            }
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let domain = Domain::cube(4, -5.0, 5.0)?;
    let bowl = FnProblem::new(domain, |x: &[f64]| {
        7.0 + x.iter().enumerate().map(|(i, x)| 10f64.powi(i as i32) * x * x).sum::<f64>()
    });
    let start = Start::new(bowl.domain(), 1);
    let mutation = AepMutation::new(Aep::practical());
    let mut engine = Engine::new("aep-plus", &start, 40, mutation, Plus)?;
    let outcome = Driver::new(Budget::evaluations(10_000)).run(&mut engine, &bowl)?;
    println!("{} after {} evaluations", outcome.cost, outcome.evaluations);
    Ok(())
}
