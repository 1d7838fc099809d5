//! No argument of the public functions panics or runs for ever: what makes no sense is an error.

use friction_ident::control::{Compensator, Course, Settings};
use friction_ident::family::{FrictionFamily, Options};
use friction_ident::identify::all_free;
use friction_ident::simulator::DEFAULT_MAX_STEP;
use friction_ident::{
    Axis, Controller, Free, Horizon, Identification, Input, Library, MeasuredMotion, Model, Pd,
    Profile, Reference, Setup, Start, WindowOptions, closed_loop, columns_along, force_along,
    simulate, window_errors,
};
use missing_physics::{Channel, Hold, Recording};
use proptest::prelude::*;

const EXTREMES: [f64; 14] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    1e-3,
    1e-300,
    5e-324,
    1e300,
    -1e300,
    f64::MAX,
    f64::MIN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![prop::sample::select(EXTREMES.to_vec()), -10.0..10.0f64, any::<f64>()]
}

/// A number that steps and lengths of time usually are, or any.
fn duration() -> impl Strategy<Value = f64> {
    prop_oneof![3 => 1e-4..1e-1f64, 1 => number()]
}

fn numbers(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(number(), count)
}

/// Models of any effects with any values that a model takes.
fn model() -> impl Strategy<Value = Model> {
    let effects = Library::builtin().effects().len();
    let chosen = prop::collection::vec(0..effects, 0..4);
    (any::<bool>(), number(), chosen, numbers(0..20)).prop_map(|(linear, mass, chosen, values)| {
        let axis = if linear { Axis::Linear } else { Axis::Rotary };
        let plain = || Model::new(axis, 20.0).unwrap();
        let mut model = Model::new(axis, mass).unwrap_or_else(|_| plain());
        for k in chosen {
            let effect = Library::builtin().effects()[k];
            model = model.clone().with_effect(effect).unwrap_or(model);
        }
        for (address, value) in model.addresses().into_iter().zip(values) {
            // What is refused leaves the model as it was.
            let _ = model.set(&address, value);
        }
        model
    })
}

/// A motion that a drive could have made.
fn recording(samples: usize) -> Recording {
    let time: Vec<f64> = (0..samples).map(|k| k as f64 * 1e-3).collect();
    let position: Vec<f64> = time.iter().map(|t| 1e-3 * (20.0 * t).sin()).collect();
    let force: Vec<f64> = time.iter().map(|t| 5.0 * (20.0 * t).cos()).collect();
    let channels = vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
    Recording::new("run", time, channels).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_input_is_simulated_or_refused(
        model in model(),
        time in prop_oneof![numbers(0..5), prop::collection::vec(0.0..0.1f64, 0..20)],
        force in numbers(0..20),
        (position, velocity, command) in (number(), number(), number()),
        max_step in duration(),
        sampled in any::<bool>(),
    ) {
        let hold = if sampled { Hold::Sampled } else { Hold::ZeroOrder };
        let mut time = time;
        if sampled {
            time.sort_by(f64::total_cmp);
        }
        // Many steps are no fault, but take long.
        let span = time.last().zip(time.first()).map_or(0.0, |(b, a)| b - a);
        prop_assume!(!(span / max_step > 1e5 && span / max_step <= 1e11));
        let force = &force[..force.len().min(time.len())];
        let start = Start { command, ..Start::at(position, velocity) };
        let input = Input::new(&time, force, hold).with_max_step(max_step);
        if let Ok(run) = simulate(&model, &input, &start) {
            prop_assert_eq!(run.position.len(), time.len());
            prop_assert!(run.velocity.iter().skip(1).all(|v| v.is_finite()));
        }
    }

    #[test]
    fn any_loop_is_closed_or_refused(
        model in model(),
        (sample_time, gain, damping) in (duration(), number(), number()),
        (resolution, limit, force_resolution) in (number(), number(), number()),
        (noise, max_step) in (number(), duration()),
        lengths in (0..30usize, 0..30usize, 0..30usize, any::<bool>()),
    ) {
        let long = |count| vec![1e-3; count];
        let (a, b, c, same) = lengths;
        let (b, c) = if same { (a, a) } else { (b, c) };
        let (position, velocity, acceleration) = (long(a), long(b), long(c));
        let reference = Reference { sample_time, position, velocity, acceleration };
        let steps = a as f64 * sample_time / max_step;
        prop_assume!(!(steps > 1e5 && steps <= 1e11));
        let setup = Setup {
            encoder_resolution: resolution,
            force_limit: limit,
            force_resolution,
            force_noise: noise,
            max_step,
            seed: 1,
        };
        let run = closed_loop(&model, &reference, &mut Pd::new(gain, damping), &setup);
        prop_assert!(run.is_err() || (a == b && a == c));
        if let Ok(mut compensator) = Compensator::new(&model, Settings::new(sample_time, 1e-3)) {
            let sample = closed_loop::Sample {
                time: gain,
                reference: damping,
                reference_velocity: resolution,
                reference_acceleration: limit,
                position: noise,
            };
            let _ = (compensator.force(&sample), compensator.force(&sample));
            let _ = Pd::new(gain, damping).command(&sample);
        }
    }

    #[test]
    fn any_motion_gives_a_force_or_is_refused(
        model in model(),
        values in prop::collection::vec((number(), number(), number(), number()), 0..20),
        more in 0..3usize,
        segments in prop::collection::vec((0..25usize, 0..25usize), 0..3),
        rest in number(),
    ) {
        let of = |pick: fn(&(f64, f64, f64, f64)) -> f64| values.iter().map(pick).collect::<Vec<_>>();
        let (time, position, velocity) = (of(|v| v.0), of(|v| v.1), of(|v| v.2));
        let mut acceleration = of(|v| v.3);
        acceleration.extend(vec![0.0; more / 2]);
        let Ok(motion) = MeasuredMotion::new(&time, &position, &velocity, &acceleration) else {
            return Ok(());
        };
        let segments: Vec<_> = segments.into_iter().map(|(from, to)| from..to).collect();
        let Ok(motion) = motion.with_segments(&segments) else { return Ok(()) };
        let motion = motion.with_rest_velocity(rest).with_cutoff(rest);
        prop_assert_eq!(force_along(&model, &motion).len(), values.len());
        let _ = columns_along(&model, &motion);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn any_values_are_a_recording_or_not_and_a_recording_is_prepared_or_refused(
        values in prop::collection::vec((number(), number(), number(), 0..3i64), 0..40),
        even in any::<bool>(),
        bandwidth in prop::option::of(number()),
    ) {
        let time = (values.iter().enumerate())
            .map(|(k, v)| if even { k as f64 * 1e-3 } else { v.0 })
            .collect();
        let of = |pick: fn(&(f64, f64, f64, i64)) -> f64| values.iter().map(pick).collect::<Vec<_>>();
        let channels = vec![
            Channel::new("force", "N", of(|v| v.1)),
            Channel::new("position", "m", of(|v| v.2)),
        ];
        let segment = values.iter().map(|v| if even { 0 } else { v.3 }).collect();
        if let Ok(recording) = Recording::with_segments("any", time, channels, segment) {
            let options = Options { bandwidth, ..Options::default() };
            let _ = FrictionFamily::new(&recording, &options);
        }
    }

    #[test]
    fn any_identification_is_begun_or_refused(
        model in model(),
        (low, high, start) in (number(), number(), number()),
        (max_step, window) in (duration(), duration()),
        iterations in 0..5usize,
        which in 0..3u8,
    ) {
        let run = recording(60);
        prop_assume!(!(0.06 / max_step > 1e5 && 0.06 / max_step <= 1e11));
        let options = WindowOptions { length: window, iterations, max_step };
        let horizon = match which {
            0 => Horizon::FreeRun { max_step },
            1 => Horizon::ClosedLoop { controller: Pd::new(low, high), encoder_resolution: start, max_step },
            _ => Horizon::Windows(options),
        };
        let mut free = all_free(&model);
        free.push(Free { low, high, ..Free::linear("mass", 1.0, 2.0) });
        free.push(Free::log("no.such", 1.0, 2.0));
        for free in [&free[..], &free[..free.len() - 1], &free[..free.len() - 2], &[]] {
            let Ok(task) = Identification::new(&model, &run, free, horizon) else { continue };
            let _ = task.model(&[start]);
            let _ = task.model(&vec![start; free.len()]);
        }
        let _ = window_errors(&model, &run, &options);
    }
}

#[test]
fn steps_without_end_are_refused() {
    let model = Model::new(Axis::Linear, 20.0).unwrap();
    let start = Start::at(0.0, 0.0);
    for (time, max_step) in [
        ([0.0, f64::INFINITY], DEFAULT_MAX_STEP),
        ([0.0, f64::MAX], DEFAULT_MAX_STEP),
        ([0.0, 1.0], 1e-300),
        ([0.0, 1.0], f64::NAN),
        ([0.0, 1.0], 0.0),
    ] {
        let input = Input::new(&time, &[0.0, 0.0], Hold::ZeroOrder).with_max_step(max_step);
        assert!(simulate(&model, &input, &start).is_err(), "{time:?} {max_step}");
    }
    let reference = Profile::new(1e-3).dwell(1.0).build(0.0, 0.0);
    let closed = |setup: Setup| closed_loop(&model, &reference, &mut Pd::new(1e4, 1e2), &setup);
    assert!(closed(Setup::default()).is_ok());
    for max_step in [0.0, -1.0, f64::NAN, 1e-300] {
        assert!(closed(Setup { max_step, ..Setup::default() }).is_err(), "{max_step}");
    }
    for force_limit in [f64::NAN, -1.0] {
        assert!(closed(Setup { force_limit, ..Setup::default() }).is_err(), "{force_limit}");
    }
    let endless = Profile::new(1e-3).dwell(f64::INFINITY).travel(1.0, f64::NAN, 0.0);
    assert!(endless.build(0.0, f64::INFINITY).position.len() < 1_000_000);
    for (distance, speed) in [(1.0, -1.0), (1e-300, 1.0), (0.0, 0.0), (f64::NAN, 1.0)] {
        let course = Course::Trapezoid { distance, speed, acceleration: 1.0 };
        assert!(course.sampled(1e-3, 1.0).position.len() <= 1_001, "{course:?}");
    }
}
