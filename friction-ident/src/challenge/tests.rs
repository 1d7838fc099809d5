use super::*;
use crate::axis::Axis;
use crate::effects::ALL;

fn challenge(hide: &str, seed: u64, level: Level) -> Challenge {
    generate(&Hide::parse(hide), seed, level).unwrap()
}

#[test]
fn the_same_seed_gives_the_same_challenge_and_another_one_another() {
    let one = challenge("stribeck", 7, Level::Clear);
    assert_eq!(one, challenge("stribeck", 7, Level::Clear));
    assert_ne!(one.recording, challenge("stribeck", 8, Level::Clear).recording);
}

#[test]
fn every_effect_that_can_hide_does_and_is_as_large_as_asked_for() {
    for effect in ALL {
        let name = effect.about().name;
        let Ok(made) = generate(&Hide::Effect(name.into()), 3, Level::Clear) else {
            let base = ["coulomb", "viscous", "offset"].contains(&name);
            assert!(base || !effect.suits(Axis::Linear) || !effect.shows_in_force(), "{name}");
            continue;
        };
        let truth = &made.truth;
        assert_eq!(truth.hidden.as_deref(), Some(name));
        assert!(truth.model.term(name).is_some());
        let ratio = match truth.model.get("presliding.k_t") {
            Ok(stiffness) => truth.model.get("coulomb.F_C").unwrap() / stiffness / ENCODER,
            Err(_) => truth.hidden_force / truth.noise_force,
        };
        // Some effects cannot get that large: a delay of a hump is no larger than the hump.
        assert!((4.0..22.0).contains(&ratio), "{name}: {ratio}");
    }
}

#[test]
fn nothing_hidden_is_the_base_model() {
    let made = challenge("nothing", 5, Level::Clear);
    assert_eq!(made.truth.model.effects(), ["coulomb", "viscous", "offset"]);
    assert_eq!(made.truth.hidden, None);
    assert!(made.truth.hidden_force == 0.0 && made.truth.noise_force > 0.1);
}

#[test]
fn levels_are_ordered() {
    let [faint, moderate, clear] = [Level::Faint, Level::Moderate, Level::Clear]
        .map(|level| challenge("ripple", 2, level).truth.hidden_force);
    assert!(faint < moderate && moderate < clear, "{faint} {moderate} {clear}");
}

#[test]
fn the_table_slides_in_most_of_the_recording_and_rests_in_some() {
    let made = challenge("nothing", 1, Level::Clear);
    let position = made.recording.require("position").unwrap();
    let moving = position.windows(20).filter(|w| w[0] != w[19]).count();
    let share = moving as f64 / position.len() as f64;
    assert!((0.6..0.98).contains(&share), "{share}");
}

#[test]
fn what_cannot_hide_is_refused() {
    let refused = |name: &str| generate(&Hide::parse(name), 1, Level::Clear).unwrap_err();
    assert!(matches!(refused("coulomb"), ChallengeError::Base(_)));
    assert!(matches!(refused("gravity-pendulum"), ChallengeError::NotHere(_)));
    assert!(matches!(refused("stribek"), ChallengeError::UnknownEffect(_)));
}

#[test]
fn the_truth_survives_its_file() {
    let truth = challenge("ripple", 4, Level::Moderate).truth;
    let text = serde_json::to_string(&truth).unwrap();
    assert_eq!(serde_json::from_str::<Truth>(&text).unwrap(), truth);
}
