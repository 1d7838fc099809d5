//! What is going on, on stderr and only while someone watches.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use missing_physics::quantity::percent;
use missing_physics::{Event, Observer};

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

    /// Says what is being done now.
    pub fn say(&self, text: impl Into<String>) {
        self.line.set_message(text.into());
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.line.finish_and_clear();
    }
}

impl Observer for Progress {
    fn event(&mut self, event: &Event<'_>) {
        match event {
            Event::BaseFitted { evaluations } => {
                self.say(format!("base model fitted ({evaluations} evaluations of the search)"));
            }
            Event::Screening { rung, candidates } => {
                self.say(format!("rung {rung}: {candidates} candidates against placebos"));
            }
            Event::ScreeningPairs { pairs } => {
                self.say(format!("no single candidate helps: {pairs} pairs against placebos"));
            }
            Event::Trying { effect, gain, .. } => {
                self.say(format!("refitting with {effect} (expected gain {})", percent(*gain)));
            }
            Event::Added { effect, before, after } => {
                let (before, after) = (percent(*before), percent(*after));
                self.line.println(format!("+ {effect}: held-out error {before} -> {after}"));
            }
            Event::Replaced { from, to } => {
                self.line.println(format!("~ {from}: its form {to} does as much as a new effect"));
            }
            Event::Dropped { effect } => {
                self.line.println(format!("- {effect}: no longer needed"));
            }
            Event::Compared { rung, effects, nats } => {
                self.say(format!("sets of {rung}: {} ({nats:+.0} nats)", effects.join(" + ")));
            }
            Event::Finishing => self.say("looking at what is left"),
            _ => {}
        }
    }
}
