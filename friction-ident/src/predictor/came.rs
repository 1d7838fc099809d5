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
            for (k, came) in all.iter_mut().enumerate().take(segment.end).skip(first + 1) {
                let (now, moved) = (direction(k), self.position[k] - self.position[k - 1]);
                if now == 0.0 {
                    rested = rested.map(|time| time + self.time[k] - self.time[k - 1]);
                } else {
                    let before = if now == going { way } else { 0.0 };
                    // Noise is no reversal.
                    way = now * (now * (before + moved)).max(0.0);
                    (going, rested) = (now, Some(0.0));
                }
                *came = Some(Came { way, rested });
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

#[cfg(test)]
mod tests {
    use missing_physics::{Channel, Recording};

    use super::*;
    use crate::effects::Came;

    /// Rests, goes 20 mm forth, rests, goes on for 10 mm, comes back.
    fn recording() -> Recording {
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 1e-3).collect();
        let way = |t: f64, from: f64, to: f64| (t.min(to) - from).max(0.0);
        let place = |t: &f64| {
            0.02 * way(*t, 0.5, 1.5) + 0.02 * way(*t, 2.0, 2.5) - 0.01 * way(*t, 3.0, 4.0)
        };
        let position: Vec<f64> = time.iter().map(|t| (place(t) / 1e-6).round() * 1e-6).collect();
        let force = time.iter().map(|t| (3.0 * t).sin()).collect();
        let channels =
            vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
        Recording::new("made", time, channels).unwrap()
    }

    #[test]
    fn the_way_since_a_reversal_and_the_time_at_rest_are_those_of_the_motion() {
        let predictor = Predictor::new(&recording(), 10.0, 100.0).unwrap();
        let at = |k: usize| predictor.came[k].unwrap();
        assert_eq!(predictor.came[0], None);
        assert_eq!(at(400), Came { way: 0.0, rested: None });
        for (k, way, rested) in
            [(1000, 0.01, 0.0), (1800, 0.02, 0.3), (2250, 0.025, 0.0), (2900, 0.03, 0.4)]
        {
            let Came { way: found, rested: dwelt } = at(k);
            assert!((found - way).abs() < 1e-4, "{k}: {found}");
            assert!((dwelt.unwrap() - rested).abs() < 0.02, "{k}: {dwelt:?}");
        }
        assert!((at(3500).way + 0.005).abs() < 1e-4, "{:?}", at(3500));
    }

    #[test]
    fn a_part_begins_as_the_recording_came_there() {
        let predictor = Predictor::new(&recording(), 10.0, 100.0).unwrap();
        // A strip that begins amid a slide knows what is left of the reversal before it.
        let start = predictor.start(1000, 4000);
        assert!((start.came.unwrap().way - 0.01).abs() < 1e-4);
        let part = predictor.thinned(1500, 1.0).unwrap();
        assert_eq!(part.came[1], predictor.came[part.origin[1]]);
    }
}
