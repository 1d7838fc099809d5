//! The library's errors as Python's: what the user gave is a `ValueError`, what the system refused an `OSError`.

use std::fmt::Display;

use aep_core::{CheckpointError, RunError};
use aep_data::DataError;
use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyValueError};

/// Something wrong with what the user gave.
pub fn bad_input(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Why a checkpoint is refused.
pub fn checkpoint(error: &CheckpointError) -> PyErr {
    match error {
        CheckpointError::File { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
            pyo3::exceptions::PyFileNotFoundError::new_err(error.to_string())
        }
        CheckpointError::File { .. } => PyOSError::new_err(error.to_string()),
        other => bad_input(other),
    }
}

/// Why a run could not be started or continued.
pub fn run(error: &RunError) -> PyErr {
    match error {
        RunError::Checkpoint(error) => checkpoint(error),
        other => bad_input(other),
    }
}

/// Why data cannot be read: what, where, how to mend it. What is a flag of the command is a keyword here.
pub fn data(error: &DataError) -> PyErr {
    let hint = error.hint().map_or_else(String::new, |hint| format!("\n  {}", keywords(&hint)));
    let text = format!("{}: {}{hint}", error.place(), keywords(&error.problem.to_string()));
    if matches!(&*error.problem, aep_data::Problem::Absent) {
        return pyo3::exceptions::PyFileNotFoundError::new_err(text);
    }
    bad_input(text)
}

/// `--force-gain` as `force_gain=`.
pub fn keywords(text: &str) -> String {
    let mut parts = text.split("--");
    let mut said = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !c.is_ascii_lowercase() && c != '-').unwrap_or(part.len());
        let (flag, rest) = part.split_at(end);
        let keyword = match flag {
            "from" | "to" => format!("t_{flag}"),
            _ => flag.replace('-', "_"),
        };
        said += &keyword;
        // A value follows, or the flag is only named.
        if let Some(value) = rest.strip_prefix(' ').filter(|value| {
            value.starts_with(|c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '\'')
        }) {
            said += "=";
            said += value;
        } else {
            said += rest;
        }
    }
    said
}
