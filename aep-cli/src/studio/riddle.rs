//! A riddle: what was guessed of a recording with a hidden effect, and what that is worth.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// Points of a riddle that is solved at the first guess; each wrong one costs one.
pub const POINTS: u32 = 3;

/// A riddle that is being solved.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Riddle {
    /// What was guessed so far.
    pub guesses: Vec<String>,
    /// What it hides, once it is over.
    pub hidden: Option<String>,
    /// Its points, once it is over.
    pub points: Option<u32>,
    /// Seed, once it is over.
    pub seed: Option<u64>,
}

impl Riddle {
    /// As the page is told.
    pub fn view(&self) -> Value {
        let left = POINTS.saturating_sub(self.guesses.len() as u32);
        json!({"guesses": self.guesses, "hidden": self.hidden, "points": self.points, "seed": self.seed, "left": left})
    }
}
