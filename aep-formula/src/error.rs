//! What is wrong with a formula, and where.

/// Why a text is no formula. It shows the text with a mark under the place.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}\n  {}\n  {}^", shown(.text, *.at).0, " ".repeat(shown(.text, *.at).1))]
pub struct FormulaError {
    /// What is wrong.
    pub what: String,
    /// The formula.
    pub text: String,
    /// Place of the mistake, in bytes from 0; the length of the text where it ends too early.
    pub at: usize,
}

impl FormulaError {
    pub(crate) fn new(what: impl Into<String>, text: &str, at: usize) -> Self {
        Self { what: what.into(), text: text.to_owned(), at }
    }
}

/// Most characters of a formula that are shown to either side of a mistake.
const AROUND: usize = 50;

/// The text around a place on one line, and how many characters of it stand before the place.
fn shown(text: &str, at: usize) -> (String, usize) {
    let plain = |c: char| if c.is_control() { ' ' } else { c };
    let before: Vec<char> = text.get(..at).unwrap_or(text).chars().map(plain).collect();
    let after: Vec<char> = text.get(at..).unwrap_or("").chars().map(plain).collect();
    let cut = before.len() > AROUND;
    let mut line: String = if cut { "...".to_owned() } else { String::new() };
    line.extend(&before[before.len().saturating_sub(AROUND)..]);
    let place = line.chars().count();
    line.extend(after.iter().take(AROUND));
    if after.len() > AROUND {
        line.push_str("...");
    }
    (line, place)
}
