//! A table of 35 kg with friction, recorded under a controller that knows nothing of its friction.

use friction_ident::closed_loop::{Pd, Setup, closed_loop};
use friction_ident::effects::ALL;
use friction_ident::family::FrictionFamily;
use friction_ident::{Axis, Model, challenge};
use missing_physics::{ModelFamily, Recording, Settings};

/// Coulomb and viscous friction.
pub fn plain() -> Model {
    Model::new(Axis::Linear, 35.0)
        .and_then(|model| model.with("coulomb", &[("F_C", 6.0)]))
        .and_then(|model| model.with("viscous", &[("F_v", 150.0)]))
        .unwrap()
}

/// `plant` as it moves under the usual excitation.
pub fn record(plant: &Model) -> Recording {
    let (mass, bandwidth) = (35.0, 110.0);
    let mut pd = Pd::new(mass * bandwidth * bandwidth, 1.6 * mass * bandwidth)
        .with_feedforward(mass)
        .with_smoothing(0.35);
    let setup = Setup {
        encoder_resolution: 1e-7,
        force_limit: 600.0,
        force_noise: 0.15,
        ..Setup::default()
    };
    closed_loop(plant, &challenge::excitation(), &mut pd, &setup).unwrap().recording
}

/// A search beside coulomb, viscous and offset in which only `effects` of those of the library take part.
pub fn among(family: &FrictionFamily, effects: &[&str]) -> Settings<'static> {
    let base = ["coulomb", "viscous", "offset"].map(str::to_owned).to_vec();
    let of_library = |name: &&str| ALL.iter().any(|effect| effect.about().name == *name);
    let all = family.terms().iter().map(|term| term.name.as_str()).filter(of_library);
    let left_out = all.filter(|name| !effects.contains(name) && !base.iter().any(|b| b == name));
    let exclude = left_out.map(str::to_owned).collect();
    Settings { base, exclude, ..Settings::default() }
}
