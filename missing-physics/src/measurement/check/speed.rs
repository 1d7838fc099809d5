//! How the axis moves, estimated from its position.

use serde::{Deserialize, Serialize};

use super::{ChannelCheck, Finding};
use crate::measurement::Recording;

/// Below this share of the top speed the motion counts as slow, and a change of sign as noise.
const SLOW: f64 = 0.02;
/// Fewer changes of direction than this are few.
const FEW: usize = 4;
/// One count a sample is coarse from this share of the top speed on.
const COARSE: f64 = 0.2;
/// Faster no axis moves: linear motors reach 10 m/s, spindles 6000 rad/s. A wrong unit makes a factor of 57 or more.
const FASTEST: f64 = 30.0;
const FASTEST_TURN: f64 = 2e4;

/// How the axis moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Speed {
    /// Speed that is exceeded in 1 % of the samples, SI.
    pub top: f64,
    /// Share of the samples below 2 % of it, rest included.
    pub slow_share: f64,
    /// Share of the samples that move forward.
    pub forward_share: f64,
    /// Share of the samples that move backward.
    pub backward_share: f64,
    /// Changes of direction.
    pub reversals: usize,
    /// Unit of the speed.
    pub unit: String,
}

impl Speed {
    /// From central differences, wide enough that the counts do not hide the motion.
    pub(super) fn of(recording: &Recording, quantum: Option<f64>) -> Option<Self> {
        let position = recording.channel("position")?;
        let half = half_width(recording, &position.values, quantum);
        let mut speeds = Vec::with_capacity(recording.len());
        let mut reversals = 0;
        let rough_top = top(&differences(recording, &position.values, half).concat());
        for segment in differences(recording, &position.values, half) {
            reversals += changes_of_direction(&segment, SLOW * rough_top);
            speeds.extend(segment);
        }
        let share = |wanted: &dyn Fn(f64) -> bool| {
            speeds.iter().filter(|speed| wanted(**speed)).count() as f64
                / speeds.len().max(1) as f64
        };
        let slow = SLOW * rough_top;
        Some(Self {
            top: rough_top,
            slow_share: share(&|speed| speed.abs() <= slow),
            forward_share: share(&|speed| speed > slow),
            backward_share: share(&|speed| speed < -slow),
            reversals,
            unit: format!("{}/s", position.unit),
        })
    }

    pub(super) fn findings(
        &self,
        position: &ChannelCheck,
        interval: f64,
        findings: &mut Vec<Finding>,
    ) {
        if self.top == 0.0 {
            return;
        }
        if self.forward_share == 0.0 || self.backward_share == 0.0 {
            findings.push(Finding::OneDirection);
        } else if self.reversals < FEW {
            findings.push(Finding::FewReversals { reversals: self.reversals });
        }
        let (top, unit) = (self.top, self.unit.clone());
        if top > if position.unit == "rad" { FASTEST_TURN } else { FASTEST } {
            findings.push(Finding::Fast { top, unit: unit.clone() });
        }
        if let Some(count) = position.quantum {
            let step = count / interval;
            findings.push(Finding::Counts {
                count,
                unit: position.unit.clone(),
                step,
                top,
                speed_unit: unit.clone(),
                coarse: step > COARSE * top,
            });
        }
        let (slow, slow_share, reversals) = (SLOW * top, self.slow_share, self.reversals);
        findings.push(Finding::Speeds { top, slow, unit, slow_share, reversals });
    }
}

/// Half the width of a difference in samples: at least two, and so many that at half the typical
/// speed twenty counts are passed.
fn half_width(recording: &Recording, position: &[f64], quantum: Option<f64>) -> usize {
    let longest = recording.segments().iter().map(ExactSizeIterator::len).max().unwrap_or(0);
    let path: f64 = position.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    let per_sample = path / position.len().max(1) as f64;
    let wanted = quantum.map_or(2.0, |quantum| 20.0 * quantum / per_sample.max(1e-300));
    (wanted as usize).clamp(2, (longest / 50).max(2))
}

fn differences(recording: &Recording, position: &[f64], half: usize) -> Vec<Vec<f64>> {
    let time = recording.time();
    let at =
        |k: usize| (position[k + half] - position[k - half]) / (time[k + half] - time[k - half]);
    let segments = recording.segments().iter();
    segments.map(|s| (s.start + half..s.end.saturating_sub(half)).map(at).collect()).collect()
}

fn top(speeds: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = speeds.iter().map(|speed| speed.abs()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let index = (sizes.len() - 1) * 99 / 100;
    *sizes.select_nth_unstable_by(index, f64::total_cmp).1
}

fn changes_of_direction(speeds: &[f64], slow: f64) -> usize {
    let moving = speeds.iter().filter(|speed| speed.abs() > slow).map(|speed| *speed > 0.0);
    let mut directions: Vec<bool> = moving.collect();
    directions.dedup();
    directions.len().saturating_sub(1)
}
