//! The paper's friction compensator, for any identified model.

use crate::closed_loop::{Controller, Sample};
use crate::effects::{Effect, Motion, Parameters, Slot, Smooth};
use crate::model::{Model, ModelEffect};
use crate::simd::sign;

use super::contact::Contact;
use super::memory::{self, Bond, Follower};
use super::state::MotionState;

/// Why a compensator cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompensatorError {
    /// A setting that is no number above 0.
    #[error("the {what} of the compensator is {value}\nit must be finite and above 0")]
    Setting {
        /// Which.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// Nothing to compensate.
    #[error(
        "the model has nothing that a compensator could add to the command; its effects: {0}\nidentify one with friction, for example 'aep identify DATA --effects coulomb,viscous'"
    )]
    Nothing(String),
}

/// What the compensator needs besides a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Sampling time, s.
    pub sample_time: f64,
    /// Speed up to which the measured motion counts as stick, `V_cr`, m/s or rad/s.
    pub critical_velocity: f64,
    /// Whether the elastic contact of the model is followed along the desired path. Without it the
    /// friction changes its sign with the desired velocity at once, as in the paper's formula.
    pub presliding: bool,
}

impl Settings {
    /// The contact is followed.
    pub fn new(sample_time: f64, critical_velocity: f64) -> Self {
        Self { sample_time, critical_velocity, presliding: true }
    }
}

/// An effect that the compensator does not act on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Its name.
    pub effect: &'static str,
    /// Why.
    pub why: &'static str,
}

/// Gives at each sample the force that the model says the friction will take.
///
/// `u = u_PD + F(x_d', t2, F_sa)`: friction and forces of position are evaluated along the *desired*
/// motion; it stands in for the measured one, whose velocity an encoder of 1 um resolves no finer than
/// 0.2 mm/s at 5 ms. The measured velocity decides between stick and slip only, and with that over the
/// dwell time `t2` and over what the last slide has left of the static hump, `F_sa`.
///
/// The force holds for a sampling interval; positions are taken in its middle, and the elastic contact
/// there carries what the desired path has bent it to. Without the contact ([`Settings::presliding`])
/// a slow start hits the table with the whole static friction at once; the table breaks away faster
/// than the reference moves, and at 0.1 mm/s falls back into stick.
#[derive(Clone, Debug)]
pub struct Compensator {
    settings: Settings,
    terms: Vec<ModelEffect>,
    left_out: Vec<LeftOut>,
    state: MotionState,
    last_position: Option<f64>,
    desired: Follower,
    measured: Follower,
    bond: Option<Bond>,
    contact: Option<Contact>,
    direction: f64,
}

impl Compensator {
    /// A compensator of `model`, at rest.
    ///
    /// # Errors
    /// A setting that is not above 0, or a model without anything to compensate.
    pub fn new(model: &Model, settings: Settings) -> Result<Self, CompensatorError> {
        check("sampling time", settings.sample_time)?;
        check("critical velocity", settings.critical_velocity)?;
        let (mut terms, mut left_out) = (Vec::new(), Vec::new());
        for term in model.terms() {
            match obstacle(term.effect()) {
                _ if settings.presliding && term.effect().about().acts_on(Slot::Contact) => {}
                None => terms.push(term.clone()),
                Some(why) => left_out.push(LeftOut { effect: term.name(), why }),
            }
        }
        let forces = |term: &ModelEffect| {
            let about = term.effect().about();
            about.acts_on(Slot::SmoothForce) || about.acts_on(Slot::FrictionLevel)
        };
        if !terms.iter().any(forces) {
            return Err(CompensatorError::Nothing(model.effects().join(", ")));
        }
        let follower = Follower::new(&terms, settings.sample_time);
        let contact = model.terms().iter().find(|t| t.effect().about().acts_on(Slot::Contact));
        let contact = contact.filter(|_| settings.presliding).and_then(Contact::new);
        Ok(Self {
            settings,
            left_out,
            state: MotionState::new(settings.critical_velocity, settings.sample_time),
            last_position: None,
            desired: follower.clone(),
            measured: follower,
            bond: Bond::new(&terms),
            contact,
            direction: 0.0,
            terms,
        })
    }

    /// Its settings.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The terms of the model that it acts on, besides the contact.
    pub fn terms(&self) -> &[ModelEffect] {
        &self.terms
    }

    /// The effects of the model that it does not act on.
    pub fn left_out(&self) -> &[LeftOut] {
        &self.left_out
    }

    /// The memory of the velocity, as it was built.
    pub(super) fn follower(&self) -> &Follower {
        &self.desired
    }

    /// The memory of the static hump, as it was built.
    pub(super) fn bond(&self) -> Option<&Bond> {
        self.bond.as_ref()
    }

    /// The contact that it follows, as it was built.
    pub(super) fn contact(&self) -> Option<&Contact> {
        self.contact.as_ref()
    }

    /// The force to be added to the command at this sample, N or N m. Samples must come one by one, in
    /// order and every [`Settings::sample_time`].
    pub fn force(&mut self, sample: &Sample) -> f64 {
        let last = self.last_position.replace(sample.position).unwrap_or(sample.position);
        let measured = (sample.position - last) / self.settings.sample_time;
        self.state.see(measured);
        let level_velocity = self.desired.follow(sample.reference_velocity);
        let slid = self.measured.follow(measured);
        let bond = self.bond.as_mut().map_or(1.0, |bond| {
            let share = memory::hump(&self.terms, slid);
            bond.see(&self.state, share)
        });
        self.friction(sample, level_velocity, bond)
    }

    fn friction(&mut self, sample: &Sample, level_velocity: f64, bond: f64) -> f64 {
        let velocity = sample.reference_velocity;
        let middle = sample.reference + 0.5 * self.settings.sample_time * velocity;
        let direction = sign(velocity);
        if direction != 0.0 {
            self.direction = direction;
        }
        let at = |velocity, level_velocity| Place {
            time: sample.time,
            position: middle,
            velocity,
            direction: self.direction,
            level_velocity,
            dwell: self.state.dwell(),
            bond,
        };
        let slides = at(velocity, level_velocity);
        let (smooth, level) = (self.smooth(&slides), self.level(&slides));
        let breakaway = self.level(&at(0.0, 0.0));
        match &mut self.contact {
            None => smooth + level * direction,
            Some(contact) => {
                let begin = sample.reference;
                smooth + contact.follow(begin, middle, self.settings.sample_time, level, breakaway)
            }
        }
    }

    fn smooth(&self, place: &Place) -> f64 {
        let (mut force, mut damping) = ([0.0], [0.0]);
        for term in self.terms.iter().filter(|t| t.effect().about().acts_on(Slot::SmoothForce)) {
            let mut out = Smooth { force: &mut force, damping: &mut damping };
            let p = Parameters::new(term.values(), 1);
            place.motion(|motion| term.effect().smooth_force(p, motion, &mut out));
        }
        force[0]
    }

    fn level(&self, place: &Place) -> f64 {
        let mut level = [0.0];
        for term in self.terms.iter().filter(|t| t.effect().about().acts_on(Slot::FrictionLevel)) {
            let p = Parameters::new(term.values(), 1);
            place.motion(|motion| term.effect().friction_level(p, motion, &mut level));
        }
        level[0].max(0.0)
    }
}

/// One [`Motion`].
struct Place {
    time: f64,
    position: f64,
    velocity: f64,
    direction: f64,
    level_velocity: f64,
    dwell: f64,
    bond: f64,
}

impl Place {
    fn motion(&self, see: impl FnOnce(&Motion<'_>)) {
        see(&Motion {
            time: &[self.time],
            position: &[self.position],
            velocity: &[self.velocity],
            acceleration: &[0.0],
            direction: &[self.direction],
            level_velocity: &[self.level_velocity],
            dwell: &[self.dwell],
            bond: &[self.bond],
            drive_force: &[0.0],
        });
    }
}

/// Why an effect has no place in a force that is added to the command; none where it has.
fn obstacle(effect: &dyn Effect) -> Option<&'static str> {
    let about = effect.about();
    let is_known = || effect.memory().is_some_and(|memory| memory.sampled().is_some());
    let of_slot = |slot: &Slot| match slot {
        Slot::SmoothForce | Slot::FrictionLevel => None,
        Slot::Memory if is_known() => None,
        Slot::Memory => Some("a memory that the compensator does not know"),
        Slot::Contact => Some("only the friction while it slides is compensated"),
        Slot::Drive => Some("it acts on the command as a whole"),
        Slot::Attached => Some("another body"),
        Slot::Sensor => Some("it acts on the sensor"),
    };
    effect.not_compensated().or_else(|| about.slots.iter().find_map(of_slot))
}

fn check(what: &'static str, value: f64) -> Result<(), CompensatorError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(CompensatorError::Setting { what, value })
}

/// A controller with a compensator on top.
#[derive(Clone, Debug)]
pub struct Compensated<C> {
    controller: C,
    compensator: Compensator,
}

impl<C: Controller> Compensated<C> {
    /// `controller` and the friction of `compensator`.
    pub fn new(controller: C, compensator: Compensator) -> Self {
        Self { controller, compensator }
    }
}

impl<C: Controller> Controller for Compensated<C> {
    fn command(&mut self, sample: &Sample) -> f64 {
        self.controller.command(sample) + self.compensator.force(sample)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;
    use crate::effects::ALL;
    use crate::paper;

    const SETTINGS: Settings =
        Settings { sample_time: 5e-3, critical_velocity: 6e-4, presliding: false };

    fn sample(k: u32, velocity: f64) -> Sample {
        let time = f64::from(k) * 5e-3;
        Sample {
            time,
            reference: velocity * time,
            reference_velocity: velocity,
            reference_acceleration: 0.0,
            position: velocity * time,
        }
    }

    #[test]
    fn the_papers_table_gets_its_static_friction_for_the_frictional_memory_and_then_the_kinetic_one()
     {
        let mut compensator = Compensator::new(&paper::table().unwrap(), SETTINGS).unwrap();
        let (velocity, level) = (1e-3, 0.4040 * 9.806_65);
        for k in 0..20 {
            let force = compensator.force(&sample(k, velocity));
            // The delayed velocity is 0 for 25 ms, and 1000 Stribeck velocities afterwards.
            let hump = if k < 5 { 0.4260 * 9.806_65 } else { 0.0 };
            let exact = level + 0.4244 * 980.665 * velocity + hump;
            assert!((force - exact).abs() < 1e-5, "sample {k}: {force} against {exact}");
        }
        let contact = &compensator.left_out()[0];
        assert_eq!((contact.effect, compensator.left_out().len()), ("presliding:static", 1));
    }

    #[test]
    fn the_contact_carries_what_the_desired_path_has_bent_it_to() {
        let settings = Settings { presliding: true, ..SETTINGS };
        let mut compensator = Compensator::new(&paper::table().unwrap(), settings).unwrap();
        let (velocity, stiffness) = (1e-4, 7173.0 * 980.665);
        // 0.25 um in the middle of the first interval, 0.5 um more with every sample.
        for k in 0..2 {
            let bent = stiffness * velocity * 5e-3 * (f64::from(k) + 0.5);
            let force = compensator.force(&sample(k, velocity)) - 0.4244 * 980.665 * velocity;
            assert!((force / bent - 1.0).abs() < 1e-9, "sample {k}: {force} against {bent}");
        }
        assert!(compensator.left_out().is_empty());
    }

    #[test]
    fn a_reference_at_rest_gets_no_friction_but_the_forces_of_its_position() {
        let model = Model::new(Axis::Linear, 1.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 5.0)]))
            .and_then(|m| m.with("spring", &[("k", 100.0), ("x_0", 0.0)]))
            .unwrap();
        let mut compensator = Compensator::new(&model, SETTINGS).unwrap();
        let still = Sample { reference: 0.02, ..sample(0, 0.0) };
        assert_eq!(compensator.force(&still), 2.0);
    }

    #[test]
    fn every_effect_is_either_compensated_or_left_out_with_a_reason() {
        for effect in ALL.iter().flat_map(|e| std::iter::once(e).chain(e.forms())) {
            let model = Model::new(Axis::Linear, 1.0).unwrap().with("offset", &[]).unwrap();
            let Ok(model) = model.with_effect(*effect) else { continue };
            let compensator = Compensator::new(&model, SETTINGS).unwrap();
            let acts = compensator.terms().iter().any(|term| term.name() == effect.about().name);
            let left_out = compensator.left_out().iter().any(|l| l.effect == effect.about().name);
            assert!(acts != left_out, "{}", effect.about().name);
        }
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let bare = Model::new(Axis::Linear, 1.0).unwrap();
        let error = Compensator::new(&bare, SETTINGS).unwrap_err();
        assert!(matches!(error, CompensatorError::Nothing(_)));
        let settings = Settings { sample_time: 0.0, ..SETTINGS };
        let error = Compensator::new(&paper::table().unwrap(), settings).unwrap_err();
        assert!(error.to_string().contains("sampling time"), "{error}");
    }
}
