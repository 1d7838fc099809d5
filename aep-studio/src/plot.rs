//! Plots as SVG: curves that run forward in x as lines, everything else as dots.

use std::fmt::Write;

use missing_physics::report::{Curve, Plot};

use crate::html::{concat, escape};

mod scale;
mod thin;

use scale::Scale;

const WIDTH: f64 = 520.0;
const HEIGHT: f64 = 300.0;
const LEFT: f64 = 58.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;
/// Colours of the style sheet for curves with names of their own.
const OTHERS: [&str; 3] = ["c3", "c4", "c0"];

/// The plot with its title and legend; nothing where it has no finite point.
pub(crate) fn figure(plot: &Plot) -> Option<String> {
    let curves: Vec<Curve> = plot.curves.iter().filter_map(cleaned).collect();
    let x = Scale::fitting(curves.iter().flat_map(|c| &c.x), LEFT, WIDTH - RIGHT)?;
    let y = Scale::of(curves.iter().flat_map(|c| &c.y), HEIGHT - BOTTOM, TOP)?;
    let drawn: String =
        curves.iter().enumerate().map(|(k, c)| curve(c, colour(c, k), &x, &y)).collect();
    let title = escape(&plot.title);
    Some(format!(
        "<figure><figcaption>{title}</figcaption>{}\
         <svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=img aria-label=\"{title}\">{}{drawn}</svg></figure>\n",
        legend(&curves),
        axes(plot, &x, &y),
    ))
}

/// The finite points of a curve; nothing where there are none.
fn cleaned(curve: &Curve) -> Option<Curve> {
    let pairs = curve.x.iter().zip(&curve.y);
    let (x, y): (Vec<f64>, Vec<f64>) =
        pairs.filter(|(x, y)| x.is_finite() && y.is_finite()).unzip();
    (!x.is_empty()).then(|| Curve { label: curve.label.clone(), x, y })
}

/// The same thing has the same colour in every plot.
fn colour(curve: &Curve, index: usize) -> &'static str {
    match curve.label.as_str() {
        label if label.contains("measured") => "c0",
        label if label.contains("base") => "c2",
        label if label.contains("last") => "c1",
        _ => OTHERS[index % OTHERS.len()],
    }
}

fn curve(curve: &Curve, class: &str, x: &Scale, y: &Scale) -> String {
    let forward = curve.x.windows(2).all(|pair| pair[1] >= pair[0]) && curve.x.len() > 1;
    let points: Vec<(f64, f64)> =
        curve.x.iter().zip(&curve.y).map(|(a, b)| (x.at(*a), y.at(*b))).collect();
    if !forward {
        let dots = thin::cloud(&points).into_iter().map(|(a, b)| format!("M{a:.1} {b:.1}h0"));
        let dots = concat(dots);
        return format!("<path class=\"dots {class}\" d=\"{dots}\"/>");
    }
    let line: Vec<String> =
        thin::line(&points).iter().map(|(a, b)| format!("{a:.1},{b:.1}")).collect();
    format!("<polyline class=\"line {class}\" points=\"{}\"/>", line.join(" "))
}

fn legend(curves: &[Curve]) -> String {
    if curves.len() < 2 {
        return String::new();
    }
    let entry = |(k, curve): (usize, &Curve)| {
        format!("<span><i class={}></i>{}</span>", colour(curve, k), escape(&curve.label))
    };
    let entries: String = curves.iter().enumerate().map(entry).collect();
    format!("<div class=legend>{entries}</div>")
}

fn axes(plot: &Plot, x: &Scale, y: &Scale) -> String {
    let (bottom, right) = (HEIGHT - BOTTOM, WIDTH - RIGHT);
    // Writing to a string cannot fail.
    let mut svg = String::new();
    for (at, text) in x.ticks() {
        let _ = write!(
            svg,
            "<line class=grid x1={at:.1} x2={at:.1} y1={TOP} y2={bottom} />\
             <text x={at:.1} y={:.1} text-anchor=middle>{text}</text>",
            bottom + 15.0
        );
    }
    for (at, text) in y.ticks() {
        let _ = write!(
            svg,
            "<line class=grid x1={LEFT} x2={right} y1={at:.1} y2={at:.1} />\
             <text x={:.1} y={:.1} text-anchor=end>{text}</text>",
            LEFT - 6.0,
            at + 3.5
        );
    }
    for (scale, vertical) in [(x, true), (y, false)] {
        let Some(zero) = scale.zero() else { continue };
        let line = if vertical {
            format!("x1={zero:.1} x2={zero:.1} y1={TOP} y2={bottom}")
        } else {
            format!("x1={LEFT} x2={right} y1={zero:.1} y2={zero:.1}")
        };
        let _ = write!(svg, "<line class=zero {line} />");
    }
    let middle = f64::midpoint(TOP, bottom);
    let _ = write!(
        svg,
        "<text class=axis x={:.1} y={:.1} text-anchor=middle>{}</text>\
         <text class=axis transform=\"translate(13 {middle:.1}) rotate(-90)\" text-anchor=middle>{}</text>",
        f64::midpoint(LEFT, right),
        HEIGHT - 7.0,
        escape(&x.label(&plot.x_label)),
        escape(&y.label(&plot.y_label)),
    );
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(x: Vec<f64>, y: Vec<f64>) -> Plot {
        let curve = Curve { label: "a<b".into(), x, y };
        Plot {
            title: "t".into(),
            x_label: "v / m/s".into(),
            y_label: "F / N".into(),
            curves: vec![curve.clone(), curve],
        }
    }

    #[test]
    fn forward_curves_are_lines_and_clouds_are_dots() {
        let line = figure(&plot(vec![0.0, 1.0, 2.0], vec![1.0, 2.0, 1.0])).unwrap();
        assert!(line.contains("<polyline") && line.contains("a&lt;b") && !line.contains("a<b"));
        let cloud = figure(&plot(vec![0.0, 2.0, 1.0], vec![1.0, 2.0, 1.0])).unwrap();
        assert!(cloud.contains("class=\"dots"));
    }

    #[test]
    fn values_that_cannot_be_drawn_are_left_out() {
        assert!(figure(&plot(vec![f64::NAN], vec![1.0])).is_none());
        assert!(figure(&plot(vec![], vec![])).is_none());
        let one = figure(&plot(vec![0.0, 1.0, f64::INFINITY], vec![3.0, 3.0, 1.0])).unwrap();
        assert!(!one.contains("NaN") && !one.contains("inf"));
    }
}
