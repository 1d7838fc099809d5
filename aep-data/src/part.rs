//! A part of a recording: between two times, every so many samples.

use missing_physics::{Channel, Hold, Recording, RecordingError};

/// What acts between samples.
const INPUT: &str = "force";

/// Which samples are used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Part {
    /// First time, s, as it stands in the recording.
    pub from: Option<f64>,
    /// Last time, s.
    pub to: Option<f64>,
    /// Every how many samples one is used: of the force its mean until the next one that is, as the plant heeds all of it; the
    /// others are skipped.
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
    let (mut kept, mut segment, mut until) = (Vec::new(), Vec::new(), Vec::new());
    for (number, piece) in (0..).zip(recording.segments()) {
        let within = piece.clone().filter(|k| (from..=to).contains(&recording.time()[*k]));
        let last = within.clone().next_back();
        let samples: Vec<usize> = within.step_by(every).collect();
        if samples.len() > 1 {
            segment.extend(std::iter::repeat_n(number, samples.len()));
            until.extend(samples[1..].iter().copied().chain(last));
            kept.extend(samples);
        }
    }
    let pick = |values: &[f64]| -> Vec<f64> { kept.iter().map(|k| values[*k]).collect() };
    // A force of which nobody said what it does between samples is most often a command.
    let hold = recording.known_hold().unwrap_or(Hold::ZeroOrder);
    let channels = recording.channels().iter().map(|c| {
        let values = if every > 1 && c.name == INPUT {
            let until = kept.iter().zip(&until);
            until.map(|(k, next)| hold.mean(recording.time(), &c.values, *k, *next)).collect()
        } else {
            pick(&c.values)
        };
        Channel::new(&c.name, &c.unit, values)
    });
    let channels = channels.collect();
    let left =
        Recording::with_segments(recording.name(), pick(recording.time()), channels, segment)?;
    // A mean is what is held instead.
    Ok(if every > 1 && hold == Hold::Sampled {
        left.with_hold(Hold::ZeroOrder)
    } else {
        left.with_hold_of(recording)
    })
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
        // The force rises with time and was held from each sample to the next.
        let means = left.time().iter().map(|t| t + 0.005);
        let close = |(force, mean): (&f64, f64)| (force - mean).abs() < 1e-12;
        let force = &left.channel("force").unwrap().values;
        assert!(force.iter().zip(means).take(4).all(close), "{force:?}");
        // No sample follows the last one of a piece.
        assert_eq!((force[4], force[20]), (0.58, 0.9));
        assert_eq!(left.known_hold(), Some(Hold::ZeroOrder));
        assert_eq!(part(&recording(), &Part::default()).unwrap(), recording());
    }

    #[test]
    fn of_a_force_that_was_sampled_the_mean_is_held() {
        let every = Part { every: Some(4), ..Part::default() };
        let left = part(&recording().with_hold(Hold::Sampled), &every).unwrap();
        let force = &left.channel("force").unwrap().values;
        assert!((force[1] - 0.06).abs() < 1e-12, "{force:?}");
        assert_eq!(left.known_hold(), Some(Hold::ZeroOrder));
    }

    #[test]
    fn nothing_left_is_too_short() {
        let window = Part { from: Some(7.0), ..Part::default() };
        assert!(matches!(part(&recording(), &window), Err(RecordingError::TooShort { .. })));
    }
}
