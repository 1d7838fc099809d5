use super::*;
use crate::axis::Axis;

/// A sine motion: time, position, velocity, acceleration.
struct Sine {
    time: Vec<f64>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

impl Sine {
    fn new(amplitude: f64, frequency: f64, samples: u32) -> Self {
        let w = std::f64::consts::TAU * frequency;
        let time: Vec<f64> = (0..samples).map(|k| f64::from(k) * 1e-3).collect();
        let of = |f: &dyn Fn(f64) -> f64| time.iter().map(|t| f(w * t)).collect::<Vec<f64>>();
        let position = of(&|a| amplitude * a.sin());
        let velocity = of(&|a| amplitude * w * a.cos());
        let acceleration = of(&|a| -amplitude * w * w * a.sin());
        Self { time, position, velocity, acceleration }
    }

    fn motion(&self) -> MeasuredMotion<'_> {
        let (x, v, a) = (&self.position, &self.velocity, &self.acceleration);
        MeasuredMotion::new(&self.time, x, v, a).unwrap()
    }
}

fn table() -> Model {
    Model::new(Axis::Linear, 30.0)
        .and_then(|m| m.with("coulomb", &[("F_C", 8.0)]))
        .and_then(|m| m.with("viscous", &[("F_v", 200.0)]))
        .and_then(|m| m.with("stribeck", &[("dF", 4.0), ("v_s", 1e-2)]))
        .unwrap()
}

#[test]
fn a_memoryless_force_is_the_formula_at_every_sample() {
    let sine = Sine::new(0.1, 0.5, 2000);
    let force = force_along(&table(), &sine.motion());
    for (k, force) in force.iter().enumerate() {
        let (v, a) = (sine.velocity[k], sine.acceleration[k]);
        let level = 8.0 + 4.0 / (1.0 + (v / 1e-2).powi(2));
        let exact = 30.0 * a + 200.0 * v + level * v.signum();
        // At the two turns the velocity is zero to rounding: the direction is that of half a step to either
        // side, which cancels.
        let turns = v.abs() < 1e-9;
        let exact = if turns { 30.0 * a } else { exact };
        assert!(
            (force - exact).abs() < if turns { 1e-3 } else { 1e-9 },
            "sample {k}: {force} {exact}"
        );
    }
}

#[test]
fn the_direction_at_a_reversal_is_the_mean_over_the_sample() {
    let time: Vec<f64> = (0..7).map(|k| f64::from(k) * 1e-3).collect();
    // The velocity changes its sign a quarter of a step after sample 3.
    let velocity: Vec<f64> = (0..7).map(|k| 0.01 * (3.25 - f64::from(k))).collect();
    let none = vec![0.0; 7];
    let model = Model::new(Axis::Linear, 1.0).and_then(|m| m.with("coulomb", &[("F_C", 8.0)]));
    let motion = MeasuredMotion::new(&time, &none, &velocity, &none).unwrap();
    let force = force_along(&model.unwrap(), &motion);
    // Three quarters of the sample forth, one quarter back.
    let expected = [8.0, 8.0, 8.0, 4.0, -8.0, -8.0, -8.0];
    for (force, expected) in force.iter().zip(expected) {
        assert!((force - expected).abs() < 1e-9, "{force} {expected}");
    }
}

#[test]
fn a_contact_turns_the_step_at_reversal_into_a_ramp() {
    let sine = Sine::new(20e-6, 1.0, 1000);
    let model = table().without("stribeck").with("presliding", &[("k_t", 1e6)]).unwrap();
    let force = force_along(&model, &sine.motion());
    let smooth = |k: usize| 30.0 * sine.acceleration[k] + 200.0 * sine.velocity[k];
    // The turn is at sample 250; 8 N at 1e6 N/m are 8 um of travel down from 20 um.
    assert!((force[249] - smooth(249) - 8.0).abs() < 1e-6);
    let k = 330;
    let elastic = 8.0 - 1e6 * (sine.position[250] - sine.position[k]);
    assert!(elastic.abs() < 7.0);
    assert!((force[k] - smooth(k) - elastic).abs() < 0.01);
    assert!((force[500] - smooth(500) + 8.0).abs() < 1e-6);
}

#[test]
fn the_contact_starts_anew_in_every_segment() {
    let sine = Sine::new(20e-6, 1.0, 1000);
    let model = table().with("presliding", &[("k_t", 1e6)]).unwrap();
    let whole = force_along(&model, &sine.motion());
    let cut = sine.motion().with_segments(&[0..300, 300..1000]).unwrap();
    let cut = force_along(&model, &cut);
    assert_eq!(whole[..300], cut[..300]);
    // At sample 300 the axis moves backwards: a new segment starts in full sliding.
    assert!(cut[300] < 0.0 && whole[300] > cut[300] + 5.0);
}

#[test]
fn a_lag_asks_for_a_command_ahead_of_the_force() {
    let sine = Sine::new(0.1, 0.5, 2000);
    let base = table().without("coulomb").without("stribeck");
    let lagged = base.clone().with("actuator-lag", &[("tau", 2e-3)]).unwrap();
    let (force, command) =
        (force_along(&base, &sine.motion()), force_along(&lagged, &sine.motion()));
    let ahead = |k: usize| force[k] + 2e-3 * (force[k + 1] - force[k - 1]) / 2e-3;
    for (k, command) in command.iter().enumerate().take(1999).skip(1) {
        assert!((command - ahead(k)).abs() < 1e-9);
    }
}

#[test]
fn columns_times_values_are_the_force() {
    let sine = Sine::new(0.1, 0.5, 2000);
    let model = table()
        .with("asymmetry", &[])
        .and_then(|m| m.with("ripple", &[("b_2", 0.3)]))
        .and_then(|m| m.with("position-friction", &[]))
        .and_then(|m| m.with("actuator-lag", &[]))
        .and_then(|m| m.with("presliding", &[("k_t", 1e5)]))
        .and_then(|m| m.with("reversal-decay", &[("F_r", 0.7)]))
        .unwrap();
    let split = columns_along(&model, &sine.motion());
    let mut sum = split.rest.clone();
    for (address, column) in split.addresses.iter().zip(&split.columns) {
        let value = model.get(address).unwrap();
        sum.iter_mut().zip(column).for_each(|(sum, column)| *sum += value * column);
    }
    for (force, sum) in force_along(&model, &sine.motion()).iter().zip(&sum) {
        assert!((force - sum).abs() < 1e-9);
    }
}

#[test]
fn dwell_grows_while_the_axis_stands_and_keeps_its_length_while_it_slides() {
    let time: Vec<f64> = (0..40).map(|k| f64::from(k) * 0.1).collect();
    let velocity: Vec<f64> =
        (0..40).map(|k| if (10..20).contains(&k) { 1e-6 } else { 0.1 }).collect();
    let motion = MeasuredMotion::new(&time, &time, &velocity, &time).unwrap();
    let dwell = memory::dwell(&motion);
    assert_eq!((dwell[5], dwell[10]), (0.0, 0.0));
    assert!((dwell[15] - 0.5).abs() < 1e-12 && (dwell[19] - 0.9).abs() < 1e-12);
    assert!((dwell[30] - 0.9).abs() < 1e-12);
    let dwell = memory::dwell(&motion.with_rest_velocity(1e-7));
    assert!(dwell.iter().all(|dwell| *dwell == 0.0));
}

#[test]
fn channels_that_do_not_fit_are_named() {
    let error = MeasuredMotion::new(&[0.0, 1.0], &[0.0, 0.0], &[0.0], &[0.0, 0.0]).unwrap_err();
    assert_eq!(error, MotionError::Length { channel: "velocity", values: 1, samples: 2 });
    let sine = Sine::new(0.1, 0.5, 20);
    assert!(sine.motion().with_segments(&[0..10, 10..21]).is_err());
}
