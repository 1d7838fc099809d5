//! An effect of your own joins the screening like any other: a type, its table, one hook.
//!
//! The table of this example carries a cable chain whose drag grows towards one end of the stroke. No
//! effect of the library says so; with the user's own it is found, and its size with it.

use friction_ident::closed_loop::{Pd, Setup, closed_loop};
use friction_ident::effects::{About, Effect, Motion, Parameter, Parameters, Slot};
use friction_ident::family::{FrictionFamily, Options};
use friction_ident::{Axis, Library, Model, Quantity, challenge};
use missing_physics::{Settings, discover};

/// `dF exp(-x / l) s`: friction that decays along the stroke.
struct CableChain;

static CABLE_CHAIN: CableChain = CableChain;

static ABOUT: About = About {
    name: "cable-chain",
    title: "drag of the cable chain",
    equation: "dF exp(-x/l) s",
    parameters: &[
        Parameter::level("dF", "drag at the origin", Quantity::Force, 50.0, 2.0),
        Parameter::shape("l", "length over which it decays", Quantity::Length, (0.01, 1.0), 0.05),
    ],
    slots: &[Slot::FrictionLevel],
    shows: "(residual x sign of velocity) against position",
    reference: "this machine's drawing",
};

impl Effect for CableChain {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        for (i, level) in level.iter_mut().enumerate() {
            *level += p.get(0)[i] * (-m.position[i] / p.get(1)[i]).exp();
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let truth = Model::new(Axis::Linear, 35.0)?
        .with("coulomb", &[("F_C", 6.0)])?
        .with("viscous", &[("F_v", 150.0)])?
        .with_effect(&CABLE_CHAIN)?;
    let (mass, bandwidth) = (35.0, 110.0);
    let mut pd = Pd::new(mass * bandwidth * bandwidth, 1.6 * mass * bandwidth)
        .with_feedforward(mass)
        .with_smoothing(0.35);
    let setup = Setup {
        encoder_resolution: 1e-6,
        force_limit: 600.0,
        force_noise: 0.15,
        ..Setup::default()
    };
    let run = closed_loop(&truth, &challenge::excitation(), &mut pd, &setup)?;

    let options = Options { library: Library::builtin().with(&CABLE_CHAIN), ..Options::default() };
    let family = FrictionFamily::new(&run.recording, &options)?;
    let base = ["coulomb", "viscous", "offset"].map(str::to_owned).to_vec();
    let found = discover(&family, &Settings { base, ..Settings::default() }, &mut ())?;

    println!("{:?}: {}", found.verdict, found.added.join(", "));
    for name in ["cable-chain.dF", "cable-chain.l"] {
        let last = found.ladder.last().and_then(|rung| rung.parameters.get(name));
        println!("{name}: {last:?}");
    }
    assert_eq!(found.added.first().map(String::as_str), Some("cable-chain"));
    Ok(())
}
