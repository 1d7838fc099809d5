//! Discoveries beside a given force, on recordings made here.

use missing_physics::{Channel, Discovery, Recording, Settings, discover};

use super::super::{FrictionFamily, Options};
use crate::effects::beside::MODEL_FORCE;

/// A force that is given for a motion of many speeds, less what is hidden: `lacks(position, velocity, acceleration)`.
fn recording(lacks: impl Fn(f64, f64, f64) -> f64) -> Recording {
    let step = 1e-3;
    let time: Vec<f64> = (0..12_000).map(|k| step * f64::from(k)).collect();
    let tones = [(0.05, 2.1, 0.0), (0.02, 5.3, 1.0), (0.004, 13.7, 2.0)];
    let of = |t: f64, law: fn(f64, f64, f64, f64) -> f64| -> f64 {
        tones.iter().map(|(a, w, p)| law(*a, *w, *p, t)).sum()
    };
    let mut state = 7u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 0.5
    };
    let (mut position, mut force, mut given) = (Vec::new(), Vec::new(), Vec::new());
    for &t in &time {
        let x = of(t, |a, w, p, t| a * (w * t + p).sin());
        let v = of(t, |a, w, p, t| a * w * (w * t + p).cos());
        let a = of(t, |a, w, p, t| -a * w * w * (w * t + p).sin());
        let own = 12.0 * a + 6.0 * v.signum() + 40.0 * v;
        position.push((x / 1e-6).round() * 1e-6);
        given.push(own);
        force.push(own + lacks(x, v, a) + noise());
    }
    let channel = |name: &str, unit: &str, values| Channel::new(name, unit, values);
    let channels = vec![
        channel("force", "N", force),
        channel("position", "m", position),
        channel(MODEL_FORCE, "N", given),
    ];
    Recording::new("given", time, channels).unwrap()
}

fn found(recording: &Recording, base: &[&str]) -> Discovery {
    let family = FrictionFamily::new(recording, &Options::default()).unwrap();
    assert!(family.is_beside());
    let base = base.iter().map(|name| (*name).to_owned()).collect();
    discover(&family, &Settings { base, ..Settings::default() }, &mut ()).unwrap()
}

#[test]
fn where_nothing_is_hidden_nothing_is_named() {
    let found = found(&recording(|_, _, _| 0.0), &[]);
    assert_eq!(found.added, Vec::<String>::new(), "{:?}", found.remains);
    assert_eq!(found.ladder.len(), 1);
}

#[test]
fn a_wrong_inertia_is_named_with_its_size() {
    let found = found(&recording(|_, _, a| -1.5 * a), &[]);
    assert_eq!(found.added, ["inertia"], "{:?}", found.remains);
    let dm = found.ladder[1].parameters["inertia.dm"].value;
    assert!((dm + 1.5).abs() < 0.05, "{dm}");
}

#[test]
fn a_hump_of_the_friction_is_named_alone() {
    let hump = |v: f64| 3.0 * v.signum() * (-(v / 0.02) * (v / 0.02)).exp();
    let found = found(&recording(|_, v, _| hump(v)), &[]);
    assert_eq!(found.added.len(), 1, "{:?}", found.added);
    assert!(found.added[0].starts_with("stribeck"), "{:?}", found.added);
}

#[test]
fn an_offset_in_the_base_is_fitted_and_not_named() {
    let found = found(&recording(|_, _, _| 2.0), &["offset"]);
    assert_eq!(found.added, Vec::<String>::new(), "{:?}", found.remains);
    let offset = found.ladder[0].parameters["offset.F_0"].value;
    assert!((offset - 2.0).abs() < 0.02, "{offset}");
}

#[test]
fn a_constant_shift_is_no_delay() {
    // The given force is a sample ahead of the recorded one.
    let mut made = recording(|_, _, _| 0.0);
    let mut channels = made.channels().to_vec();
    channels[2].values.rotate_left(1);
    made = Recording::new("late", made.time().to_vec(), channels).unwrap();
    let found = found(&made, &[]);
    assert_eq!(found.added, Vec::<String>::new(), "{:?}", found.remains);
    let shift = found.ladder[0].parameters["timing.shift"].value;
    assert!((shift + 1e-3).abs() < 1e-4, "{shift}");
}

#[test]
fn a_given_force_moved_by_part_of_a_sample_keeps_its_waves() {
    let wave = |k: f64| (0.2 * k).sin();
    let mut values: Vec<f64> = (0..200).map(|k| wave(f64::from(k))).collect();
    super::advance(&mut values, 0.5);
    for (k, value) in values.iter().enumerate().take(190).skip(5) {
        assert!((value - wave(k as f64 + 0.5)).abs() < 1e-4, "{k}");
    }
}
