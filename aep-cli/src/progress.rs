//! What is going on, on stderr and only while someone watches.

use std::io::IsTerminal;
use std::time::Duration;

use aep_studio::words;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use missing_physics::{Event, Observer};

use crate::stop;

/// A line that says what is being done.
pub struct Progress {
    line: ProgressBar,
}

impl Progress {
    /// Shows nothing where stderr is no terminal, or when asked to be quiet.
    pub fn new(quiet: bool) -> Self {
        if quiet || !std::io::stderr().is_terminal() {
            return Self { line: ProgressBar::hidden() };
        }
        let line = ProgressBar::new_spinner();
        line.enable_steady_tick(Duration::from_millis(100));
        if let Ok(style) = ProgressStyle::with_template("{spinner:.blue} {msg} {elapsed:.dim}") {
            line.set_style(style);
        }
        Self { line }
    }

    /// Counts the time from now on, and tells how much of `limit` is used.
    pub fn within(&self, limit: Option<Duration>) {
        self.line.reset_elapsed();
        let Some(limit) = limit else { return };
        if let Ok(style) = ProgressStyle::with_template("{spinner:.blue} {msg} {used:.dim}") {
            self.line.set_style(style.with_key(
                "used",
                move |state: &ProgressState, to: &mut dyn std::fmt::Write| {
                    // Writing to a line cannot fail.
                    let _ = to.write_str(&used(state.elapsed(), limit));
                },
            ));
        }
    }

    /// Counts up to `length` from now on and estimates when it will be done.
    pub fn count_to(&self, length: u64) {
        let bar = "{spinner:.blue} {msg} {wide_bar:.blue} {pos}/{len} {elapsed:.dim} (ETA {eta})";
        if let Ok(style) = ProgressStyle::with_template(bar) {
            self.line.set_style(style);
        }
        self.line.set_position(0);
        self.line.set_length(length);
    }

    /// One more is done.
    pub fn one_more(&self) {
        self.line.inc(1);
    }

    /// Shows nothing any more.
    pub fn hide(&self) {
        self.line.finish_and_clear();
    }

    /// Says what is being done now.
    pub fn say(&self, text: impl Into<String>) {
        self.line.set_message(text.into());
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.hide();
    }
}

impl Observer for Progress {
    fn event(&mut self, event: &Event<'_>) {
        // With a base model there is something to tell.
        if !matches!(event, Event::BaseFitted { .. }) {
            stop::keeping();
        }
        if let Some(said) = said(event) {
            self.say(said);
        }
    }
}

/// What is going on, in words.
pub fn said(event: &Event<'_>) -> Option<String> {
    Some(match event {
        Event::BaseFitted { evaluations } => {
            format!("base model fitted ({evaluations} evaluations of the search)")
        }
        Event::Screening { rung, candidates } => screening(*rung, *candidates),
        Event::Compared { rung, effects, nats } => compared(*rung, effects, *nats),
        Event::Concluding => "asking what is needed, and what else would do as well".to_owned(),
        Event::Finishing => "looking at what is left".to_owned(),
        _ => return None,
    })
}

/// `12 s of 60 s`.
fn used(elapsed: Duration, limit: Duration) -> String {
    let of = limit.as_secs_f64();
    // A limit below a second has no whole ones.
    let of = if of < 1.0 { format!("{of}") } else { format!("{of:.0}") };
    format!("{} s of {of} s", elapsed.as_secs())
}

fn screening(rung: usize, candidates: usize) -> String {
    let which = match rung {
        1 => "a first".to_owned(),
        2 => "a second".to_owned(),
        3 => "a third".to_owned(),
        rung => format!("a {rung}th"),
    };
    let noun = if candidates == 1 { "candidate" } else { "candidates" };
    format!("looking at {candidates} {noun} for {which} effect")
}

fn compared(rung: usize, effects: &[String], nats: f64) -> String {
    // The effects of the base model come first.
    let beside = effects.len().saturating_sub(rung);
    let (verb, size) = if nats < 0.0 { ("loses", -nats) } else { ("gains", nats) };
    let size = words::nats(size);
    format!("{} {verb} {} nats", effects[beside..].join(" + "), size.trim_start_matches('+'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_going_on_is_said_in_plain_words() {
        assert_eq!(screening(1, 34), "looking at 34 candidates for a first effect");
        assert_eq!(screening(4, 1), "looking at 1 candidate for a 4th effect");
        let effects = ["coulomb", "viscous", "stribeck", "drift"].map(str::to_owned);
        assert_eq!(compared(2, &effects, 340.2), "stribeck + drift gains 340 nats");
        assert_eq!(compared(1, &effects, -3.21), "drift loses 3.2 nats");
        assert_eq!(compared(9, &effects[..1], 0.0), "coulomb gains 0.0 nats");
    }

    #[test]
    fn the_time_used_stands_beside_the_limit() {
        let of = |limit: f64| used(Duration::from_secs_f64(12.7), Duration::from_secs_f64(limit));
        assert_eq!(of(60.0), "12 s of 60 s");
        assert_eq!(of(0.5), "12 s of 0.5 s");
    }
}
