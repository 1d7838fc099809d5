//! What the user sees: text on standard output, errors on standard error, files.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use anstyle::{AnsiColor, Style};
use serde::Serialize;

use crate::failure::Failure;

mod bars;
mod check;
mod compared;
mod confirmation;
mod discovery;
mod failing;
mod ladder;
mod parameters;
mod ranking;
mod residual;
mod simulated;
mod style;
mod table;
#[cfg(test)]
mod tests;
mod views;

pub use check::data_check;
pub use compared::{compared, comparisons};
pub use confirmation::{confirmation, surrogates};
pub use discovery::{note, notes, verdict, why};
pub use failing::{regimes, where_it_fails};
pub use ladder::ladder;
pub use parameters::{parameters, together};
pub use ranking::{Columns, ranking};
pub use residual::{lines, tests};
pub use simulated::simulated;
pub use style::{bold, dim, heading};
pub use table::{Align, Table};
pub use views::{views, warnings};

/// Prints to standard output; without colours where nobody would see them.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = anstream::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        // `aep ... | head` is no failure.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|error| Failure::failed(format!("cannot print: {error}"))),
    }
}

/// Prints a failure: what, where, and how to mend it on a line of its own.
pub fn error(failure: &Failure) {
    let red = Style::new().bold().fg_color(Some(AnsiColor::Red.into()));
    let blue = Style::new().bold().fg_color(Some(AnsiColor::Cyan.into()));
    let mut text = format!("{red}error:{red:#} {}\n", failure.what);
    if let Some(place) = &failure.place {
        text.push_str(&format_lines("  ", place));
    }
    if let Some(hint) = &failure.hint {
        let hint = hint.replace('\n', "\n      ");
        let _ = writeln!(text, "{blue}hint:{blue:#} {hint}");
    }
    // Where standard error is closed, nobody is left to tell.
    let _ = anstream::stderr().lock().write_all(text.as_bytes());
}

/// Prints what is done otherwise than asked.
pub fn warn(what: &str) {
    let yellow = Style::new().bold().fg_color(Some(AnsiColor::Yellow.into()));
    let _ =
        anstream::stderr().lock().write_all(format!("{yellow}note:{yellow:#} {what}\n").as_bytes());
}

fn format_lines(indent: &str, text: &str) -> String {
    text.lines().map(|line| format!("{indent}{line}\n")).collect::<Vec<String>>().concat()
}

/// Makes a folder to write to, if it is not there.
pub fn make_folder(path: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(path).map_err(|error| {
        Failure::bad_input(format!("cannot make the folder: {error}"))
            .in_file(path)
            .with_hint("give a folder that may be written to")
    })
}

/// Writes a file, completely or not at all; `-` is standard output.
pub fn save(path: &Path, text: &str) -> Result<(), Failure> {
    if path.as_os_str() == "-" {
        return print(text);
    }
    Ok(aep_data::save(path, text.as_bytes())?)
}

/// Writes `value` as JSON.
pub fn save_json(path: &Path, value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value);
    let text = text.map_err(|error| Failure::failed(format!("cannot write JSON: {error}")))?;
    save(path, &(text + "\n"))
}

/// The line that says a file was written.
pub fn written(what: &str, path: &Path) -> String {
    format!("{} {}\n", dim(&format!("{what} written to")), path.display())
}
