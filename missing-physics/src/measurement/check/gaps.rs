//! Gaps: holes in the samples that nothing may be interpolated over.

use crate::measurement::{Recording, RecordingError};

/// Up to this many intervals a hole is bridged; a longer one ends the segment.
pub(super) const BRIDGED: f64 = 10.0;

/// The recording with a segment ending at every long gap, so that nothing is made up inside it.
///
/// # Errors
/// None for a checked recording.
pub fn cut_at_gaps(recording: &Recording) -> Result<Recording, RecordingError> {
    let (time, longest) = (recording.time(), BRIDGED * recording.interval());
    let mut segment = vec![0; recording.len()];
    let mut number = 0;
    for range in recording.segments() {
        number += 1;
        segment[range.start] = number;
        for sample in range.start + 1..range.end {
            number += i64::from(time[sample] - time[sample - 1] > longest);
            segment[sample] = number;
        }
    }
    let channels = recording.channels().to_vec();
    let cut = Recording::with_segments(recording.name(), time.to_vec(), channels, segment)?;
    Ok(cut.with_hold_of(recording).taken_like(recording))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_gaps_end_a_segment_and_short_ones_do_not() {
        let gap = |k: u32| f64::from(u8::from(k > 30)) * 4e-3 + f64::from(u8::from(k > 60)) * 1e6;
        let time: Vec<f64> = (0..100).map(|k| f64::from(k) * 1e-3 + gap(k)).collect();
        let recording = Recording::with_segments(
            "gaps",
            time,
            vec![],
            (0..100).map(|k| i64::from(k >= 80)).collect(),
        );
        let cut = cut_at_gaps(&recording.unwrap()).unwrap();
        assert_eq!(cut.segments(), &[0..61, 61..80, 80..100]);
    }
}
