//! Plants of the same effects that advance together, one per lane.

use super::SimulationError;
use super::scratch::Scratch;
use crate::effects::{Drive, Effect, Element, Motion, Parameters, Response, Slot, Smooth, Step};
use crate::model::Model;

/// Events within one step after which a lane rests for what is left of it. A step has two in a
/// reversal; more come from a step that is too long for the plant.
const MAX_PIECES: usize = 6;

/// Where a plant starts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// Time, s.
    pub time: f64,
    /// Position, m or rad.
    pub position: f64,
    /// Velocity, m/s or rad/s.
    pub velocity: f64,
    /// Utilisation of the friction contact, -1..1; only with an elastic contact.
    pub used: f64,
    /// Command of the drive up to here, N or N m.
    pub command: f64,
}

impl Start {
    /// At rest or in full sliding, as the velocity says.
    pub fn at(position: f64, velocity: f64) -> Self {
        let used = if velocity == 0.0 { 0.0 } else { velocity.signum() };
        Self { time: 0.0, position, velocity, used, command: 0.0 }
    }
}

/// An effect with the parameters and states of all lanes.
struct Active {
    effect: &'static dyn Effect,
    values: Vec<f64>,
    element: Vec<f64>,
    drive: Vec<f64>,
}

/// Plants of the same effects with parameters of their own, in lockstep.
pub struct Plants {
    lanes: usize,
    effects: Vec<Active>,
    smooth: Vec<usize>,
    level: Vec<usize>,
    drives: Vec<usize>,
    attached: Vec<usize>,
    contact: Option<usize>,
    iterations: usize,
    mass: Vec<f64>,
    time: Vec<f64>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    /// Mean acceleration of the last step.
    slope: Vec<f64>,
    dwell: Vec<f64>,
    bond: Vec<f64>,
    scratch: Scratch,
}

impl Plants {
    /// One lane per model, all at rest at 0.
    ///
    /// # Errors
    /// [`SimulationError::Structure`] where the models are not of the same effects.
    pub fn new(models: &[Model]) -> Result<Self, SimulationError> {
        let lanes = models.len();
        let first = models.first().ok_or(SimulationError::Empty)?;
        for model in models {
            if model.effects() != first.effects() {
                let (first, other) = (first.effects().join(", "), model.effects().join(", "));
                return Err(SimulationError::Structure { first, other });
            }
        }
        let mut plants = Self::empty(first, lanes);
        for (i, model) in models.iter().enumerate() {
            plants.set_values(i, &model.values());
        }
        Ok(plants)
    }

    /// Plants of the effects of `model` without parameters.
    fn empty(model: &Model, lanes: usize) -> Self {
        let effects: Vec<Active> =
            model.terms().iter().map(|term| Active::new(term.effect(), lanes)).collect();
        let on = |slot: Slot| -> Vec<usize> {
            (0..effects.len()).filter(|k| effects[*k].effect.about().acts_on(slot)).collect()
        };
        let elements = effects.iter().filter_map(|active| active.effect.element());
        Self {
            lanes,
            smooth: on(Slot::SmoothForce),
            level: on(Slot::FrictionLevel),
            drives: on(Slot::Drive),
            attached: on(Slot::Attached),
            contact: on(Slot::Contact).first().copied(),
            iterations: elements.map(Element::iterations).max().unwrap_or(0),
            effects,
            mass: vec![1.0; lanes],
            time: vec![0.0; lanes],
            position: vec![0.0; lanes],
            velocity: vec![0.0; lanes],
            slope: vec![0.0; lanes],
            dwell: vec![0.0; lanes],
            bond: vec![1.0; lanes],
            scratch: Scratch::new(lanes),
        }
    }

    /// `lanes` plants that are all `model`.
    pub fn uniform(model: &Model, lanes: usize) -> Self {
        let mut plants = Self::empty(model, lanes);
        let values = model.values();
        for i in 0..lanes {
            plants.set_values(i, &values);
        }
        plants
    }

    /// Gives lane `i` the parameters `values`, in the order of [`Model::addresses`]. Extra values
    /// are ignored.
    pub fn set_values(&mut self, i: usize, values: &[f64]) {
        let Some((mass, values)) = values.split_first() else { return };
        self.mass[i] = *mass;
        let slots = self
            .effects
            .iter_mut()
            .flat_map(|active| active.values.iter_mut().skip(i).step_by(self.lanes));
        for (slot, value) in slots.zip(values) {
            *slot = *value;
        }
    }

    /// Number of lanes.
    pub fn lanes(&self) -> usize {
        self.lanes
    }

    /// Positions, m or rad.
    pub fn position(&self) -> &[f64] {
        &self.position
    }

    /// Velocities, m/s or rad/s.
    pub fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    /// Mean force of the drive on the mass in the last step, N or N m.
    pub fn drive_force(&self) -> &[f64] {
        &self.scratch.drive
    }

    /// Puts lane `i` to `start`.
    pub fn start(&mut self, i: usize, start: &Start) {
        self.time[i] = start.time;
        self.position[i] = start.position;
        self.velocity[i] = start.velocity;
        self.slope[i] = 0.0;
        self.dwell[i] = 0.0;
        self.bond[i] = 1.0;
        let level = self.level_at(i, start);
        for active in &mut self.effects {
            active.start(i, self.lanes, level, start);
        }
    }

    /// Friction level of lane `i` at its state.
    fn level_at(&mut self, i: usize, start: &Start) -> f64 {
        let s = &mut self.scratch;
        s.position.copy_from_slice(&self.position);
        s.velocity.copy_from_slice(&self.velocity);
        s.direction[i] = start.used.signum();
        self.call_level();
        self.scratch.level[i]
    }

    /// Advances every lane by its `duration` (s) under its `command`, the mean over the step.
    pub fn step(&mut self, duration: &[f64], command: &[f64]) {
        self.drive(duration, command);
        self.scratch.left.copy_from_slice(duration);
        if self.contact.is_some() {
            self.predict();
            self.elastic_piece();
        } else {
            for _ in 0..MAX_PIECES {
                self.predict();
                self.rigid_piece();
                if self.scratch.left.iter().all(|left| *left <= 0.0) {
                    break;
                }
            }
        }
        for (time, duration) in self.time.iter_mut().zip(duration) {
            *time += duration;
        }
    }

    fn drive(&mut self, duration: &[f64], command: &[f64]) {
        let force = &mut self.scratch.drive;
        force.copy_from_slice(command);
        for k in &self.drives {
            let active = &mut self.effects[*k];
            if let Some(drive) = active.effect.drive() {
                let p = Parameters::new(&active.values, self.lanes);
                drive.advance(p, duration, &mut active.drive, force);
            }
        }
    }

    /// Middle of the piece that is left, and the smooth forces there.
    fn predict(&mut self) {
        let (n, s) = (self.lanes, &mut self.scratch);
        let (x, v, slope) = (&self.position[..n], &self.velocity[..n], &self.slope[..n]);
        let (middle, predicted) = (&mut s.position[..n], &mut s.velocity[..n]);
        let (left, direction) = (&s.left[..n], &mut s.direction[..n]);
        for i in 0..n {
            let half = 0.5 * left[i];
            let sign = if v[i] == 0.0 { 0.0 } else { v[i].signum() };
            middle[i] = x[i] + half * v[i];
            // The prediction stays on this side of a stop: what comes behind it is another piece.
            let along = (v[i] + half * slope[i]) * sign;
            predicted[i] = along.max(0.0) * sign;
            direction[i] = sign;
        }
        s.force.fill(0.0);
        s.damping.fill(0.0);
        self.call_smooth();
        keep_positive(&mut self.scratch.damping);
    }

    fn rigid_piece(&mut self) {
        self.scratch.displacement.fill(0.0);
        self.begin_elements(false);
        self.direct_at_rest();
        self.call_level();
        self.rest_or_slide();
        for _ in 0..self.iterations {
            self.newton(false);
        }
        self.close_rigid();
        self.commit_elements(false);
    }

    fn elastic_piece(&mut self) {
        self.scratch.displacement.fill(0.0);
        self.call_level();
        self.begin_elements(true);
        self.first_displacement(0.0);
        for _ in 0..self.iterations {
            self.newton(true);
        }
        self.close_elastic();
        self.commit_elements(true);
    }

    /// Direction in which a lane at rest is pushed.
    fn direct_at_rest(&mut self) {
        let (n, s) = (self.lanes, &mut self.scratch);
        for i in 0..n {
            if self.velocity[i] == 0.0 {
                let applied = s.drive[i] - s.force[i] - 0.5 * (s.before[i] + s.after[i]);
                s.direction[i] = if applied == 0.0 { 0.0 } else { applied.signum() };
            }
        }
    }

    /// Ends the step of lanes that stay at rest; first displacement of the others.
    fn rest_or_slide(&mut self) {
        let (n, s) = (self.lanes, &mut self.scratch);
        for i in 0..n {
            let applied = s.drive[i] - s.force[i] - 0.5 * (s.before[i] + s.after[i]);
            let rests = self.velocity[i] == 0.0 && applied.abs() <= s.level[i];
            self.dwell[i] += if rests { s.left[i] } else { 0.0 };
            s.left[i] = if rests { 0.0 } else { s.left[i] };
        }
        self.first_displacement(1.0);
    }

    /// Displacement over the piece with the elements' force as it answers no displacement;
    /// `rigid` is 1 where the friction level acts as a force, 0 where a contact carries it.
    fn first_displacement(&mut self, rigid: f64) {
        let (n, s) = (self.lanes, &mut self.scratch);
        let (mass, v) = (&self.mass[..n], &self.velocity[..n]);
        let left = &s.left[..n];
        let (drive, force, damping) = (&s.drive[..n], &s.force[..n], &s.damping[..n]);
        let (level, direction) = (&s.level[..n], &s.direction[..n]);
        let (predicted, before) = (&s.velocity[..n], &s.before[..n]);
        let (after, stiffness) = (&s.after[..n], &s.stiffness[..n]);
        let (moved, taken) = (&mut s.displacement[..n], &mut s.taken[..n]);
        for i in 0..n {
            let r = left[i];
            let push = drive[i] - force[i] - rigid * level[i] * direction[i]
                + damping[i] * predicted[i]
                - 0.5 * (before[i] + after[i]);
            // Times r: no division by a piece of length 0.
            let inertia = 2.0 * mass[i] + r * damping[i] + 0.5 * r * r * stiffness[i];
            moved[i] = r * (2.0 * mass[i] * v[i] + r * push) / inertia;
            taken[i] = r;
        }
    }

    /// Newton's step on the displacement for the elements' response at the displacement so far.
    fn newton(&mut self, contact: bool) {
        self.respond_elements(contact);
        let (n, s) = (self.lanes, &mut self.scratch);
        let rigid = if contact { 0.0 } else { 1.0 };
        for i in 0..n {
            let r = s.left[i];
            let linear = s.after[i] - s.stiffness[i] * s.displacement[i];
            let push = s.drive[i] - s.force[i] - rigid * s.level[i] * s.direction[i]
                + s.damping[i] * s.velocity[i]
                - 0.5 * (s.before[i] + linear);
            let inertia = 2.0 * self.mass[i] + r * s.damping[i] + 0.5 * r * r * s.stiffness[i];
            s.displacement[i] = r * (2.0 * self.mass[i] * self.velocity[i] + r * push) / inertia;
        }
    }

    /// Takes the piece, up to the stop where there is one in it.
    fn close_rigid(&mut self) {
        let (n, s) = (self.lanes, &mut self.scratch);
        let (x, v) = (&mut self.position[..n], &mut self.velocity[..n]);
        let (slope, dwell) = (&mut self.slope[..n], &mut self.dwell[..n]);
        let (left, direction) = (&mut s.left[..n], &s.direction[..n]);
        let (moved, taken) = (&mut s.displacement[..n], &mut s.taken[..n]);
        for i in 0..n {
            let r = left[i];
            if r <= 0.0 {
                (moved[i], taken[i]) = (0.0, 0.0);
                continue;
            }
            let end = 2.0 * moved[i] / r - v[i];
            let stops = end * direction[i] <= 0.0;
            // Constant acceleration to the stop. A lane that cannot leave its rest takes no time
            // for that and stays for what is left.
            let share = if stops && v[i] != 0.0 { v[i] / (v[i] - end) } else { 1.0 };
            let held = stops && v[i] == 0.0;
            if stops && v[i] != 0.0 {
                dwell[i] = 0.0;
            }
            slope[i] = if held { 0.0 } else { (end - v[i]) / r };
            taken[i] = share * r;
            moved[i] = if held {
                0.0
            } else if stops {
                0.5 * v[i] * taken[i]
            } else {
                moved[i]
            };
            x[i] += moved[i];
            v[i] = if stops { 0.0 } else { end };
            left[i] = if stops && !held { r - taken[i] } else { 0.0 };
        }
    }

    fn close_elastic(&mut self) {
        let (n, s) = (self.lanes, &mut self.scratch);
        let (x, v) = (&mut self.position[..n], &mut self.velocity[..n]);
        let (slope, moved) = (&mut self.slope[..n], &s.displacement[..n]);
        let left = &s.left[..n];
        for i in 0..n {
            let r = left[i];
            let end = if r > 0.0 { 2.0 * moved[i] / r - v[i] } else { v[i] };
            slope[i] = if r > 0.0 { (end - v[i]) / r } else { slope[i] };
            x[i] += moved[i];
            v[i] = end;
        }
    }

    fn call_smooth(&mut self) {
        let Self { effects, smooth, scratch: s, time, dwell, bond, .. } = self;
        let motion = Motion {
            time,
            position: &s.position,
            velocity: &s.velocity,
            direction: &s.direction,
            level_velocity: &s.velocity,
            dwell,
            bond,
            drive_force: &s.drive,
        };
        for k in smooth.iter() {
            let active = &effects[*k];
            let mut out = Smooth { force: &mut s.force, damping: &mut s.damping };
            let p = Parameters::new(&active.values, self.lanes);
            active.effect.smooth_force(p, &motion, &mut out);
        }
    }

    fn call_level(&mut self) {
        let Self { effects, level, scratch: s, time, dwell, bond, .. } = self;
        s.level.fill(0.0);
        let motion = Motion {
            time,
            position: &s.position,
            velocity: &s.velocity,
            direction: &s.direction,
            level_velocity: &s.velocity,
            dwell,
            bond,
            drive_force: &s.drive,
        };
        for k in level.iter() {
            let active = &effects[*k];
            let p = Parameters::new(&active.values, self.lanes);
            active.effect.friction_level(p, &motion, &mut s.level);
        }
        keep_positive(&mut s.level);
    }

    /// Elements at the start of the piece: their force, and their response to no displacement.
    fn begin_elements(&mut self, contact: bool) {
        self.scratch.before.fill(0.0);
        for k in self.elements(contact) {
            let (active, s) = (&self.effects[k], &mut self.scratch);
            let Some(element) = active.effect.element() else { continue };
            let level = if Some(k) == self.contact { &s.level } else { &s.zero };
            let step = Step { duration: &s.left, displacement: &s.displacement, level };
            let p = Parameters::new(&active.values, self.lanes);
            element.force(p, &step, &active.element, &mut s.before);
        }
        self.respond_elements(contact);
    }

    fn respond_elements(&mut self, contact: bool) {
        self.scratch.after.fill(0.0);
        self.scratch.stiffness.fill(0.0);
        for k in self.elements(contact) {
            let (active, s) = (&self.effects[k], &mut self.scratch);
            let Some(element) = active.effect.element() else { continue };
            let level = if Some(k) == self.contact { &s.level } else { &s.zero };
            let step = Step { duration: &s.left, displacement: &s.displacement, level };
            let mut out = Response { force: &mut s.after, stiffness: &mut s.stiffness };
            let p = Parameters::new(&active.values, self.lanes);
            element.respond(p, &step, &active.element, &mut out);
        }
    }

    fn commit_elements(&mut self, contact: bool) {
        for k in self.elements(contact) {
            let (active, s) = (&mut self.effects[k], &self.scratch);
            let Some(element) = active.effect.element() else { continue };
            let level = if Some(k) == self.contact { &s.level } else { &s.zero };
            let step = Step { duration: &s.taken, displacement: &s.displacement, level };
            let p = Parameters::new(&active.values, self.lanes);
            element.commit(p, &step, &mut active.element);
        }
    }

    fn elements(&self, contact: bool) -> impl Iterator<Item = usize> + use<> {
        let contact = if contact { self.contact } else { None };
        self.attached.clone().into_iter().chain(contact)
    }

    /// Which effect makes lane `i` run away: one whose force is not finite, or else the largest.
    pub(crate) fn culprit(&mut self, i: usize) -> String {
        let mut worst = (0.0, "the mass".to_owned());
        for k in 0..self.effects.len() {
            let size = self.size_of(k, i);
            let size = if size.is_finite() { size } else { f64::INFINITY };
            if size > worst.0 {
                worst = (size, self.effects[k].effect.about().name.to_owned());
            }
        }
        worst.1
    }

    fn size_of(&mut self, k: usize, i: usize) -> f64 {
        let (smooth, level) = (self.smooth.clone(), self.level.clone());
        self.smooth.retain(|other| *other == k);
        self.level.retain(|other| *other == k);
        self.scratch.force.fill(0.0);
        self.call_smooth();
        self.call_level();
        (self.smooth, self.level) = (smooth, level);
        let active = &self.effects[k];
        let states = active.element.iter().chain(&active.drive).skip(i).step_by(self.lanes);
        let state: f64 = states.map(|state| state.abs()).sum();
        self.scratch.force[i].abs() + self.scratch.level[i] + state
    }
}

impl Active {
    fn new(effect: &'static dyn Effect, lanes: usize) -> Self {
        let element = effect.element().map_or(0, Element::states);
        let drive = effect.drive().map_or(0, Drive::states);
        Self {
            effect,
            values: vec![0.0; effect.about().parameters.len() * lanes],
            element: vec![0.0; element * lanes],
            drive: vec![0.0; drive * lanes],
        }
    }

    fn start(&mut self, i: usize, lanes: usize, level: f64, start: &Start) {
        let p: Vec<f64> = self.values.iter().skip(i).step_by(lanes).copied().collect();
        if let Some(element) = self.effect.element() {
            let mut state = vec![0.0; element.states()];
            element.start(&p, level, start.used, &mut state);
            scatter(&state, &mut self.element, i, lanes);
        }
        if let Some(drive) = self.effect.drive() {
            let mut state = vec![0.0; drive.states()];
            drive.start(&p, start.command, &mut state);
            scatter(&state, &mut self.drive, i, lanes);
        }
    }
}

/// Cuts off at 0, unlike `max` without hiding a NaN.
fn keep_positive(values: &mut [f64]) {
    for value in values {
        *value = if *value < 0.0 { 0.0 } else { *value };
    }
}

fn scatter(state: &[f64], all: &mut [f64], i: usize, lanes: usize) {
    for (state, slot) in state.iter().zip(all.iter_mut().skip(i).step_by(lanes)) {
        *slot = *state;
    }
}
