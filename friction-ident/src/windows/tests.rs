use missing_physics::{Channel, Hold};

use super::*;
use crate::axis::Axis;
use crate::challenge::{Hide, Level, generate};
use crate::simulator::{Input, Start, simulate};

fn table() -> Model {
    Model::new(Axis::Linear, 33.0)
        .and_then(|m| m.with("coulomb", &[("F_C", 8.0)]))
        .and_then(|m| m.with("viscous", &[("F_v", 200.0)]))
        .unwrap()
}

/// A simulated recording of `model`, position in whole counts of `count` m.
fn recording(model: &Model, count: f64, hold: Hold) -> Recording {
    let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 1e-3).collect();
    let force: Vec<f64> = time.iter().map(|t| 30.0 * (5.0 * t).sin()).collect();
    let input = Input::new(&time, &force, hold).with_max_step(1e-4);
    let out = simulate(model, &input, &Start::at(0.0, 0.0)).unwrap();
    let position = out.position.iter().map(|x| (x / count).round() * count).collect();
    let channels = vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
    Recording::new("simulated", time, channels).unwrap().with_hold(hold)
}

#[test]
fn the_true_model_misses_by_the_quantisation_alone() {
    for hold in [Hold::ZeroOrder, Hold::Sampled] {
        let data = recording(&table(), 1e-6, hold);
        for length in [0.1, 0.2] {
            let errors = window_errors(&table(), &data, &WindowOptions::new(length)).unwrap();
            assert!(errors.median() < 0.32e-6, "{length}: {:.3e}", errors.median());
            assert!(errors.robust_rms() < 0.36e-6, "{length}: {:.3e}", errors.robust_rms());
        }
    }
}

#[test]
fn a_wrong_parameter_shows_and_more_so_in_longer_windows() {
    let data = recording(&table(), 1e-6, Hold::ZeroOrder);
    let mut wrong = table();
    wrong.set("coulomb.F_C", 7.0).unwrap();
    let at = |length| window_errors(&wrong, &data, &WindowOptions::new(length)).unwrap().median();
    assert!(at(0.1) > 3e-6 && at(0.2) > 3.0 * at(0.1), "{:.3e} {:.3e}", at(0.1), at(0.2));
}

#[test]
fn windows_stay_within_segments_and_lie_side_by_side() {
    let whole = recording(&table(), 1e-6, Hold::ZeroOrder);
    let segment = (0..4000).map(|k| i64::from(k >= 1950)).collect();
    let data =
        Recording::with_segments("two", whole.time().to_vec(), whole.channels().to_vec(), segment)
            .unwrap();
    let errors = window_errors(&table(), &data, &WindowOptions::new(0.2)).unwrap();
    assert_eq!(errors.windows.len(), 9 + 10);
    for window in &errors.windows {
        assert!(data.segments()[window.segment].contains(&window.samples.start));
        assert!(data.segments()[window.segment].contains(&(window.samples.end - 1)));
        assert_eq!(window.samples.len(), 201);
    }
}

/// Windows share lanes of a batch one after the other: nothing of an earlier window may be left there.
#[test]
fn a_window_does_not_depend_on_those_simulated_before_it() {
    let models: [&[&str]; 3] = [
        &["presliding", "load-friction", "input-delay", "stribeck", "frictional-memory"],
        &["flexible-coupling", "actuator-lag", "rising-static-friction", "drift"],
        &["presliding:lugre", "load-friction", "position-friction:fine"],
    ];
    for effects in models {
        let with = |model: Model, effect: &&str| model.with(effect, &[]).unwrap();
        let model = effects.iter().fold(table(), with);
        let recording = recording(&model, 1e-7, Hold::ZeroOrder);
        let data = Data::new(&recording, &WindowOptions::new(0.1)).unwrap();
        let mut used = Fitter::new(&model, &data);
        for windows in data.cut().chunks(TOGETHER) {
            let rms = |windows: Vec<Window>| windows.iter().map(|w| w.rms).collect::<Vec<f64>>();
            let fresh = Fitter::new(&model, &data).fit(windows);
            assert_eq!(rms(used.fit(windows)), rms(fresh), "{effects:?}");
        }
    }
}

#[test]
fn a_contact_is_fitted_with_its_utilisation() {
    let model = table().with("presliding", &[("k_t", 5e5)]).unwrap();
    let data = recording(&model, 1e-7, Hold::ZeroOrder);
    let errors = window_errors(&model, &data, &WindowOptions::new(0.1)).unwrap();
    assert!(errors.median() < 0.1e-6, "{:.3e}", errors.median());
}

#[test]
fn the_truth_of_a_challenge_is_at_the_floor_and_the_base_model_is_not() {
    // What the encoder shows wrongly is of the size of its counts.
    for (effect, ratio) in [("ripple", 5.0), ("encoder", 1.5)] {
        let made = generate(&Hide::Effect(effect.into()), 1, Level::Clear).unwrap();
        let options = WindowOptions::new(0.1);
        let truth = window_errors(&made.truth.model, &made.recording, &options).unwrap();
        let base = made.truth.model.clone().without(effect);
        let base = window_errors(&base, &made.recording, &options).unwrap();
        assert!(truth.robust_rms() < 2e-6, "{effect}: {:.3e}", truth.robust_rms());
        let (base, truth) = (base.robust_rms(), truth.robust_rms());
        assert!(base > ratio * truth, "{effect}: {base:.3e} {truth:.3e}");
    }
}

#[test]
fn windows_longer_than_the_recording_are_refused() {
    let data = recording(&table(), 1e-6, Hold::ZeroOrder);
    let refused = window_errors(&table(), &data, &WindowOptions::new(10.0));
    assert_eq!(refused, Err(WindowError::TooShort { length: 10.0 }));
    let options = WindowOptions { max_step: 0.0, ..WindowOptions::new(0.1) };
    assert!(matches!(window_errors(&table(), &data, &options), Err(WindowError::Simulation(_))));
}
