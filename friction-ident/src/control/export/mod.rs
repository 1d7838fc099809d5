//! The compensator as C99: no allocation, no I/O, no global state, nothing but `math.h`.
//!
//! Four files: header, source, test vectors (CSV) and a small program that runs the vectors. The source
//! repeats the arithmetic of [`Compensator::force`] operation by operation.

mod text;

use std::fmt::Write as _;

use crate::axis::{Axis, Quantity};
use crate::closed_loop::Sample;

use super::compensator::Compensator;
use text::Writer;

/// A file of the exported compensator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// Why a compensator has no C code.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// An effect without a law in C.
    #[error(
        "the effect '{0}' has no law in C\nidentify a model without it, or with another form of it"
    )]
    Effect(String),
    /// A contact that is not written in C.
    #[error(
        "the contact '{0}' has no law in C; 'presliding' and 'presliding:static' have\nexport without it (--no-presliding)"
    )]
    Contact(String),
    /// A name that C does not take.
    #[error("'{0}' is no name in C\nuse letters, digits and underscores, a letter first")]
    Name(String),
}

/// Units of an axis, for comments and headings.
#[derive(Clone, Copy, Debug)]
struct Units {
    force: &'static str,
    length: &'static str,
    velocity: &'static str,
    /// As in the names of columns.
    columns: [&'static str; 4],
}

impl Units {
    fn of(axis: Axis) -> Self {
        Self {
            force: axis.unit(Quantity::Force),
            length: axis.unit(Quantity::Length),
            velocity: axis.unit(Quantity::Velocity),
            columns: match axis {
                Axis::Linear => ["reference_m", "reference_velocity_m_s", "position_m", "force_N"],
                Axis::Rotary => {
                    ["reference_rad", "reference_velocity_rad_s", "position_rad", "force_Nm"]
                }
            },
        }
    }
}

/// The files of `compensator`, which belongs to a model of `axis` and must not have run yet; all names
/// begin with `name`. The test vectors are the compensator's forces along `samples`.
///
/// # Errors
/// An effect or a contact that has no law in C, or a name that C does not take.
pub fn to_c(
    compensator: &Compensator,
    axis: Axis,
    name: &str,
    samples: &[Sample],
) -> Result<Vec<File>, ExportError> {
    let first = name.chars().next().is_some_and(|c| c.is_ascii_alphabetic());
    if !(first && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')) {
        return Err(ExportError::Name(name.to_owned()));
    }
    let writer = Writer::new(compensator, Units::of(axis), name)?;
    let file = |suffix: &str, text: String| File { name: format!("{name}{suffix}"), text };
    Ok(vec![
        file(".h", writer.header()),
        file(".c", writer.source()),
        file("_vectors.csv", vectors(compensator, axis, samples)),
        file("_test.c", writer.test()),
    ])
}

/// What the compensator gives along `samples`, to the last digit.
fn vectors(compensator: &Compensator, axis: Axis, samples: &[Sample]) -> String {
    let mut compensator = compensator.clone();
    let mut text = Units::of(axis).columns.join(",") + "\n";
    for sample in samples {
        let force = compensator.force(sample);
        let (reference, velocity) = (sample.reference, sample.reference_velocity);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{reference:e},{velocity:e},{:e},{force:e}", sample.position);
    }
    text
}

#[cfg(test)]
mod tests;
