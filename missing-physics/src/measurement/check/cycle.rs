//! Motion that repeats: how long a cycle is, and how well the force repeats from one to the next.

use serde::{Deserialize, Serialize};

use super::Finding;
use crate::measurement::Recording;
use crate::measurement::period::{difference, period};

/// Motion that repeats.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Length of a cycle in samples, rounded.
    pub samples: usize,
    /// Length of a cycle, s.
    pub period_s: f64,
    /// Whole cycles in the recording.
    pub cycles: usize,
    /// Root mean square of what differs in the force from cycle to cycle, over the square root of
    /// two: the part of the force that no model of the motion can explain.
    pub force_repeatability: Option<f64>,
    /// Unit of the force.
    pub force_unit: String,
}

/// Most cycles over which the force is compared, where one is not whole samples long.
const APART: usize = 10;

impl Cycle {
    pub(super) fn of(recording: &Recording) -> Option<Self> {
        // Over several segments a sample's number says nothing of the motion.
        let [_] = recording.segments() else {
            return None;
        };
        let motion = recording.channel("reference").or_else(|| recording.channel("position"))?;
        let period = period(&motion.values)?;
        let force = recording.channel("force");
        let apart = whole(period, motion.values.len());
        Some(Self {
            samples: period.round() as usize,
            period_s: period * recording.interval(),
            cycles: (motion.values.len() as f64 / period) as usize,
            force_repeatability: force
                .map(|force| difference(&force.values, apart) / std::f64::consts::SQRT_2),
            force_unit: force.map(|force| force.unit.clone()).unwrap_or_default(),
        })
    }

    pub(super) fn finding(&self) -> Finding {
        Finding::Repeats {
            period_s: self.period_s,
            cycles: self.cycles,
            force: self.force_repeatability,
            force_unit: self.force_unit.clone(),
        }
    }
}

/// The lag of one cycle or a few that is nearest to whole samples: beside a jump of the force a part of a sample is a
/// difference that the drive does not make.
fn whole(period: f64, samples: usize) -> usize {
    let off = |lag: f64| (lag - lag.round()).abs();
    let lags = (1..=APART).map(|cycles| cycles as f64 * period);
    let lags = lags.filter(|lag| 2.0 * lag <= samples as f64);
    lags.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(period).round() as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measurement::Channel;

    #[test]
    fn a_force_that_repeats_exactly_does_so_where_a_cycle_ends_between_samples() {
        let turn = |k: u32| std::f64::consts::TAU * f64::from(k) / 80.4;
        let of = |f: fn(f64) -> f64| (0..8040).map(|k| f(turn(k))).collect();
        let channels = vec![
            Channel::new("position", "m", of(f64::sin)),
            Channel::new("force", "N", of(|turn| (turn + 0.1).cos().signum())),
        ];
        let time = (0..8040).map(|k| f64::from(k) * 1e-3).collect();
        let cycle = Cycle::of(&Recording::new("sine", time, channels).unwrap()).unwrap();
        assert_eq!((cycle.samples, cycle.cycles), (80, 100));
        assert!((cycle.period_s - 0.0804).abs() < 1e-5, "{}", cycle.period_s);
        assert!(cycle.force_repeatability.unwrap() < 1e-9, "{:?}", cycle.force_repeatability);
    }
}
