//! Results point by point.

use std::path::{Path, PathBuf};

use aep_data::{Format, PLACE};

/// Where results go point by point.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct SeriesArgs {
    /// Write a row for every sample: time, what was measured, prediction and residual of every model, regime, whether the
    /// sample took part and why not
    #[arg(long, value_name = "FILE.csv|FILE.parquet", value_parser = path, help_heading = "Results")]
    series: Option<PathBuf>,
}

impl SeriesArgs {
    /// The same of one axis of several, whose name takes the place of `{}`.
    pub fn of_axis(&self, name: &str) -> Option<PathBuf> {
        self.path().map(|path| axis_path(path, name))
    }

    /// The file, where one was asked for.
    pub fn path(&self) -> Option<&Path> {
        self.series.as_deref()
    }
}

/// The file of an axis: its name in place of `{}`.
pub fn axis_path(path: &Path, name: &str) -> PathBuf {
    let safe = |c: char| if matches!(c, '/' | '\\') { '-' } else { c };
    let name: String = name.chars().map(safe).collect();
    PathBuf::from(path.to_string_lossy().replace(PLACE, &name))
}

fn path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match Format::of(&path) {
        Some(_) => Ok(path),
        None => Err("the name must end in .csv or .parquet".to_owned()),
    }
}
