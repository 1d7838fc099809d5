use std::sync::atomic::AtomicBool;

use aep_core::Aep;
use missing_physics::fit::Until;
use missing_physics::{Channel, Hold};

use super::*;
use crate::axis::Axis;
use crate::closed_loop::{Setup, closed_loop};
use crate::reference::Reference;
use crate::simulator::{Input, Start, simulate};

fn table() -> Model {
    Model::new(Axis::Linear, 33.0)
        .and_then(|m| m.with("coulomb", &[("F_C", 8.0)]))
        .and_then(|m| m.with("viscous", &[("F_v", 200.0)]))
        .unwrap()
}

fn recording(model: &Model, count: f64) -> Recording {
    let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 2e-3).collect();
    let force: Vec<f64> =
        time.iter().map(|t| 30.0 * (5.0 * t).sin() + 10.0 * (17.0 * t).sin()).collect();
    let input = Input::new(&time, &force, Hold::ZeroOrder).with_max_step(1e-4);
    let out = simulate(model, &input, &Start::at(0.0, 0.0)).unwrap();
    let position = out.position.iter().map(|x| (x / count).round() * count).collect();
    let channels = vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
    Recording::new("simulated", time, channels).unwrap().with_hold(Hold::ZeroOrder)
}

fn free() -> Vec<Free> {
    vec![
        Free::log("mass", 5.0, 100.0),
        Free::linear("coulomb.F_C", 0.0, 20.0),
        Free::linear("viscous.F_v", 0.0, 1000.0),
    ]
}

fn assert_found(horizon: Horizon, tolerance: f64) {
    let data = recording(&table(), 1e-6);
    let task = Identification::new(&table(), &data, &free(), horizon).unwrap();
    let aep = Aep::practical().with_population(24);
    let found = task.run(&aep, Budget::generations(120), 3).unwrap();
    for ((free, x), truth) in free().iter().zip(&found.position).zip([33.0, 8.0, 200.0]) {
        assert!((x / truth - 1.0).abs() < tolerance, "{}: {x}, {}", free.address, found.cost);
    }
    for (interval, truth) in intervals(&task, &found.position).iter().zip([33.0, 8.0, 200.0]) {
        assert!(interval.identifiable, "{interval:?}");
        let room = 2.0 * tolerance * truth;
        assert!(interval.low - room < truth && truth < interval.high + room, "{interval:?}");
    }
}

#[test]
fn a_free_run_gives_the_parameters_back() {
    assert_found(Horizon::FreeRun { max_step: 2e-3 }, 2e-3);
}

#[test]
fn windows_give_the_parameters_back() {
    let options = WindowOptions { max_step: 2e-3, ..WindowOptions::new(0.2) };
    assert_found(Horizon::Windows(options), 2e-3);
}

#[test]
fn a_closed_loop_under_the_known_controller_gives_the_parameters_back() {
    let pd = Pd::new(2e4, 1e3).with_smoothing(0.5);
    let time = || (0..2000).map(|k| 2e-3 * f64::from(k));
    let swing = |t: f64, w: f64, amplitude: f64| amplitude * (1.0 - (w * t).cos());
    let reference = Reference {
        sample_time: 2e-3,
        position: time().map(|t| swing(t, 3.0, 0.02) + swing(t, 25.0, 0.001)).collect(),
        velocity: time().map(|t| 0.06 * (3.0 * t).sin() + 0.025 * (25.0 * t).sin()).collect(),
        acceleration: vec![0.0; 2000],
    };
    let setup = Setup { encoder_resolution: 0.0, max_step: 2e-3, ..Setup::default() };
    let run = closed_loop(&table(), &reference, &mut pd.clone(), &setup).unwrap();
    let horizon = Horizon::ClosedLoop { controller: pd, encoder_resolution: 0.0, max_step: 2e-3 };
    let task = Identification::new(&table(), &run.recording, &free(), horizon).unwrap();
    let found = task.run(&Aep::practical().with_population(24), Budget::generations(60), 3);
    let found = task.refine(&found.unwrap().position);
    for (x, truth) in found.position.iter().zip([33.0, 8.0, 200.0]) {
        assert!((x / truth - 1.0).abs() < 0.02, "{found:?}");
    }
    let data = recording(&table(), 1e-6);
    let lacking = Identification::new(&table(), &data, &free(), horizon);
    assert!(matches!(lacking, Err(IdentifyError::Recording(_))));
}

#[test]
fn who_is_told_to_stop_keeps_what_was_found() {
    let data = recording(&table(), 1e-6);
    let horizon = Horizon::FreeRun { max_step: 2e-3 };
    let stop = AtomicBool::new(true);
    let task = Identification::new(&table(), &data, &free(), horizon).unwrap();
    let task = task.until(Until::stopped(&stop));
    let aep = Aep::practical().with_population(24);
    let found = task.run_from(&[task.start()], &aep, Budget::generations(120), 3).unwrap();
    assert!(found.generations <= 1, "{found:?}");
    assert_eq!(task.refine_around(&found.position).position, found.position);
}

#[test]
fn costs_do_not_depend_on_the_batch() {
    let data = recording(&table(), 1e-6);
    let horizon = Horizon::FreeRun { max_step: 2e-3 };
    let task = Identification::new(&table(), &data, &free(), horizon).unwrap();
    let points: Vec<f64> =
        (0..7).flat_map(|k| [20.0 + f64::from(k), 5.0 + f64::from(k), 150.0]).collect();
    let mut together = [0.0; 7];
    task.evaluate_batch(Batch::new(3, &points), &mut together);
    for (k, cost) in together.iter().enumerate() {
        assert_eq!(task.evaluate(&points[3 * k..3 * k + 3]).to_bits(), cost.to_bits());
    }
}

#[test]
fn a_parameter_without_influence_is_reported_as_such() {
    let model = table().with("stribeck", &[("dF", 1e-9), ("v_s", 1e-3)]).unwrap();
    let data = recording(&model, 1e-6);
    let mut free = free();
    free.push(Free::log("stribeck.v_s", 1e-5, 1e-1));
    let horizon = Horizon::FreeRun { max_step: 2e-3 };
    let task = Identification::new(&model, &data, &free, horizon).unwrap();
    let found = intervals(&task, &task.start());
    assert!(found[0].identifiable && found[1].identifiable && found[2].identifiable);
    assert!(!found[3].identifiable, "{:?}", found[3]);
}

#[test]
fn the_gain_of_a_motor_is_known_only_where_the_mass_is() {
    let model = table().with("motor-gain", &[("g", 1.0)]).unwrap();
    let data = recording(&model, 1e-6);
    let mut free = free();
    free.push(Free::log("motor-gain.g", 0.5, 2.0));
    let windows = WindowOptions { max_step: 2e-3, ..WindowOptions::new(0.2) };
    for horizon in [Horizon::FreeRun { max_step: 2e-3 }, Horizon::Windows(windows)] {
        let task = Identification::new(&model, &data, &free, horizon).unwrap();
        for (free, interval) in free.iter().zip(intervals(&task, &task.start())) {
            assert!(!interval.identifiable, "{} {interval:?}", free.address);
        }
        let task = Identification::new(&model, &data, &free[1..], horizon).unwrap();
        for (free, interval) in free[1..].iter().zip(intervals(&task, &task.start())) {
            assert!(interval.identifiable, "{} {interval:?}", free.address);
        }
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let data = recording(&table(), 1e-6);
    let horizon = Horizon::FreeRun { max_step: 2e-3 };
    let unknown = [Free::linear("coulomb.F_S", 0.0, 1.0)];
    let refused = Identification::new(&table(), &data, &unknown, horizon);
    assert!(matches!(refused, Err(IdentifyError::Model(_))));
    let empty = [Free::linear("coulomb.F_C", 1.0, 1.0)];
    let refused = Identification::new(&table(), &data, &empty, horizon);
    assert!(matches!(refused, Err(IdentifyError::Domain(_))));
}

#[test]
fn all_free_leaves_out_what_is_not_fitted() {
    let model = table().with("position-friction", &[]).unwrap();
    let addresses: Vec<String> = all_free(&model).into_iter().map(|free| free.address).collect();
    assert!(addresses.contains(&"mass".into()) && addresses.contains(&"viscous.F_v".into()));
    assert!(!addresses.contains(&"position-friction.start".into()));
}
