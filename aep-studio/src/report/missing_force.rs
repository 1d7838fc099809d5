//! The force that the models lack: over time, and along the coordinates of the state.

use missing_physics::Discovery;
use missing_physics::measurement::quantity::percent;
use missing_physics::report::{Curve, MissingForce, Plot, ResidualMap};

use super::residual::{band, curve};
use crate::html::{concat, escape};
use crate::plot::{self, Band};
use crate::words;

/// Instants this many times as far apart as most of them have unknown ones between them.
const GAP: f64 = 3.0;
/// Most points of a band over time: more than there are places on the page.
const BAND_POINTS: usize = 1000;

/// How large it is, in words, and its plots; nothing where nothing is known of it.
pub(super) fn shown(discovery: &Discovery) -> String {
    let Some(said) = words::missing_force(discovery) else { return String::new() };
    let models = models(discovery);
    let time = over_time(discovery, &models).into_iter();
    let figures = concat(time.chain(maps(discovery, &models)));
    let unknown = discovery.missing_force_base.as_ref().map_or(0.0, |force| 1.0 - force.known);
    let name = words::main_quantity(discovery);
    format!(
        "<p><b>{}</b></p><p class=lead>It would have to be added to the recorded {name} so that the model follows, with \
         95 % bands; friction that is missing is negative at positive velocity. While the model rests, {} of the time, it \
         is not known.</p><div class=figures>{figures}</div>",
        escape(&said),
        percent(unknown),
    )
}

/// What is drawn, with its name.
type Named<'a> = (&'static str, &'a MissingForce);

fn models(discovery: &Discovery) -> Vec<Named<'_>> {
    let base = discovery.missing_force_base.iter().map(|force| ("base model", force));
    let changed = discovery.ladder.len() > 1;
    let last = discovery.missing_force.iter().filter(|_| changed);
    base.chain(last.map(|force| ("last model", force))).collect()
}

fn over_time(discovery: &Discovery, models: &[Named<'_>]) -> Option<String> {
    let plot = Plot {
        title: format!("Missing {} over time", words::main_quantity(discovery)),
        x_label: "time / s".to_owned(),
        y_label: ordinate(discovery, ""),
        curves: models.iter().map(|(name, force)| line(name, force)).collect(),
    };
    let bands: Vec<Band> = models.iter().map(|(name, force)| around(name, force)).collect();
    plot::figure_with_bands(&plot, &bands)
}

fn maps(discovery: &Discovery, models: &[Named<'_>]) -> Vec<String> {
    let of_first = models.first().into_iter().flat_map(|(_, force)| &force.maps);
    of_first.filter_map(|map| along(discovery, models, map)).collect()
}

/// The means of all models along the coordinate of a map.
fn along(discovery: &Discovery, models: &[Named<'_>], map: &ResidualMap) -> Option<String> {
    let same = |(name, force): &Named<'_>| {
        let other = force.maps.iter().find(|other| other.coordinate == map.coordinate)?;
        Some((curve(name, other), band(name, other)))
    };
    let (curves, bands): (Vec<Curve>, Vec<Band>) = models.iter().filter_map(same).unzip();
    let against = if map.against_motion { ", against the motion" } else { "" };
    let plot = Plot {
        title: format!("Missing {} along {}", words::main_quantity(discovery), map.coordinate),
        x_label: format!("{} / {}", map.coordinate, map.unit),
        y_label: ordinate(discovery, against),
        curves,
    };
    plot::figure_with_bands(&plot, &bands)
}

fn ordinate(discovery: &Discovery, against: &str) -> String {
    let (name, unit) = (words::main_quantity(discovery), words::main_unit(discovery));
    format!("missing {name}{against} / {unit}")
}

fn line(name: &str, force: &MissingForce) -> Curve {
    let (x, y) = with_gaps(&force.time, 1, |k| force.force[k]).into_iter().unzip();
    Curve { label: name.to_owned(), x, y }
}

fn around(name: &str, force: &MissingForce) -> Band {
    let step = force.time.len().div_ceil(BAND_POINTS).max(1);
    let side =
        |sign: f64| with_gaps(&force.time, step, |k| force.force[k] + sign * force.half_width[k]);
    let (x, low) = side(-1.0).into_iter().unzip();
    let high = side(1.0).into_iter().map(|(_, high)| high).collect();
    Band { label: name.to_owned(), x, low, high }
}

/// Points of every `step`-th instant, interrupted where instants are missing.
fn with_gaps(time: &[f64], step: usize, value: impl Fn(usize) -> f64) -> Vec<(f64, f64)> {
    let mut intervals: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    intervals.sort_unstable_by(f64::total_cmp);
    let most = GAP * intervals.get(intervals.len() / 2).copied().unwrap_or(0.0);
    let mut points = Vec::with_capacity(time.len() / step + 1);
    for k in 0..time.len() {
        if k > 0 && time[k] - time[k - 1] > most {
            points.push((f64::midpoint(time[k - 1], time[k]), f64::NAN));
        }
        if k % step == 0 {
            points.push((time[k], value(k)));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_interrupted_where_nothing_is_known() {
        let points = with_gaps(&[0.0, 1.0, 2.0, 9.0, 10.0, 11.0], 2, |k| k as f64);
        let finite: Vec<f64> =
            points.iter().map(|point| point.1).filter(|y| y.is_finite()).collect();
        assert_eq!(finite, [0.0, 2.0, 4.0]);
        assert!(points[2].1.is_nan() && (points[2].0 - 5.5).abs() < 1e-12);
    }
}
