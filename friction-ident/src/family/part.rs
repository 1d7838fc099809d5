//! A long recording: on pieces spread over it the hold is decided, and the base model begins.

use missing_physics::Recording;
use missing_physics::measurement::in_pieces;

use super::{FrictionFamily, Options, PreparationError, hold};
use crate::effects::beside::MODEL_FORCE;

/// Samples of such pieces together.
const MOST: usize = 50_000;

impl FrictionFamily {
    /// The family of a short recording, or of a long one with that of its pieces.
    pub(super) fn of_any_length(
        recording: &Recording,
        options: &Options,
    ) -> Result<Self, PreparationError> {
        let Some(part) = in_pieces(recording, MOST)? else {
            return Self::as_read(recording, options);
        };
        // Pieces may move too little where all of it does not.
        let Ok(part) = Self::as_read(&part, options) else {
            return Self::as_read(recording, options);
        };
        part.extended(recording, options)
    }

    fn as_read(recording: &Recording, options: &Options) -> Result<Self, PreparationError> {
        // Beside a given force the shift in time of the two is fitted in place of the hold.
        let is_given = recording.channel(MODEL_FORCE).is_some();
        if is_given || recording.known_hold().is_some() {
            return Self::as_recorded(recording, options);
        }
        hold::decided(recording, options)
    }

    /// The family of all of a recording, read as this one of a part of it.
    fn extended(mut self, all: &Recording, options: &Options) -> Result<Self, PreparationError> {
        // To prepare all of it twice takes long: where the pieces tell, that stands.
        let other = self.other_hold.take().filter(|_| self.hold.is_some_and(|hold| hold.by_search));
        let other = other.map(|other| other.extended(all, options)).transpose()?;
        let whole = Self::as_recorded(&all.clone().with_hold(self.recording.hold()), options)?;
        let (hold, other_hold) = (self.hold, other.map(Box::new));
        let part = Some(Box::new(self.with_stroke_of(&whole)));
        Ok(Self { hold, other_hold, part, ..whole })
    }
}

#[cfg(test)]
mod tests {
    use missing_physics::report::Remark;
    use missing_physics::{Channel, ModelFamily};

    use super::*;

    /// A mass with friction under a force that is held between samples.
    fn recording(samples: usize) -> Recording {
        let (interval, mass) = (1e-3, 10.0);
        let (mut x, mut v) = (0.0f64, 0.0f64);
        let (mut time, mut force, mut position) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..samples {
            let t = k as f64 * interval;
            let f = 60.0 * (3.0 * t).sin() + 25.0 * (17.3 * t).sin() - 200.0 * x;
            time.push(t);
            force.push(f);
            position.push((x / 1e-7).round() * 1e-7);
            for _ in 0..10 {
                v += (f - 8.0 * v.signum() - 50.0 * v) / mass * 0.1 * interval;
                x += v * 0.1 * interval;
            }
        }
        let channels =
            vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
        Recording::new("long", time, channels).unwrap()
    }

    #[test]
    fn a_long_recording_is_read_as_pieces_of_it_say_and_its_base_model_begins_there() {
        let all = recording(MOST + MOST / 4 + 1);
        let family = FrictionFamily::new(&all, &Options::default()).unwrap();
        assert_eq!(family.recording.len(), all.len());
        let part = family.part.as_deref().unwrap();
        assert!(part.recording.len() < all.len() && part.terms.len() == family.terms.len());
        assert_eq!(part.stroke, family.stroke);
        let hold = family.hold().unwrap().hold;
        assert_eq!((family.recording.hold(), part.recording.hold()), (hold, hold));
        if let Some(other) = &family.other_hold {
            assert_ne!(other.recording.hold(), hold);
            assert_eq!(other.recording.len(), all.len());
        }
        // All of it was looked at.
        assert!(!family.reading().iter().any(|remark| matches!(remark, Remark::InPieces { .. })));
    }

    #[test]
    fn a_short_recording_has_no_part() {
        let family = FrictionFamily::new(&recording(20_000), &Options::default()).unwrap();
        assert!(family.in_part().is_none());
    }

    #[test]
    fn what_is_pieces_of_a_very_long_recording_says_so() {
        let part = in_pieces(&recording(40_000), 20_000).unwrap().unwrap();
        let pieces = part.segments().len();
        let family = FrictionFamily::new(&part, &Options::default()).unwrap();
        let looked_at = part.len();
        let said = Remark::InPieces { samples: 40_000, looked_at, pieces };
        assert!(family.reading().contains(&said), "{:?}", family.reading());
    }
}
