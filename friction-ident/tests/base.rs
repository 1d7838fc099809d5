//! A base model of many effects is found, whatever the number of their shapes.

mod seen;

use std::f64::consts::TAU;

use friction_ident::family::{FrictionFamily, Options};
use friction_ident::{Axis, Model, Pd, Setup, closed_loop, control};
use missing_physics::report::Verdict;
use missing_physics::{Recording, Settings, discover};
use seen::seen;

/// An axis of 20 kg with a Stribeck curve, a ripple of 4 mm and a contact, at many speeds, seen with 1 um.
fn axis() -> Recording {
    let plant = Model::new(Axis::Linear, 20.0)
        .and_then(|model| model.with("coulomb", &[("F_C", 8.0)]))
        .and_then(|model| model.with("viscous", &[("F_v", 60.0)]))
        .and_then(|model| model.with("offset", &[("F_0", 1.5)]))
        .and_then(|model| model.with("stribeck:gaussian", &[("dF", 6.0), ("v_s", 8e-3)]))
        .and_then(|model| model.with("ripple", &[("a_1", 2.0), ("b_1", 1.0), ("l", 4e-3)]))
        .and_then(|model| model.with("presliding", &[("k_t", 2e6)]))
        .unwrap();
    let at = |k: u32| {
        let t = 1e-3 * f64::from(k);
        0.03 * (TAU * 0.21 * t).sin() + 0.012 * (TAU * 0.53 * t).sin()
    };
    let reference = control::from_positions(1e-3, (0..20_000).map(at).collect());
    let mut controller = Pd::new(4e4, 900.0);
    let run = closed_loop(&plant, &reference, &mut controller, &Setup::default()).unwrap();
    seen("axis", &run.recording, run.command)
}

#[test]
fn effects_with_shapes_join_a_base_one_by_one_and_stand_where_they_were_asked_for() {
    let family = FrictionFamily::new(&axis(), &Options::default()).unwrap();
    // The last one is no candidate by itself: it begins as the contact that it is a form of.
    let names = ["coulomb", "viscous", "offset", "stribeck:gaussian", "ripple", "presliding:free"];
    let base = names.map(str::to_owned).to_vec();
    let settings = Settings { base: base.clone(), most: 0, ..Settings::default() };
    let found = discover(&family, &settings, &mut ()).unwrap();
    let model = &found.ladder[0];
    assert_eq!(model.effects, base);
    assert!(model.budget.unwrap() < 1.3, "{:?}", model.budget);
    assert_eq!(found.verdict, Verdict::NothingMissing, "{:?}", found.remains);
    for (parameter, truth, near) in [
        ("mass", 20.0, 0.02),
        ("viscous.F_v", 60.0, 0.1),
        ("stribeck:gaussian.dF", 6.0, 0.2),
        ("stribeck:gaussian.v_s", 8e-3, 0.2),
        ("ripple.l", 4e-3, 5e-3),
    ] {
        let value = model.parameters[parameter].value;
        assert!((value / truth - 1.0).abs() < near, "{parameter}: {value}");
    }
}
