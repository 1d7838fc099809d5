//! Pieces spread over a long recording, which stand for all of it.

use std::ops::Range;

use super::check::cut_at_gaps;
use super::recording::{Recording, RecordingError};

/// Samples of a recording that are looked at; of a longer one pieces spread over it that have so many together.
pub const MOST_LOOKED_AT: usize = 200_000;
/// Pieces that a long recording is cut into.
const PIECES: usize = 50;
/// Fractional part of the golden ratio: steps of it never fall in step with a cycle.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// What is looked at of a recording: all of it, or pieces of a very long one, cut where too much is missing to know the
/// motion.
///
/// # Errors
/// Too little is left.
pub fn looked_at(recording: &Recording) -> Result<Recording, RecordingError> {
    match in_pieces(recording, MOST_LOOKED_AT)? {
        Some(part) => cut_at_gaps(&part),
        None => cut_at_gaps(recording),
    }
}

/// About `most` samples of a recording in pieces spread over it; nothing where it has no more.
///
/// # Errors
/// Too little is left.
pub fn in_pieces(recording: &Recording, most: usize) -> Result<Option<Recording>, RecordingError> {
    if recording.len() <= most + most / 4 {
        return Ok(None);
    }
    let share = most as f64 / recording.len() as f64;
    let length = |segment: &Range<usize>| segment.len().min(most / PIECES);
    recording.of_parts(&spread(recording.segments(), share, length)).map(Some)
}

/// Pieces of these segments, each of about `length` samples (at least one), that have about a `share` of all samples and
/// are spread over them. What is left of a segment is a piece where it has more than half of that.
pub fn spread(
    segments: &[Range<usize>],
    share: f64,
    length: impl Fn(&Range<usize>) -> usize,
) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let mut number = 0.0f64;
    for segment in segments {
        let length = length(segment);
        let mut start = segment.start;
        while start < segment.end {
            let end = (start + length).min(segment.end);
            number += 1.0;
            if (number * GOLDEN).fract() < share && end - start > length / 2 {
                parts.push(start..end);
            }
            start = end;
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measurement::{Channel, Hold};

    fn recording(samples: usize) -> Recording {
        let time: Vec<f64> = (0..samples).map(|k| k as f64 * 1e-3).collect();
        let values = time.iter().map(|t| 2.0 * t).collect();
        let channels = vec![Channel::new("position", "m", values)];
        Recording::new("long", time, channels).unwrap().with_hold(Hold::ZeroOrder)
    }

    #[test]
    fn a_long_recording_is_looked_at_in_pieces_from_all_over_it() {
        let all = recording(100_000);
        let part = in_pieces(&all, 10_000).unwrap().unwrap();
        assert!((9_000..=11_000).contains(&part.len()), "{}", part.len());
        assert_eq!((part.taken_from(), part.hold()), (Some(100_000), Hold::ZeroOrder));
        // Every value stands beside its own time, and no stretch of a fifth of the recording is without a piece.
        let position = part.require("position").unwrap();
        assert!(part.time().iter().zip(position).all(|(t, x)| *x == 2.0 * t));
        let begins: Vec<f64> = part.segments().iter().map(|s| part.time()[s.start]).collect();
        for fifth in 0..5 {
            let stretch = 20.0 * f64::from(fifth)..20.0 * f64::from(fifth + 1);
            assert!(begins.iter().any(|begin| stretch.contains(begin)), "{fifth}: {begins:?}");
        }
        assert_eq!(cut_at_gaps(&part).unwrap().taken_from(), Some(100_000));
    }

    #[test]
    fn a_recording_that_is_hardly_longer_stays_as_it_is() {
        assert_eq!(in_pieces(&recording(12_000), 10_000).unwrap(), None);
        assert_eq!(looked_at(&recording(12_000)).unwrap(), recording(12_000));
    }

    #[test]
    fn of_many_short_segments_whole_ones_are_taken() {
        let segments: Vec<Range<usize>> = (0..1000).map(|k| 10 * k..10 * k + 10).collect();
        let parts = spread(&segments, 0.1, |segment| segment.len().min(500));
        assert!((80..=120).contains(&parts.len()), "{}", parts.len());
        assert!(parts.iter().all(|part| part.len() == 10));
    }
}
