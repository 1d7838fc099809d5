//! A problem of one's own: two methods. `cargo run --release -p aep-core --example own_problem`

use aep_core::{Aep, Budget, Domain, Problem, minimize};

/// Fits a decay a exp(-k t) to a few samples.
struct Decay {
    domain: Domain,
}

impl Problem for Decay {
    fn domain(&self) -> &Domain {
        &self.domain
    }

    fn evaluate(&self, x: &[f64]) -> f64 {
        let samples = [(0.0, 2.05), (1.0, 1.21), (2.0, 0.74), (4.0, 0.27)];
        samples.iter().map(|(t, y)| (x[0] * f64::exp(-x[1] * t) - y).powi(2)).sum()
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let domain = Domain::new(vec![0.0, 0.0], vec![10.0, 5.0])?.with_names(["a", "k"])?;
    let outcome = minimize(&Decay { domain }, &Aep::practical(), Budget::evaluations(4_000), 1)?;
    println!("a, k = {:.4?}, cost {:.6}, {}", outcome.position, outcome.cost, outcome.stop);
    Ok(())
}
