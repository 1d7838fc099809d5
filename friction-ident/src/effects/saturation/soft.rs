//! A limit of the drive that it comes to little by little.

use super::{
    About, Advance, CDynamics, Drive, Effect, Parameter, Parameters, Quantity, SHOWS, Slot,
};
use crate::effects::as_found::AT_END;
use crate::effects::bend::bent;
use crate::effects::{AsFound, Refused};
use crate::simd::vectorised;

/// `F = u / (1 + |u/u_max|^n)^(1/n)`.
#[derive(Clone, Copy, Debug)]
pub struct Soft;

static ABOUT: About = About {
    name: "saturation:soft",
    title: "saturation of the drive, little by little",
    equation: "F = u / (1 + |u/u_max|^n)^(1/n)",
    parameters: &[
        super::LIMIT,
        // Below it is a gain that falls (`motor-gain:knee`).
        Parameter::shape("n", "sharpness", Quantity::One, (3.0, 30.0), 8.0),
    ],
    slots: &[Slot::Drive],
    shows: SHOWS,
    reference: "W. Leonhard, Control of Electrical Drives, Springer",
};

impl Effect for Soft {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn is_only_flexible(&self) -> bool {
        true
    }

    /// What bends as softly as it may is a gain that falls.
    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        found.at_least((1, "n"), AT_END, "it is as soft as it may be: a gain that falls")
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            drive: "force /= pow(1.0 + pow(fabs(force) / {u_max}, {n}), 1.0 / {n});",
            ..CDynamics::NONE
        })
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }
}

impl Drive for Soft {
    fn advance(
        &self,
        p: Parameters<'_>,
        _step: &Advance<'_>,
        _state: &mut [f64],
        force: &mut [f64],
    ) {
        yields(p.get(0), p.get(1), force);
    }

    fn invert(&self, _p: &[f64], _time: &[f64], _force: &mut [f64]) {
        // Which command near the limit was given hardly follows from the motion.
    }

    fn withhold(&self, p: &[f64], command: &[f64], force: &mut [f64]) {
        for (force, command) in force.iter_mut().zip(command) {
            *force += command - bent(*command, 1.0 / p[0], p[1]);
        }
    }
}

vectorised! {
    fn yields(most: &[f64], sharpness: &[f64], force: &mut [f64]) {
        for ((force, most), n) in force.iter_mut().zip(most).zip(sharpness) {
            *force = bent(*force, 1.0 / most, *n);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::Past;
    use super::*;

    #[test]
    fn it_comes_to_its_limit_little_by_little_and_withholds_the_rest() {
        let commands = [-60.0, 3.0, 30.0];
        let (mut force, past) = (commands, Past::default());
        let step = Advance { duration: &[1e-3; 3], end: &[0.0; 3], past: &past };
        let p = [[30.0; 3], [8.0; 3]].concat();
        Soft.advance(Parameters::new(&p, 3), &step, &mut [], &mut force);
        let half = 30.0 / 2f64.powf(0.125);
        assert!((force[0] + 30.0).abs() < 0.02 && (force[1] - 3.0).abs() < 1e-6, "{force:?}");
        assert!((force[2] - half).abs() < 1e-9, "{force:?}");
        let mut required = force;
        Soft.withhold(&[30.0, 8.0], &commands, &mut required);
        assert!(required.iter().zip(commands).all(|(a, b)| (a - b).abs() < 1e-12), "{required:?}");
    }
}
