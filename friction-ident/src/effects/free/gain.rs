//! A gain of the drive that changes over time: magnets that warm up, a supply that sags.

use super::{BEGIN, END};
use crate::axis::Quantity;
use crate::effects::{About, Advance, Drive, Effect, Parameter, Parameters, Slot};

/// A gain that is 1 at the begin of the recording and bends to another value.
#[derive(Clone, Copy, Debug)]
pub struct GainOverTime;

const fn share(name: &'static str, meaning: &'static str, default: f64) -> Parameter {
    Parameter::signed(name, meaning, Quantity::One, 0.9, default)
}

pub(super) static ABOUT: About = About {
    name: "gain-over-time",
    title: "gain of the drive that changes over time",
    equation: "F = (1 + k_1 u + k_2 u^2) u_0, u from 0 to 1 over the recording",
    parameters: &[
        BEGIN,
        END,
        share("k_1", "change of the gain over the recording, even part", 0.1),
        share("k_2", "the part that grows", 0.0),
    ],
    slots: &[Slot::Drive],
    shows: "the residual in proportion to the commanded force, more and more",
    reference: "T. Sebastian, IEEE Trans. Ind. Appl. 31, 1995 (temperature effects on torque production of PM motors)",
};

/// What is left of the gain at least: a drive does not turn round.
const LEAST: f64 = 0.05;

/// The gain so far into the recording.
pub(super) fn gain([begin, end, even, growing]: [f64; 4], time: f64) -> f64 {
    let gone = ((time - begin) / (end - begin)).clamp(0.0, 1.0);
    (1.0 + even * gone + growing * gone * gone).max(LEAST)
}

impl Effect for GainOverTime {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }

    fn shows_in_force(&self) -> bool {
        false
    }

    fn shows_beside_given_force(&self) -> bool {
        false
    }
}

impl Drive for GainOverTime {
    fn advance(
        &self,
        p: Parameters<'_>,
        step: &Advance<'_>,
        _state: &mut [f64],
        force: &mut [f64],
    ) {
        for (i, force) in force.iter_mut().enumerate() {
            *force *= gain(std::array::from_fn(|k| p.get(k)[i]), step.end[i]);
        }
    }

    fn invert(&self, p: &[f64], time: &[f64], force: &mut [f64]) {
        for (force, time) in force.iter_mut().zip(time) {
            *force /= gain([p[0], p[1], p[2], p[3]], *time);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::Past;
    use super::*;

    const P: [f64; 4] = [10.0, 30.0, -0.2, 0.1];

    #[test]
    fn it_is_one_at_the_begin_and_bends_to_its_last_value() {
        let at = |time| gain(P, time);
        assert_eq!((at(0.0), at(10.0)), (1.0, 1.0));
        assert!((at(20.0) - 0.925).abs() < 1e-12 && (at(30.0) - 0.9).abs() < 1e-12);
        assert_eq!(at(40.0), at(30.0));
        assert_eq!(gain([0.0, 1.0, -0.9, -0.9], 1.0), LEAST);
    }

    #[test]
    fn what_arrives_is_undone() {
        let past = Past::default();
        let end = [10.0, 20.0, 30.0];
        let step = Advance { duration: &[1e-3; 3], end: &end, past: &past };
        let lanes: Vec<f64> = P.iter().flat_map(|p| [*p; 3]).collect();
        let mut force = [20.0; 3];
        GainOverTime.advance(Parameters::new(&lanes, 3), &step, &mut [], &mut force);
        assert_eq!(force[0], 20.0);
        assert!((force[1] - 18.5).abs() < 1e-12 && (force[2] - 18.0).abs() < 1e-12);
        GainOverTime.invert(&P, &end, &mut force);
        assert!(force.iter().all(|force| (force - 20.0).abs() < 1e-12));
    }
}
