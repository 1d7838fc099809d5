//! A figure of the paper: what it is made under, and what comes of it.

use std::path::{Path, PathBuf};

use aep_problems::paper::Claim;
use aep_studio::report::plain;

use crate::curve_plot::{self, Axes, Curve};
use crate::failure::Failure;
use crate::output;

/// A figure: what it is called and how it is made.
pub struct Figure {
    /// `fig2`, `fig3`, ...
    pub name: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// Makes its files and holds the paper's statements against what comes out.
    pub make: fn(&'static str, &Conditions) -> Result<Made, Failure>,
}

/// What every figure is made under.
pub struct Conditions {
    /// Folder for the files; exists.
    pub directory: PathBuf,
    /// Trials of each line.
    pub trials: usize,
    /// Seed of every random choice.
    pub seed: u64,
    /// Whether the other readings are measured, too.
    pub readings: bool,
}

/// A figure that has been made.
#[derive(Default)]
pub struct Made {
    /// The paper's statements beside ours.
    pub claims: Vec<Claim>,
    /// The files written.
    pub files: Vec<PathBuf>,
    /// Its plots, for the page.
    pub figures: Vec<plain::Figure>,
}

impl Made {
    /// Writes a file.
    pub fn keep(&mut self, path: &Path, text: &str) -> Result<(), Failure> {
        keep(&mut self.files, path, text)
    }

    /// Draws curves, and some to be compared with, as an SVG file and for the page.
    pub fn draw(
        &mut self,
        path: &Path,
        axes: Axes<'_>,
        (curves, dashed): (&[Curve], &[Curve]),
    ) -> Result<(), Failure> {
        self.figures.push(curve_plot::figure(axes, &[curves, dashed].concat()));
        self.keep(path, &curve_plot::svg_against(axes, curves, dashed)?)
    }
}

/// A field of a CSV file.
pub fn quote(field: &str) -> String {
    if field.contains([',', '"', '\n']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}

/// Writes a file of a figure and notes it.
pub fn keep(files: &mut Vec<PathBuf>, path: &Path, text: &str) -> Result<(), Failure> {
    output::save(path, text)?;
    files.push(path.to_owned());
    Ok(())
}
