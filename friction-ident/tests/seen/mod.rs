//! What a user has of a simulated run.

use missing_physics::{Channel, Recording};

/// The positions of a run with the force that was recorded beside them.
pub fn seen(name: &str, run: &Recording, force: Vec<f64>) -> Recording {
    let position = run.require("position").unwrap().to_vec();
    let of = |name: &str, values| {
        let unit = &run.channel(name).unwrap().unit;
        Channel::new(name, unit.clone(), values)
    };
    let channels = vec![of("force", force), of("position", position)];
    Recording::new(name, run.time().to_vec(), channels).unwrap().with_hold(run.hold())
}
