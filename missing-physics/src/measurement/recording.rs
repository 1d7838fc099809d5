//! A measurement: time, named channels in SI units, and the segments that belong together.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// How the input acts between two samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hold {
    /// The recorded input is the instantaneous value at the sample: the signal is continuous.
    #[default]
    Sampled,
    /// The recorded input is a command that is held until the next sample.
    ZeroOrder,
}

impl Hold {
    /// Mean of an input from one sample to another one, by what it does between samples; its value where both are the same.
    pub fn mean(self, time: &[f64], input: &[f64], from: usize, to: usize) -> f64 {
        let acts = |k: usize| match self {
            Self::Sampled => 0.5 * (input[k] + input[k + 1]),
            Self::ZeroOrder => input[k],
        };
        let impulse: f64 = (from..to).map(|k| acts(k) * (time[k + 1] - time[k])).sum();
        if to > from { impulse / (time[to] - time[from]) } else { input[from] }
    }
}

/// One measured quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// What it is, e.g. `position`.
    pub name: String,
    /// SI unit, e.g. `m`.
    pub unit: String,
    /// One value per sample.
    pub values: Vec<f64>,
}

impl Channel {
    /// A channel called `name` in `unit`.
    pub fn new(name: impl Into<String>, unit: impl Into<String>, values: Vec<f64>) -> Self {
        Self { name: name.into(), unit: unit.into(), values }
    }
}

/// Why values do not make a recording. `index` counts samples from 0; readers of files add the line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// Fewer samples than anything can be learned from.
    #[error("the recording has {samples} samples; at least {needed} are needed")]
    TooShort {
        /// Samples there are.
        samples: usize,
        /// Samples needed.
        needed: usize,
    },
    /// A channel has more or fewer values than there are times.
    #[error("channel '{channel}' has {values} values, but there are {samples} times")]
    Length {
        /// Channel name.
        channel: String,
        /// Values in the channel.
        values: usize,
        /// Number of times.
        samples: usize,
    },
    /// A value is NaN or infinite.
    #[error("'{channel}' is {value} at sample {index}")]
    NotFinite {
        /// Channel name, or `time`.
        channel: String,
        /// Sample, from 0.
        index: usize,
        /// The offending value.
        value: f64,
    },
    /// Time stands still or runs backwards inside a segment.
    #[error("time goes from {before} s to {after} s at sample {index}: it must increase")]
    TimeNotIncreasing {
        /// Sample, from 0.
        index: usize,
        /// Time of the sample before, s.
        before: f64,
        /// Time of this sample, s.
        after: f64,
    },
    /// A channel that the analysis needs is not there.
    #[error("the recording has no channel '{channel}'; it has: {present}")]
    MissingChannel {
        /// The channel wanted.
        channel: String,
        /// The channels there are, comma-separated.
        present: String,
    },
}

/// Fewest samples of a recording.
pub const MIN_SAMPLES: usize = 16;

/// A checked measurement. Invariants: all values finite, every channel as long as `time`, time
/// strictly increasing inside every segment, segments contiguous, in order and non-empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    name: String,
    time: Vec<f64>,
    channels: Vec<Channel>,
    segments: Vec<Range<usize>>,
    /// Median step inside segments, s.
    interval: f64,
    /// Nothing where nobody stated it.
    hold: Option<Hold>,
    /// Samples of the recording that this one is a part of.
    taken_from: Option<usize>,
}

impl Recording {
    /// One segment of `time` (s) with its channels.
    ///
    /// # Errors
    /// The first [`RecordingError`] found, in order of channels and samples.
    pub fn new(
        name: impl Into<String>,
        time: Vec<f64>,
        channels: Vec<Channel>,
    ) -> Result<Self, RecordingError> {
        let samples = time.len();
        Self::with_segments(name, time, channels, vec![0; samples])
    }

    /// Like [`Recording::new`]; `segment[k]` numbers the piece that sample `k` belongs to. A new
    /// piece starts wherever the number changes; time may jump there.
    ///
    /// # Errors
    /// The first [`RecordingError`] found.
    #[expect(clippy::needless_pass_by_value, reason = "the column of a file is handed over")]
    pub fn with_segments(
        name: impl Into<String>,
        time: Vec<f64>,
        channels: Vec<Channel>,
        segment: Vec<i64>,
    ) -> Result<Self, RecordingError> {
        let samples = time.len();
        if samples < MIN_SAMPLES {
            return Err(RecordingError::TooShort { samples, needed: MIN_SAMPLES });
        }
        check_finite("time", &time)?;
        for channel in &channels {
            check_length(&channel.name, channel.values.len(), samples)?;
            check_finite(&channel.name, &channel.values)?;
        }
        check_length("segment", segment.len(), samples)?;
        let segments: Vec<Range<usize>> = split(&segment);
        for range in &segments {
            check_increasing(&time, range)?;
        }
        let interval = interval(&time, &segments);
        Ok(Self {
            name: name.into(),
            time,
            channels,
            segments,
            interval,
            hold: None,
            taken_from: None,
        })
    }

    /// Says how the input acts between samples.
    #[must_use]
    pub fn with_hold(mut self, hold: Hold) -> Self {
        self.hold = Some(hold);
        self
    }

    /// The same at other instants, s.
    ///
    /// # Errors
    /// They are not as many, not finite somewhere, or do not increase inside a segment.
    pub fn with_time(self, time: Vec<f64>) -> Result<Self, RecordingError> {
        check_length("time", time.len(), self.len())?;
        check_finite("time", &time)?;
        for range in &self.segments {
            check_increasing(&time, range)?;
        }
        Ok(Self { interval: interval(&time, &self.segments), time, ..self })
    }

    /// The same with other channels.
    ///
    /// # Errors
    /// One is of another length or not finite somewhere.
    pub fn with_channels(self, channels: Vec<Channel>) -> Result<Self, RecordingError> {
        for channel in &channels {
            check_length(&channel.name, channel.values.len(), self.len())?;
            check_finite(&channel.name, &channel.values)?;
        }
        Ok(Self { channels, ..self })
    }

    /// These parts of it, in order, each a segment of its own.
    ///
    /// # Errors
    /// They have too few samples together.
    pub(super) fn of_parts(&self, parts: &[Range<usize>]) -> Result<Self, RecordingError> {
        let picked = |values: &[f64]| -> Vec<f64> {
            parts.iter().flat_map(|part| values[part.clone()].iter().copied()).collect()
        };
        let channels = self.channels.iter();
        let channels =
            channels.map(|c| Channel::new(c.name.clone(), c.unit.clone(), picked(&c.values)));
        let segment = (0i64..).zip(parts).flat_map(|(k, part)| std::iter::repeat_n(k, part.len()));
        let (time, segment) = (picked(&self.time), segment.collect());
        let part = Self::with_segments(self.name.clone(), time, channels.collect(), segment)?;
        Ok(Self { taken_from: Some(self.len()), ..part.with_hold_of(self) })
    }

    /// The same with the number of samples that `other` was taken from.
    #[must_use]
    pub(super) fn taken_like(self, other: &Self) -> Self {
        Self { taken_from: other.taken_from, ..self }
    }

    /// Number of samples of the recording that this one is pieces of; nothing where it is all there is.
    pub fn taken_from(&self) -> Option<usize> {
        self.taken_from
    }

    /// Where it comes from, e.g. the file's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Never: a recording has at least [`MIN_SAMPLES`] samples.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Times, s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// All channels.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Index ranges of the contiguous pieces.
    pub fn segments(&self) -> &[Range<usize>] {
        &self.segments
    }

    /// How the input acts between samples.
    pub fn hold(&self) -> Hold {
        self.hold.unwrap_or_default()
    }

    /// How the input acts between samples, where that was stated.
    pub fn known_hold(&self) -> Option<Hold> {
        self.hold
    }

    /// The same with what `other` states about its input.
    #[must_use]
    pub fn with_hold_of(mut self, other: &Self) -> Self {
        self.hold = other.hold;
        self
    }

    /// The channel called `name`, if there is one.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.name == name)
    }

    /// The values of the channel called `name`.
    ///
    /// # Errors
    /// [`RecordingError::MissingChannel`] with the names that there are.
    pub fn require(&self, name: &str) -> Result<&[f64], RecordingError> {
        self.channel(name).map(|channel| channel.values.as_slice()).ok_or_else(|| {
            let present: Vec<&str> = self.channels.iter().map(|c| c.name.as_str()).collect();
            RecordingError::MissingChannel { channel: name.to_owned(), present: present.join(", ") }
        })
    }

    /// Median sampling interval inside segments, s.
    pub fn interval(&self) -> f64 {
        self.interval
    }
}

/// The median step inside segments; 0 where there is none.
fn interval(time: &[f64], segments: &[Range<usize>]) -> f64 {
    let steps = segments.iter().flat_map(|range| time[range.clone()].windows(2));
    let mut steps: Vec<f64> = steps.map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn check_length(channel: &str, values: usize, samples: usize) -> Result<(), RecordingError> {
    if values == samples {
        return Ok(());
    }
    Err(RecordingError::Length { channel: channel.to_owned(), values, samples })
}

fn check_finite(channel: &str, values: &[f64]) -> Result<(), RecordingError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => Err(RecordingError::NotFinite {
            channel: channel.to_owned(),
            index,
            value: values[index],
        }),
    }
}

fn check_increasing(time: &[f64], range: &Range<usize>) -> Result<(), RecordingError> {
    for index in range.start + 1..range.end {
        let (before, after) = (time[index - 1], time[index]);
        if after <= before {
            return Err(RecordingError::TimeNotIncreasing { index, before, after });
        }
    }
    Ok(())
}

fn split(segment: &[i64]) -> Vec<Range<usize>> {
    let mut ranges = Vec::new();
    let mut start = 0;
    for index in 1..=segment.len() {
        if index == segment.len() || segment[index] != segment[start] {
            ranges.push(start..index);
            start = index;
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(samples: usize) -> Vec<f64> {
        (0..samples).map(|k| k as f64 * 0.001).collect()
    }

    #[test]
    fn time_that_runs_backwards_names_the_sample() {
        let mut time = times(20);
        time[7] = 0.0;
        let error = Recording::new("r", time, vec![]).unwrap_err();
        assert!(matches!(error, RecordingError::TimeNotIncreasing { index: 7, .. }));
    }

    #[test]
    fn time_may_jump_back_between_segments() {
        let mut time = times(20);
        time.extend(times(20));
        let segment = (0..40).map(|k| i64::from(k >= 20)).collect();
        let recording = Recording::with_segments("r", time, vec![], segment).unwrap();
        assert_eq!(recording.segments(), &[0..20, 20..40]);
        assert!((recording.interval() - 0.001).abs() < 1e-12);
    }

    #[test]
    fn a_nan_names_channel_and_sample() {
        let mut values = vec![0.0; 20];
        values[3] = f64::NAN;
        let error =
            Recording::new("r", times(20), vec![Channel::new("force", "N", values)]).unwrap_err();
        assert!(
            matches!(&error, RecordingError::NotFinite { channel, index: 3, .. } if channel == "force")
        );
    }
}
