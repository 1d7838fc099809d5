use std::f64::consts::PI;

use missing_physics::Channel;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::*;
use crate::axis::Axis;
use crate::simulator::{Input, Start, simulate};

pub(super) const MASS: f64 = 33.0;
pub(super) const DAMPING: f64 = 200.0;
/// Counts of the encoder, m.
const COUNT: f64 = 1e-6;
const SAMPLES: u32 = 8000;

pub(super) fn table() -> Model {
    Model::new(Axis::Linear, MASS)
        .and_then(|m| m.with("coulomb", &[("F_C", 8.0)]))
        .and_then(|m| m.with("viscous", &[("F_v", DAMPING)]))
        .unwrap()
}

/// What the sensors add: standard deviations.
#[derive(Clone, Copy)]
struct Sensors {
    position: f64,
    force: f64,
}

const QUIET: Sensors = Sensors { position: 0.0, force: 0.0 };

/// A recording of `model` that is simulated with twenty steps a sample and read in counts.
fn recording(model: &Model, hold: Hold, sensors: Sensors) -> Recording {
    commanded(model, hold, sensors, |t| 24.0 * (5.0 * t).sin() + 12.0 * (13.0 * t + 1.0).sin())
}

/// The same under a command over time.
fn commanded(
    model: &Model,
    hold: Hold,
    sensors: Sensors,
    command: impl Fn(f64) -> f64,
) -> Recording {
    commanded_every(1e-3, model, hold, sensors, command)
}

/// The same with so many seconds between two samples.
fn commanded_every(
    interval: f64,
    model: &Model,
    hold: Hold,
    sensors: Sensors,
    command: impl Fn(f64) -> f64,
) -> Recording {
    let time: Vec<f64> = (0..SAMPLES).map(|k| f64::from(k) * interval).collect();
    let force: Vec<f64> = time.iter().map(|t| command(*t)).collect();
    let input = Input::new(&time, &force, hold).with_max_step(5e-5);
    let out = simulate(model, &input, &Start::at(0.0, 0.0)).unwrap();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let shown = |x: &f64| ((x + sensors.position * normal()) / COUNT).round() * COUNT;
    let position = out.position.iter().map(shown).collect();
    let force = force.iter().map(|f| f + sensors.force * normal()).collect();
    let channels = vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
    Recording::new("simulated", time, channels).unwrap().with_hold(hold)
}

/// A command with 80 Hz beside a slow motion, N.
fn fast(t: f64) -> f64 {
    24.0 * (5.0 * t).sin() + 300.0 * (8.0 * t).sin() * (500.0 * t).sin()
}

fn predictor(recording: &Recording) -> Predictor {
    Predictor::new(recording, MASS, DAMPING).unwrap()
}

pub(super) fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

/// Autocorrelation at lag 1.
fn lag_one(errors: &[f64]) -> f64 {
    let product: f64 = errors.windows(2).map(|pair| pair[0] * pair[1]).sum();
    product / errors.iter().map(|e| e * e).sum::<f64>()
}

/// Setting at which a model predicts best, and its errors there.
pub(super) fn best(predictor: &Predictor, model: &Model) -> (usize, Vec<f64>) {
    let trials: Vec<(Model, usize)> =
        (0..predictor.settings()).map(|setting| (model.clone(), setting)).collect();
    let all = predictor.errors(&trials).into_iter().enumerate();
    all.min_by(|a, b| rms(&a.1).total_cmp(&rms(&b.1))).unwrap()
}

#[test]
fn what_the_true_plant_leaves_is_white_and_as_large_as_the_sensors_make_it() {
    for hold in [Hold::ZeroOrder, Hold::Sampled] {
        for position in [0.0, 2e-6] {
            let predictor = predictor(&recording(&table(), hold, Sensors { position, ..QUIET }));
            let (setting, errors) = best(&predictor, &table());
            let ratio = rms(&errors) / predictor.budget();
            // Of counts alone the noise is told too large, and so is the budget.
            let low = if position == 0.0 { 0.75 } else { 0.85 };
            assert!((low..1.15).contains(&ratio), "{hold:?} {position}: {ratio} at {setting}");
            let lag = lag_one(&errors);
            assert!(lag.abs() < 0.1, "{hold:?} {position}: {lag} at {setting}");
        }
    }
}

#[test]
fn a_command_that_is_held_and_read_as_sampled_shows() {
    let data = recording(&table(), Hold::ZeroOrder, QUIET);
    let truth = best(&predictor(&data), &table()).1;
    let wrong = best(&predictor(&data.clone().with_hold(Hold::Sampled)), &table()).1;
    assert!(rms(&wrong) > 1.02 * rms(&truth), "{:.3e} {:.3e}", rms(&wrong), rms(&truth));
}

#[test]
fn a_step_a_sample_follows_a_force_that_changes_within_it() {
    for hold in [Hold::ZeroOrder, Hold::Sampled] {
        let predictor = predictor(&commanded(&table(), hold, QUIET, fast));
        let (setting, errors) = best(&predictor, &table());
        let ratio = rms(&errors) / predictor.budget();
        assert!(setting == 0 && ratio < 0.9, "{hold:?}: {ratio} at {setting}");
    }
}

#[test]
fn a_few_steps_a_sample_follow_a_slow_recording() {
    // Twenty samples a second, under a force that is as slow; with a spring, too, on which the mass swings in nine samples.
    let sprung = table().with("spring", &[("k", MASS * (2.0 * PI / 0.45).powi(2))]).unwrap();
    let slow = |t: f64| 24.0 * t.sin() + 12.0 * (2.6 * t + 1.0).sin();
    for (hold, model) in
        [(Hold::ZeroOrder, table()), (Hold::Sampled, table()), (Hold::Sampled, sprung)]
    {
        let predictor = predictor(&commanded_every(0.05, &model, hold, QUIET, slow));
        // No more than one and a half times what the counts make.
        let left = rms(&best(&predictor, &model).1);
        assert!(left < 1.5 * COUNT / 12f64.sqrt(), "{hold:?}: {left:.3e}");
    }
}

#[test]
fn a_delay_of_part_of_a_sample_is_no_actuator() {
    // A delay turns the phase of a fast command, an actuator that is as late lowers its gain besides.
    let late = 0.65e-3;
    let delayed = table().with("input-delay", &[("T_d", late)]).unwrap();
    let predictor = predictor(&commanded(&delayed, Hold::ZeroOrder, QUIET, fast));
    let left = |model: &Model| rms(&best(&predictor, model).1);
    let (zeta, form) = (0.6, "actuator-lag:second-order");
    let lagged = table().with(form, &[("tau", late / (2.0 * zeta)), ("zeta", zeta)]).unwrap();
    assert!(left(&delayed) < 0.95 * left(&lagged), "{:.3e} {:.3e}", left(&delayed), left(&lagged));
    assert!(left(&delayed) < 1.05 * predictor.budget(), "{:.3e}", left(&delayed));
}

#[test]
fn a_stribeck_hump_that_the_model_lacks_raises_what_is_left() {
    let truth = table().with("stribeck", &[("dF", 4.0), ("v_s", 1e-2)]).unwrap();
    let noisy = Sensors { position: 5e-7, ..QUIET };
    let predictor = predictor(&recording(&truth, Hold::ZeroOrder, noisy));
    let (with, errors) = best(&predictor, &truth);
    let (without, more) = best(&predictor, &table());
    let of_budget = |errors: &[f64]| rms(errors) / predictor.budget();
    assert!(of_budget(&errors) < 1.15, "{}", of_budget(&errors));
    assert!(of_budget(&more) > 1.2 * of_budget(&errors), "{}", of_budget(&more));
    // What is not known acts as a force.
    assert!(predictor.process(without) > predictor.process(with), "{without} {with}");
}

#[test]
fn the_noise_of_the_position_is_known_within_a_fifth() {
    for position in [5e-7, 1e-6, 5e-6] {
        let data = recording(&table(), Hold::ZeroOrder, Sensors { position, ..QUIET });
        let truth = position.hypot(COUNT / 12f64.sqrt());
        let known = predictor(&data).noise().position;
        assert!((known / truth - 1.0).abs() < 0.2, "{known:.3e} {truth:.3e}");
    }
}

/// The median of fourth differences of evenly spread rounding errors is 1.23 times that of normal errors as large.
#[test]
fn of_counts_alone_the_noise_is_told_a_quarter_too_large_at_most() {
    let data = recording(&table(), Hold::ZeroOrder, QUIET);
    let ratio = predictor(&data).noise().position / (COUNT / 12f64.sqrt());
    assert!((0.99..1.25).contains(&ratio), "{ratio}");
}

#[test]
fn the_noise_that_a_force_can_hold_is_known_within_a_fifth() {
    for force in [0.1, 0.5] {
        let data = recording(&table(), Hold::ZeroOrder, Sensors { force, ..QUIET });
        let noise = *predictor(&data).noise();
        assert!((noise.force_at_most / force - 1.0).abs() < 0.2, "{noise:?}");
        // White noise of a force may be what acts: only a resolution or a law of control says that it is none.
        assert_eq!(noise.force, 0.0);
    }
}

#[test]
fn what_a_law_of_control_leaves_is_noise_of_the_force_and_counts_of_it_are() {
    let data = recording(&table(), Hold::ZeroOrder, QUIET);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(10);
    let position = data.channel("position").unwrap().values.clone();
    let force = data.channel("force").unwrap().values.clone();
    let (gain, noise) = (1e5, 0.3);
    let law = |(x, f): (&f64, &f64)| x + f / gain;
    let reference: Vec<f64> = position.iter().zip(&force).map(law).collect();
    let with = |force: Vec<f64>, reference: Option<&Vec<f64>>| {
        let mut channels = vec![
            Channel::new("force", "N", force),
            Channel::new("position", "m", position.clone()),
        ];
        channels.extend(reference.map(|r| Channel::new("reference", "m", r.clone())));
        let data = Recording::new("control", data.time().to_vec(), channels).unwrap();
        predictor(&data.with_hold(Hold::ZeroOrder)).noise().force
    };
    let noisy: Vec<f64> = force
        .iter()
        .map(|f| {
            let normal: f64 = StandardNormal.sample(&mut random);
            f + noise * normal
        })
        .collect();
    let known = with(noisy, Some(&reference));
    assert!((known / noise - 1.0).abs() < 0.2, "{known}");
    let step = 0.25;
    let known = with(force.iter().map(|f| (f / step).round() * step).collect(), None);
    assert!((known / (step / 12f64.sqrt()) - 1.0).abs() < 0.2, "{known}");
}

#[test]
fn errors_do_not_depend_on_the_number_of_threads_nor_on_the_models_beside() {
    let model = table().with("stribeck", &[]).unwrap();
    let predictor = predictor(&recording(&model, Hold::ZeroOrder, QUIET));
    let models: Vec<(Model, usize)> = (0..23)
        .map(|k| {
            let mut model = model.clone();
            model.set("coulomb.F_C", 7.0 + 0.1 * f64::from(k)).unwrap();
            (model, k as usize % predictor.settings())
        })
        .collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| predictor.errors(&models))
    };
    let all = on(1);
    assert_eq!(all, on(2));
    assert_eq!(all, on(5));
    let alone = predictor.errors(&models[20..21]).swap_remove(0);
    assert_eq!(all[20], alone);
}

/// A filter forgets where it began: strips side by side say what one long run says.
#[test]
fn strips_side_by_side_err_as_one_run_does() {
    let contact = [("k_t", 4e6), ("spread", 2.5)];
    for model in [table(), table().with("presliding:maxwell-slip", &contact).unwrap()] {
        let predictor = predictor(&recording(&model, Hold::ZeroOrder, QUIET));
        let long = Predictor {
            time: predictor.time.iter().map(|t| 4.0 * t).collect(),
            ..predictor.clone()
        };
        let long = Predictor {
            teams: teams(&long.segments, &long.time, |k| long.speed_around(k)),
            ..long
        };
        assert_eq!(long.teams[0].len(), 4);
        let cut = Predictor { teams: long.teams, ..predictor.clone() };
        let (setting, whole) = best(&predictor, &model);
        let strips = cut.errors(&[(model, setting)]).swap_remove(0);
        let apart: Vec<f64> = strips.iter().zip(&whole).map(|(a, b)| a - b).collect();
        assert!(rms(&apart) < 1e-2 * rms(&whole), "{:e} {:e}", rms(&apart), rms(&whole));
    }
}

#[test]
fn a_model_that_runs_away_errs_as_much_as_can_be() {
    let mut model = table();
    let predictor = predictor(&recording(&model, Hold::ZeroOrder, QUIET));
    model.set("mass", 1e-3).unwrap();
    model.set("coulomb.F_C", 0.0).unwrap();
    model.set("viscous.F_v", 0.0).unwrap();
    let errors = predictor.errors(&[(model, 0)]).swap_remove(0);
    assert!(errors.iter().all(|e| e.is_finite()) && rms(&errors) > 100.0 * predictor.budget());
}

#[test]
fn a_part_of_a_recording_has_as_many_samples_as_asked_and_all_of_its_places() {
    let data = recording(&table(), Hold::ZeroOrder, QUIET);
    let whole = predictor(&data);
    assert!(whole.thinned(SAMPLES as usize, 1.0).is_none());
    let part = whole.thinned(3000, 1.0).unwrap();
    let samples: usize = part.segments.iter().map(Range::len).sum();
    assert!((2000..=4000).contains(&samples), "{samples}");
    assert!(part.counted.iter().all(|k| part.segments[part.piece(*k)].contains(k)));
    assert!(part.counted().last().unwrap() > SAMPLES as usize / 2);
    for (k, (time, _)) in part.counted().zip(part.instants()) {
        assert_eq!(data.time()[k], time);
    }
    let ratio = rms(&best(&part, &table()).1) / rms(&best(&whole, &table()).1);
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}

#[test]
fn of_samples_that_follow_each_other_fast_the_force_is_averaged() {
    for hold in [Hold::ZeroOrder, Hold::Sampled] {
        let data = commanded_every(2.5e-4, &table(), hold, QUIET, fast);
        let whole = predictor(&data);
        let part = whole.thinned(2000, 1.0).unwrap();
        assert!((part.interval() - 1e-3).abs() < 1e-12 && part.time.len() == 2000);
        assert!((part.duration() / whole.duration() - 1.0).abs() < 0.01);
        for (k, (time, _)) in part.counted().zip(part.instants()) {
            assert_eq!(data.time()[k], time);
        }
        // The true model errs by the counts, as it does from one sample to the next; with the force of every fourth sample alone
        // it would err by more.
        let errs = |predictor: &Predictor| {
            let (setting, errors) = best(predictor, &table());
            rms(&errors) / predictor.expected(setting)
        };
        let ratio = errs(&part) / errs(&whole);
        assert!((0.9..1.1).contains(&ratio), "{hold:?} {ratio}");
        let mut skipping = part.clone();
        skipping.force = skipping.origin.iter().map(|k| whole.force[*k]).collect();
        let [skipping, part] = [&skipping, &part].map(|p| rms(&best(p, &table()).1));
        assert!(skipping > 1.5 * part, "{hold:?} {skipping} {part}");
    }
}

#[test]
fn samples_are_taken_together_that_follow_each_other_faster_than_is_needed_where_there_are_many() {
    let whole = predictor(&commanded_every(2.5e-4, &table(), Hold::ZeroOrder, QUIET, fast));
    let samples = whole.time.len();
    let coarser = whole.clone().no_faster(2e-3, samples / 2);
    assert!((coarser.interval() - 2e-3).abs() < 1e-12 && coarser.time.len() == samples.div_ceil(8));
    for (apart, most) in [(2e-3, samples), (2.5e-4, samples / 2), (4e-4, samples / 2)] {
        let same = whole.clone().no_faster(apart, most);
        assert_eq!(same.time.len(), samples, "{apart} {most}");
    }
}

#[test]
fn a_noise_of_the_force_suits_the_same_setting_where_it_is_averaged() {
    let sensors = Sensors { force: 2.0, ..QUIET };
    let whole = predictor(&commanded_every(5e-4, &table(), Hold::ZeroOrder, sensors, |t| {
        24.0 * (5.0 * t).sin() + 12.0 * (13.0 * t + 1.0).sin()
    }));
    let part = whole.thinned(4000, 1.0).unwrap();
    assert!((part.interval() - 1e-3).abs() < 1e-12);
    let (there, here) = (best(&whole, &table()).0, best(&part, &table()).0);
    assert!(here.abs_diff(there) <= 1, "{here} {there}");
    assert!((part.noise.force_at_most / whole.noise.force_at_most - 0.5_f64.sqrt()).abs() < 1e-9);
}

#[test]
fn of_segments_that_are_shorter_than_a_piece_whole_ones_are_taken() {
    let data = recording(&table(), Hold::ZeroOrder, QUIET);
    let segment = (0..i64::from(SAMPLES)).map(|k| k / 400).collect();
    let (time, channels) = (data.time().to_vec(), data.channels().to_vec());
    let data = Recording::with_segments("short", time, channels, segment).unwrap();
    let part = predictor(&data).thinned(3000, 1.0).unwrap();
    let samples: usize = part.segments.iter().map(Range::len).sum();
    assert!((2000..=4000).contains(&samples), "{samples}");
}

/// What the response to a wave of one period says, against what a simulation of it changes.
fn assert_response(wave: Wave, of: impl Fn(f64, f64) -> Model, period: f64) {
    let predictor = predictor(&recording(&table(), Hold::ZeroOrder, QUIET));
    let small = 0.01;
    for setting in [1, 3] {
        let models = [(0.0, 0.0), (small, 0.0), (0.0, small)].map(|(a, b)| (of(a, b), setting));
        let errors = predictor.errors(&models);
        let response = predictor.responses(setting, wave, &[period]).swap_remove(0);
        for (column, moved) in response.iter().zip(&errors[1..]) {
            let change: Vec<f64> =
                moved.iter().zip(&errors[0]).map(|(e, old)| (e - old) / small).collect();
            let column: Vec<f64> = column.iter().map(|value| f64::from(*value)).collect();
            let product: f64 = column.iter().zip(&change).map(|(a, b)| a * b).sum();
            let cosine = product / (rms(&column) * rms(&change) * column.len() as f64);
            assert!(cosine.abs() > 0.9, "{wave:?} {setting}: {cosine}");
            assert!((rms(&column) / rms(&change) - 1.0).abs() < 0.25, "{wave:?} {setting}");
        }
    }
}

#[test]
fn the_response_to_a_ripple_is_what_a_simulation_of_it_changes() {
    let ripple =
        |a: f64, b: f64| table().with("ripple", &[("a_1", a), ("b_1", b), ("l", 5e-3)]).unwrap();
    assert_response(Wave::Force, ripple, 5e-3);
}

#[test]
fn the_response_to_a_gain_is_what_a_simulation_of_it_changes() {
    let gain = |a: f64, b: f64| {
        table().with("motor-gain:ripple", &[("a", a), ("b", b), ("l", 0.02)]).unwrap()
    };
    assert_response(Wave::Gain, gain, 0.02);
}

#[test]
fn half_of_a_motion_is_fast_and_of_one_that_rests_for_longer_what_moves() {
    let moves =
        |share: f64| move |t: f64| if t % 1.0 < share { 24.0 * (40.0 * t).sin() } else { 0.0 };
    for (share, expected) in [(1.0, 0.5), (0.3, 0.3)] {
        let p = predictor(&commanded(&table(), Hold::ZeroOrder, QUIET, moves(share)));
        let fast = p.counted_and_fast();
        let of = |is: bool| {
            let those = p.counted.iter().zip(&fast).filter(move |(_, fast)| **fast == is);
            those.map(|(k, _)| p.speed_around(*k))
        };
        let found = of(true).count() as f64 / fast.len() as f64;
        assert!((found - expected).abs() < 0.03, "{found}");
        assert!(of(true).fold(f64::MAX, f64::min) > of(false).fold(0.0, f64::max));
    }
}

#[test]
fn a_surrogate_leaves_its_model_the_same_errors_in_another_order() {
    let hidden = table().with("stribeck", &[("dF", 3.0)]).unwrap();
    let predictor = predictor(&recording(&hidden, Hold::ZeroOrder, QUIET));
    let (setting, _) = best(&predictor, &table());
    let errors = |predictor: &Predictor| {
        let mut all = Vec::new();
        predictor.follow(&[(table(), setting)], |_, step| all.push(step.error[0])).unwrap();
        all
    };
    let position = predictor.surrogate(&table(), setting, 3).unwrap();
    assert_eq!(predictor.surrogate(&table(), setting, 3).unwrap(), position);
    assert_ne!(predictor.surrogate(&table(), setting, 4).unwrap(), position);
    let before = errors(&predictor);
    let after = errors(&Predictor { position, ..predictor });
    // Where it begins the speed is told by other samples.
    assert!((rms(&after[300..]) / rms(&before[300..]) - 1.0).abs() < 0.03);
    let same = before.iter().zip(&after).filter(|(a, b)| (*a - *b).abs() < 1e-12).count();
    assert!(same < before.len() / 10, "{same} of {}", before.len());
}
