//! A pendulum is not told as a spring that stiffens, whose three parameters follow its sine over half a turn.

mod seen;

use std::f64::consts::TAU;

use friction_ident::family::{FrictionFamily, Options};
use friction_ident::{Axis, Model, Pd, Setup, closed_loop, control};
use missing_physics::{Recording, Settings, discover};
use seen::seen;

/// A joint that swings from 0 to 1.8 rad, seen with 1 mrad.
fn joint() -> Recording {
    let plant = Model::new(Axis::Rotary, 0.08)
        .and_then(|model| model.with("coulomb", &[("F_C", 0.4)]))
        .and_then(|model| model.with("viscous", &[("F_v", 0.3)]))
        .and_then(|model| model.with("gravity-pendulum", &[("M", 1.2), ("q_0", 0.0)]))
        .unwrap();
    let time = (0..12_000).map(|k| 1e-3 * f64::from(k));
    let positions = time.map(|t| 0.9 - 0.9 * (TAU * 0.23 * t).cos() + 0.2 * (TAU * 0.9 * t).sin());
    let reference = control::from_positions(1e-3, positions.collect());
    let setup = Setup { encoder_resolution: 1e-3, ..Setup::default() };
    let run = closed_loop(&plant, &reference, &mut Pd::new(60.0, 3.0), &setup).unwrap();
    seen("joint", &run.recording, run.command)
}

#[test]
fn of_a_pendulum_and_a_spring_that_imitates_it_with_more_parameters_the_pendulum_is_told() {
    let family = FrictionFamily::new(&joint(), &Options::default()).unwrap();
    let base = ["coulomb", "viscous", "offset"].map(str::to_owned).to_vec();
    let found = discover(&family, &Settings { base, ..Settings::default() }, &mut ()).unwrap();
    assert_eq!(found.added, ["gravity-pendulum"]);
}
