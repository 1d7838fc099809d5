//! How a search runs and where its results go.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use friction_ident::family::{Decides, FrictionFamily};
use missing_physics::report::Samples;
use missing_physics::{Fitted, Settings, Thresholds};

use super::EffectNames;
use crate::failure::Failure;
use crate::stop::{self, Watch};

/// Limit of a search where none is given.
const SEARCH: Duration = Duration::from_mins(1);

/// How a search runs.
#[derive(clap::Args, Clone, Debug)]
#[command(next_help_heading = "Running")]
pub struct RunArgs {
    /// Seed of every random choice; the same seed gives the same result
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Seconds from the start of the command, after which a search ends; `none` for no limit. A discovery that is cut names
    /// nothing and tells the best so far as such. Without it the search ends after 60 s, however long the file took to read.
    /// A result that no limit cut is the same on every machine
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = limit)]
    time_limit: Option<Limit>,
    /// Largest p-value at which an effect is called likely, by 'suggest' and on --validate recordings
    #[arg(long, value_name = "P", default_value = "0.05", allow_negative_numbers = true, value_parser = rate)]
    alpha: f64,
    /// Effects not to try, e.g. ripple,presliding
    #[arg(long, value_name = "EFFECTS", default_value = "")]
    exclude: EffectNames,
    /// Print every comparison of models: by how much, what was needed, what came of it
    #[arg(long)]
    pub explain: bool,
    #[command(flatten)]
    thresholds: ThresholdArgs,
}

/// What an effect must be worth.
#[derive(clap::Args, Clone, Debug)]
#[command(next_help_heading = "Thresholds")]
struct ThresholdArgs {
    /// Held-out log-likelihood that an effect must gain, in nats: higher finds less and errs less
    #[arg(long, value_name = "NATS", default_value_t = Thresholds::default().better, allow_negative_numbers = true, value_parser = positive)]
    better: f64,
    /// Share of all that is explained that a further effect must explain, 0 to 1 (sets that differ by less are as good)
    #[arg(long, value_name = "SHARE", default_value_t = Thresholds::default().share, allow_negative_numbers = true, value_parser = share)]
    share: f64,
    /// A model is complete where it errs up to this many times as much as the sensors make it, and lacks a force of no more than so
    /// many of its 95 % bands
    #[arg(long, value_name = "FACTOR", default_value_t = Thresholds::default().complete, allow_negative_numbers = true, value_parser = positive)]
    complete: f64,
    /// A model is incomplete where it errs this many times as much as the sensors make it at some place or some time
    #[arg(long, value_name = "FACTOR", default_value_t = Thresholds::default().local, allow_negative_numbers = true, value_parser = positive)]
    local: f64,
    /// Largest p-value of an effect: how often any candidate gains as much where the errors are shifted in time
    #[arg(long, value_name = "P", default_value_t = Thresholds::default().chance, allow_negative_numbers = true, value_parser = rate)]
    chance: f64,
    /// Sets of effects that are followed side by side: more finds more and takes longer
    #[arg(long, value_name = "N", default_value_t = Thresholds::default().beam, value_parser = count)]
    beam: usize,
    /// Candidates that are fitted beside each set: more finds more and takes longer
    #[arg(long, value_name = "N", default_value_t = Thresholds::default().fitted, value_parser = count)]
    fitted: usize,
    /// Most effects to add
    #[arg(long, visible_alias = "most", value_name = "N", default_value_t = Thresholds::default().most)]
    most_effects: usize,
}

impl ThresholdArgs {
    fn thresholds(&self) -> Thresholds {
        Thresholds {
            better: self.better,
            share: self.share,
            complete: self.complete,
            local: self.local,
            chance: self.chance,
            beam: self.beam,
            fitted: self.fitted,
            most: self.most_effects,
        }
    }
}

/// A time limit, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Limit(Option<Duration>);

impl RunArgs {
    /// The engine's settings for the base model of these effects.
    pub fn settings(&self, base: Vec<String>) -> Result<Settings<'static>, Failure> {
        Ok(Settings {
            base,
            exclude: self.exclude.checked()?,
            seed: self.seed,
            alpha: self.alpha,
            most: self.thresholds.most_effects,
            thresholds: self.thresholds.thresholds(),
            stop: Some(stop::flag()),
            time_limit: self.time_limit.map_or(Some(SEARCH), |limit| limit.0),
            ..Settings::default()
        })
    }

    /// The settings with what is left of the time limit: one that was given began with the command, the usual one when the
    /// recording was `read`.
    pub fn with_time_left(
        &self,
        settings: Settings<'static>,
        begun: Instant,
        read: Instant,
    ) -> Settings<'static> {
        let begun = if self.time_limit.is_some() { begun } else { read };
        let left = settings.time_limit.map(|limit| limit.saturating_sub(begun.elapsed()));
        Settings { time_limit: left, ..settings }
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
    /// Write a report with interactive plots as one HTML file that loads nothing from elsewhere; `-` for the terminal
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
}

impl OutputArgs {
    /// Whether standard output belongs to one of the files.
    pub fn own_stdout(&self) -> bool {
        [&self.json, &self.html].into_iter().flatten().any(|path| path.as_os_str() == "-")
    }

    /// The recording and these models sample by sample, where a page is asked for.
    pub fn samples(&self, family: &FrictionFamily, models: &[Fitted], decides: Decides) -> Samples {
        if self.html.is_some() { family.samples(models, decides) } else { Samples::default() }
    }
}

fn limit(text: &str) -> Result<Limit, String> {
    if text == "none" {
        return Ok(Limit(None));
    }
    let limit = seconds(text).map(|limit| Limit(Some(limit)));
    limit.map_err(|why| format!("{why}, or 'none'"))
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("it must be a number above 0".to_owned()),
    }
}

fn share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if (0.0..1.0).contains(&share) => Ok(share),
        _ => Err("it must be a share from 0 to below 1, e.g. 0.02".to_owned()),
    }
}

fn count(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if count > 0 => Ok(count),
        _ => Err("it must be a whole number from 1 on".to_owned()),
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

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        run: RunArgs,
    }

    fn settings(line: &str) -> Settings<'static> {
        let words = std::iter::once("aep").chain(line.split_whitespace());
        Line::try_parse_from(words).unwrap().run.settings(Vec::new()).unwrap()
    }

    #[test]
    fn without_flags_the_thresholds_are_those_of_the_engine() {
        let settings = settings("");
        assert_eq!(settings.thresholds, Thresholds::default());
        assert_eq!(settings.most, Thresholds::default().most);
        assert_eq!(settings.time_limit, Some(Duration::from_mins(1)));
    }

    #[test]
    fn every_threshold_can_be_set() {
        let line = "--better 50 --share 0.1 --complete 2 --local 3 --chance 0.01 --beam 1 \
                    --fitted 4 --most-effects 2";
        let found = settings(&format!("{line} --time-limit none"));
        let thresholds = Thresholds {
            better: 50.0,
            share: 0.1,
            complete: 2.0,
            local: 3.0,
            chance: 0.01,
            beam: 1,
            fitted: 4,
            most: 2,
        };
        assert_eq!((found.thresholds, found.most), (thresholds, 2));
        assert_eq!(found.time_limit, None);
        assert_eq!(settings("--most 1").thresholds.most, 1);
    }

    #[test]
    fn thresholds_that_make_no_sense_are_refused() {
        for line in [
            "--better 0",
            "--better nan",
            "--share 1",
            "--complete inf",
            "--local 0",
            "--chance 2",
            "--fitted 0",
            "--beam 0",
            "--time-limit 0",
        ] {
            let words = std::iter::once("aep").chain(line.split_whitespace());
            assert!(Line::try_parse_from(words).is_err(), "{line}");
        }
    }
}
