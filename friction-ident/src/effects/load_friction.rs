//! Friction that grows with the transmitted load: gears, nuts, preloaded bearings.

use super::{About, Before, Begin, CLaw, Effect, Motion, Parameter, Parameters, Slot};
use crate::axis::Quantity;
use crate::simd::vectorised;

/// Which load presses the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Load {
    /// The force `F` of the drive: `mu |F|`.
    Drive,
    /// The inertia of what is carried: `c |a|`.
    Inertia,
    /// Both.
    Both,
}

/// `level += mu |F|` with the force `F` of the drive; the forms take the force of inertia too, or alone.
#[derive(Clone, Copy, Debug)]
pub struct LoadFriction(Load);

/// The default form, by the force of the drive.
pub static LOAD_FRICTION: LoadFriction = LoadFriction(Load::Drive);
static INERTIA: LoadFriction = LoadFriction(Load::Inertia);
static BOTH: LoadFriction = LoadFriction(Load::Both);
static FORMS: [&dyn Effect; 2] = [&INERTIA, &BOTH];

const SHARE: Parameter = Parameter::level("mu", "share of the load", Quantity::One, 0.9, 0.05);
const CARRIED: Parameter = Parameter::level(
    "c",
    "friction per acceleration: coefficient of friction times the mass that presses; below the mass",
    Quantity::Mass,
    20.0,
    0.5,
);

static ABOUT: About = About {
    name: "load-friction",
    title: "load-dependent friction",
    equation: "mu |F| s, F = force of the drive",
    parameters: &[SHARE],
    slots: &[Slot::FrictionLevel],
    shows: "(residual x sign of velocity) against |force| at equal speed; mostly absorbed into mass, viscous and coulomb",
    reference: "A. C. Bittencourt, S. Gunnarsson, J. Dyn. Syst. Meas. Control 134, 2012",
};
static INERTIA_ABOUT: About = About {
    name: "load-friction:inertia",
    title: "load-dependent friction, by the force of inertia",
    equation: "c |a| s, a = acceleration",
    parameters: &[CARRIED],
    slots: &[Slot::FrictionLevel],
    shows: "(residual x sign of velocity) against |acceleration| at equal speed: the mass looks larger while speeding up \
            than while slowing down",
    reference: "P. Hamon, M. Gautier, P. Garrec, IEEE/RSJ IROS 2010 (load-dependent dry friction)",
};
static BOTH_ABOUT: About = About {
    name: "load-friction:both",
    title: "load-dependent friction, by the force of the drive and of inertia",
    equation: "(mu |F| + c |a|) s, F = force of the drive, a = acceleration",
    parameters: &[SHARE, CARRIED],
    slots: &[Slot::FrictionLevel],
    shows: "(residual x sign of velocity) against |force| and |acceleration| at equal speed",
    reference: "P. Hamon, M. Gautier, P. Garrec, IEEE/RSJ IROS 2010 (load-dependent dry friction)",
};

impl Effect for LoadFriction {
    fn about(&self) -> &'static About {
        match self.0 {
            Load::Drive => &ABOUT,
            Load::Inertia => &INERTIA_ABOUT,
            Load::Both => &BOTH_ABOUT,
        }
    }

    fn flexible_form(&self) -> Option<&'static str> {
        (self.0 != Load::Both).then_some("load-friction:both")
    }

    fn begins_flexible(&self, before: &Before<'_>) -> Begin {
        Begin::at(["mu", "c"].map(|name| (name, (before.value)(name).unwrap_or(0.0))))
    }

    fn is_only_flexible(&self) -> bool {
        self.0 == Load::Both
    }

    /// As much as of the force: an axis that needs none to slow down is one whose force comes too late.
    fn most(&self, parameter: &str, _values: &[f64], mass: f64) -> Option<f64> {
        (parameter == CARRIED.name).then_some(SHARE.high * mass)
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw::level(match self.0 {
            Load::Drive => "level += {mu} * fabs(drive);",
            Load::Inertia => "level += {c} * fabs(a);",
            Load::Both => "level += {mu} * fabs(drive) + {c} * fabs(a);",
        }))
    }

    fn not_compensated(&self) -> Option<&'static str> {
        Some(match self.0 {
            Load::Drive | Load::Both => "it needs the force of the drive",
            Load::Inertia => "it needs the acceleration",
        })
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        if self.0 == Load::Drive { &FORMS } else { &[] }
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        if self.0 != Load::Inertia {
            load(p.get(0), m.drive_force, level);
        }
        if self.0 != Load::Drive {
            // In a simulation the acceleration is that of the step before: it settles like (c/m)^steps.
            load(p.get(usize::from(self.0 == Load::Both)), m.acceleration, level);
        }
    }
}

vectorised! {
    fn load(share: &[f64], force: &[f64], level: &mut [f64]) {
        for ((level, share), force) in level.iter_mut().zip(share).zip(force) {
            *level += share * force.abs();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, along_and_simulated, breaks_away, level};
    use super::*;
    use crate::axis::Axis;
    use crate::model::Model;
    use crate::simulator::{Input, Start, simulate};
    use missing_physics::Hold;

    #[test]
    fn the_level_is_a_share_of_the_load_of_either_sign() {
        for force in [40.0, -40.0] {
            let acceleration = -0.1 * force;
            let point = Point { drive_force: force, acceleration, ..Point::at(0.0, 0.1) };
            assert_eq!(level(&LOAD_FRICTION, &[0.05], point), 2.0);
            assert_eq!(level(&INERTIA, &[0.5], point), 2.0);
            assert_eq!(level(&BOTH, &[0.05, 0.25], point), 3.0);
        }
    }

    #[test]
    fn with_friction_by_inertia_a_table_gains_speed_as_if_it_were_heavier_and_loses_it_as_if_lighter()
     {
        let model = Model::new(Axis::Linear, 5.0)
            .and_then(|m| m.with("load-friction:inertia", &[("c", 2.0)]))
            .unwrap();
        let time: Vec<f64> = (0..=2000).map(|k| f64::from(k) * 1e-3).collect();
        let force: Vec<f64> = time.iter().map(|t| if *t < 1.0 { 7.0 } else { -3.0 }).collect();
        let input = Input::new(&time, &force, Hold::ZeroOrder);
        let velocity = simulate(&model, &input, &Start::at(0.0, 0.1)).unwrap().velocity;
        // (m + c) a = 7 N, then (m - c) a = -3 N.
        assert!((velocity[900] - velocity[100] - 0.8).abs() < 1e-6);
        assert!((velocity[1900] - velocity[1100] + 0.8).abs() < 1e-6);
    }

    #[test]
    fn a_table_that_came_to_rest_breaks_away_at_its_level() {
        let model = Model::new(Axis::Linear, 2.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 5.0)]))
            .and_then(|m| m.with("load-friction:inertia", &[("c", 0.5)]))
            .unwrap();
        let force = breaks_away(&model);
        assert!((force - 5.0).abs() < 0.01, "{force}");
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        for (form, values) in [
            ("load-friction:inertia", &[("c", 1.0)][..]),
            ("load-friction:both", &[("mu", 0.1), ("c", 0.7)][..]),
        ] {
            let left = along_and_simulated(&[(form, values)], None);
            assert!(left < 0.05, "{form}: {left}");
        }
    }
}
