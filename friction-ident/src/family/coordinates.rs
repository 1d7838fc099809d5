//! What a drive's residual may depend on, and the repeats of its motion.

use std::ops::Range;

use missing_physics::measurement::period::period;
use missing_physics::{Coordinate, Recording};

use super::preparation::Prepared;
use crate::axis::{Axis, Effort, Quantity};

/// Fewest blocks that cycles are made into, and most: shorter ones are too much alike their neighbours.
const BLOCKS: (usize, usize) = (3, 40);

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

/// The cycles of a motion that repeats itself at least three times, as ranges of the grid, several in one where there
/// are more than 40; empty for any other.
pub fn cycles(p: &Prepared) -> Vec<Range<usize>> {
    let [range] = p.segments.as_slice() else { return Vec::new() };
    let at = |sample: usize| p.grid.partition_point(|&k| k < range.start + sample);
    let mut starts = starts(&p.position[range.clone()]);
    starts.push(range.len());
    starts.windows(2).map(|block| at(block[0])..at(block[1])).collect()
}

/// The samples at which the blocks of a motion begin.
fn starts(x: &[f64]) -> Vec<usize> {
    let Some(period) = period(x) else { return Vec::new() };
    let cycles = x.len() as f64 / period;
    let block = period * (cycles / BLOCKS.1 as f64).ceil();
    if (BLOCKS.0 as f64) * block > x.len() as f64 {
        return Vec::new();
    }
    // The last one may be cut short; less than half of one belongs to its predecessor.
    let count = (x.len() as f64 / block).round() as usize;
    (0..count).map(|k| (k as f64 * block).round() as usize).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sines(samples: u32, period: f64) -> Vec<f64> {
        let phase = |k: u32| std::f64::consts::TAU * f64::from(k) / period;
        (0..samples).map(|k| phase(k).sin() + 0.3 * (3.0 * phase(k) + 1.0).cos()).collect()
    }

    #[test]
    fn blocks_are_cycles_and_where_there_are_many_several_of_them() {
        assert_eq!(starts(&sines(24_841, 6240.0)), [0, 6240, 12_480, 18_720]);
        let of_many = starts(&sines(20_000, 200.0));
        assert_eq!((of_many.len(), of_many[1]), (33, 600));
    }

    #[test]
    fn two_cycles_and_no_cycle_make_no_blocks() {
        assert_eq!(starts(&sines(500, 200.0)), [0; 0]);
        let rising: Vec<f64> = (0..9000).map(|k| (1e-6 * f64::from(k * k)).sin()).collect();
        assert_eq!(starts(&rising), [0; 0]);
    }
}
