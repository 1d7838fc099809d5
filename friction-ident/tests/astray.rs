//! A base model that predicts best where the force hardly matters does not lead the search astray.

mod seen;

use std::f64::consts::PI;

use friction_ident::family::{FrictionFamily, Options};
use friction_ident::{Axis, Controller, Model, Pd, Setup, closed_loop, control};
use missing_physics::{Recording, Settings, discover};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use seen::seen;

/// A position controller to whose force a disturbance of 0.15 N comes that nobody records.
struct Shaken {
    pd: Pd,
    random: StdRng,
    disturbance: Vec<f64>,
}

impl Controller for Shaken {
    fn command(&mut self, sample: &closed_loop::Sample) -> f64 {
        let disturbance = 0.15 * self.random.sample::<f64, _>(StandardNormal);
        self.disturbance.push(disturbance);
        self.pd.command(sample) + disturbance
    }
}

/// A slow way there and back of an axis of 20 kg with a Stribeck curve, seen with 1 um.
fn slow_axis() -> Recording {
    let plant = Model::new(Axis::Linear, 20.0)
        .and_then(|model| model.with("coulomb", &[("F_C", 8.0)]))
        .and_then(|model| model.with("viscous", &[("F_v", 60.0)]))
        .and_then(|model| model.with("offset", &[("F_0", 1.5)]))
        .and_then(|model| model.with("stribeck:gaussian", &[("dF", 5.0), ("v_s", 8e-3)]))
        .unwrap();
    let smooth = |share: f64| share - (2.0 * PI * share).sin() / (2.0 * PI);
    let there = (0..8_200).map(|k| -0.1 * smooth(f64::from(k) / 8_200.0));
    let back = (0..11_500).map(|k| 0.12 * smooth(f64::from(k) / 11_500.0) - 0.1);
    let positions = there.chain(std::iter::repeat_n(-0.1, 300)).chain(back).collect();
    let reference = control::from_positions(1e-3, positions);
    let (pd, random) = (Pd::new(4e4, 900.0), StdRng::seed_from_u64(3));
    let mut shaken = Shaken { pd, random, disturbance: Vec::new() };
    let run = closed_loop(&plant, &reference, &mut shaken, &Setup::default()).unwrap();
    let force = run.command.iter().zip(&shaken.disturbance).map(|(f, d)| f - d).collect();
    seen("slow axis", &run.recording, force)
}

#[test]
fn a_slow_axis_whose_stribeck_curve_makes_it_look_heavy_is_told_the_curve_and_its_mass() {
    let family = FrictionFamily::new(&slow_axis(), &Options::default()).unwrap();
    let base = ["coulomb", "viscous", "offset"].map(str::to_owned).to_vec();
    let found = discover(&family, &Settings { base, ..Settings::default() }, &mut ()).unwrap();
    let mass = |rung: usize| found.ladder[rung].parameters["mass"].value;
    assert!(mass(0) > 60.0, "the base is no riddle: {}", mass(0));
    assert_eq!(found.added, ["stribeck:gaussian"]);
    assert!((mass(1) / 20.0 - 1.0).abs() < 0.2, "{}", mass(1));
}
