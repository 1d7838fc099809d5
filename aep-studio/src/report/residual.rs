//! What the residual says by itself: is it noise, where along the coordinates does it lie, what in it is
//! periodic.

use missing_physics::Discovery;
use missing_physics::measurement::quantity::quantity;
use missing_physics::report::{Curve, Diagnosis, Plot, ResidualMap, Whiteness};

use crate::html::{self, concat, escape, table};
use crate::plot::Named;
use crate::plot::{self, Band};
use crate::words;

const LEAD: &str = "Tests of what the last model leaves, its mean along the coordinates with 95 % bands \
    (which know that neighbours in time err together), and what in it is periodic.";
/// How titles of spectra begin.
const SPECTRUM: &str = "Spectrum of the residual over ";
/// Most maps that are drawn.
const MAPS: usize = 6;

/// The section; nothing where nothing was looked at.
pub(super) fn section(discovery: &Discovery) -> String {
    let Some(diagnosis) = &discovery.diagnosis else { return String::new() };
    let base = discovery.diagnosis_base.as_ref().and_then(|base| base.whiteness.as_ref());
    let resembles = diagnosis.whiteness.as_ref().and_then(|last| autocorrelation(base, last));
    let drawn = resembles.unwrap_or_default() + &maps(discovery, diagnosis);
    let drawn = if drawn.is_empty() { drawn } else { format!("<div class=figures>{drawn}</div>") };
    let body = tests(diagnosis) + &lines(discovery, diagnosis) + &drawn;
    if body.is_empty() {
        return String::new();
    }
    html::section("residual", "What remains", LEAD, &body)
}

fn tests(diagnosis: &Diagnosis) -> String {
    let sentences = words::residual_tests(diagnosis);
    if sentences.is_empty() {
        return String::new();
    }
    format!("<p>{}</p>", escape(&sentences.join(" ")))
}

fn lines(discovery: &Discovery, diagnosis: &Diagnosis) -> String {
    if diagnosis.lines.is_empty() {
        return String::new();
    }
    let unit = words::main_unit(discovery);
    let rows: Vec<Vec<String>> = diagnosis
        .lines
        .iter()
        .map(|line| {
            vec![
                format!(
                    "{}<small>{}</small>",
                    escape(&words::line(line)),
                    escape(&words::relation(line))
                ),
                escape(&line.along),
                escape(&quantity(line.amplitude, &unit)),
                escape(&words::p_value(line.p_value)),
            ]
        })
        .collect();
    table(&["Periodic in the residual", "Along", "#Amplitude", "#p-value"], &rows)
}

/// Title of the map along a coordinate.
fn title(map: &ResidualMap) -> String {
    format!("Mean residual along {}", map.coordinate)
}

/// Titles of the maps that the section draws.
pub(super) fn titles(discovery: &Discovery) -> Vec<String> {
    discovery.diagnosis.iter().flat_map(|diagnosis| diagnosis.maps.iter().map(title)).collect()
}

/// The maps along the coordinates on which the base model fails most.
fn maps(discovery: &Discovery, diagnosis: &Diagnosis) -> String {
    let base = discovery.diagnosis_base.as_ref();
    let places = discovery.where_base.iter().chain(&discovery.where_it_fails);
    let mut chosen: Vec<&ResidualMap> = Vec::new();
    for place in places {
        let map = diagnosis.maps.iter().find(|map| map.coordinate == place.coordinate);
        chosen.extend(map.filter(|map| chosen.iter().all(|c| c.coordinate != map.coordinate)));
    }
    let figures = chosen.into_iter().take(MAPS).filter_map(|map| {
        let of_base =
            base.and_then(|base| base.maps.iter().find(|other| other.coordinate == map.coordinate));
        figure(discovery, of_base, map)
    });
    concat(figures)
}

/// How much the residual resembles itself some time later, with what it would be were it white.
pub(crate) fn autocorrelation(base: Option<&Whiteness>, last: &Whiteness) -> Option<String> {
    const WHITE: &str = "white noise, 95 %";
    let lags = |test: &Whiteness| -> Vec<f64> {
        (1..=test.autocorrelation.len()).map(|k| test.interval_s * k as f64).collect()
    };
    let curve = |label: &str, test: &Whiteness, y: &[f64]| Curve {
        label: label.to_owned(),
        x: lags(test),
        y: y.to_vec(),
    };
    let name = if base.is_some() { "last model" } else { "the model (last)" };
    let of_base = base.map(|base| curve("base model", base, &base.autocorrelation));
    let plot = Plot {
        title: "Autocorrelation of the residual".to_owned(),
        x_label: "lag / s".to_owned(),
        y_label: "correlation".to_owned(),
        curves: std::iter::once(curve(WHITE, last, &last.expected))
            .chain(of_base)
            .chain([curve(name, last, &last.autocorrelation)])
            .collect(),
    };
    let edge = |sign: f64| -> Vec<f64> {
        last.expected.iter().zip(&last.bound).map(|(middle, half)| middle + sign * half).collect()
    };
    let band = Band { label: WHITE.to_owned(), x: lags(last), low: edge(-1.0), high: edge(1.0) };
    plot::figure_with_bands(&plot, &[band])
}

fn figure(discovery: &Discovery, base: Option<&ResidualMap>, last: &ResidualMap) -> Option<String> {
    let name = if base.is_some() { "last model" } else { "the model (last)" };
    let shown: Vec<(&str, &ResidualMap)> =
        base.map(|map| ("base model", map)).into_iter().chain([(name, last)]).collect();
    let quantity = words::main_error(discovery).map(|name| name.quantity).unwrap_or_default();
    let opposes = if last.against_motion { ", against the motion" } else { "" };
    let plot = Plot {
        title: title(last),
        x_label: format!("{} / {}", last.coordinate, last.unit),
        y_label: format!("{quantity} residual{opposes} / {}", words::main_unit(discovery)),
        curves: shown.iter().map(|(label, map)| curve(label, map)).collect(),
    };
    let bands: Vec<Band> = shown.iter().map(|(label, map)| band(label, map)).collect();
    plot::figure_with_bands(&plot, &bands)
}

/// A plot of the engine; spectra with their lines by name.
pub(super) fn curves(discovery: &Discovery, plot: &Plot) -> Option<String> {
    let Some(along) = plot.title.strip_prefix(SPECTRUM) else { return plot::figure(plot) };
    let diagnosis = discovery.diagnosis.as_ref()?;
    let unit = if along == "time" {
        Some("s")
    } else {
        plot.x_label.split_once("1/").map(|(_, unit)| unit)
    };
    let lines = diagnosis.lines.iter().filter(|line| line.along == along && line.period > 0.0);
    let named = Named {
        period_unit: unit.map(ToOwned::to_owned),
        lines: lines.map(|line| (1.0 / line.period, words::line(line))).collect(),
    };
    plot::named(plot, &[], &named)
}

/// The means of a map as a curve.
pub(super) fn curve(label: &str, map: &ResidualMap) -> Curve {
    let (x, y) = map.bins.iter().map(|bin| (bin.at, bin.mean)).unzip();
    Curve { label: label.to_owned(), x, y }
}

/// Their bands.
pub(super) fn band(label: &str, map: &ResidualMap) -> Band {
    let (low, high) = map.bins.iter().map(|bin| (bin.low, bin.high)).unzip();
    Band { label: label.to_owned(), x: map.bins.iter().map(|bin| bin.at).collect(), low, high }
}
