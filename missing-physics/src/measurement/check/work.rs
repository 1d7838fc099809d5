//! Whether force and motion can belong together.
//!
//! Over a motion that comes back to where it began springs, weights and inertia give back what they took, and friction takes: the
//! force does positive work. Where it does negative work, its sign or that of the position is turned. A force that is stamped late
//! does some, too: what accelerates an axis then seems to brake it in part. That leaves force and acceleration alike, though, so
//! both are asked.

use super::Finding;
use crate::measurement::Recording;

/// Share of the work that must be negative where force and acceleration are opposed, and where they need not be.
const OPPOSED: f64 = -0.1;
const ALONE: f64 = -0.5;
/// Samples on either side of a difference, as a share of a segment; at least two.
const HALF: usize = 200;

/// What there is to be said; nothing where force and motion may belong together.
pub fn finding(recording: &Recording) -> Option<Finding> {
    let force = &recording.channel("force")?.values;
    let position = &recording.channel("position")?.values;
    // A constant part does no work on the whole where the motion comes back, and hides the rest where it does not.
    let mean = force.iter().sum::<f64>() / force.len().max(1) as f64;
    let (mut work, mut inertia) = (Share::default(), Share::default());
    for segment in recording.segments() {
        let half = (segment.len() / HALF).max(2);
        for k in segment.start + half..segment.end.saturating_sub(half) {
            let (before, here, after) = (position[k - half], position[k], position[k + half]);
            work.add((force[k] - mean) * (after - before));
            inertia.add((force[k] - mean) * (after - 2.0 * here + before));
        }
    }
    let (share, along) = (work.value()?, inertia.value()?);
    let turned = share < ALONE || share < OPPOSED && along < 0.0;
    turned.then_some(Finding::NegativeWork { share })
}

/// A sum and that of the sizes.
#[derive(Default)]
struct Share {
    sum: f64,
    sizes: f64,
}

impl Share {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.sizes += value.abs();
    }

    fn value(&self) -> Option<f64> {
        (self.sizes > 0.0 && self.sizes.is_finite()).then(|| self.sum / self.sizes)
    }
}
