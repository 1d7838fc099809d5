//! When the samples were taken.

use serde::{Deserialize, Serialize};

use super::gaps::BRIDGED;
use super::{Finding, neighbours};
use crate::measurement::Recording;

/// A step this many intervals long is a gap.
const GAP: f64 = 2.5;

/// A sampling interval longer than this is probably in another unit, s.
const SLOW: f64 = 0.05;

/// Intervals that vary by more than this share of the median are told.
const JITTER: f64 = 0.05;

/// A hole in the samples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gap {
    /// Time of the last sample before it, s.
    pub at_s: f64,
    /// From that sample to the next, s.
    pub length_s: f64,
}

/// When the samples were taken.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sampling {
    /// Length of all segments together, s.
    pub duration_s: f64,
    /// Median interval, s.
    pub interval_s: f64,
    /// Shortest interval, s.
    pub shortest_s: f64,
    /// Longest interval, s.
    pub longest_s: f64,
    /// Root mean square of the intervals' deviation from the median, gaps left out, as a fraction of it.
    pub jitter: f64,
    /// Holes, the longest first.
    pub gaps: Vec<Gap>,
}

impl Sampling {
    pub(super) fn of(recording: &Recording) -> Self {
        let time = recording.time();
        let steps: Vec<(f64, f64)> = neighbours(recording)
            .map(|pair| (time[pair.start], time[pair.end] - time[pair.start]))
            .collect();
        let interval = recording.interval();
        let (gaps, regular): (Vec<_>, Vec<_>) =
            steps.iter().copied().partition(|(_, step)| *step > GAP * interval);
        let mut gaps: Vec<Gap> =
            gaps.into_iter().map(|(at_s, length_s)| Gap { at_s, length_s }).collect();
        gaps.sort_by(|a, b| b.length_s.total_cmp(&a.length_s));
        let lengths = steps.iter().map(|(_, step)| *step);
        Self {
            duration_s: lengths.clone().sum(),
            interval_s: interval,
            shortest_s: lengths.clone().fold(f64::INFINITY, f64::min),
            longest_s: lengths.fold(0.0, f64::max),
            jitter: jitter(&regular, interval),
            gaps,
        }
    }

    pub(super) fn findings(&self, findings: &mut Vec<Finding>) {
        if let Some(longest) = self.gaps.first() {
            findings.push(Finding::Gaps {
                count: self.gaps.len(),
                longest: longest.clone(),
                ends_a_segment: longest.length_s > BRIDGED * self.interval_s,
            });
        }
        let interval_s = self.interval_s;
        if interval_s > SLOW {
            findings.push(Finding::SlowSampling { interval_s });
        }
        if self.jitter > JITTER {
            findings.push(Finding::Jitter { jitter: self.jitter, interval_s });
        }
    }
}

fn jitter(steps: &[(f64, f64)], interval: f64) -> f64 {
    if steps.is_empty() || interval == 0.0 {
        return 0.0;
    }
    let squares: f64 = steps.iter().map(|(_, step)| (step / interval - 1.0).powi(2)).sum();
    (squares / steps.len() as f64).sqrt()
}
