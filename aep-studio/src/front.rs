//! What makes a page live: styles, scripts and the data that they draw, all inside the page.
//!
//! The scripts of `src/front` are plain and share one scope; `uplot` there is a library, as it was published.

pub(crate) mod packed;
pub(crate) mod samples;

use missing_physics::Discovery;
use serde_json::Value;

use crate::source::Source;
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

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn no_text_ends_the_element_that_holds_the_data() {
        let nasty = json!({"name": "</script><script>alert(1)</script><!--"});
        let text = inside_script(&nasty);
        assert!(!text.contains('<'));
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), nasty);
    }
}
