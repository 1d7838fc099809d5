//! Samples that repeat the one before while the axis moves: the recorder dropped them, or reads slower than it writes.

use missing_physics::Recording;
use missing_physics::measurement::check::count_of;

/// The axis moves where the samples around one lie this many counts apart, and the two before it half of that.
const MOVING: f64 = 8.0;
/// The least of that as a share of the stroke, for positions without counts.
const LEAST: f64 = 1e-6;
/// Fewest repeated samples, by number and of those that move, and how many of them there must be for each that differs
/// by one count: noise and stick-slip make both alike.
const FEWEST: (usize, f64) = (10, 0.005);
const EXCESS: usize = 4;

/// Which samples of `position` repeat the one before although the axis moves.
pub(super) fn stale(recording: &Recording, position: &[f64]) -> Vec<bool> {
    let span = position.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    let count = count_of(position).unwrap_or(0.0);
    let far = MOVING * count.max(LEAST * (span.1 - span.0));
    let mut stale = vec![false; position.len()];
    let (mut neighbours, mut moving) = (0, 0);
    for segment in recording.segments() {
        for k in segment.start + 2..segment.end.saturating_sub(1) {
            let moved = (position[k] - position[k - 1]).abs();
            // It moved before, so that it did not start or turn just there.
            let before = stale[k - 1] || (position[k - 1] - position[k - 2]).abs() > 0.5 * far;
            if before && (position[k + 1] - position[k - 1]).abs() > far {
                moving += 1;
                stale[k] = moved == 0.0;
                neighbours += usize::from(moved > 0.0 && moved < 1.5 * count);
            }
        }
    }
    let repeated = stale.iter().filter(|stale| **stale).count();
    // One count to either side is two ways, none is one.
    let few = repeated < FEWEST.0 || (repeated as f64) < FEWEST.1 * f64::from(moving);
    if few || repeated * 2 < EXCESS * neighbours {
        stale.fill(false);
    }
    stale
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    fn recording(noise: f64, dropped: impl Fn(usize) -> bool) -> (Recording, Vec<f64>) {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 1e-3).collect();
        let mut position: Vec<f64> = time
            .iter()
            .map(|t| 0.02 * (2.0 * t).sin() + noise * random.random_range(-1.0..1.0))
            .map(|x| (x / 1e-6).round() * 1e-6)
            .collect();
        for k in 1..position.len() {
            if dropped(k) {
                position[k] = position[k - 1];
            }
        }
        (Recording::new("stale", time, Vec::new()).unwrap(), position)
    }

    #[test]
    fn dropped_samples_are_found_where_the_axis_moves() {
        let (recording, position) = recording(0.0, |k| k % 50 == 7);
        let stale = stale(&recording, &position);
        assert!((0..4000).all(|k| !stale[k] || k % 50 == 7));
        assert!(stale.iter().filter(|stale| **stale).count() > 60);
    }

    #[test]
    fn noise_of_several_counts_repeats_none() {
        let (recording, position) = recording(8e-6, |_| false);
        assert!(stale(&recording, &position).iter().all(|stale| !stale));
    }
}
