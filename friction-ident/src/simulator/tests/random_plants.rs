use proptest::prelude::*;

use super::*;
use crate::effects::{ALL, Scale};

/// A plant with a random choice of effects, parameters anywhere within their bounds.
fn any_plant() -> impl Strategy<Value = Model> {
    let unit = prop::collection::vec(0.0..1.0f64, 8 * ALL.len());
    (unit, prop::collection::vec(any::<bool>(), ALL.len()), 0.5..100.0f64).prop_map(
        |(unit, chosen, mass)| {
            let mut model = Model::new(Axis::Linear, mass).unwrap();
            for (e, effect) in ALL.iter().enumerate().filter(|(e, _)| chosen[*e]) {
                let Ok(with) = model.clone().with_effect(*effect) else { continue };
                model = with;
                for (k, p) in effect.about().parameters.iter().enumerate() {
                    let u = unit[8 * e + k % 8];
                    let value = match p.scale {
                        Scale::Linear => p.low + u * (p.high - p.low),
                        Scale::Log => p.low * (p.high / p.low).powf(u),
                    };
                    let name = crate::model::address(*effect, p.name);
                    // A stroke is drawn as begin and end; keep them apart.
                    let value = if p.name == "end" { value.abs() + 11.0 } else { value };
                    model.set(&name, value).unwrap();
                }
            }
            model
        },
    )
}

/// Effects that neither store nor supply energy on their own.
const DISSIPATIVE: [&str; 5] = ["coulomb", "viscous", "stribeck", "presliding", "quadratic-drag"];

fn dissipative(model: Model) -> Model {
    ALL.iter()
        .map(|effect| effect.about().name)
        .filter(|name| !DISSIPATIVE.contains(name))
        .fold(model, Model::without)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn every_plant_stays_finite_or_says_that_it_does_not(model in any_plant(), f in -100.0..100.0f64) {
        let time = times(300, 1e-3);
        let force: Vec<f64> = time.iter().map(|t| f * (40.0 * t).cos()).collect();
        let input = Input::new(&time, &force, Hold::Sampled);
        if let Ok(out) = simulate(&model, &input, &Start::at(0.0, 0.01)) {
            prop_assert!(out.position.iter().chain(&out.velocity).all(|x| x.is_finite()));
        }
    }

    #[test]
    fn friction_never_supplies_energy(model in any_plant(), v in -0.5..0.5f64) {
        let model = dissipative(model);
        let time = times(400, 1e-3);
        let out = run(&model, &time, Start { used: 0.0, ..Start::at(0.0, v) }, |_| 0.0);
        for pair in out.velocity.windows(2) {
            prop_assert!(pair[1].abs() <= v.abs() * (1.0 + 1e-9));
        }
        let rigid = model.term("presliding").is_none();
        for pair in out.velocity.windows(2).filter(|_| rigid) {
            // Up to the rounding of one step.
            prop_assert!(pair[1].abs() <= pair[0].abs() * (1.0 + 1e-14));
        }
    }

    #[test]
    fn a_plant_moves_the_same_to_the_bit_in_whatever_batch(model in any_plant(), f in -50.0..50.0f64) {
        let mut others = vec![model.clone(); 7];
        for (i, other) in others.iter_mut().enumerate().filter(|(i, _)| *i != 4) {
            other.set("mass", 1.0 + i as f64).unwrap();
        }
        let mut alone = Plants::new(std::slice::from_ref(&model)).unwrap();
        let mut batch = Plants::new(&others).unwrap();
        let start = Start { command: f, ..Start::at(0.0, 0.02) };
        alone.start(0, &start);
        (0..7).for_each(|i| batch.start(i, &start));
        for k in 0..200 {
            let command = f * (0.05 * f64::from(k)).cos();
            alone.step(&[1e-3], &[command]);
            batch.step(&[1e-3; 7], &[command; 7]);
        }
        prop_assert_eq!(alone.position()[0].to_bits(), batch.position()[4].to_bits());
        prop_assert_eq!(alone.velocity()[0].to_bits(), batch.velocity()[4].to_bits());
    }
}

#[test]
fn a_prediction_that_is_far_off_supplies_no_energy() {
    // A contact that swings faster than the steps, with drag taken at the predicted velocity.
    let hump: (&str, &[(&str, f64)]) = ("stribeck", &[("dF", 57.3), ("v_s", 0.012)]);
    let contact: (&str, &[(&str, f64)]) = ("presliding", &[("k_t", 7.4e7)]);
    let drag: (&str, &[(&str, f64)]) = ("quadratic-drag", &[("c", 7105.0)]);
    let model = plant(0.5, &[("coulomb", &[("F_C", 426.0)]), hump, contact, drag]);
    let start = Start { used: 0.0, ..Start::at(0.0, 0.030_55) };
    let out = run(&model, &times(400, 1e-3), start, |_| 0.0);
    assert!(out.velocity.iter().all(|v| v.abs() <= 0.030_55 * (1.0 + 1e-9)));
}

#[test]
fn a_plant_that_runs_away_behind_an_encoder_says_so_before_the_encoder_shows_nonsense() {
    let encoder: (&str, &[(&str, f64)]) = ("encoder", &[("a", 1e-6), ("p", 1e-4)]);
    let model = plant(0.5, &[("spring", &[("k", -1e5)]), encoder]);
    let time = times(2_000, 1e-3);
    let force = vec![0.0; time.len()];
    let told = simulate(&model, &Input::new(&time, &force, Hold::Sampled), &Start::at(0.01, 0.0));
    assert!(matches!(told, Err(SimulationError::NotFinite { .. })), "{told:?}");
}
