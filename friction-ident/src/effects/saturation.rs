//! Saturation of the drive.

mod soft;
mod speed;

use super::{About, Advance, Drive, Effect, Parameter, Parameters, Slot};
use crate::axis::Quantity;
use crate::effects::CDynamics;
use crate::effects::c_dynamics::LIMITED;
use crate::simd::limited;

/// `clip(u, +-u_max)`.
#[derive(Clone, Copy, Debug)]
pub struct Saturation;

static FORMS: [&dyn Effect; 2] = [&soft::Soft, &speed::Speed];

const LIMIT: Parameter =
    Parameter::shape("u_max", "largest force", Quantity::Force, (1.0, 1e4), 300.0);
const SHOWS: &str =
    "a residual while the command is high; a spike at the end of the command's histogram";

static ABOUT: About = About {
    name: "saturation",
    title: "saturation of the drive",
    equation: "F = clip(u, +-u_max)",
    parameters: &[LIMIT],
    slots: &[Slot::Drive],
    shows: SHOWS,
    reference: "W. Leonhard, Control of Electrical Drives, Springer",
};

impl Effect for Saturation {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some("saturation:soft")
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            helpers: &[LIMITED],
            drive: "force = limited(force, {u_max});",
            ..CDynamics::NONE
        })
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }
}

impl Drive for Saturation {
    fn advance(
        &self,
        p: Parameters<'_>,
        _step: &Advance<'_>,
        _state: &mut [f64],
        force: &mut [f64],
    ) {
        for (force, most) in force.iter_mut().zip(p.get(0)) {
            *force = limited(*force, *most);
        }
    }

    fn invert(&self, _p: &[f64], _time: &[f64], _force: &mut [f64]) {
        // Which command beyond the limit was given does not follow from the motion.
    }

    fn withhold(&self, p: &[f64], command: &[f64], force: &mut [f64]) {
        for (force, command) in force.iter_mut().zip(command) {
            *force += command - limited(*command, p[0]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Past;
    use super::*;

    #[test]
    fn the_force_stays_within_its_limit() {
        let (mut force, past) = ([-50.0, 20.0, 50.0], Past::default());
        let step = Advance { duration: &[1e-3; 3], end: &[0.0; 3], past: &past };
        Saturation.advance(Parameters::new(&[30.0; 3], 3), &step, &mut [], &mut force);
        assert_eq!(force, [-30.0, 20.0, 30.0]);
    }

    #[test]
    fn what_is_commanded_beyond_the_limit_is_withheld() {
        let mut required = [-30.0, 19.0, 30.0];
        Saturation.withhold(&[30.0], &[-50.0, 20.0, 33.0], &mut required);
        assert_eq!(required, [-50.0, 19.0, 33.0]);
    }
}
