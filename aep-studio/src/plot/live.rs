//! What scripts draw a plot from.

use missing_physics::report::{Curve, Plot};
use serde_json::{Value, json};

use super::{Band, colour};
use crate::front::packed;
use crate::html::escape;

/// The data of a figure as an attribute, with which scripts draw it anew.
pub(super) fn attribute(plot: &Plot, bands: &[Band], named: &Named) -> String {
    let band = |curve: &Curve| bands.iter().find(|band| band.label == curve.label);
    let curves: Vec<Value> = (plot.curves.iter().enumerate())
        .map(|(k, curve)| {
            let class = colour(curve, k);
            let mut json = json!({
                "label": curve.label, "class": class,
                "x": packed::floats(&curve.x), "y": packed::floats(&curve.y),
            });
            if let Some(band) = band(curve) {
                json["band"] = json!({
                    "x": packed::floats(&band.x), "low": packed::floats(&band.low), "high": packed::floats(&band.high),
                });
            }
            json
        })
        .collect();
    let json = json!({
        "title": plot.title, "x": plot.x_label, "y": plot.y_label, "curves": curves,
        "period": named.period_unit, "lines": named.lines,
    });
    format!(" data-plot=\"{}\"", escape(&json.to_string()))
}

/// What a figure's axis is called besides, for spectra.
#[derive(Clone, Debug, Default)]
pub(crate) struct Named {
    /// For a spectrum its unit of a period; its axes are then logarithmic.
    pub period_unit: Option<String>,
    /// Frequencies with names.
    pub lines: Vec<(f64, String)>,
}
