//! Candidates as a table.

use std::fmt::Write;

use aep_studio::words;
use missing_physics::measurement::quantity::percent;
use missing_physics::report::Candidate;

use super::bars::{BAR, bar};
use super::style::dim;
use super::table::{Align, LINE, Table};

/// How to read a ranking by prediction errors.
const RANKING: &str = "share: of the squared prediction error; chance: of as large a gain where errors are shifted in time";

/// How many candidates are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// The best few.
    Best,
    /// Every one.
    All,
}

/// Candidates, best first.
pub fn ranking(candidates: &[Candidate], shown_of: Columns) -> String {
    const FEW: usize = 6;
    let shown = match shown_of {
        Columns::Best => candidates.len().min(FEW),
        Columns::All => candidates.len(),
    };
    // Told by what they predict one sample ahead, or by the force that they explain.
    let ahead = candidates.iter().any(|candidate| candidate.nats.is_some());
    let mut columns = vec![("effect", Align::Left)];
    if ahead {
        columns.push(("gain\n(nats)", Align::Right));
    }
    columns.extend([
        ("", Align::Bar),
        (if ahead { "share" } else { "gain" }, Align::Right),
        (if ahead { "chance" } else { "p-value" }, Align::Right),
        ("size", Align::Left),
    ]);
    let mut table = Table::new(&columns).at_most(LINE);
    let most = if ahead { room(&candidates[..shown]) } else { 46 };
    for candidate in &candidates[..shown] {
        let nats = candidate.nats.map_or_else(|| "-".to_owned(), words::nats);
        let p_value = if ahead { words::chance } else { words::p_value };
        let cells = [
            bar(candidate.gain, BAR),
            percent(candidate.gain),
            p_value(candidate.p_value),
            shortened(&words::size(&candidate.size), most),
        ];
        let first = std::iter::once(candidate.effect.clone()).chain(ahead.then_some(nats));
        table.row(first.chain(cells));
    }
    let mut text = table.text();
    if shown < candidates.len() {
        let rest = candidates.len() - shown;
        let _ = writeln!(text, " {}", dim(&format!("and {rest} more that gain less")));
    }
    if ahead && shown_of == Columns::All {
        let _ = writeln!(text, " {}", dim(RANKING));
    }
    text
}

/// Characters that the other columns of a ranking leave for the sizes.
fn room(candidates: &[Candidate]) -> usize {
    // Numbers, the margin, and what separates six columns.
    const TAKEN: usize = 7 + 6 + 8 + 1 + 6 * 3;
    let widest = |width: fn(&Candidate) -> usize| candidates.iter().map(width).max().unwrap_or(0);
    let names = widest(|candidate| candidate.effect.chars().count());
    let bars = widest(|candidate| bar(candidate.gain, BAR).chars().count());
    usize::from(LINE).saturating_sub(TAKEN + names + bars).max(24)
}

/// A size of many numbers fits on a line; the page and the JSON have all of it.
fn shortened(size: &str, most: usize) -> String {
    if size.chars().count() <= most {
        return size.to_owned();
    }
    let start: String = size.chars().take(most).collect();
    let end = start.rfind(", ").unwrap_or(start.len());
    format!("{}, ...", &start[..end])
}
