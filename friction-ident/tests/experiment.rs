//! The motion that is proposed where a recording cannot tell effects apart does tell them apart.

use friction_ident::family::{FrictionFamily, Options};
use friction_ident::{Axis, Model, Pd, Profile, Reference, Setup, closed_loop};
use missing_physics::{Channel, Discovery, Recording, Settings, Thresholds, discover};

/// A table of 40 kg with 8 N of Coulomb and 200 N s/m of viscous friction, and one effect more.
fn table(effect: &str, values: &[(&str, f64)]) -> Model {
    Model::new(Axis::Linear, 40.0)
        .and_then(|model| model.with("coulomb", &[("F_C", 8.0)]))
        .and_then(|model| model.with("viscous", &[("F_v", 200.0)]))
        .and_then(|model| model.with(effect, values))
        .unwrap()
}

/// `plant` under a controller that knows nothing of its friction.
fn record(plant: &Model, reference: &Reference, seed: u64) -> Recording {
    let (mass, w) = (40.0, 110.0);
    let mut pd = Pd::new(mass * w * w, 1.6 * mass * w).with_feedforward(mass).with_smoothing(0.35);
    let setup = Setup { force_noise: 0.15, seed, ..Setup::default() };
    closed_loop(plant, reference, &mut pd, &setup).unwrap().recording
}

/// Slow sines: accelerations of at most 0.4 m/s^2, next to no slow motion.
fn sines() -> Reference {
    let sine = |profile: Profile, k: i32| {
        profile.reciprocate(0.02 + 0.002 * f64::from(k), 0.42 + 0.03 * f64::from(k), 2.0)
    };
    (0..8).fold(Profile::new(1e-3).dwell(0.1), sine).build(0.0, 0.05)
}

fn joined(first: &Recording, second: &Recording) -> Recording {
    let channel = |name: &str| {
        let values = [first, second].map(|r| r.require(name).unwrap().to_vec()).concat();
        Channel::new(name, "", values)
    };
    let channels = ["force", "position"].map(channel).to_vec();
    let time = [first.time(), second.time()].concat();
    let segment = (0..time.len()).map(|k| i64::from(k >= first.len())).collect();
    Recording::with_segments("both", time, channels, segment).unwrap().with_hold(first.hold())
}

fn found(family: &FrictionFamily) -> Discovery {
    let base = vec!["coulomb".to_owned(), "viscous".to_owned()];
    // What is named first is asked; effects along the position take most of the time.
    let exclude = vec!["ripple".to_owned(), "position-friction".to_owned()];
    // A wide margin: what is within it counts as not told apart.
    let thresholds = Thresholds { better: 200.0, ..Thresholds::default() };
    let settings = Settings { base, exclude, thresholds, most: 2, ..Settings::default() };
    discover(family, &settings, &mut ()).unwrap()
}

/// Whether `truth` is the first effect added, told from `rival`, and that is not named at all.
fn names_only(found: &Discovery, truth: &str, rival: &str) -> bool {
    let named = |name: &str| found.added.iter().any(|added| added == name);
    let both = |set: &[String]| [truth, rival].iter().all(|name| set.iter().any(|n| n == name));
    let doubted = found.ambiguous.iter().any(|set| both(&set.effects));
    found.added.first().is_some_and(|first| first == truth) && !named(rival) && !doubted
}

#[test]
fn the_proposed_motion_tells_apart_what_the_recording_cannot() {
    type Case = (&'static str, &'static str, &'static [(&'static str, f64)]);
    // Slower than where the search for `v_s` ends (0.05 m/s), or nothing would be told of it.
    let hump: &[(&'static str, f64)] = &[("dF", 1.0), ("v_s", 4.5e-2)];
    let cases: [Case; 2] =
        [("actuator-lag", "input-delay", &[("tau", 1.1e-3)]), ("stribeck", "quadratic-drag", hump)];
    for (truth, rival, values) in cases {
        let plant = table(truth, values);
        let first = record(&plant, &sines(), 1);
        let family = FrictionFamily::new(&first, &Options::default()).unwrap();
        let before = found(&family);
        assert!(!names_only(&before, truth, rival), "{truth} is no riddle: {:?}", before.added);

        let names = |names: [&str; 2]| names.map(str::to_owned).to_vec();
        let (below, rivals) = (names(["coulomb", "viscous"]), names([truth, rival]));
        let next = family.experiment_between(&below, &rivals, 1).unwrap();
        assert!(next.gain > 2.0, "{truth}: {} from {:?}", next.gain, next.here);
        assert!(next.tried.iter().all(|tried| tried.deviations.is_finite()));

        let second = record(&plant, &next.reference, 2);
        let both = FrictionFamily::new(&joined(&first, &second), &Options::default()).unwrap();
        let after = found(&both);
        assert!(names_only(&after, truth, rival), "{truth}: {:?}", after.added);
    }
}

#[test]
fn the_proposed_motion_keeps_to_what_the_axis_did() {
    let first = record(&table("stribeck", &[]), &sines(), 1);
    let family = FrictionFamily::new(&first, &Options::default()).unwrap();
    let names = |names: [&str; 2]| names.map(str::to_owned).to_vec();
    let (below, rivals) = (names(["coulomb", "viscous"]), names(["stribeck", "input-delay"]));
    let next = family.experiment_between(&below, &rivals, 1).unwrap();
    let extremes = |values: &[f64]| {
        values.iter().fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(*x), high.max(*x)))
    };
    let (seen, asked) =
        (extremes(first.require("position").unwrap()), extremes(&next.reference.position));
    assert!(asked.0 >= seen.0 && asked.1 <= seen.1, "{asked:?} beyond {seen:?}");
    let fastest = |values: &[f64]| values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    assert!(fastest(&next.reference.velocity) <= fastest(&family.prepared().velocity));
    assert!(family.experiment_between(&below, &rivals[..1], 1).is_err());
}
