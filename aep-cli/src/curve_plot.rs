//! Curves as an SVG file, and as a figure of a page.

use aep_studio::report::plain::{Band, Figure};
use missing_physics::report::{self, Plot};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::failure::Failure;

/// One curve of a plot.
#[derive(Clone, Debug)]
pub struct Curve {
    /// As in the legend.
    pub label: String,
    /// (x, y), x ascending.
    pub points: Vec<(f64, f64)>,
    /// (x, low, high) of a band around it; empty for none.
    pub band: Vec<(f64, f64, f64)>,
}

/// What the axes say and how they are divided.
#[derive(Clone, Copy, Debug)]
pub struct Axes<'a> {
    /// Above the plot.
    pub title: &'a str,
    /// Below it.
    pub x: &'a str,
    /// Beside it.
    pub y: &'a str,
    /// Whether y is divided by powers of ten; what is not positive is then left out.
    pub logarithmic: bool,
}

const SIZE: (u32, u32) = (760, 480);
const COLOURS: [RGBColor; 7] = [
    RGBColor(31, 119, 180),
    RGBColor(214, 39, 40),
    RGBColor(44, 160, 44),
    RGBColor(148, 103, 189),
    RGBColor(255, 127, 14),
    RGBColor(140, 86, 75),
    RGBColor(23, 190, 207),
];

/// The plot as the text of an SVG file.
pub fn svg(axes: Axes<'_>, curves: &[Curve]) -> Result<String, Failure> {
    svg_against(axes, curves, &[])
}

/// The same with curves to be compared with, dashed and on top.
pub fn svg_against(axes: Axes<'_>, curves: &[Curve], dashed: &[Curve]) -> Result<String, Failure> {
    let mut text = String::new();
    let failed = |error: &dyn std::fmt::Display| Failure::failed(format!("cannot plot: {error}"));
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        area.fill(&WHITE).map_err(|error| failed(&error))?;
        draw(&area, axes, curves, dashed).map_err(|error| failed(&error))?;
        area.present().map_err(|error| failed(&error))?;
    }
    Ok(text)
}

/// The same for a page: its axes are even, so a logarithmic one has the logarithms.
pub fn figure(axes: Axes<'_>, curves: &[Curve]) -> Figure {
    let with_unit = |label: &str| label.replacen(", ", " / ", 1);
    let curves: Vec<Curve> = curves.iter().map(|curve| scaled(curve, axes.logarithmic)).collect();
    let drawn = curves.iter().map(|curve| {
        let (x, y) = curve.points.iter().copied().unzip();
        report::Curve { label: curve.label.clone(), x, y }
    });
    let bands = curves.iter().filter(|curve| !curve.band.is_empty()).map(|curve| Band {
        label: curve.label.clone(),
        x: curve.band.iter().map(|(x, ..)| *x).collect(),
        low: curve.band.iter().map(|(_, low, _)| *low).collect(),
        high: curve.band.iter().map(|(.., high)| *high).collect(),
    });
    Figure {
        plot: Plot {
            title: axes.title.to_owned(),
            x_label: with_unit(axes.x),
            y_label: if axes.logarithmic {
                format!("log10 of {}", axes.y)
            } else {
                with_unit(axes.y)
            },
            curves: drawn.collect(),
        },
        bands: bands.collect(),
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(area: &Area<'_>, axes: Axes<'_>, curves: &[Curve], dashed: &[Curve]) -> Drawn {
    let all = curves.iter().chain(dashed).map(|curve| scaled(curve, axes.logarithmic));
    let all: Vec<Curve> = all.collect();
    let (x, y) = limits(&all);
    let (curves, dashed) = all.split_at(curves.len());
    let mut chart = ChartBuilder::on(area)
        .caption(axes.title, ("sans-serif", 18))
        .margin(12)
        .margin_right(28)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
    let logarithmic = axes.logarithmic;
    chart
        .configure_mesh()
        .x_desc(axes.x)
        .y_desc(axes.y)
        .light_line_style(TRANSPARENT)
        .x_label_formatter(&|x| tick(*x))
        .y_label_formatter(&|y| if logarithmic { format!("1e{y:.0}") } else { tick(*y) })
        .draw()?;
    for (curve, colour) in curves.iter().zip(COLOURS.iter().cycle()) {
        add(&mut chart, curve, *colour)?;
    }
    for curve in dashed {
        add_dashed(&mut chart, curve)?;
    }
    chart.configure_series_labels().background_style(WHITE.mix(0.8)).border_style(BLACK).draw()?;
    Ok(())
}

/// A place on an axis without the rounding errors of its making.
fn tick(place: f64) -> String {
    ((place * 1e9).round() / 1e9).to_string()
}

fn add(chart: &mut Chart<'_, '_>, curve: &Curve, colour: RGBColor) -> Drawn {
    if !curve.band.is_empty() {
        let below = curve.band.iter().map(|(x, low, _)| (*x, *low));
        let above = curve.band.iter().rev().map(|(x, _, high)| (*x, *high));
        let outline: Vec<(f64, f64)> = below.chain(above).collect();
        chart.draw_series([Polygon::new(outline, colour.mix(0.15))])?;
    }
    let style = colour.stroke_width(2);
    chart
        .draw_series(LineSeries::new(curve.points.iter().copied(), style))?
        .label(&curve.label)
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
    Ok(())
}

/// Length of a dash and of a gap, in points.
const DASH: (i32, i32) = (7, 5);

fn add_dashed(chart: &mut Chart<'_, '_>, curve: &Curve) -> Drawn {
    let style = BLACK.stroke_width(1);
    chart
        .draw_series(DashedLineSeries::new(curve.points.iter().copied(), DASH.0, DASH.1, style))?
        .label(&curve.label)
        .legend(move |(x, y)| {
            plotters::element::DashedPathElement::new(
                vec![(x, y), (x + 18, y)],
                DASH.0,
                DASH.1,
                style,
            )
        });
    Ok(())
}

/// The curve as it is drawn: finite, and by its decimal logarithm where asked for.
fn scaled(curve: &Curve, logarithmic: bool) -> Curve {
    let place = |y: f64| if logarithmic { y.log10() } else { y };
    let mut points: Vec<(f64, f64)> = curve.points.iter().map(|(x, y)| (*x, place(*y))).collect();
    points.retain(|(_, y)| y.is_finite());
    let mut band: Vec<(f64, f64, f64)> =
        curve.band.iter().map(|(x, low, high)| (*x, place(*low), place(*high))).collect();
    band.retain(|(_, low, high)| low.is_finite() && high.is_finite());
    Curve { label: curve.label.clone(), points, band }
}

/// The axes' ends, never equal.
fn limits(curves: &[Curve]) -> ((f64, f64), (f64, f64)) {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let bands = || curves.iter().flat_map(|curve| &curve.band);
    let x = points().map(|(x, _)| *x);
    let y = points().map(|(_, y)| *y).chain(bands().flat_map(|(_, low, high)| [*low, *high]));
    (range(x), range(y))
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if low < high {
        (low, high)
    } else if low.is_finite() {
        (low - 1.0, low + 1.0)
    } else {
        (0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_on_a_logarithmic_axis_and_empty_curves_are_drawn_around() {
        let axes = Axes { title: "t", x: "x", y: "y", logarithmic: true };
        let points = vec![(0.0, 1.0), (1.0, 1e-3), (2.0, 0.0)];
        let curve =
            Curve { label: "a".into(), points, band: vec![(0.0, 0.5, 2.0), (1.0, 0.0, 1.0)] };
        let empty = Curve { label: "b".into(), points: vec![], band: vec![] };
        let text = svg(axes, &[curve, empty]).unwrap();
        assert!(text.starts_with("<svg") && text.contains("1e-3"), "{text}");
    }
}
