//! Emphasis, which the stream takes out again where there is no terminal or the user wants none, and lines.

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

/// Lines of at most 98 characters.
pub fn wrapped(text: &str) -> Vec<String> {
    const WIDTH: usize = 98;
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last =
            lines.last_mut().filter(|line| line.chars().count() + word.chars().count() < WIDTH);
        match last {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

fn styled(style: Style, text: &str) -> String {
    format!("{style}{text}{style:#}")
}
