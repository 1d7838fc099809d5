//! The effects of a one-axis drive. One effect = one file: law, parameters, fingerprint, source, tests.
//!
//! [`ALL`] feeds the simulator, the screening, the command line and the documentation. A new effect
//! is one file and one line there; an effect of your own is a type that implements [`Effect`], put
//! into a [`Library`].

mod about;
mod apart;
mod as_found;
mod bend;
pub mod c_dynamics;
mod c_law;
mod cosines;
mod drive;
mod element;
mod flexible;
mod lanes;
mod library;
mod load;
mod memory;
mod own;
mod past;
pub mod search;
mod second_body;
mod sensor;
mod signal;

pub mod actuator_lag;
pub mod asymmetry;
pub mod backlash;
pub mod beside;
pub mod coulomb;
pub mod drift;
pub mod encoder;
pub mod flexible_coupling;
pub mod formula;
pub mod free;
pub mod frictional_memory;
pub mod gravity_pendulum;
pub mod input_delay;
pub mod load_friction;
pub mod motor_gain;
pub mod offset;
pub mod position_friction;
pub mod presliding;
pub mod quadratic_drag;
pub mod regressor;
pub mod reversal_decay;
pub mod ripple;
pub mod rising_static_friction;
pub mod saturation;
pub mod shear_thinning;
pub mod spring;
pub mod stribeck;
pub mod viscous;
pub mod viscous_stroke;

#[cfg(test)]
mod testing;

use missing_physics::Recording;

use crate::axis::Axis;

pub use about::{About, Extent, Parameter, ParameterRole, Scale, Slot};
pub use apart::Apart;
pub use as_found::{AsFound, Refused};
pub use c_dynamics::CDynamics;
pub use c_law::CLaw;
pub use drive::{Advance, Drive};
pub use element::{Balance, Correction, Element, Leg, Onset, Response, Step};
pub use flexible::{Before, Begin};
pub use lanes::{Motion, Parameters, Smooth, broadcast};
pub use library::{Library, UnknownEffect};
pub use memory::{Begun, Came, Memory, Recalled, Sampled, Taken};
pub use own::Own;
pub use past::Past;
pub use search::{Periodic, Repeats, Trials};
pub use second_body::{Along, SecondBody};
pub use sensor::{Sensor, Shown};
pub use signal::Signal;

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

    /// Slot [`Slot::Memory`].
    fn memory(&self) -> Option<&dyn Memory> {
        None
    }

    /// Slot [`Slot::Sensor`].
    fn sensor(&self) -> Option<&dyn Sensor> {
        None
    }

    /// For effects with a hump of the level at rest: writes the share of it that is left at
    /// `level_velocity` and returns true.
    fn hump(&self, _p: Parameters<'_>, _level_velocity: &[f64], _share: &mut [f64]) -> bool {
        false
    }

    /// Whether a hook depends on `m.dwell`.
    fn reads_dwell(&self) -> bool {
        false
    }

    /// Whether a drive can have it with these values; a search does not go where it cannot.
    fn is_possible(&self, _values: &[f64]) -> bool {
        true
    }

    /// Why it is no such effect as it was fitted (a gap of no width), in words that go on after its name; nothing where it
    /// is one.
    fn refused(&self, _found: &AsFound<'_>) -> Option<Refused> {
        None
    }

    /// How far a contact with these values gives before it slides at this friction level, the mean of its elements; nothing
    /// where it is no contact.
    fn gives(&self, _values: &[f64], _level: f64) -> Option<f64> {
        None
    }

    /// Parameters whose value the data need not tell: whatever it is, a damping that may be none, the law is that effect.
    fn whatever(&self) -> &'static [&'static str] {
        &[]
    }

    /// Whether it rings wherever the axis moves, at any speed: what would gain next to rest alone is a contact, what the
    /// errors foretell themselves a noise.
    fn rings(&self) -> bool {
        false
    }

    /// The usual effect that this one is another law of, if any.
    fn law_of(&self) -> Option<&'static str> {
        None
    }

    /// How the law repeats itself along the stroke. Where an effect does not say, its law is asked: see
    /// [`search::periodic`].
    fn periodic(&self) -> Option<Periodic> {
        None
    }

    /// The values of the same effect in a recording that differs so; nothing where it changes nothing.
    fn in_recording(&self, _values: &[f64], _own: Own) -> Option<Vec<f64>> {
        None
    }

    /// What the shape called `parameter` is tried at where all trials are screened; nothing for the usual grid. An effect
    /// says it for all of its shapes or for none.
    fn trials(&self, _parameter: &str) -> Option<Trials> {
        None
    }

    /// How many values each shape is tried at where a fit follows each trial; nothing for the usual numbers.
    fn few_trials(&self) -> Option<&'static [usize]> {
        None
    }

    /// Values beside those of a fit that may lie in a lower valley, where valleys are narrow: one for each parameter that
    /// is fitted. Those beyond the limits of the search are left out.
    fn other_valleys(&self, _fitted: &[f64]) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// Whether every axis has it: the usual effects make the base model where nobody names one, and no challenge hides
    /// them.
    fn is_usual(&self) -> bool {
        false
    }

    /// The effect by whose absence it is absent, too; a challenge that hides this one has that one as well.
    fn companion(&self) -> Option<&'static str> {
        None
    }

    /// Values that a challenge draws the length called `parameter` from; nothing for a range about the typical one.
    fn drawn_from(&self, _parameter: &str) -> Option<&'static [f64]> {
        None
    }

    /// What it looks like in ordinary motion, and what tells them apart; said by one of them is enough.
    fn told_apart(&self) -> &'static [Apart] {
        &[]
    }

    /// Whether it is a force of the place alone: no friction, and a shape of a force that varies freely along the stroke,
    /// which does not speak against it.
    fn is_of_place(&self) -> bool {
        false
    }

    /// Whether it is a friction level that fades as speed grows: level and viscosity are what friction is beyond it.
    fn fades_with_speed(&self) -> bool {
        false
    }

    /// Whether it is a friction level that runs with time: a shape of one that varies freely, which does not speak
    /// against it.
    fn is_course_of_time(&self) -> bool {
        false
    }

    /// The form, by name, that takes its place before another effect is named.
    fn flexible_form(&self) -> Option<&'static str> {
        None
    }

    /// Where that form begins, if not at the values of this one.
    fn begins_flexible(&self, _before: &Before<'_>) -> Begin {
        Begin::default()
    }

    /// Where its fits begin, for a second body with friction of its own.
    fn second_body(&self) -> Option<&'static SecondBody> {
        None
    }

    /// Share of all that the given force holds, beside a force that another model gives, that it is with these values,
    /// where the model's own mass is `mass`; nothing for what is no share of it.
    fn share_of_given(&self, _values: &[f64], _mass: f64) -> Option<f64> {
        None
    }

    /// How much later the force of the drive comes than its command, s, where it is an effect that makes it late.
    fn lateness(&self, _values: &[f64]) -> Option<f64> {
        None
    }

    /// The largest value of a parameter with which it is this effect, beside these values of the others and a moved mass.
    fn most(&self, _parameter: &str, _values: &[f64], _mass: f64) -> Option<f64> {
        None
    }

    /// Whether it is only tried in the place of another form.
    fn is_only_flexible(&self) -> bool {
        false
    }

    /// Whether it can be told beside a force that another model gives.
    fn shows_beside_given_force(&self) -> bool {
        true
    }

    /// Whether another model, which has it, may have too much of it: its amplitudes may be negative beside that model.
    fn may_be_overrated(&self) -> bool {
        false
    }

    /// Why no compensator acts on it, beyond what its slots say.
    fn not_compensated(&self) -> Option<&'static str> {
        None
    }

    /// Its law in C, for an export; an effect that the compensator acts on needs one.
    fn c_law(&self) -> Option<CLaw> {
        None
    }

    /// What it does in C beside its law, for the export of a plant: an effect with a state, or one that acts on the drive or
    /// the sensor.
    fn c_dynamics(&self) -> Option<CDynamics> {
        None
    }

    /// Whether a motion can show it beside a mass that is not known: a gain of the motor scales all parameters alike.
    fn is_determined(&self) -> bool {
        true
    }

    /// Columns of the recording that its law reads.
    fn columns(&self) -> &[String] {
        &[]
    }

    /// Whether the columns that its law reads are known.
    fn is_bound(&self) -> bool {
        self.columns().is_empty()
    }

    /// The same effect with the columns of a recording that its law reads; nothing where it reads none.
    fn bound(&self, _recording: &Recording) -> Option<&'static dyn Effect> {
        None
    }

    /// Whether a comparison of forces along a measured motion can show it at all, apart from other forms of it.
    fn shows_in_force(&self) -> bool {
        true
    }
}

/// Every effect there is, in the order of the documentation.
pub static ALL: &[&dyn Effect] = &[
    &coulomb::Coulomb,
    &viscous::Viscous,
    &offset::Offset,
    &asymmetry::Asymmetry,
    &stribeck::STRIBECK,
    &frictional_memory::FrictionalMemory,
    &rising_static_friction::RisingStaticFriction,
    &reversal_decay::ReversalDecay,
    &presliding::PRESLIDING,
    &ripple::Ripple,
    &position_friction::POSITION_FRICTION,
    &spring::Spring,
    &gravity_pendulum::GravityPendulum,
    &quadratic_drag::QuadraticDrag,
    &load_friction::LOAD_FRICTION,
    &drift::Drift,
    &shear_thinning::SHEAR_THINNING,
    &viscous_stroke::ViscousStroke,
    &actuator_lag::ActuatorLag,
    &input_delay::InputDelay,
    &saturation::Saturation,
    &motor_gain::MotorGain,
    &flexible_coupling::FlexibleCoupling,
    &backlash::Backlash,
    &encoder::Encoder,
];

/// The effect called `name` (`effect` or `effect:form`) among [`ALL`].
///
/// # Errors
/// [`UnknownEffect`] with the nearest name and the list of all.
pub fn find(name: &str) -> Result<&'static dyn Effect, UnknownEffect> {
    Library::builtin().find(name)
}
