//! Spectra of the residual with named lines: over time ("50.0 Hz") and over a coordinate such as the
//! position ("period 2.50 mm").
//!
//! The comparison's own bandwidth is no limit here: the residual comes at the full rate of the recording
//! ([`FullRate`]). What is periodic along the position shows up in time, too, wherever the motion is
//! uniform (and the other way round); of two such lines the one that explains more of the residual is
//! the cause, and the other one says so.

use std::f64::consts::TAU;
use std::ops::Range;

use crate::diagnosis::where_it_fails::parity;
use crate::family::{Coordinate, Fitted, FullRate, ModelFamily};
use crate::report::{Curve, Line, LineOf, Plot, Relation};
use crate::statistics::autocorrelation::{interval, pieces};

use crate::statistics::periodogram::{Peak, Periodogram};

/// Chance of any line at all in a spectrum without lines.
pub const FALSE_ALARMS: f64 = 0.01;
/// Most lines that are reported per spectrum.
const MOST: usize = 4;
/// Finest and coarsest division of a coordinate.
const DIVISIONS: (usize, usize) = (128, 4096);
/// A coordinate is divided more coarsely until at most this share of the bins is empty.
const EMPTY: f64 = 0.1;
/// Two frequencies are the same, or one a multiple of the other, within this.
const SAME: f64 = 0.01;
/// Share of the amplitudes of all passes that must remain in their sum.
const IN_ALL: f64 = 0.5;
/// Least share of the time at the speed that turns one line into another.
const AT_SPEED: f64 = 0.03;
/// Curves are thinned out to this many points for plots.
const CURVE: usize = 2000;

/// The residual of `model` at full rate, or on the family's grid where the family has no more.
pub fn full_rate(family: &dyn ModelFamily, model: &Fitted, residual: &[f64]) -> FullRate {
    family.full_rate(model).unwrap_or_else(|| FullRate {
        interval: interval(family.time()),
        residual: residual.to_vec(),
        used: vec![true; residual.len()],
        pieces: pieces(family.time()),
        coordinates: Vec::new(),
    })
}

/// The lines of all spectra of `full`, and the spectra themselves as plots. `unit` is that of the
/// residual, `quantity` its name.
pub fn lines(full: &FullRate, quantity: &str, unit: &str) -> (Vec<Line>, Vec<Plot>) {
    let mut spectra = Vec::new();
    spectra.extend(Spectrum::over_time(full));
    spectra.extend(full.coordinates.iter().filter_map(|c| Spectrum::along(full, c)));
    let plots = spectra.iter().map(|spectrum| spectrum.plot(quantity, unit)).collect();
    let mut lines: Vec<(usize, Line)> = Vec::new();
    for (k, spectrum) in spectra.iter().enumerate() {
        let kept = spectrum.lines().filter(|line| {
            spectrum.coordinate.is_none_or(|c| in_all_passes(full, c, 1.0 / line.period))
        });
        lines.extend(kept.take(MOST).map(|line| (k, line)));
    }
    for k in 0..lines.len() {
        lines[k].1.relation = relation(full, &spectra, &lines, k);
    }
    (lines.into_iter().map(|(_, line)| line).collect(), plots)
}

struct Spectrum<'a> {
    /// Nothing for time.
    coordinate: Option<&'a Coordinate>,
    periodogram: Periodogram,
}

impl<'a> Spectrum<'a> {
    fn over_time(full: &FullRate) -> Option<Self> {
        let pieces: Vec<Vec<f64>> =
            full.pieces.iter().map(|piece| masked(full, piece.clone())).collect();
        let periodogram = Periodogram::new(&pieces, full.interval)?;
        Some(Self { coordinate: None, periodogram })
    }

    fn along(full: &FullRate, coordinate: &'a Coordinate) -> Option<Self> {
        let (profile, width) = folded(full, coordinate)?;
        let periodogram = Periodogram::new(&[profile], width)?;
        Some(Self { coordinate: Some(coordinate), periodogram })
    }

    fn name(&self) -> &str {
        self.coordinate.map_or("time", |coordinate| coordinate.name.as_str())
    }

    fn unit(&self) -> &str {
        self.coordinate.map_or("s", |coordinate| coordinate.unit.as_str())
    }

    fn lines(&self) -> impl Iterator<Item = Line> {
        let named = move |peak: Peak| {
            let period = 1.0 / peak.frequency;
            Line {
                along: self.name().to_owned(),
                period,
                unit: self.unit().to_owned(),
                amplitude: peak.amplitude,
                p_value: peak.p_value,
                relation: None,
            }
        };
        self.periodogram.peaks(FALSE_ALARMS).map(named)
    }

    fn plot(&self, quantity: &str, unit: &str) -> Plot {
        let (frequency, amplitude, needed) = self.periodogram.curves(FALSE_ALARMS);
        let step = frequency.len().div_ceil(CURVE).max(1);
        // The highest of each stretch: lines survive.
        let most = |values: &[f64]| -> Vec<f64> {
            values.chunks(step).map(|part| part.iter().copied().fold(0.0, f64::max)).collect()
        };
        let curve = |label: &str, values: &[f64]| Curve {
            label: label.to_owned(),
            x: frequency.iter().step_by(step).copied().collect(),
            y: most(values),
        };
        let per =
            if self.coordinate.is_none() { "Hz".into() } else { format!("1/{}", self.unit()) };
        Plot {
            title: format!("Spectrum of the residual over {}", self.name()),
            x_label: format!("frequency / {per}"),
            y_label: format!("{quantity} amplitude / {unit}"),
            curves: vec![
                curve("last model", &amplitude),
                curve("from here on more than chance (1 in 100 spectra of noise)", &needed),
            ],
        }
    }
}

/// A piece of the residual, zero where it says nothing.
fn masked(full: &FullRate, piece: Range<usize>) -> Vec<f64> {
    let inside = piece.clone().filter(|&k| full.used[k]);
    let count = inside.clone().count().max(1) as f64;
    let mean = inside.map(|k| full.residual[k]).sum::<f64>() / count;
    piece.map(|k| if full.used[k] { full.residual[k] - mean } else { 0.0 }).collect()
}

/// The mean residual over equal steps of a coordinate, and the length of a step; nothing where too
/// little of the coordinate is covered.
fn folded(full: &FullRate, coordinate: &Coordinate) -> Option<(Vec<f64>, f64)> {
    let seen = parity(coordinate, &full.residual, &vec![1.0; full.residual.len()]);
    let x = &coordinate.values;
    let used: Vec<usize> = (0..x.len()).filter(|&k| full.used[k]).collect();
    let (low, high) =
        used.iter().fold((f64::MAX, f64::MIN), |(low, high), &k| (low.min(x[k]), high.max(x[k])));
    let mut steps: Vec<f64> = used.iter().skip(1).map(|&k| (x[k] - x[k - 1]).abs()).collect();
    if steps.is_empty() || low >= high {
        return None;
    }
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let mut count = (((high - low) / (1.5 * usual)) as usize).min(DIVISIONS.1);
    while count >= DIVISIONS.0 {
        let width = (high - low) / count as f64;
        let (mut sum, mut points) = (vec![0.0; count], vec![0.0; count]);
        for &k in &used {
            let bin = (((x[k] - low) / width) as usize).min(count - 1);
            sum[bin] += seen[k];
            points[bin] += 1.0;
        }
        let empty = points.iter().filter(|points| **points == 0.0).count();
        if empty as f64 <= EMPTY * count as f64 {
            return Some((bridged(&sum, &points), width));
        }
        count = count * 3 / 4;
    }
    None
}

/// Means of the bins; an empty one takes the mean of its neighbours before and after.
fn bridged(sum: &[f64], points: &[f64]) -> Vec<f64> {
    let mean = |k: usize| (points[k] > 0.0).then(|| sum[k] / points[k]);
    (0..sum.len())
        .map(|k| {
            mean(k).unwrap_or_else(|| {
                let before = (0..k).rev().find_map(mean);
                let after = (k + 1..sum.len()).find_map(mean);
                let both = (before.or(after), after.or(before));
                both.0.zip(both.1).map_or(0.0, |(a, b)| 0.5 * (a + b))
            })
        })
        .collect()
}

/// Whether a line along a coordinate has the same phase in its passes: what depends on the place is there
/// whenever the place is passed. The counts of an encoder beat with the sampling at a uniform speed and
/// leave lines as sharp, but others at every other speed. `|sum z|² / (sum w · sum |z|² / w)` of the
/// amplitudes `z` of passes of length `w` is 1 for a line in all of them, and the share of the way where
/// it is in one.
fn in_all_passes(full: &FullRate, coordinate: &Coordinate, frequency: f64) -> bool {
    let x = &coordinate.values;
    let seen = parity(coordinate, &full.residual, &vec![1.0; full.residual.len()]);
    let period = 1.0 / frequency;
    let (mut total, mut way, mut apart) = ((0.0, 0.0), 0.0, 0.0);
    for pass in passes(full, x) {
        let length = (x[pass.end - 1] - x[pass.start]).abs();
        if length < 3.0 * period {
            continue;
        }
        let mean = seen[pass.clone()].iter().sum::<f64>() / pass.len() as f64;
        let z = pass.clone().skip(1).fold((0.0, 0.0), |(cosine, sine), k| {
            let step = (x[k] - x[k - 1]).abs() * (seen[k] - mean);
            let (s, c) = (TAU * frequency * x[k]).sin_cos();
            (cosine + c * step, sine + s * step)
        });
        total = (total.0 + z.0, total.1 + z.1);
        way += length;
        apart += (z.0 * z.0 + z.1 * z.1) / length;
    }
    apart > 0.0 && (total.0 * total.0 + total.1 * total.1) / (way * apart) >= IN_ALL
}

/// Stretches of used samples in which a coordinate runs one way.
fn passes(full: &FullRate, x: &[f64]) -> Vec<Range<usize>> {
    let mut passes = Vec::new();
    for piece in &full.pieces {
        let mut start = piece.start;
        for k in piece.clone() {
            let ends = k + 1 == piece.end
                || !full.used[k + 1]
                || (k > start && (x[k + 1] - x[k]) * (x[k] - x[k - 1]) < 0.0);
            if ends {
                if full.used[start] && k > start + 1 {
                    passes.push(start..k + 1);
                }
                start = k + 1;
            }
        }
    }
    passes
}

/// What the `k`-th line has to do with the others. Along a coordinate harmonics come first: one line of
/// it makes several over time, which then are multiples of each other by chance of the speeds.
fn relation(
    full: &FullRate,
    spectra: &[Spectrum<'_>],
    lines: &[(usize, Line)],
    k: usize,
) -> Option<Relation> {
    let harmonic = || harmonic(lines, k);
    let seen_at = || seen_at(full, spectra, lines, k);
    if spectra[lines[k].0].coordinate.is_some() {
        twin(spectra, lines, k).or_else(harmonic).or_else(seen_at)
    } else {
        seen_at().or_else(harmonic)
    }
}

/// The same period, stronger along another coordinate: with or against the motion.
fn twin(spectra: &[Spectrum<'_>], lines: &[(usize, Line)], k: usize) -> Option<Relation> {
    let (of, line) = &lines[k];
    lines.iter().find_map(|(other, stronger)| {
        let alike = other != of
            && spectra[*other].coordinate.is_some()
            && stronger.amplitude > line.amplitude
            && (stronger.period / line.period - 1.0).abs() < SAME;
        alike.then(|| Relation::StrongerAlong { coordinate: stronger.along.clone() })
    })
}

/// The longest period in the same spectrum that this one is a whole part of.
fn harmonic(lines: &[(usize, Line)], k: usize) -> Option<Relation> {
    let (of, line) = &lines[k];
    let whole = |base: &Line| {
        let ratio = base.period / line.period;
        let near = (2.0..9.5).contains(&ratio) && (ratio / ratio.round() - 1.0).abs() < SAME;
        near.then(|| ratio.round())
    };
    lines
        .iter()
        .filter(|(other, _)| other == of)
        .filter_map(|(_, base)| Some((base, whole(base)?)))
        .max_by(|a, b| a.0.period.total_cmp(&b.0.period))
        .map(|(base, whole)| Relation::Harmonic { order: whole as u32, of: line_of(base) })
}

/// The line along a coordinate that shows up as this one over time, or the other way round.
fn seen_at(
    full: &FullRate,
    spectra: &[Spectrum<'_>],
    lines: &[(usize, Line)],
    k: usize,
) -> Option<Relation> {
    let (of, line) = &lines[k];
    let is_in_time = spectra[*of].coordinate.is_none();
    lines.iter().find_map(|(other, cause)| {
        let ((Some(coordinate), None) | (None, Some(coordinate))) =
            (spectra[*of].coordinate, spectra[*other].coordinate)
        else {
            return None;
        };
        let (in_time, in_space) = if is_in_time { (line, cause) } else { (cause, line) };
        let speed = in_space.period / in_time.period;
        if at_speed(full, coordinate, speed) < AT_SPEED {
            return None;
        }
        let explained = (over_time(full, in_time), over_space(full, coordinate, in_space));
        let is_effect = (explained.0 < explained.1) == is_in_time;
        let unit = format!("{}/s", coordinate.unit);
        is_effect.then(|| Relation::SeenAt { of: line_of(cause), rate: speed, unit })
    })
}

fn line_of(line: &Line) -> LineOf {
    LineOf { along: line.along.clone(), period: line.period, unit: line.unit.clone() }
}

/// Share of the used time at which the coordinate changes at this rate.
fn at_speed(full: &FullRate, coordinate: &Coordinate, speed: f64) -> f64 {
    let moves = |k: usize| (coordinate.values[k + 1] - coordinate.values[k]).abs() / full.interval;
    let mut used = 0usize;
    let mut near = 0usize;
    for k in full.pieces.iter().flat_map(|piece| piece.start..piece.end.saturating_sub(1)) {
        if full.used[k] {
            used += 1;
            near += usize::from((moves(k) / speed - 1.0).abs() < 0.1);
        }
    }
    near as f64 / used.max(1) as f64
}

/// Square of the residual that a line over time removes.
fn over_time(full: &FullRate, line: &Line) -> f64 {
    let span = full.interval * full.residual.len() as f64;
    let longest = full.pieces.iter().map(ExactSizeIterator::len).max().unwrap_or(1);
    let width = 1.0 / (full.interval * longest as f64);
    let time: Vec<f64> = (0..full.residual.len()).map(|k| k as f64 * full.interval).collect();
    strongest(&time, &full.residual, &full.used, (1.0 / line.period, 0.5 * width), 0.25 / span)
}

/// Square of the residual that a line along a coordinate removes.
fn over_space(full: &FullRate, coordinate: &Coordinate, line: &Line) -> f64 {
    let x = &coordinate.values;
    let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    let seen = parity(coordinate, &full.residual, &vec![1.0; full.residual.len()]);
    let width = 1.0 / (high - low).max(f64::MIN_POSITIVE);
    strongest(x, &seen, &full.used, (1.0 / line.period, 0.5 * width), 0.25 * width)
}

/// Largest square that a sine of a frequency around `at.0`, not farther than `at.1`, removes.
fn strongest(x: &[f64], values: &[f64], used: &[bool], at: (f64, f64), step: f64) -> f64 {
    let steps = ((at.1 / step).ceil() as i32).clamp(1, 20);
    let count = used.iter().filter(|used| **used).count().max(1) as f64;
    (-steps..=steps)
        .map(|k| {
            let frequency = at.0 + at.1 * f64::from(k) / f64::from(steps);
            let (mut cosine, mut sine) = (0.0, 0.0);
            for ((x, value), _) in x.iter().zip(values).zip(used).filter(|(_, used)| **used) {
                let (s, c) = (TAU * frequency * x).sin_cos();
                cosine += c * value;
                sine += s * value;
            }
            2.0 * (cosine * cosine + sine * sine) / count
        })
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
