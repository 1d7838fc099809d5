//! Riddles: recordings with a hidden effect are made, and guessed.

use std::sync::Arc;

use friction_ident::challenge::{Hide, Level, Truth, generate};

use super::riddle::{POINTS, Riddle};
use super::task::Task;
use super::{Studio, data, jobs};
use crate::args::known;
use crate::failure::Failure;
use crate::output;

/// What a riddle hides; it is in no folder whose files are handed out.
const TRUTH: &str = "truth.json";
/// Digits of a recorded number, as of `aep challenge`.
const DIGITS: usize = 8;
/// What is guessed where nothing is hidden.
const NOTHING: &str = "nothing";

/// Makes one: any effect, or none at all, as hidden as asked for.
pub fn make(studio: &Arc<Studio>, level: Level) -> Result<(), Failure> {
    let seed = u64::from(rand::random::<u32>());
    // Now and then nothing is hidden: to say so is an answer, too.
    let hide = if seed % 8 == 0 { Hide::Nothing } else { Hide::Random };
    let made = generate(&hide, seed, level)?;
    let path = {
        let project = studio.project();
        let path = project.place("data", &format!("riddle-{}.csv", project.state.tree.next))?;
        output::save(&path, &aep_data::to_csv_rounded(&made.recording, DIGITS))?;
        output::save(&path.with_extension("toml"), &aep_data::to_toml(&made.recording))?;
        output::save_json(&project.folder().join(TRUTH), &made.truth)?;
        path
    };
    data::begin(studio, &path)?;
    {
        let mut project = studio.project();
        project.state.riddle = Some(Riddle::default());
        project.save()?;
    }
    jobs::start(studio, Task::Base { effects: None })
}

/// A guess: the name of an effect, or `nothing`; without one the riddle is given up.
pub fn guess(studio: &Studio, guess: Option<&str>) -> Result<(), Failure> {
    let mut project = studio.project();
    let Some(riddle) = project.state.riddle.clone().filter(|riddle| riddle.points.is_none()) else {
        return Err(
            Failure::bad_input("there is no riddle to solve").with_hint("ask for one first")
        );
    };
    let truth = read_truth(&project.folder().join(TRUTH))?;
    let hidden = truth.hidden.clone().unwrap_or_else(|| NOTHING.to_owned());
    let mut riddle = riddle;
    let right = match guess {
        Some(NOTHING) => hidden == NOTHING,
        Some(name) => main_of(&known(name)?) == main_of(&hidden),
        None => false,
    };
    let wrong = riddle.guesses.len() as u32;
    riddle.guesses.extend(guess.map(str::to_owned));
    let over = right || guess.is_none() || wrong + 1 >= POINTS;
    if over {
        let points = if right { POINTS - wrong } else { 0 };
        riddle =
            Riddle { hidden: Some(hidden), points: Some(points), seed: Some(truth.seed), ..riddle };
        project.state.points += points;
    }
    project.state.riddle = Some(riddle);
    project.save()
}

/// The effect that a name is a form of.
fn main_of(name: &str) -> &str {
    name.split(':').next().unwrap_or(name)
}

fn read_truth(path: &std::path::Path) -> Result<Truth, Failure> {
    let lost = |error: String| {
        Failure::bad_input(format!("what the riddle hides is lost: {error}"))
            .in_file(path)
            .with_hint("ask for another one")
    };
    let text = std::fs::read_to_string(path).map_err(|error| lost(error.to_string()))?;
    serde_json::from_str(&text).map_err(|error| lost(error.to_string()))
}
