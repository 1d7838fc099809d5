use super::*;

/// Positions at 0.1 s intervals under a force that reverses the motion, sticks and slides.
fn motion(model: &Model, step: f64) -> Vec<f64> {
    let time = times(16, 0.1);
    // Linear between samples, so that the input is the same at every step.
    let force: Vec<f64> = (0..16).map(|k| 25.0 * (1.9 * f64::from(k)).sin()).collect();
    let input = Input::new(&time, &force, Hold::Sampled).with_max_step(step);
    simulate(model, &input, &Start::at(0.0, 0.05)).unwrap().position
}

/// Largest error at `step` against a step 64 times smaller than the smallest in use.
fn error(model: &Model, exact: &[f64], step: f64) -> f64 {
    motion(model, step).iter().zip(exact).map(|(x, e)| (x - e).abs()).fold(0.0, f64::max)
}

fn assert_second_order(name: &str, model: &Model, step: f64) {
    let exact = motion(model, step / 512.0);
    // Events hit the grid of steps at random: the order shows over a span of steps.
    let (coarse, fine) = (error(model, &exact, step), error(model, &exact, step / 16.0));
    let order = (coarse / fine).log2() / 4.0;
    assert!(order > 1.7, "{name}: {coarse:.2e} -> {fine:.2e}, order {order:.2}");
}

#[test]
fn halving_the_step_divides_the_error_by_four_through_stops_and_reversals() {
    let coulomb: (&str, &[(&str, f64)]) = ("coulomb", &[("F_C", 8.0)]);
    let viscous: (&str, &[(&str, f64)]) = ("viscous", &[("F_v", 100.0)]);
    let ripple: (&str, &[(&str, f64)]) = ("ripple", &[("a_1", 2.0), ("l", 5e-3)]);
    let stribeck: (&str, &[(&str, f64)]) = ("stribeck", &[("dF", 3.0), ("v_s", 0.02)]);
    let base = plant(5.0, &[coulomb, viscous]);
    assert_second_order("coulomb, viscous", &base, 8e-3);
    assert_second_order("ripple", &plant(5.0, &[coulomb, viscous, ripple]), 4e-3);
    assert_second_order("stribeck", &plant(5.0, &[coulomb, viscous, stribeck]), 4e-3);
    let drag: (&str, &[(&str, f64)]) = ("quadratic-drag", &[("c", 300.0)]);
    assert_second_order("drag", &plant(5.0, &[coulomb, drag]), 8e-3);
    let contact: (&str, &[(&str, f64)]) = ("presliding", &[("k_t", 2e4)]);
    assert_second_order("contact", &plant(5.0, &[coulomb, viscous, contact]), 2e-3);
    let lag: (&str, &[(&str, f64)]) = ("actuator-lag", &[("tau", 0.02)]);
    assert_second_order("lag", &plant(5.0, &[coulomb, viscous, lag]), 8e-3);
    let delay: (&str, &[(&str, f64)]) = ("input-delay", &[("T_d", 0.0137)]);
    assert_second_order("delay", &plant(5.0, &[coulomb, viscous, delay]), 8e-3);
    let behind: &[(&str, f64)] = &[("m_L", 2.0), ("f", 8.0), ("zeta", 0.05)];
    let coupling: (&str, &[(&str, f64)]) = ("flexible-coupling", behind);
    assert_second_order("coupling", &plant(5.0, &[coulomb, viscous, coupling]), 2e-3);
    let lugre: (&str, &[(&str, f64)]) = ("presliding:lugre", &[("k_t", 2e4), ("sigma_1", 20.0)]);
    assert_second_order("lugre", &plant(5.0, &[coulomb, viscous, lugre]), 1e-3);
    let memory: (&str, &[(&str, f64)]) = ("frictional-memory", &[("tau_L", 0.013)]);
    assert_second_order("memory", &plant(5.0, &[coulomb, viscous, stribeck, memory]), 4e-3);
}

#[test]
fn a_contact_that_breaks_falls_at_its_time_within_the_step() {
    let stribeck: (&str, &[(&str, f64)]) = ("stribeck", &[("dF", 6.0), ("v_s", 1e-3)]);
    let contact: (&str, &[(&str, f64)]) = ("presliding:static", &[("k_t", 2e4)]);
    let base = [("coulomb", &[("F_C", 8.0)] as &[_]), ("viscous", &[("F_v", 100.0)])];
    let model = plant(5.0, &[base[0], base[1], stribeck, contact]);
    // One break-away: a ramp that ends above the force at which the contact breaks.
    let after = |step: f64| {
        let time = times(3, 0.1);
        let input = Input::new(&time, &[0.0, 10.0, 20.0], Hold::Sampled).with_max_step(step);
        simulate(&model, &input, &Start::at(0.0, 0.0)).unwrap().position[2]
    };
    let exact = after(1e-6);
    // The time of the fall hits the grid of steps at random: mean over spans of steps.
    let error = |coarse: f64| {
        let steps = (0..20).map(|k| coarse * (1.0 + 0.02 * f64::from(k)));
        steps.map(|step| (after(step) - exact).abs()).sum::<f64>() / 20.0
    };
    let (coarse, fine) = (error(4e-3), error(2.5e-4));
    let order = (coarse / fine).log2() / 4.0;
    assert!(order > 1.7, "{coarse:.2e} -> {fine:.2e}, order {order:.2}");
}

#[test]
fn the_work_of_the_drive_is_kinetic_energy_and_dissipation() {
    let model = plant(5.0, &[("coulomb", &[("F_C", 8.0)]), ("viscous", &[("F_v", 100.0)])]);
    let time = times(4000, 5e-4);
    let force = |t: f64| 25.0 * (7.0 * t).sin();
    let out = run(&model, &time, Start::default(), force);
    let (mut work, mut lost) = (0.0, 0.0);
    for (k, t) in time.iter().enumerate().take(3999) {
        let moved = out.position[k + 1] - out.position[k];
        let v = 0.5 * (out.velocity[k] + out.velocity[k + 1]);
        work += force(*t) * moved;
        lost += 8.0 * moved.abs() + 100.0 * v * moved;
    }
    let kinetic = 2.5 * out.velocity[3999].powi(2);
    assert!(work > 1.0 && ((lost + kinetic) / work - 1.0).abs() < 1e-3, "{work} {lost} {kinetic}");
}
