//! The library's errors as Python's: what the user gave is a `ValueError`, what the system refused an `OSError`.

use std::fmt::Display;

use aep_core::{CheckpointError, RunError};
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
