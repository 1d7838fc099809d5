//! The one place where a recording is handed to the library, and where its answer is judged.

use friction_ident::family::{FrictionFamily, Options};
use missing_physics::measurement::check::cut_at_gaps;
use missing_physics::report::Verdict;
use missing_physics::{Channel, Discovery, Hold, Recording, Settings, Thresholds, discover};

use super::case::{Case, Wanted};
use super::level::Recorded;
use super::machine::Force;

/// What the discovery is told of the way in which the force acts between samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// Nothing, as by a user who does not know.
    Nothing,
    /// The truth.
    Truth,
}

/// What was said.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Answer {
    /// A right name first.
    First,
    /// Another name first, but a right one stands in an ambiguous set of at most three.
    InSet,
    /// Nothing is missing.
    Silent,
    /// Structure remains that no effect explains.
    Unexplained,
    /// Another name.
    Wrong,
    /// No answer: the recording was refused.
    Refused,
}

/// One recording, judged.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was said.
    pub answer: Answer,
    /// Verdict and effects in words.
    pub said: String,
    /// Effects named besides the right ones and those that do no harm.
    pub extra: usize,
    /// Whether it is what must be said, and nothing besides.
    pub right: bool,
    /// Relative error of the size, where the law of the library is the one that acts.
    pub size_error: Option<f64>,
    /// As in [`Recorded`].
    pub visibility: f64,
    /// Time of the discovery, s.
    pub wall_s: f64,
}

/// How a recording says that its force acts.
fn hold(force: Force, told: Told) -> Option<Hold> {
    match (told, force) {
        (Told::Nothing, _) => None,
        (Told::Truth, Force::Command) => Some(Hold::ZeroOrder),
        (Told::Truth, Force::Measured) => Some(Hold::Sampled),
    }
}

/// How the library is asked.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// What it is told.
    pub told: Told,
    /// What an effect must be worth.
    pub thresholds: Thresholds,
}

/// Asks the library what a model with `base` lacks.
fn ask(recorded: &Recorded, base: &[&str], seed: u64, asked: Asked) -> Result<Discovery, String> {
    let (force, position) = if recorded.rotary { ("Nm", "rad") } else { ("N", "m") };
    let channels = vec![
        Channel::new("force", force, recorded.run.force.clone()),
        Channel::new("position", position, recorded.run.position.clone()),
    ];
    let hold = hold(recorded.force, asked.told);
    let recording = Recording::new("axis", recorded.run.time.clone(), channels)
        .map_err(|error| error.to_string())?;
    let recording = match hold {
        Some(hold) => recording.with_hold(hold),
        None => recording,
    };
    let recording = cut_at_gaps(&recording).map_err(|error| error.to_string())?;
    let family =
        FrictionFamily::new(&recording, &Options::default()).map_err(|error| error.to_string())?;
    let base = base.iter().map(|name| (*name).to_owned()).collect();
    let thresholds = asked.thresholds;
    let settings =
        Settings { base, seed, most: thresholds.most, thresholds, ..Settings::default() };
    discover(&family, &settings, &mut ()).map_err(|error| error.to_string())
}

/// Asks and judges.
pub fn judged(case: &Case, recorded: &Recorded, seed: u64, asked: Asked) -> Outcome {
    let visibility = recorded.visibility;
    match ask(recorded, &case.base, seed, asked) {
        Err(said) => Outcome {
            answer: Answer::Refused,
            said,
            extra: 0,
            right: false,
            size_error: None,
            visibility,
            wall_s: 0.0,
        },
        Ok(found) => {
            let (answer, extra) = (answer(case, &found), extra(case, &found));
            let wanted = match case.wanted() {
                Wanted::Silence => Answer::Silent,
                Wanted::Name => Answer::First,
                Wanted::Unexplained => Answer::Unexplained,
            };
            Outcome {
                answer,
                said: format!("{:?} {}", found.verdict, found.added.join(" + ")),
                extra,
                right: answer == wanted && extra == 0,
                size_error: size_error(recorded, &found),
                visibility,
                wall_s: found.wall_s,
            }
        }
    }
}

/// The name of the effect without that of its form.
fn stem(effect: &str) -> &str {
    effect.split(':').next().unwrap_or_default()
}

/// Effects in the order in which they were added, those of a pair one by one.
fn added(found: &Discovery) -> Vec<&str> {
    found.added.iter().flat_map(|effect| effect.split(" + ")).map(stem).collect()
}

fn answer(case: &Case, found: &Discovery) -> Answer {
    let right = |effect: &&str| case.answers.contains(effect);
    let in_set = found
        .ambiguous
        .iter()
        .any(|set| set.effects.len() <= 3 && set.effects.iter().any(|effect| right(&stem(effect))));
    match added(found).first() {
        _ if found.verdict == Verdict::Unexplained => Answer::Unexplained,
        None => Answer::Silent,
        Some(first) if right(first) => Answer::First,
        Some(_) if in_set => Answer::InSet,
        Some(_) => Answer::Wrong,
    }
}

/// Effects named besides, less those that the report calls indistinguishable from a right one.
fn extra(case: &Case, found: &Discovery) -> usize {
    let right = |effect: &str| case.answers.contains(&effect);
    let excused = |effect: &str| {
        found.ambiguous.iter().any(|set| {
            let inside = set.effects.iter().any(|other| stem(other) == effect);
            inside && set.effects.iter().any(|other| right(stem(other)))
        })
    };
    let harmless = |effect: &str| right(effect) || case.minor.contains(&effect) || excused(effect);
    added(found).into_iter().filter(|effect| !harmless(effect)).count()
}

fn size_error(recorded: &Recorded, found: &Discovery) -> Option<f64> {
    let (name, truth) = recorded.run.parameter?;
    let estimate = found.ladder.last()?.parameters.get(name)?;
    Some((estimate.value / truth - 1.0).abs())
}

#[cfg(test)]
mod tests {
    use super::super::case::all;
    use super::super::level::{Level, recorded};
    use super::*;

    #[test]
    fn a_clear_spring_whose_hold_is_known_is_answered() {
        let case = all().into_iter().find(|case| case.name == "spring").expect("exists");
        let recorded = recorded(&case, Level::Clear, 1).expect("shows");
        let asked = Asked { told: Told::Truth, thresholds: Thresholds::default() };
        let outcome = judged(&case, &recorded, 1, asked);
        assert_ne!(outcome.answer, Answer::Refused, "{}", outcome.said);
        assert!((outcome.visibility - recorded.visibility).abs() < 1e-12);
    }
}
