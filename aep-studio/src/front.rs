//! What makes a page live: styles, scripts and the data that they draw, all inside the page.
//!
//! The scripts of `src/front` are plain and share one scope; `uplot` there is a library, as it was published.

mod packed;
pub(crate) mod samples;

use missing_physics::Discovery;
use missing_physics::report::{Curve, Plot};
use serde_json::{Value, json};

use crate::html::escape;
use crate::plot::Band;
use crate::report::Source;
use crate::words;

/// Styles of live plots.
pub(crate) const STYLE: &str =
    concat!(include_str!("front/uplot/uPlot.min.css"), "\n", include_str!("front/live.css"));

/// A library of plots, as it was published.
pub(crate) const LIBRARY: &str = include_str!("front/uplot/uPlot.iife.min.js");
/// Plots, in the order in which they need each other.
pub(crate) const PLOTS: [&str; 11] = [
    include_str!("front/data.js"),
    include_str!("front/units.js"),
    include_str!("front/colours.js"),
    include_str!("front/zoom.js"),
    include_str!("front/export.js"),
    include_str!("front/chart.js"),
    include_str!("front/heatmap.js"),
    include_str!("front/figures.js"),
    include_str!("front/region.js"),
    include_str!("front/screen.js"),
    include_str!("front/print.js"),
];
const START: &str = include_str!("front/start.js");

/// The scripts of a page.
pub(crate) fn scripts() -> String {
    format!(
        "<script>{LIBRARY}</script>\n<script>\"use strict\";(() => {{\n{}{START}}})();</script>\n",
        PLOTS.concat()
    )
}

/// The data of the first screen as an element that scripts read; nothing where there is no course.
pub(crate) fn data(discovery: &Discovery, source: &Source) -> String {
    let course = &source.samples;
    if course.time.len() < 2 || course.compared.is_empty() {
        return String::new();
    }
    let places = discovery.where_base.iter().chain(&discovery.where_it_fails);
    let mut order: Vec<&str> = Vec::new();
    for place in places {
        if !order.contains(&place.coordinate.as_str()) {
            order.push(&place.coordinate);
        }
    }
    let ladder: Vec<_> = discovery.ladder.iter().map(|rung| (words::rung(rung), rung)).collect();
    let packed = samples::packed(&ladder, &order, course);
    format!("<script type=\"application/json\" class=course>{}</script>\n", inside_script(&packed))
}

/// JSON as it may stand in a script element: whatever text a file brought, no tag begins in it.
fn inside_script(value: &Value) -> String {
    value.to_string().replace('<', "\\u003c")
}

/// The data of a figure as an attribute, with which scripts draw it anew.
pub(crate) fn figure(plot: &Plot, bands: &[Band], named: &Named) -> String {
    let band = |curve: &Curve| bands.iter().find(|band| band.label == curve.label);
    let curves: Vec<Value> = (plot.curves.iter().enumerate())
        .map(|(k, curve)| {
            let class = crate::plot::colour(curve, k);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_ends_the_element_that_holds_the_data() {
        let nasty = json!({"name": "</script><script>alert(1)</script><!--"});
        let text = inside_script(&nasty);
        assert!(!text.contains('<'));
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), nasty);
    }
}
