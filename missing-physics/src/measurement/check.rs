//! What is to be known of a recording before any model: sampling, gaps, resolution, clipping, speeds,
//! repeated motion. Everything is estimated from the samples alone; the findings say what limits the
//! analysis.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::measurement::{Channel, Recording};

mod cycle;
mod finding;
mod gaps;
mod quantum;
mod sampling;
mod saturation;
mod speed;
mod work;

pub use cycle::Cycle;
pub use finding::{Finding, Severity};
pub use gaps::cut_at_gaps;
pub use sampling::{Gap, Sampling};
pub use saturation::Saturation;
pub use speed::Speed;

/// What one channel looks like.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChannelCheck {
    /// Name of the channel.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Root mean square.
    pub rms: f64,
    /// Size of one count, where the values are multiples of one.
    pub quantum: Option<f64>,
    /// Limits that the channel is held at.
    pub saturation: Vec<Saturation>,
}

impl ChannelCheck {
    /// Whether every value is the same.
    pub fn is_constant(&self) -> bool {
        self.min == self.max
    }
}

/// What is to be known of a recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DataCheck {
    /// Number of samples.
    pub samples: usize,
    /// Number of segments.
    pub segments: usize,
    /// When the samples were taken.
    pub sampling: Sampling,
    /// Every channel, in the recording's order.
    pub channels: Vec<ChannelCheck>,
    /// How the axis moves, where there is a position.
    pub speed: Option<Speed>,
    /// The motion that repeats, where one does.
    pub cycle: Option<Cycle>,
    /// What follows from all this, the worst first.
    pub findings: Vec<Finding>,
}

/// Looks at a recording.
pub fn check(recording: &Recording) -> DataCheck {
    let channels: Vec<ChannelCheck> = recording.channels().iter().map(channel).collect();
    let quantum = channels.iter().find(|c| c.name == "position").and_then(|c| c.quantum);
    let mut check = DataCheck {
        samples: recording.len(),
        segments: recording.segments().len(),
        sampling: Sampling::of(recording),
        channels,
        speed: Speed::of(recording, quantum),
        cycle: Cycle::of(recording),
        findings: Vec::new(),
    };
    check.findings = check.conclude(work::finding(recording));
    check
}

/// The size of one count of a channel; nothing where its values are continuous.
pub fn count_of(values: &[f64]) -> Option<f64> {
    quantum::of(values)
}

fn channel(channel: &Channel) -> ChannelCheck {
    let values = &channel.values;
    let squares: f64 = values.iter().map(|value| value * value).sum();
    // Rest at an end of the stroke is no clipping: only what the drive and the sensors limit.
    let limited = matches!(channel.name.as_str(), "force" | "velocity");
    let quantum = quantum::of(values);
    ChannelCheck {
        name: channel.name.clone(),
        unit: channel.unit.clone(),
        min: values.iter().copied().fold(f64::INFINITY, f64::min),
        max: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        rms: (squares / values.len().max(1) as f64).sqrt(),
        quantum,
        saturation: if limited { Saturation::of(values, quantum) } else { Vec::new() },
    }
}

impl DataCheck {
    /// What was found about the channel `name`.
    pub fn channel(&self, name: &str) -> Option<&ChannelCheck> {
        self.channels.iter().find(|channel| channel.name == name)
    }

    fn conclude(&self, work: Option<Finding>) -> Vec<Finding> {
        let mut findings: Vec<Finding> = work.into_iter().collect();
        self.sampling.findings(&mut findings);
        for channel in &self.channels {
            channel.findings(&mut findings);
        }
        let position = self.channel("position");
        if let (Some(speed), Some(position)) = (&self.speed, position) {
            speed.findings(position, self.sampling.interval_s, &mut findings);
        }
        if let Some(cycle) = &self.cycle {
            findings.push(cycle.finding());
        }
        findings.sort_by_key(|finding| std::cmp::Reverse(finding.severity()));
        findings
    }
}

impl ChannelCheck {
    fn findings(&self, findings: &mut Vec<Finding>) {
        let (channel, unit) = (&self.name, &self.unit);
        if self.is_constant() {
            return findings.push(Finding::Constant {
                channel: channel.clone(),
                value: self.max,
                unit: unit.clone(),
                needed: matches!(channel.as_str(), "force" | "position"),
            });
        }
        findings.extend(self.saturation.iter().map(|limit| Finding::Clipped {
            channel: channel.clone(),
            level: limit.level,
            unit: unit.clone(),
            share: limit.share,
        }));
    }
}

/// Indices of all pairs of neighbours inside segments.
fn neighbours(recording: &Recording) -> impl Iterator<Item = Range<usize>> {
    let segments = recording.segments().iter();
    segments.flat_map(|segment| (segment.start + 1..segment.end).map(|end| end - 1..end))
}

#[cfg(test)]
mod tests;
