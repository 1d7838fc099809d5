//! Emphasis. The stream takes it out again where there is no terminal or the user wants none.

use anstyle::{AnsiColor, Style};

/// `text` in bold.
pub fn bold(text: &str) -> String {
    styled(Style::new().bold(), text)
}

/// `text` in the background.
pub fn dim(text: &str) -> String {
    styled(Style::new().dimmed(), text)
}

/// `text` in a colour, bold.
pub fn paint(colour: AnsiColor, text: &str) -> String {
    styled(Style::new().bold().fg_color(Some(colour.into())), text)
}

/// The heading of a part of the output.
pub fn heading(text: &str) -> String {
    format!("\n{}\n", bold(text))
}

fn styled(style: Style, text: &str) -> String {
    format!("{style}{text}{style:#}")
}
