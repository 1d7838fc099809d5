//! Samples that repeat the one before while the axis moves: the recorder dropped them, or reads slower than it writes.

use missing_physics::Recording;
use missing_physics::data_check::count_of;

/// The axis moves where the samples around one lie this many counts apart.
const MOVING: f64 = 8.0;
/// The least of that as a share of the stroke, for positions without counts.
const LEAST: f64 = 1e-6;
/// Fewest repeated samples, and how many of them there must be for each that differs by one count: noise makes both
/// alike.
const FEWEST: usize = 5;
const EXCESS: usize = 4;

/// Which samples of `position` repeat the one before although the axis moves.
pub(super) fn stale(recording: &Recording, position: &[f64]) -> Vec<bool> {
    let span = position.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    let count = count_of(position).unwrap_or(0.0);
    let far = MOVING * count.max(LEAST * (span.1 - span.0));
    let mut stale = vec![false; position.len()];
    let mut neighbours = 0;
    for segment in recording.segments() {
        for k in segment.start + 1..segment.end.saturating_sub(1) {
            let moved = (position[k] - position[k - 1]).abs();
            if (position[k + 1] - position[k - 1]).abs() > far {
                stale[k] = moved == 0.0;
                neighbours += usize::from(moved > 0.0 && moved < 1.5 * count);
            }
        }
    }
    let repeated = stale.iter().filter(|stale| **stale).count();
    // One count to either side is two ways, none is one.
    if repeated < FEWEST || repeated * 2 < EXCESS * neighbours {
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
