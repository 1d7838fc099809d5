//! The reference of a challenge: it excites every effect, twice and differently, so that one part
//! can be held out.

use super::{SAMPLE_TIME, STROKE};
use crate::reference::{Profile, Reference};

/// Time over which accelerations are spread, s.
const SMOOTHING: f64 = 0.02;

/// About 14 s: dwells, reciprocation within and beyond the contact, constant speeds from 0.5 mm/s
/// to 0.3 m/s in both directions, a slow velocity triangle, the whole stroke at several speeds and
/// accelerations; then the same with other speeds, in another order.
pub fn excitation() -> Reference {
    let first = Profile::new(SAMPLE_TIME)
        .dwell(0.2)
        .reciprocate(15e-6, 5.0, 2.0)
        .reciprocate(60e-6, 5.0, 2.0)
        .reciprocate(400e-6, 4.0, 1.0)
        .round_trip(0.5e-3 * 0.4, 0.5e-3, 0.5)
        .round_trip(3e-3 * 0.3, 3e-3, 0.5)
        .round_trip(12e-3 * 0.3, 12e-3, 2.0)
        .velocity_triangle(25e-3, 1.0)
        .dwell(0.3)
        .round_trip(STROKE, 0.3, 5.0)
        .round_trip(0.5 * STROKE, 0.08, 1.0);
    let both = first
        .dwell(0.1)
        .travel(STROKE, 0.15, 2.0)
        .velocity_triangle(-40e-3, 1.2)
        .round_trip(-25e-3 * 0.3, 25e-3, 1.0)
        .round_trip(-6e-3 * 0.3, 6e-3, 0.5)
        .round_trip(-1e-3 * 0.4, 1e-3, 0.2)
        .dwell(0.4)
        .reciprocate(-400e-6, 3.0, 1.0)
        .reciprocate(-100e-6, 4.0, 2.0)
        .reciprocate(-20e-6, 4.0, 2.0)
        .travel(-STROKE, 0.15, 2.0)
        .round_trip(STROKE, 0.22, 3.0)
        .dwell(0.2);
    both.build(0.0, SMOOTHING)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_covers_the_stroke_and_is_of_a_handy_length() {
        let reference = excitation();
        assert!(
            (8_000..16_000).contains(&reference.position.len()),
            "{}",
            reference.position.len()
        );
        let (low, high) =
            reference.position.iter().fold((0.0f64, 0.0f64), |(l, h), x| (l.min(*x), h.max(*x)));
        assert!(low > -1e-2 && (STROKE - 1e-6..STROKE + 1e-2).contains(&high), "{low} {high}");
    }
}
