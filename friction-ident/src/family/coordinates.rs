//! What a drive's residual may depend on, and the repeats of its motion.

use std::ops::Range;

use missing_physics::{Coordinate, Recording};

use super::preparation::Prepared;
use crate::axis::{Axis, Effort, Quantity};

/// Two stretches of motion repeat each other where they differ by less than this share of the
/// motion's standard deviation.
const REPEATS: f64 = 0.02;

/// The coordinates of the comparison grid.
pub fn coordinates(
    p: &Prepared,
    (axis, effort): (Axis, Effort),
    recording: &Recording,
) -> Vec<Coordinate> {
    let unit = |quantity| effort.unit(axis, quantity).to_owned();
    let direction = direction(p);
    let since = p.sample(&since_reversal(p));
    let position = p.sample(&p.position);
    let velocity = p.sample(&p.velocity);
    let acceleration = p.sample(&p.acceleration);
    let force_rate = p.sample(&slope(&p.force, p.interval));
    let time = p.sample(&p.time);
    let load = p.sample(&p.force).iter().map(|f| f.abs()).collect();
    let speed = velocity.iter().map(|v| v.abs()).collect();
    let entry = |name: &str, quantity, values: Vec<f64>, opposes: bool, state| Coordinate {
        name: name.to_owned(),
        unit: unit(quantity),
        values,
        parity: opposes.then(|| direction.clone()),
        state,
    };
    let mut all = vec![
        entry("velocity", Quantity::Velocity, velocity, false, true),
        entry("speed", Quantity::Velocity, speed, true, false),
        entry("position", Quantity::Length, position.clone(), false, true),
        entry("position (against motion)", Quantity::Length, position, true, false),
        Coordinate {
            name: "acceleration".to_owned(),
            unit: format!("{}/s", unit(Quantity::Velocity)),
            values: acceleration,
            parity: None,
            state: true,
        },
        entry("distance since reversal", Quantity::Length, since, true, true),
        entry("load", Quantity::Force, load, true, false),
        Coordinate {
            name: "rate of force".to_owned(),
            unit: format!("{}/s", unit(Quantity::Force)),
            values: force_rate,
            parity: None,
            state: false,
        },
        entry("time", Quantity::Time, time.clone(), false, false),
        entry("time (against motion)", Quantity::Time, time, true, false),
    ];
    // Only where the recording is already uniform do its samples and the grid's correspond.
    if let Some(channel) = recording.channel("temperature")
        && recording.len() == p.time.len()
    {
        all.push(Coordinate {
            name: "temperature".to_owned(),
            unit: channel.unit.clone(),
            values: p.sample(&channel.values),
            parity: Some(direction.clone()),
            state: false,
        });
    }
    all
}

/// Direction of motion on the grid.
fn direction(p: &Prepared) -> Vec<f64> {
    p.sample(&p.velocity.iter().map(|v| v.signum()).collect::<Vec<_>>())
}

/// Velocity and its sign: what makes two instants the same experiment.
pub fn motion(p: &Prepared) -> Vec<Vec<f64>> {
    vec![p.sample(&p.velocity), direction(p)]
}

/// Distance travelled since the direction last changed, sample by sample.
pub(super) fn since_reversal(p: &Prepared) -> Vec<f64> {
    let mut since = vec![0.0; p.position.len()];
    for range in &p.segments {
        let (mut from, mut sign) = (p.position[range.start], 0.0);
        for k in range.clone() {
            let now = if p.moving[k] > 0.0 { p.velocity[k].signum() } else { sign };
            if now != sign {
                (from, sign) = (p.position[k], now);
            }
            since[k] = (p.position[k] - from).abs();
        }
    }
    since
}

fn slope(values: &[f64], interval: f64) -> Vec<f64> {
    (0..values.len())
        .map(|k| {
            let (before, after) = (k.saturating_sub(2), (k + 2).min(values.len() - 1));
            (values[after] - values[before]) / ((after - before).max(1) as f64 * interval)
        })
        .collect()
}

/// The cycles of a motion that repeats itself at least three times, as ranges of the grid; empty
/// for any other.
pub fn cycles(p: &Prepared) -> Vec<Range<usize>> {
    let [range] = p.segments.as_slice() else { return Vec::new() };
    let x = &p.position[range.clone()];
    let Some(period) = period(x) else { return Vec::new() };
    // The last cycle may be cut short; less than half of one belongs to its predecessor.
    let count = (x.len() + period / 2) / period;
    let at = |sample: usize| p.grid.partition_point(|&k| k < range.start + sample);
    (0..count)
        .map(|c| at(c * period)..if c + 1 == count { p.grid.len() } else { at((c + 1) * period) })
        .collect()
}

/// The period of a motion that repeats itself at least three times, in samples.
fn period(x: &[f64]) -> Option<usize> {
    let n = x.len();
    let mean = x.iter().sum::<f64>() / n as f64;
    let deviation = (x.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n as f64).sqrt();
    let difference = |lag: usize, step: usize| {
        let pairs = (0..n - lag).step_by(step);
        let count = pairs.len() as f64;
        (pairs.map(|k| (x[k + lag] - x[k]).powi(2)).sum::<f64>() / count).sqrt() / deviation
    };
    let (coarse, step) = ((n / 2000).max(1), (n / 1000).max(1));
    let candidates: Vec<usize> = (n / 40..n / 3).step_by(coarse).collect();
    // A lag near a period, then the best lag around it.
    let near = candidates.into_iter().find(|&lag| difference(lag, step) < 2.0 * REPEATS)?;
    let around = near..(near + 20 * coarse).min(n / 2);
    let best = around.min_by(|&a, &b| difference(a, step).total_cmp(&difference(b, step)))?;
    (difference(best, 1) < REPEATS).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_of_four_cycles_has_their_period() {
        let x: Vec<f64> = (0..24_841)
            .map(|k| {
                let phase = std::f64::consts::TAU * f64::from(k) / 6240.0;
                phase.sin() + 0.3 * (3.0 * phase + 1.0).cos()
            })
            .collect();
        assert!(period(&x).unwrap().abs_diff(6240) < 3);
    }

    #[test]
    fn a_motion_without_repeats_has_no_period() {
        let x: Vec<f64> = (0..9000).map(|k| (1e-6 * f64::from(k) * f64::from(k)).sin()).collect();
        assert_eq!(period(&x), None);
    }
}
