//! What a user has of a simulated run.

use missing_physics::{Channel, Recording};

/// The positions of a run with the force that was recorded beside them.
pub fn seen(name: &str, run: &Recording, force: Vec<f64>) -> Recording {
    let position = run.require("position").unwrap().to_vec();
    let channels = vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
    Recording::new(name, run.time().to_vec(), channels).unwrap().with_hold(run.hold())
}
