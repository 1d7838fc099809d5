//! The verdict of a discovery and what is said beside it.

use std::fmt::Write;

use aep_studio::words;
use anstyle::AnsiColor;
use missing_physics::Discovery;
use missing_physics::report::Verdict;

use super::style::{dim, paint, wrapped};
use super::table::{Align, Table};

/// The verdict and its summary.
pub fn verdict(discovery: &Discovery) -> String {
    let colour = match discovery.verdict {
        Verdict::EffectsFound | Verdict::NothingMissing if !words::is_cut(discovery) => {
            AnsiColor::Green
        }
        _ => AnsiColor::Yellow,
    };
    let mut title = words::verdict(discovery).to_uppercase();
    if !discovery.added.is_empty() {
        let _ = write!(title, ": {}", discovery.added.join(", "));
    }
    let mut text = format!("\n{}\n", paint(colour, &title));
    if let Some(said) = words::completeness(discovery) {
        let complete = discovery.budget.is_some_and(|budget| budget.complete);
        let colour = if complete { AnsiColor::Green } else { AnsiColor::Yellow };
        let _ = writeln!(text, " {}", paint(colour, &said));
    }
    if let Some(said) = words::missing_force(discovery) {
        let _ = writeln!(text, " {said}");
    }
    for line in wrapped(&words::summary(discovery)) {
        let _ = writeln!(text, " {line}");
    }
    text += &notes(discovery);
    let unexplained = discovery.verdict == Verdict::Unexplained;
    if let Some(term) = discovery.generic_term.as_ref().filter(|_| unexplained) {
        let _ =
            writeln!(text, "\n An effect file that describes what remains without explaining it:");
        for line in term.lines() {
            let _ = writeln!(text, "   {}", dim(line));
        }
    }
    if discovery.verdict == Verdict::NothingMissing {
        text += &limits(discovery);
    }
    text
}

/// What there is to add, a line each.
pub fn notes(discovery: &Discovery) -> String {
    words::notes(discovery).iter().map(|text| note(text)).collect()
}

/// A line that adds something.
pub fn note(text: &str) -> String {
    format!(" {} {text}\n", dim("note:"))
}

/// How large each effect would have had to be.
fn limits(discovery: &Discovery) -> String {
    if discovery.detection_limits.is_empty() {
        return String::new();
    }
    let mut table =
        Table::new(&[("effect", Align::Left), ("would have been found above", Align::Left)]);
    for (effect, size) in &discovery.detection_limits {
        table.row([effect.clone(), words::detection_limit(size)]);
    }
    format!("\n{}", table.text())
}

/// Why nothing was added.
pub fn why(text: &str) -> String {
    let lines = wrapped(&format!("Why: {text}."));
    format!(" {}\n", lines.join("\n "))
}
