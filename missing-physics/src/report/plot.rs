//! Curves of a report page.

use serde::{Deserialize, Serialize};

/// A curve or a cloud of the report page.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plot {
    /// What it shows.
    pub title: String,
    /// Label of the abscissa, with unit.
    pub x_label: String,
    /// Label of the ordinate, with unit.
    pub y_label: String,
    /// The curves, all on the same axes.
    pub curves: Vec<Curve>,
}

/// One curve of a [`Plot`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name in the legend.
    pub label: String,
    /// Abscissa.
    pub x: Vec<f64>,
    /// Ordinate, as long as `x`.
    pub y: Vec<f64>,
}
