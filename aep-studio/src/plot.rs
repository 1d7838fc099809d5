//! Plots as SVG: curves that run forward in x as lines, everything else as dots.

use std::fmt::Write;

use missing_physics::report::{Curve, Plot};
use serde::{Deserialize, Serialize};

use crate::html::{concat, escape};

mod live;
mod scale;
mod thin;

pub(crate) use live::Named;
use scale::PlotScale;

const WIDTH: f64 = 520.0;
const HEIGHT: f64 = 300.0;
const LEFT: f64 = 58.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;
/// Colours of the style sheet for curves with names of their own.
const OTHERS: [&str; 6] = ["c3", "c4", "c6", "c7", "c0", "c5"];

/// What is known of the curve of the same label: an area between two lines.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Band {
    /// Label of the curve that it belongs to.
    pub label: String,
    /// Abscissa.
    pub x: Vec<f64>,
    /// Lower line.
    pub low: Vec<f64>,
    /// Upper line.
    pub high: Vec<f64>,
}

/// The plot with its title and legend; nothing where it has no finite point.
pub(crate) fn figure(plot: &Plot) -> Option<String> {
    figure_with_bands(plot, &[])
}

/// The same, which scripts leave as it is.
pub(crate) fn still(plot: &Plot) -> Option<String> {
    drawn(plot, &[], "")
}

/// The same with bands behind the curves.
pub(crate) fn figure_with_bands(plot: &Plot, bands: &[Band]) -> Option<String> {
    named(plot, bands, &Named::default())
}

/// The same with what its axis is called besides.
pub(crate) fn named(plot: &Plot, bands: &[Band], named: &Named) -> Option<String> {
    drawn(plot, bands, &live::attribute(plot, bands, named))
}

fn drawn(plot: &Plot, bands: &[Band], attributes: &str) -> Option<String> {
    let whole: Vec<&Curve> = plot.curves.iter().filter(|curve| has_points(curve)).collect();
    let curves: Vec<Curve> = whole.iter().map(|curve| cleaned(curve)).collect();
    let edges: Vec<Curve> = bands.iter().flat_map(edges).collect();
    let x = PlotScale::fitting(curves.iter().flat_map(|c| &c.x), LEFT, WIDTH - RIGHT)?;
    let both = curves.iter().chain(&edges).flat_map(|c| &c.y);
    let y = PlotScale::of(both, HEIGHT - BOTTOM, TOP)?;
    let areas: String = edges.chunks(2).map(|pair| area(pair, &curves, &x, &y)).collect();
    let drawn: String =
        whole.iter().enumerate().map(|(k, c)| curve(c, colour(c, k), &x, &y)).collect();
    let title = escape(&plot.title);
    Some(format!(
        "<figure{attributes}><figcaption>{title}</figcaption>{}\
         <svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=img aria-label=\"{title}\">{}{areas}{drawn}</svg></figure>\n",
        legend(&curves),
        axes(plot, &x, &y),
    ))
}

/// Lower and upper line of each stretch of a band in which both are finite.
fn edges(band: &Band) -> Vec<Curve> {
    let points = band.x.iter().zip(&band.low).zip(&band.high);
    let points: Vec<(f64, f64, f64)> = points.map(|((x, low), high)| (*x, *low, *high)).collect();
    let finite =
        |(x, low, high): &(f64, f64, f64)| x.is_finite() && low.is_finite() && high.is_finite();
    let line = |stretch: &[(f64, f64, f64)], pick: fn(&(f64, f64, f64)) -> f64| Curve {
        label: band.label.clone(),
        x: stretch.iter().map(|point| point.0).collect(),
        y: stretch.iter().map(pick).collect(),
    };
    let stretches = points.split(|point| !finite(point)).filter(|stretch| !stretch.is_empty());
    stretches.flat_map(|s| [line(s, |point| point.1), line(s, |point| point.2)]).collect()
}

/// The area between two lines, in the colour of the curve with their label.
fn area(pair: &[Curve], curves: &[Curve], x: &PlotScale, y: &PlotScale) -> String {
    let [low, high] = pair else { return String::new() };
    let index = curves.iter().position(|curve| curve.label == low.label).unwrap_or(0);
    let place = |curve: &Curve| -> Vec<String> {
        let points = curve.x.iter().zip(&curve.y);
        points.map(|(a, b)| format!("{:.1},{:.1}", x.at(*a), y.at(*b))).collect()
    };
    let (there, mut back) = (place(low), place(high));
    back.reverse();
    format!(
        "<polygon class=\"band {}\" points=\"{} {}\"/>",
        colour(low, index),
        there.join(" "),
        back.join(" ")
    )
}

/// Whether a point can be drawn.
fn is_finite((x, y): &(f64, f64)) -> bool {
    x.is_finite() && y.is_finite()
}

fn points(curve: &Curve) -> impl Iterator<Item = (f64, f64)> + '_ {
    curve.x.iter().copied().zip(curve.y.iter().copied())
}

fn has_points(curve: &Curve) -> bool {
    points(curve).any(|point| is_finite(&point))
}

/// The finite points of a curve.
fn cleaned(curve: &Curve) -> Curve {
    let (x, y) = points(curve).filter(is_finite).unzip();
    Curve { label: curve.label.clone(), x, y }
}

/// The same thing has the same colour in every plot.
pub(crate) fn colour(curve: &Curve, index: usize) -> &'static str {
    match curve.label.as_str() {
        label if label.contains("measured") => "c0",
        label if label.contains("base") => "c2",
        label if label.contains("last") => "c1",
        _ => OTHERS[index % OTHERS.len()],
    }
}

/// A line is interrupted where a value is no number.
fn curve(whole: &Curve, class: &str, x: &PlotScale, y: &PlotScale) -> String {
    let clean = cleaned(whole);
    let forward = clean.x.windows(2).all(|pair| pair[1] >= pair[0]) && clean.x.len() > 1;
    let at = |(a, b): (f64, f64)| (x.at(a), y.at(b));
    if !forward {
        let places: Vec<(f64, f64)> = points(&clean).map(at).collect();
        let dots = thin::cloud(&places).into_iter().map(|(a, b)| format!("M{a:.1} {b:.1}h0"));
        let dots = concat(dots);
        return format!("<path class=\"dots {class}\" d=\"{dots}\"/>");
    }
    let all: Vec<(f64, f64)> = points(whole).collect();
    let stretches = all.split(|point| !is_finite(point)).filter(|stretch| !stretch.is_empty());
    concat(stretches.map(|stretch| {
        let places: Vec<(f64, f64)> = stretch.iter().copied().map(at).collect();
        let line: Vec<String> =
            thin::line(&places).iter().map(|(a, b)| format!("{a:.1},{b:.1}")).collect();
        format!("<polyline class=\"line {class}\" points=\"{}\"/>", line.join(" "))
    }))
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

fn axes(plot: &Plot, x: &PlotScale, y: &PlotScale) -> String {
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
    fn a_band_lies_behind_its_curve_and_widens_the_axis() {
        let plot = plot(vec![0.0, 1.0, 2.0], vec![1.0, 2.0, 1.0]);
        let band = |high: f64| Band {
            label: "a<b".into(),
            x: vec![0.0, 1.0, 2.0],
            low: vec![0.5, 1.5, f64::NAN],
            high: vec![high; 3],
        };
        let figure = |high| figure_with_bands(&plot, &[band(high)]).unwrap();
        assert!(figure(3.0).contains("<polygon class=\"band") && !figure(3.0).contains("NaN"));
        assert!(figure(900.0).contains(">800<") || figure(900.0).contains("×10"));
        assert!(!figure(f64::INFINITY).contains("<polygon"));
    }

    #[test]
    fn lines_and_bands_are_interrupted_where_a_value_is_no_number() {
        let x: Vec<f64> = (0..5).map(f64::from).collect();
        let y = vec![1.0, 2.0, f64::NAN, 2.0, 1.0];
        let whole = plot(x.clone(), y.clone());
        let band = Band {
            label: "a<b".into(),
            x,
            low: y.clone(),
            high: y.iter().map(|y| y + 1.0).collect(),
        };
        let figure = figure_with_bands(&whole, &[band]).unwrap();
        assert_eq!(figure.matches("<polyline").count(), 4);
        assert_eq!(figure.matches("<polygon").count(), 2);
    }

    #[test]
    fn values_that_cannot_be_drawn_are_left_out() {
        assert!(figure(&plot(vec![f64::NAN], vec![1.0])).is_none());
        assert!(figure(&plot(vec![], vec![])).is_none());
        let one = figure(&plot(vec![0.0, 1.0, f64::INFINITY], vec![3.0, 3.0, 1.0])).unwrap();
        assert!(!one.contains("NaN") && !one.contains("inf"));
    }
}
