//! Two masses, with friction on either side, behind a coupling and behind a gap.

use super::*;
use crate::driven::{MeasuredMotion, force_along};

const COUPLING: &str = "flexible-coupling:friction";
const ON_LOAD: &str = "flexible-coupling:load";
const GAP: &str = "backlash:two-mass";

fn coupled(name: &str, load: f64, level: f64, viscous: f64) -> Model {
    let values = [("m_L", load), ("f", 20.0), ("zeta", 0.1), ("F_L", level), ("d_L", viscous)];
    plant(3.0, &[(name, &values)])
}

fn gapped(load: f64, level: f64, b: f64, k: f64, zeta: f64) -> Model {
    let values = [("m_L", load), ("F_L", level), ("d_L", 0.0), ("b", b), ("k", k), ("zeta", zeta)];
    plant(3.0, &[(GAP, &values)])
}

/// Stretch and velocity of the load of the last effect, in lane 0.
fn load(plants: &Plants) -> (f64, f64) {
    let state = &plants.effects.last().unwrap().element;
    (state[0], state[plants.lanes()])
}

#[test]
fn without_friction_of_the_load_the_form_is_the_main_one() {
    let values = [("m_L", 2.0), ("f", 20.0), ("zeta", 0.1)];
    for other in [&[][..], &[("coulomb", &[("F_C", 5.0)][..])]] {
        let main = plant(3.0, &[other, &[("flexible-coupling", &values[..])]].concat());
        let with: Vec<_> = values.iter().copied().chain([("F_L", 0.0), ("d_L", 0.0)]).collect();
        let form = plant(3.0, &[other, &[(COUPLING, &with[..])]].concat());
        let time = times(2000, 5e-4);
        let force = |t: f64| 20.0 * (30.0 * t).sin();
        let [a, b] = [main, form].map(|model| run(&model, &time, Start::default(), force));
        for (a, b) in a.position.iter().zip(&b.position) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }
}

#[test]
fn the_load_sticks_until_the_coupling_pulls_with_more_than_its_friction() {
    let model = coupled(ON_LOAD, 2.0, 5.0, 10.0);
    let mut plants = Plants::uniform(&model, 1);
    let stiffness = 2.0 * (std::f64::consts::TAU * 20.0).powi(2);
    for k in 0..6000 {
        let force = f64::from(k) * 1e-3;
        plants.step(&[5e-4], &[force]);
        if force < 4.9 {
            assert_eq!(plants.shown_velocity()[0].to_bits(), 0.0f64.to_bits());
            assert!(plants.shown()[0].abs() < 1e-15);
            assert!((plants.position()[0] - force / stiffness).abs() < 3e-6);
        }
    }
    assert!(plants.shown()[0] > 1e-3 && plants.shown_velocity()[0] > 0.01);
    // It shows the load from the start on.
    plants.start(0, &Start::at(1.0, 0.1));
    let before = plants.shown()[0];
    assert!((before - 1.0 + (5.0 + 10.0 * 0.1) / stiffness).abs() < 1e-12);
}

#[test]
fn two_masses_that_collide_across_a_gap_keep_their_momentum_and_without_damping_their_energy() {
    for (step, zeta) in [(5e-4, 1e-12), (1e-5, 1e-12), (5e-4, 0.3), (1e-5, 0.3)] {
        let mut plants = Plants::uniform(&gapped(1.0, 0.0, 1e-3, 2e7, zeta), 1);
        plants.start(0, &Start { velocity: 0.0, ..Start::default() });
        plants.step(&[step], &[0.0]);
        plants.velocity[0] = 0.1;
        let steps = (15e-3 / step) as usize;
        for _ in 0..steps {
            plants.step(&[step], &[0.0]);
            let momentum = 3.0 * plants.velocity()[0] + load(&plants).1;
            assert!((momentum - 0.3).abs() < 1e-12, "{step} {zeta}: {momentum}");
        }
        let (v, after) = (plants.velocity()[0], load(&plants).1);
        assert!(after > v, "they part: {v} {after}");
        if zeta < 0.1 {
            assert!((v - 0.05).abs() < 1e-6 && (after - 0.15).abs() < 1e-6, "{v} {after}");
        } else {
            assert!(after - v < 0.09, "{v} {after}");
        }
    }
}

#[test]
fn a_mass_on_the_contact_of_a_load_that_sticks_swings_at_its_resonance() {
    let mut plants = Plants::uniform(&gapped(1.0, 1e4, 1e-12, 1e5, 1e-12), 1);
    let w = (1e5f64 / 3.0).sqrt();
    for k in 1..2000 {
        plants.step(&[1e-4], &[100.0]);
        let exact = 1e-3 * (1.0 - (w * f64::from(k) * 1e-4).cos());
        assert!((plants.position()[0] - exact).abs() < 5e-6, "{k}: {:?}", plants.position());
    }
    assert_eq!(load(&plants).1.to_bits(), 0.0f64.to_bits());
}

#[test]
fn the_energy_never_grows() {
    // Nor with a contact without friction: nothing stops the mass on its way.
    for others in [&[][..], &[("presliding", &[("k_t", 1e6)][..])]] {
        let grows = most_growth(others);
        assert!(grows < 1e-9, "{grows:e}");
    }
}

/// Largest growth of the energy in a step of 0.5 ms, as a share of that energy.
fn most_growth(others: &[(&str, &[(&str, f64)])]) -> f64 {
    let mut most = 0.0f64;
    for mass in [1e-6f64, 0.01, 0.3, 4.0] {
        for level in [0.0, 0.5, 30.0] {
            for zeta in [1e-6, 0.05, 1.0] {
                for (name, k) in [(GAP, 2e7), (GAP, 1e4), (COUPLING, 2e7), (COUPLING, 1e4f64)] {
                    let f = (k / mass).sqrt() / std::f64::consts::TAU;
                    let common = [("m_L", mass), ("F_L", level), ("d_L", 1.0), ("zeta", zeta)];
                    let own =
                        if name == GAP { vec![("b", 2e-4), ("k", k)] } else { vec![("f", f)] };
                    let values = [&common[..], &own[..]].concat();
                    let model = plant(3.0, &[others, &[(name, &values[..])]].concat());
                    let mut plants = Plants::uniform(&model, 1);
                    plants.start(0, &Start::at(0.0, 0.05));
                    plants.step(&[1e-9], &[0.0]);
                    plants.velocity[0] = -0.1;
                    let half = if name == GAP { 1e-4 } else { 0.0 };
                    let energy = |plants: &Plants| {
                        let ((stretch, after), v) = (load(plants), plants.velocity()[0]);
                        let pressed = (stretch.abs() - half).max(0.0);
                        0.5 * (3.0 * v * v + mass * after * after + k * pressed * pressed)
                    };
                    let mut before = energy(&plants);
                    for _ in 0..4000 {
                        plants.step(&[5e-4], &[0.0]);
                        let now = energy(&plants);
                        most = most.max((now - before) / before.max(1e-9));
                        before = now;
                    }
                }
            }
        }
    }
    most
}

/// Semi-implicit Euler with a tiny step; friction takes what momentum there is, up to its level.
fn reference(model: &Model, gap: bool, until: f64, force: impl Fn(f64) -> f64) -> [f64; 2] {
    let get = |name: &str| model.terms().last().unwrap().effect().about().parameter(name);
    let value = |name: &str| get(name).map_or(0.0, |k| model.terms().last().unwrap().values()[k]);
    let (mass, level, viscous) = (value("m_L"), value("F_L"), value("d_L"));
    let w = std::f64::consts::TAU * value("f");
    let k = if gap { value("k") } else { mass * w * w };
    let d = 2.0 * value("zeta") * (k * mass).sqrt();
    let (mut x, mut v, mut y, mut u) = (0.0, 0.0, 0.0, 0.0);
    let h = 2e-7;
    for j in 0..(until / h) as usize {
        let (ahead, rate): (f64, f64) = (x - y, v - u);
        let pressed = ahead.abs() - 0.5 * value("b");
        let pull = if !gap {
            k * ahead + d * rate
        } else if pressed > 0.0 {
            ahead.signum() * (k * pressed + d * rate * ahead.signum()).max(0.0)
        } else {
            0.0
        };
        v += h * (force(j as f64 * h) - pull) / model.mass();
        let free = u + h * (pull - viscous * u) / mass;
        u = free - free.clamp(-h * level / mass, h * level / mass);
        x += h * v;
        y += h * u;
    }
    [x, y]
}

#[test]
fn stick_slip_and_impacts_are_those_of_a_reference_with_a_tiny_step() {
    let force = |t: f64| 25.0 * (25.0 * t).sin();
    let cases =
        [(coupled(COUPLING, 2.0, 6.0, 5.0), false), (gapped(2.0, 6.0, 1e-3, 2e5, 0.3), true)];
    for (model, gap) in cases {
        let [x, y] = reference(&model, gap, 0.5, force);
        let error = |step: f64| {
            let mut plants = Plants::uniform(&model, 1);
            for j in 0..(0.5 / step) as usize {
                plants.step(&[step], &[force((j as f64 + 0.5) * step)]);
            }
            let position = plants.position()[0];
            (position - x).abs().max((position + load(&plants).0 - y).abs())
        };
        let errors = [5e-4, 1e-5].map(error);
        assert!(errors[0] < 1e-4 && errors[1] < 3e-6, "{errors:?} of {x} {y}");
    }
}

#[test]
fn between_events_the_error_falls_with_the_square_of_the_step() {
    let values = [("m_L", 2.0), ("f", 20.0), ("zeta", 0.1), ("F_L", 3.0), ("d_L", 5.0)];
    let own = [("m_L", 2.0), ("F_L", 3.0), ("d_L", 5.0), ("b", 1e-4), ("k", 1e5), ("zeta", 0.2)];
    for (name, values) in [(COUPLING, &values[..]), (GAP, &own[..])] {
        let model = plant(3.0, &[(name, values)]);
        let end = |step: f64| {
            let mut plants = Plants::uniform(&model, 1);
            plants.start(0, &Start::at(0.0, 0.5));
            // Always forwards, always pressed to the same side.
            for j in 0..(0.2 / step).round() as usize {
                let force = 30.0 + 5.0 * (20.0 * (j as f64 + 0.5) * step).sin();
                plants.step(&[step], &[force]);
            }
            plants.position()[0]
        };
        let exact = end(1e-6);
        let (coarse, fine) = ((end(5e-4) - exact).abs(), (end(1.25e-4) - exact).abs());
        let order = (coarse / fine).log2() / 2.0;
        assert!(order > 1.8, "{name}: {coarse:.2e} -> {fine:.2e}, order {order:.2}");
    }
}

#[test]
fn a_load_of_nothing_leaves_the_mass_alone() {
    let time = times(400, 5e-4);
    let force = |t: f64| 20.0 * (30.0 * t).sin();
    let bare = run(&plant(3.0, &[]), &time, Start::default(), force);
    for level in [0.0, 5.0] {
        let out = run(&coupled(COUPLING, 0.0, level, 0.0), &time, Start::default(), force);
        for (x, bare) in out.position.iter().zip(&bare.position) {
            assert!((x - bare).abs() < 1e-14);
        }
        let out = run(&gapped(0.0, level, 1e-4, 1e6, 0.1), &time, Start::default(), force);
        assert!(out.position.iter().all(|x| x.is_finite()));
        let (end, free) = (out.position[399], bare.position[399]);
        assert!(level > 0.0 || (end - free).abs() < 1e-6, "{end} {free}");
    }
}

#[test]
fn along_a_motion_the_load_weighs_and_rubs() {
    let w = std::f64::consts::TAU;
    let time = times(4000, 1e-3);
    let x: Vec<f64> = time.iter().map(|t| 0.05 * (1.0 - (w * t).cos())).collect();
    let v: Vec<f64> = time.iter().map(|t| 0.05 * w * (w * t).sin()).collect();
    let a: Vec<f64> = time.iter().map(|t| 0.05 * w * w * (w * t).cos()).collect();
    let motion = MeasuredMotion::new(&time, &x, &v, &a).unwrap();
    let gap = [("m_L", 2.0), ("F_L", 4.0), ("d_L", 10.0), ("b", 1e-4), ("k", 1e6), ("zeta", 0.5)];
    let own = [("m_L", 2.0), ("f", 50.0), ("zeta", 0.7), ("F_L", 4.0), ("d_L", 10.0)];
    for model in [
        plant(3.0, &[(COUPLING, &own)]),
        plant(3.0, &[(ON_LOAD, &own)]),
        plant(3.0, &[(GAP, &gap)]),
    ] {
        let force = force_along(&model, &motion);
        assert!(force.iter().all(|f| f.is_finite()));
        // Once friction presses it to the side that it goes to: the second quarter of each stroke is braked,
        // where a load in a gap runs on by itself unless its friction is larger.
        for k in (1000..4000).filter(|k| (k % 500) > 120 && (k % 500) < 400) {
            let rigid = 5.0 * a[k] + 4.0 * v[k].signum() + 10.0 * v[k];
            let error = (force[k] - rigid).abs();
            assert!(error < 0.35, "{:?} {k}: {} {rigid}", model.effects(), force[k]);
        }
    }
    for name in [COUPLING, ON_LOAD, GAP] {
        let force = force_along(&plant(3.0, &[(name, &[])]), &motion);
        assert!(force.iter().all(|f| f.is_finite() && f.abs() < 1e3), "{name}");
    }
}

#[test]
fn corrections_move_both_bodies_and_inside_a_gap_the_mass_alone() {
    for name in [COUPLING, ON_LOAD] {
        let mut plants = Plants::uniform(&coupled(name, 2.0, 5.0, 1.0), 1);
        plants.start(0, &Start::at(0.0, 0.1));
        plants.step(&[5e-4], &[8.0]);
        let (before, shown) = (load(&plants), plants.shown()[0]);
        plants.correct(&[1e-3], &[0.02]);
        assert_eq!(load(&plants), (before.0, before.1 + 0.02));
        assert!((plants.shown()[0] - shown - 1e-3).abs() < 1e-15);
    }
    let mut plants = Plants::uniform(&gapped(2.0, 5.0, 1e-3, 1e6, 0.1), 1);
    plants.correct(&[2e-4], &[0.01]);
    assert_eq!(load(&plants), (-2e-4, 0.0));
    plants.correct(&[1.0], &[0.0]);
    assert_eq!(load(&plants), (-5e-4, 0.0));
    plants.correct(&[1e-4], &[0.01]);
    assert_eq!(load(&plants), (-5e-4, 0.01));
}
