//! The effects of a one-axis drive. One effect = one file: law, parameters, fingerprint, source, tests.
//!
//! [`ALL`] feeds the simulator, the screening, the command line and the documentation. A new effect
//! is one file and one line there; an effect of your own is a type that implements [`Effect`], put
//! into a [`Library`].

mod about;
mod lanes;
mod library;

pub mod actuator_lag;
pub mod asymmetry;
pub mod coulomb;
pub mod gravity_pendulum;
pub mod offset;
pub mod position_friction;
pub mod presliding;
pub mod quadratic_drag;
pub mod ripple;
pub mod shear_thinning;
pub mod spring;
pub mod stribeck;
pub mod viscous;

#[cfg(test)]
mod testing;

use crate::axis::Axis;

pub use about::{About, Parameter, Role, Scale, Slot};
pub use lanes::{Motion, Parameters, Smooth, broadcast};
pub use library::{Library, UnknownEffect};

/// A physical effect. Every hook adds to its output, lane by lane; all slices are equally long.
///
/// An effect overrides the hooks of the slots that its [`About`] names.
pub trait Effect: Sync + Send {
    /// Name, equation, parameters, slots.
    fn about(&self) -> &'static About;

    /// Other forms of the same law, named `effect:form`.
    fn forms(&self) -> &'static [&'static dyn Effect] {
        &[]
    }

    /// Whether the effect exists on this kind of axis. It decides what is tried, not what a model
    /// may have.
    fn suits(&self, _axis: Axis) -> bool {
        true
    }

    /// Slot [`Slot::SmoothForce`]: adds the force that resists the motion.
    fn smooth_force(&self, _p: Parameters<'_>, _m: &Motion<'_>, _out: &mut Smooth<'_>) {}

    /// Slot [`Slot::FrictionLevel`]: adds to the level of the set-valued friction for sliding in
    /// the direction `m.direction`. The sum of all levels is cut off at 0.
    fn friction_level(&self, _p: Parameters<'_>, _m: &Motion<'_>, _level: &mut [f64]) {}

    /// Slots [`Slot::Contact`] and [`Slot::Attached`].
    fn element(&self) -> Option<&dyn Element> {
        None
    }

    /// Slot [`Slot::Drive`].
    fn drive(&self) -> Option<&dyn Drive> {
        None
    }
}

/// Something with a state of its own that answers a displacement of the mass with a force: the
/// elastic friction contact, a second body behind a coupling.
///
/// The force at the end of a step must not decrease with the displacement in the step: then the
/// implicit step has exactly one solution.
pub trait Element: Sync + Send {
    /// State variables per lane.
    fn states(&self) -> usize;

    /// State of one lane at rest (`direction` 0) or in full sliding (`direction` -1 or 1) at
    /// friction `level`; `p` are the lane's parameters.
    fn start(&self, p: &[f64], level: f64, direction: f64, state: &mut [f64]);

    /// Force at the start of the step.
    fn force(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], force: &mut [f64]);

    /// Resisting force at the end of the step, and its slope against the displacement.
    /// `state[k * lanes + i]` is variable `k` in lane `i`.
    fn respond(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], out: &mut Response<'_>);

    /// Takes the step: the state at its end.
    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]);

    /// Newton iterations that the implicit step needs.
    fn iterations(&self) -> usize;

    /// Force at every sample of a measured path: sample `k` is reached by `path[k]`.
    fn along(&self, p: &[f64], path: &[(f64, f64, f64)], state: &mut [f64], force: &mut [f64]) {
        let p = Parameters::new(p, 1);
        for (&(duration, displacement, level), force) in path.iter().zip(force) {
            let (duration, displacement, level) = ([duration], [displacement], [level]);
            let step = Step { duration: &duration, displacement: &displacement, level: &level };
            let mut stiffness = [0.0];
            let force = std::slice::from_mut(force);
            self.respond(p, &step, state, &mut Response { force, stiffness: &mut stiffness });
            self.commit(p, &step, state);
        }
    }
}

/// A step of the mass as an [`Element`] sees it.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// Length of the step, s.
    pub duration: &'a [f64],
    /// Displacement of the mass in the step, m or rad.
    pub displacement: &'a [f64],
    /// Friction level in the step, N or N m.
    pub level: &'a [f64],
}

/// What an [`Element`] answers.
#[derive(Debug)]
pub struct Response<'a> {
    /// To be added to: force at the end of the step.
    pub force: &'a mut [f64],
    /// To be added to: slope of `force` against the displacement, at least 0.
    pub stiffness: &'a mut [f64],
}

/// What happens to the commanded force on its way to the mass.
pub trait Drive: Sync + Send {
    /// State variables per lane.
    fn states(&self) -> usize;

    /// State of one lane after a long time at constant `command`.
    fn start(&self, p: &[f64], command: f64, state: &mut [f64]);

    /// Advances by `duration` under `force`, the command's mean over the step, and replaces `force`
    /// by the mean of what comes out.
    fn advance(&self, p: Parameters<'_>, duration: &[f64], state: &mut [f64], force: &mut [f64]);

    /// Replaces `force`, one contiguous piece sampled at `time`, by the command that yields it.
    fn invert(&self, p: &[f64], time: &[f64], force: &mut [f64]);
}

/// Every effect there is, in the order of the documentation.
pub static ALL: &[&dyn Effect] = &[
    &coulomb::Coulomb,
    &viscous::Viscous,
    &offset::Offset,
    &asymmetry::Asymmetry,
    &stribeck::STRIBECK,
    &presliding::Presliding,
    &ripple::Ripple,
    &position_friction::PositionFriction,
    &spring::Spring,
    &gravity_pendulum::GravityPendulum,
    &quadratic_drag::QuadraticDrag,
    &shear_thinning::ShearThinning,
    &actuator_lag::ActuatorLag,
];

/// The effect called `name` (`effect` or `effect:form`) among [`ALL`].
///
/// # Errors
/// [`UnknownEffect`] with the nearest name and the list of all.
pub fn find(name: &str) -> Result<&'static dyn Effect, UnknownEffect> {
    Library::builtin().find(name)
}
