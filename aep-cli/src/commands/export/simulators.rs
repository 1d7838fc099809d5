//! Formats of other simulators, one file each.

use std::fmt::Write as _;
use std::path::Path;

use friction_ident::Model;
use friction_ident::export::{ExportError, Exported, to_mjcf, to_modelica, to_urdf};

use super::Args;
use crate::failure::Failure;
use crate::output::{self, written};

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        Self::from_lines(&error.to_string())
    }
}

/// A scene of `MuJoCo`.
pub fn mjcf(model: &Model, args: &Args, path: &Path) -> Result<String, Failure> {
    let exported = to_mjcf(model, &name(args, path), args.max_step)?;
    write(&exported, "MuJoCo scene", path)
}

/// A robot description.
pub fn urdf(model: &Model, args: &Args, path: &Path) -> Result<String, Failure> {
    write(&to_urdf(model, &name(args, path))?, "URDF", path)
}

/// A model in Modelica.
pub fn modelica(model: &Model, args: &Args, path: &Path) -> Result<String, Failure> {
    write(&to_modelica(model, &name(args, path))?, "Modelica model", path)
}

/// The name that was given, or that of the file where it can be one.
pub(super) fn name(args: &Args, path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let can_be = stem.starts_with(|c: char| c.is_ascii_alphabetic())
        && stem.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    args.name.clone().unwrap_or(if can_be { stem } else { "axis".to_owned() })
}

fn write(exported: &Exported, what: &str, path: &Path) -> Result<String, Failure> {
    if let Some(file) = exported.files.first() {
        output::save(path, &file.text)?;
    }
    Ok(said(exported) + &written(what, path))
}

/// What is expressed, and what is not.
pub(super) fn said(exported: &Exported) -> String {
    let mut text = format!("expressed: {}\n", exported.expressed.join(", "));
    for left in &exported.left_out {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "left out: {}: {}", left.what, left.why);
    }
    text
}
