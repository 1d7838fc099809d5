//! A part of a recording: between two times, every so many samples.

use missing_physics::{Channel, Recording, RecordingError};

/// Which samples are used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Part {
    /// First time, s, as it stands in the recording.
    pub from: Option<f64>,
    /// Last time, s.
    pub to: Option<f64>,
    /// Every how many samples one is used; the others are skipped, not averaged.
    pub every: Option<usize>,
}

impl Part {
    /// Whether it is all of a recording.
    pub fn is_all(&self) -> bool {
        self.from.is_none() && self.to.is_none() && self.every.unwrap_or(1) <= 1
    }
}

/// That part of a recording. Pieces stay pieces; those of which fewer than two samples are left are left out.
///
/// # Errors
/// Too little is left.
pub fn part(recording: &Recording, part: &Part) -> Result<Recording, RecordingError> {
    let (from, to) = (part.from.unwrap_or(f64::NEG_INFINITY), part.to.unwrap_or(f64::INFINITY));
    let every = part.every.unwrap_or(1).max(1);
    let (mut kept, mut segment) = (Vec::new(), Vec::new());
    for (number, piece) in (0..).zip(recording.segments()) {
        let within = piece.clone().filter(|k| (from..=to).contains(&recording.time()[*k]));
        let samples: Vec<usize> = within.step_by(every).collect();
        if samples.len() > 1 {
            segment.extend(std::iter::repeat_n(number, samples.len()));
            kept.extend(samples);
        }
    }
    let pick = |values: &[f64]| -> Vec<f64> { kept.iter().map(|k| values[*k]).collect() };
    let channels = recording.channels().iter();
    let channels = channels.map(|c| Channel::new(&c.name, &c.unit, pick(&c.values))).collect();
    let left =
        Recording::with_segments(recording.name(), pick(recording.time()), channels, segment)?;
    Ok(left.with_hold_of(recording))
}

#[cfg(test)]
mod tests {
    use missing_physics::Hold;

    use super::*;

    fn recording() -> Recording {
        let time: Vec<f64> = (0..100).map(|k| 0.01 * f64::from(k)).collect();
        let channels = vec![Channel::new("force", "N", time.clone())];
        let segment = (0..100).map(|k| i64::from(k >= 60)).collect();
        let made = Recording::with_segments("run", time, channels, segment).unwrap();
        made.with_hold(Hold::ZeroOrder)
    }

    #[test]
    fn times_are_those_of_the_file_and_pieces_stay() {
        let window = Part { from: Some(0.5), to: Some(0.9), every: Some(2) };
        let left = part(&recording(), &window).unwrap();
        assert_eq!(left.segments().len(), 2);
        assert_eq!((left.time()[0], left.len()), (0.5, 5 + 16));
        assert!((left.interval() - 0.02).abs() < 1e-12);
        assert_eq!(left.channel("force").unwrap().values, left.time());
        assert_eq!(left.known_hold(), Some(Hold::ZeroOrder));
        assert_eq!(part(&recording(), &Part::default()).unwrap(), recording());
    }

    #[test]
    fn nothing_left_is_too_short() {
        let window = Part { from: Some(7.0), ..Part::default() };
        assert!(matches!(part(&recording(), &window), Err(RecordingError::TooShort { .. })));
    }
}
