//! The whole loop: a plant with a hidden effect, a file, a discovery, a model that another simulation follows.

use std::f64::consts::TAU;

use aep_data::{Mapping, load, to_csv};
use friction_ident::closed_loop::{Controller, Pd, Sample, Setup, closed_loop};
use friction_ident::family::{FrictionFamily, Options};
use friction_ident::{Axis, Model, control};
use missing_physics::report::Verdict;
use missing_physics::{Channel, Discovery, Fitted, Recording, confirm, discover};

use super::table::{among, plain, record};

/// What is looked for, apart from what is there.
const AMONG: [&str; 7] =
    ["stribeck", "asymmetry", "spring", "quadratic-drag", "drift", "ripple", "position-friction"];

/// Friction along the stroke that varies by as much as its mean.
const PROFILE: [(&str, f64); 6] =
    [("c_1", 2.5), ("c_2", 1.5), ("c_5", 2.4), ("c_6", -1.8), ("start", 0.0), ("end", 0.12)];

fn from_file(plant: &Model) -> FrictionFamily {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    std::fs::write(&path, to_csv(&record(plant))).unwrap();
    let recording = load(&path, &Mapping::default()).unwrap();
    FrictionFamily::new(&recording, &Options::default()).unwrap()
}

fn searched(plant: &Model) -> (FrictionFamily, Discovery) {
    let family = from_file(plant);
    let found = discover(&family, &among(&family, &AMONG), &mut ()).unwrap();
    (family, found)
}

#[test]
fn what_was_hidden_is_named_with_its_size_and_holds_elsewhere() {
    let cases: [(&str, &[(&str, f64)]); 2] =
        [("spring", &[("k", 200.0)]), ("quadratic-drag", &[("c", 900.0)])];
    for (effect, values) in cases {
        let plant = plain().with(effect, values).unwrap();
        let (family, found) = searched(&plant);
        assert_eq!(found.added, [effect], "{:?}", found.remains);
        let rung = found.ladder.last().unwrap();
        assert_eq!(rung.added, [effect]);
        let name = format!("{effect}.{}", values[0].0);
        let estimate = &rung.parameters[&name];
        assert!((estimate.value / values[0].1 - 1.0).abs() < 0.1, "{name}: {estimate:?}");
        // The model of the last rung is a plant of its own: another recording of it is followed as well.
        let indices = missing_physics::terms(&family, &rung.effects).unwrap();
        let values: Vec<f64> = Fitted { terms: indices.clone(), values: Vec::new() }
            .parameters(&family)
            .map(|(term, parameter)| rung.parameters[&term.key(parameter)].value)
            .collect();
        let model = family.model(&Fitted { terms: indices, values }).unwrap();
        assert_eq!(model.axis(), Axis::Linear);
        let again = confirm(&from_file(&model), &found.ladder, &among(&family, &AMONG)).unwrap();
        assert_eq!(again.last().unwrap().holds, Some(true), "{again:?}");
    }
}

/// After another homing, and with warmer oil, a ripple and a damping are still those of the axis.
#[test]
fn what_belongs_to_a_recording_does_not_speak_against_an_effect() {
    let ripple = [("a_1", 1.6), ("b_1", 0.4), ("l", 0.005)];
    let plant = |damping: f64| {
        Model::new(Axis::Linear, 35.0)
            .and_then(|model| model.with("coulomb", &[("F_C", 6.0)]))
            .and_then(|model| model.with("viscous", &[("F_v", damping)]))
            .and_then(|model| model.with("ripple", &ripple))
            .unwrap()
    };
    let (family, found) = searched(&plant(180.0));
    assert_eq!(found.added, ["ripple"], "{:?}", found.remains);
    let home = 1.7e-3;
    let other = record(&plant(150.0));
    let channels = other.channels().iter().map(|channel| {
        let by = if channel.name == "position" { home } else { 0.0 };
        let values = channel.values.iter().map(|value| value + by).collect();
        Channel::new(channel.name.clone(), channel.unit.clone(), values)
    });
    let other = Recording::new("other", other.time().to_vec(), channels.collect()).unwrap();
    let other = FrictionFamily::new(&other, &Options::default()).unwrap();
    let again = confirm(&other, &found.ladder, &among(&family, &AMONG)).unwrap();
    let last = again.last().unwrap();
    assert_eq!(last.holds, Some(true), "{last:?}");
    let own = |name: &str| last.own.iter().find(|own| own.name == name).unwrap().value;
    assert!((own("home") + home).abs() < 5e-5, "{last:?}");
    assert!((own("shear") * 180.0 / 150.0 - 1.0).abs() < 0.02, "{last:?}");
}

/// What each of them does hides the other one in part.
#[test]
fn two_strong_effects_that_hide_each_other_are_both_named() {
    let plant = plain()
        .with("position-friction", &PROFILE)
        .and_then(|plant| plant.with("ripple", &[("a_1", 1.3), ("a_2", 0.8), ("l", 0.005)]))
        .unwrap();
    let (_, found) = searched(&plant);
    let main = |name: &String| name.split(':').next().unwrap_or_default().to_owned();
    let mut named: Vec<String> = found.added.iter().map(main).collect();
    named.sort();
    assert_eq!(named, ["position-friction", "ripple"], "{:?}", found.remains);
}

/// A controller that knows the spring.
struct Stiff {
    pd: Pd,
    stiffness: f64,
}

impl Controller for Stiff {
    fn command(&mut self, sample: &Sample) -> f64 {
        self.stiffness * sample.reference + self.pd.command(sample)
    }
}

/// A flexure of 50 kg: its spring makes 912 N of force (rms), friction and inertia 17 N.
fn on_a_flexure() -> Recording {
    let stiffness = 3e5;
    let plant = Model::new(Axis::Linear, 50.0)
        .and_then(|model| model.with("coulomb", &[("F_C", 15.0)]))
        .and_then(|model| model.with("viscous", &[("F_v", 100.0)]))
        .and_then(|model| model.with("spring", &[("k", stiffness), ("x_0", 0.0)]))
        .unwrap();
    let sines = [(4e-3, 0.4), (1.5e-3, 1.1), (0.5e-3, 3.1)];
    let position =
        |time: f64| sines.map(|(size, hertz)| size * (TAU * hertz * time).sin()).iter().sum();
    let positions = (0..20_000).map(|k| position(1e-3 * f64::from(k))).collect();
    let reference = control::from_positions(1e-3, positions);
    let mut controller = Stiff { pd: Pd::new(2e5, 3e3), stiffness };
    let setup = Setup { encoder_resolution: 1e-7, force_noise: 0.05, seed: 5, ..Setup::default() };
    closed_loop(&plant, &reference, &mut controller, &setup).unwrap().recording
}

/// The base model, which has no spring, finds its mass at the limit of its search.
#[test]
fn a_spring_that_makes_nearly_all_of_the_force_is_named() {
    let family = FrictionFamily::new(&on_a_flexure(), &Options::default()).unwrap();
    let found = discover(&family, &among(&family, &AMONG), &mut ()).unwrap();
    assert!(found.added[0].starts_with("spring"), "{:?} {:?}", found.added, found.remains);
    let budget = found.budget.unwrap();
    assert!(budget.base > 1.5 && budget.last < 1.0, "{budget:?}");
}

#[test]
fn where_nothing_is_hidden_nothing_is_named() {
    let (_, found) = searched(&plain());
    assert_eq!(
        (found.verdict, found.added.len()),
        (Verdict::NothingMissing, 0),
        "{:?}",
        found.remains
    );
}
