//! How a search runs and where its results go.

use std::path::PathBuf;
use std::time::Duration;

use missing_physics::Settings;

use super::EffectNames;
use crate::failure::Failure;
use crate::stop::{self, Watch};

/// How a search runs.
#[derive(clap::Args, Clone, Debug)]
#[command(next_help_heading = "Running")]
pub struct RunArgs {
    /// Seed of every random choice; the same seed gives the same result
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Begin nothing new after this many seconds; what was found is kept
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = seconds)]
    time_limit: Option<Duration>,
    /// False-alarm rate of a screening: the largest p-value at which an effect is added
    #[arg(long, value_name = "P", default_value = "0.05", allow_negative_numbers = true, value_parser = rate)]
    alpha: f64,
    /// Most effects to add
    #[arg(long, value_name = "N", default_value_t = 8)]
    most: usize,
    /// Effects not to try, e.g. ripple,presliding
    #[arg(long, value_name = "EFFECTS", default_value = "")]
    exclude: EffectNames,
}

impl RunArgs {
    /// The engine's settings for the base model of these effects.
    pub fn settings(&self, base: Vec<String>) -> Result<Settings<'static>, Failure> {
        Ok(Settings {
            base,
            exclude: self.exclude.checked()?,
            seed: self.seed,
            alpha: self.alpha,
            most: self.most,
            stop: Some(stop::flag()),
            time_limit: self.time_limit,
            ..Settings::default()
        })
    }
}

/// When a command ends early.
#[derive(clap::Args, Clone, Debug)]
pub struct LimitArgs {
    /// Begin nothing new after this many seconds; what was found is kept
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = seconds)]
    time_limit: Option<Duration>,
}

impl LimitArgs {
    /// Watches Ctrl-C and the limit, which begins now.
    pub fn watch(&self) -> Watch {
        Watch::new(self.time_limit)
    }
}

/// Where results go.
#[derive(clap::Args, Clone, Debug)]
#[command(next_help_heading = "Results")]
pub struct OutputArgs {
    /// Write the results as JSON; `-` for the terminal
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write a report with plots as one HTML file; `-` for the terminal
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
}

impl OutputArgs {
    /// Whether standard output belongs to one of the files.
    pub fn own_stdout(&self) -> bool {
        [&self.json, &self.html].into_iter().flatten().any(|path| path.as_os_str() == "-")
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|_| "it must be a number of seconds".to_owned())?;
    match Duration::try_from_secs_f64(seconds) {
        Ok(limit) if !limit.is_zero() => Ok(limit),
        _ => Err("it must be a number of seconds above 0".to_owned()),
    }
}

fn rate(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(rate) if rate > 0.0 && rate < 1.0 => Ok(rate),
        _ => Err("it must be a probability between 0 and 1, e.g. 0.05".to_owned()),
    }
}
