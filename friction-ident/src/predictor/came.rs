//! How a measured axis came to where it is: what a memory has to know where a simulation starts amid a recording.

use std::ops::Range;

use super::Predictor;
use super::response::around;
use crate::effects::Came;
use crate::simd::sign;

impl Predictor {
    /// The motion before each sample; nothing at the begin of a piece of the recording.
    ///
    /// What was before a piece that begins at rest nobody knows. Its first motion is taken for a reversal: most often the
    /// axis stands at an end of its way, and then it is one.
    pub(super) fn came(&self) -> Vec<Option<Came>> {
        let moving = self.moving();
        let mut all = vec![None; self.time.len()];
        for segment in &self.segments {
            let direction = |k: usize| if moving[k] { self.direction(segment, k) } else { 0.0 };
            let first = segment.start;
            let mut going = if first + 1 < segment.end { direction(first + 1) } else { 0.0 };
            let mut way = if going == 0.0 { 0.0 } else { going * f64::INFINITY };
            let mut rested = (going != 0.0).then_some(0.0);
            for k in first + 1..segment.end {
                let (now, moved) = (direction(k), self.position[k] - self.position[k - 1]);
                if now == 0.0 {
                    rested = rested.map(|time| time + self.time[k] - self.time[k - 1]);
                } else {
                    let before = if now == going { way } else { 0.0 };
                    // Noise is no reversal.
                    way = now * (now * (before + moved)).max(0.0);
                    (going, rested) = (now, Some(0.0));
                }
                all[k] = Some(Came { way, rested });
            }
        }
        all
    }

    /// The direction of a motion around a sample.
    fn direction(&self, segment: &Range<usize>, k: usize) -> f64 {
        let (from, to) = around(segment, k);
        sign(self.position[to] - self.position[from])
    }
}
