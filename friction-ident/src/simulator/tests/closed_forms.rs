use super::*;

#[test]
fn coulomb_friction_stops_a_free_mass_after_the_exact_distance_and_for_good() {
    let model = plant(2.0, &[("coulomb", &[("F_C", 3.0)])]);
    let time = times(1000, 1e-3);
    let out = run(&model, &time, Start::at(0.1, 0.4), |_| 0.0);
    let (stop, distance) = (0.4 * 2.0 / 3.0, 0.4 * 0.4 * 2.0 / (2.0 * 3.0));
    for (k, t) in time.iter().enumerate() {
        let exact = if *t < stop { 0.4 * t - 0.75 * t * t } else { distance };
        assert!((out.position[k] - 0.1 - exact).abs() < 1e-12, "at {t} s");
        assert!(*t < stop || out.velocity[k] == 0.0, "at {t} s");
    }
}

#[test]
fn below_breakaway_nothing_moves_for_any_duration() {
    let model = plant(30.0, &[("coulomb", &[("F_C", 8.0)]), ("stribeck", &[("dF", 2.0)])]);
    let time = times(100_000, 1e-3);
    let out = run(&model, &time, Start::at(0.2, 0.0), |_| 9.999);
    assert!(out.velocity.iter().all(|v| *v == 0.0));
    assert!(out.position.iter().all(|x| *x == 0.2));
}

#[test]
fn the_force_of_the_drive_is_what_its_limit_leaves_of_the_command() {
    let model = plant(2.0, &[("saturation", &[("u_max", 5.0)])]);
    let time = times(40, 1e-3);
    let out = run(&model, &time, Start::default(), |t| if t < 0.02 { 3.0 } else { 9.0 });
    for (k, force) in out.drive_force.iter().enumerate().skip(1) {
        assert_eq!(*force, if time[k] < 0.0205 { 3.0 } else { 5.0 }, "{k}");
    }
}

#[test]
fn a_rising_force_breaks_away_at_the_static_level() {
    let model = plant(30.0, &[("coulomb", &[("F_C", 8.0)]), ("stribeck", &[("dF", 2.0)])]);
    let time = times(3000, 1e-3);
    let force: Vec<f64> = time.iter().map(|t| -5.0 * t).collect();
    let input = Input::new(&time, &force, Hold::Sampled);
    let out = simulate(&model, &input, &Start::default()).unwrap();
    let first = out.velocity.iter().position(|v| *v != 0.0).unwrap();
    assert!((5.0 * time[first] - 10.0).abs() < 0.011, "at {} N", 5.0 * time[first]);
    assert!(out.velocity[first] < 0.0);
}

#[test]
fn viscous_friction_lets_the_velocity_decay_exponentially() {
    let model = plant(2.0, &[("viscous", &[("F_v", 10.0)])]);
    let time = times(500, 1e-3);
    let out = run(&model, &time, Start::at(0.0, 1.0), |_| 0.0);
    for (k, t) in time.iter().enumerate() {
        let exact = (-5.0 * t).exp();
        assert!((out.velocity[k] - exact).abs() < 5e-6);
        assert!((out.position[k] - (1.0 - exact) / 5.0).abs() < 2e-6);
    }
}

#[test]
fn a_strong_damper_is_stable_at_a_step_of_many_time_constants() {
    let model = plant(0.01, &[("viscous", &[("F_v", 1000.0)])]);
    let time = times(200, 1e-3);
    let out = run(&model, &time, Start::default(), |_| 5.0);
    assert!((out.velocity[199] - 5e-3).abs() < 1e-4);
    assert!(out.velocity.iter().all(|v| *v >= 0.0 && *v < 0.011));
}

#[test]
fn a_spring_oscillates_at_its_frequency_and_keeps_its_energy() {
    let model = plant(2.0, &[("spring", &[("k", 800.0), ("x_0", 0.0)])]);
    let time = times(100_000, 1e-3);
    let out = run(&model, &time, Start::at(0.01, 0.0), |_| 0.0);
    let energy = |k: usize| 1.0 * out.velocity[k].powi(2) + 400.0 * out.position[k].powi(2);
    for k in (0..100_000).step_by(997) {
        // The leapfrog scheme's energy swings by (w h)^2 / 4 and does not drift.
        assert!((energy(k) / energy(0) - 1.0).abs() < 2e-4);
    }
    for (x, t) in out.position.iter().zip(&time).take(300) {
        assert!((x - 0.01 * (20.0 * t).cos()).abs() < 2e-6);
    }
}

#[test]
fn the_contact_spring_oscillates_without_damping_and_without_drift() {
    let model = plant(30.0, &[("coulomb", &[("F_C", 8.0)]), ("presliding", &[("k_t", 1e6)])]);
    let time = times(50_000, 1e-3);
    let start = Start { used: 0.0, ..Start::at(0.0, 0.0) };
    let out = run(&model, &time, start, |_| 3.0);
    // 3 N on 1e6 N/m: between 0 and 6 um, for ever; the contact carries at most 6 N.
    let (low, high) =
        out.position.iter().fold((0.0f64, 0.0f64), |(l, h), x| (l.min(*x), h.max(*x)));
    assert!(low > -1e-12 && (high - 6e-6).abs() < 1e-8, "{low} {high}");
}

#[test]
fn a_slow_cycle_in_the_contact_encloses_the_work_of_a_jenkins_element() {
    let effects: &[(&str, &[(&str, f64)])] = &[
        ("coulomb", &[("F_C", 8.0)]),
        ("presliding", &[("k_t", 1e6)]),
        ("viscous", &[("F_v", 500.0)]),
        ("spring", &[("k", 2e5)]),
    ];
    let model = plant(1.0, effects);
    let time = times(20_000, 1e-3);
    let force = |t: f64| 12.0 * (std::f64::consts::TAU * t / 10.0).sin();
    let out = run(&model, &time, Start { used: 0.0, ..Start::default() }, force);
    // Second cycle. Work of the drive = 4 F (A - F / k) with the amplitude A that comes out.
    let (mut work, mut high) = (0.0, 0.0f64);
    for (pair, t) in out.position.windows(2).zip(&time).skip(10_000) {
        work += force(*t) * (pair[1] - pair[0]);
        high = high.max(pair[0]);
    }
    let exact = 4.0 * 8.0 * (high - 8.0 / 1e6);
    assert!(high > 10e-6 && (work / exact - 1.0).abs() < 0.01, "{work} against {exact}");
}

#[test]
fn a_lag_delays_the_momentum_by_its_time_constant() {
    let model = plant(2.0, &[("actuator-lag", &[("tau", 5e-3)])]);
    let time = times(200, 1e-3);
    let out = run(&model, &time, Start::default(), |_| 4.0);
    for (k, t) in time.iter().enumerate() {
        let exact = 2.0 * (t - 5e-3 * (1.0 - (-t / 5e-3).exp()));
        assert!((out.velocity[k] - exact).abs() < 1e-9);
    }
}

#[test]
fn an_irregular_grid_gives_the_same_motion() {
    let model = plant(2.0, &[("coulomb", &[("F_C", 3.0)])]);
    let time: Vec<f64> = (0..400).map(|k| f64::from(k) * 1e-3 + 4e-4 * f64::from(k % 3)).collect();
    let out = run(&model, &time, Start::at(0.0, 0.4), |_| 0.0);
    for (k, t) in time.iter().enumerate().filter(|(_, t)| **t < 0.26) {
        assert!((out.position[k] - (0.4 * t - 0.75 * t * t)).abs() < 1e-12);
    }
    assert_eq!(out.velocity[399], 0.0);
}

#[test]
fn a_plant_that_runs_away_stops_with_time_and_effect() {
    let model = plant(1e-6, &[("coulomb", &[]), ("spring", &[("k", 1e5)])]);
    let (time, force) = (times(2000, 1e-3), vec![20.0; 2000]);
    let input = Input::new(&time, &force, Hold::ZeroOrder);
    let error = simulate(&model, &input, &Start::default()).unwrap_err();
    assert!(matches!(&error, SimulationError::NotFinite { effect, .. } if effect == "spring"));
    // The moment is the first one at which it is nowhere.
    let force = [0.0, 0.0, 0.0, 1e308, 0.0, 0.0];
    let input = Input::new(&time[..6], &force, Hold::ZeroOrder);
    let error = simulate(&plant(1e-6, &[]), &input, &Start::default()).unwrap_err();
    let expected = SimulationError::NotFinite { time: time[4], effect: "the mass".into() };
    assert_eq!(error, expected);
}

#[test]
fn input_that_makes_no_sense_is_refused() {
    let model = plant(1.0, &[]);
    let at = |time: &[f64], force: &[f64], step: f64| {
        let input = Input::new(time, force, Hold::ZeroOrder).with_max_step(step);
        simulate(&model, &input, &Start::default()).map(|out| out.position.len())
    };
    assert!(matches!(at(&[0.0, 1.0], &[0.0], 1e-3), Err(SimulationError::Length { .. })));
    assert!(matches!(
        at(&[0.0, 0.0], &[0.0; 2], 1e-3),
        Err(SimulationError::Time { index: 1, .. })
    ));
    for time in [[f64::NAN, 1.0], [0.0, f64::INFINITY], [0.0, f64::NAN]] {
        assert!(matches!(at(&time, &[0.0; 2], 1e-3), Err(SimulationError::Time { index: 1, .. })));
    }
    assert!(matches!(at(&[0.0, 1.0], &[0.0; 2], 0.0), Err(SimulationError::Setting { .. })));
    // How late a recording begins does not make it longer.
    assert_eq!(at(&[1e9, 1e9 + 0.5], &[0.0; 2], 1e-3), Ok(2));
    assert_eq!(at(&[], &[], 1e-3), Ok(0));
    assert_eq!(at(&[0.0], &[0.0], 1e-3), Ok(1));
}

#[test]
fn a_level_that_effects_take_below_zero_drives_nothing() {
    let asymmetry: [(&str, f64); 2] = [("dF_C", -3.0), ("dF_v", 0.0)];
    let model = plant(2.0, &[("coulomb", &[("F_C", 1.0)]), ("asymmetry", &asymmetry)]);
    let last = |velocity: f64| {
        run(&model, &times(500, 1e-3), Start::at(0.0, velocity), |_| 0.0).velocity[499]
    };
    // 1 - 3 N forth, 1 + 3 N back.
    assert_eq!(last(0.4), 0.4);
    assert!((last(-1.1) + 1.1 - 2.0 * 0.499).abs() < 1e-9);
}

#[test]
fn a_mass_that_moves_within_its_contact_does_not_slide() {
    let free = plant(2.0, &[("coulomb", &[("F_C", 1.0)])]);
    let elastic = free.clone().with("presliding", &[("k_t", 1e6)]).unwrap();
    let slides = |model: &Model, velocity: f64, used: f64| {
        let mut plants = Plants::uniform(model, 2).watched();
        plants.start(1, &Start { used, ..Start::at(0.0, velocity) });
        plants.sliding().to_vec()
    };
    for (model, velocity, used, expected) in [
        (&free, 0.1, 0.0, 1.0),
        (&free, 0.0, 0.0, 0.0),
        (&elastic, 0.1, 0.5, 0.0),
        (&elastic, -0.1, -1.0, 1.0),
        (&elastic, 0.0, 1.0, 0.0),
    ] {
        assert_eq!(slides(model, velocity, used), [0.0, expected], "{velocity} {used}");
    }
}
