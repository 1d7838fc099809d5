//! A hum of the supply, faster than any period that is tried along a recording, is told as such.

mod seen;

use std::f64::consts::TAU;

use friction_ident::family::{FrictionFamily, Options};
use friction_ident::{Axis, Controller, Model, Pd, Setup, closed_loop, control};
use missing_physics::report::{Course, Remains};
use missing_physics::{Recording, Settings, discover};
use seen::seen;

const SIZE: f64 = 6.0;
const PERIOD: f64 = 1.0 / 50.02;

/// A position controller to whose force a hum comes that nobody records.
struct Hummed {
    pd: Pd,
    hum: Vec<f64>,
}

impl Controller for Hummed {
    fn command(&mut self, sample: &closed_loop::Sample) -> f64 {
        let hum = SIZE * (TAU * 1e-3 * self.hum.len() as f64 / PERIOD).sin();
        self.hum.push(hum);
        self.pd.command(sample) + hum
    }
}

/// Ways there and back of an axis of 20 kg, seen with 1 um.
fn axis() -> Recording {
    let plant = Model::new(Axis::Linear, 20.0)
        .and_then(|model| model.with("coulomb", &[("F_C", 8.0)]))
        .and_then(|model| model.with("viscous", &[("F_v", 60.0)]))
        .unwrap();
    let time = (0..20_000).map(|k| 1e-3 * f64::from(k));
    let positions = time.map(|t| 0.05 * (TAU * 0.31 * t).sin() + 0.01 * (TAU * 1.3 * t).sin());
    let reference = control::from_positions(1e-3, positions.collect());
    let mut hummed = Hummed { pd: Pd::new(4e4, 900.0), hum: Vec::new() };
    let run = closed_loop(&plant, &reference, &mut hummed, &Setup::default()).unwrap();
    let force = run.command.iter().zip(&hummed.hum).map(|(force, hum)| force - hum).collect();
    seen("hum", &run.recording, force)
}

#[test]
fn a_hum_of_the_supply_is_told_with_its_size_and_its_period() {
    let family = FrictionFamily::new(&axis(), &Options::default()).unwrap();
    let base = ["coulomb", "viscous"].map(str::to_owned).to_vec();
    let found = discover(&family, &Settings { base, ..Settings::default() }, &mut ()).unwrap();
    assert!(found.added.is_empty(), "{:?}", found.added);
    let wave = found.remains.iter().find_map(|remains| match remains {
        Remains::Rival { course: Some(Course::Wave { amplitude, period, .. }), .. } => {
            Some((amplitude, period))
        }
        _ => None,
    });
    let (amplitude, period) = wave.expect("a wave is told");
    assert!((period / PERIOD - 1.0).abs() < 1e-3, "{period}");
    assert!((amplitude / SIZE - 1.0).abs() < 0.15, "{amplitude}");
}
