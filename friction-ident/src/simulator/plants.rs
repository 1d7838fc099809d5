//! Plants of the same effects that advance together, one per lane.

use std::borrow::Cow;

use super::SimulationError;
use super::kernels::keep_positive;
use super::scratch::Scratch;
use crate::effects::{Begun, Came, Drive, Effect, Element, Memory, Onset, Parameters, Past, Slot};
use crate::model::Model;
use crate::simd::sign;

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
    /// How it came there, if anybody knows.
    pub came: Option<Came>,
}

impl Start {
    /// At rest or in full sliding, as the velocity says.
    pub fn at(position: f64, velocity: f64) -> Self {
        Self { position, velocity, used: sign(velocity), ..Self::default() }
    }
}

/// An effect with the parameters and states of all lanes.
pub(super) struct Active {
    pub effect: &'static dyn Effect,
    pub values: Vec<f64>,
    pub element: Vec<f64>,
    pub drive: Vec<f64>,
    pub memory: Vec<f64>,
    /// Integral of what came into this drive, where it wants it.
    pub past: Past,
}

/// Plants of the same effects with parameters of their own, in lockstep.
pub struct Plants {
    pub(super) lanes: usize,
    pub(super) effects: Vec<Active>,
    pub(super) smooth: Vec<usize>,
    pub(super) level: Vec<usize>,
    pub(super) drives: Vec<usize>,
    pub(super) memories: Vec<usize>,
    pub(super) attached: Vec<usize>,
    pub(super) sensors: Vec<usize>,
    pub(super) contact: Option<usize>,
    /// Elements with the encoder on their own body.
    shows: Vec<usize>,
    pub(super) iterations: usize,
    pub(super) mass: Vec<f64>,
    pub(super) time: Vec<f64>,
    pub(super) position: Vec<f64>,
    pub(super) velocity: Vec<f64>,
    /// Mean acceleration of the last step.
    pub(super) slope: Vec<f64>,
    pub(super) dwell: Vec<f64>,
    pub(super) sliding: Vec<f64>,
    /// Whether an effect depends on the time at rest.
    pub(super) reads_dwell: bool,
    /// Velocity so far, where an effect wants it.
    pub(super) past: Past,
    /// Lanes that were started since the last step.
    pub(super) fresh: Vec<(usize, Start)>,
    pub(super) scratch: Scratch,
}

impl Plants {
    /// One lane per model, all at rest at 0.
    ///
    /// # Errors
    /// [`SimulationError::Structure`] where the models are not of the same effects.
    pub fn new(models: &[Model]) -> Result<Self, SimulationError> {
        let first = models.first().ok_or(SimulationError::Empty)?;
        for model in models {
            if model.effects() != first.effects() {
                let (first, other) = (first.effects().join(", "), model.effects().join(", "));
                return Err(SimulationError::Structure { first, other });
            }
        }
        let mut plants = Self::empty(first, models.len());
        for (i, model) in models.iter().enumerate() {
            plants.set_values(i, &model.values());
        }
        plants.keep_pasts();
        Ok(plants)
    }

    /// `lanes` plants that are all `model`.
    pub fn uniform(model: &Model, lanes: usize) -> Self {
        let mut plants = Self::empty(model, lanes);
        let values = model.values();
        for i in 0..lanes {
            plants.set_values(i, &values);
        }
        plants.keep_pasts();
        plants
    }

    /// Plants of the effects of `model` without parameters.
    fn empty(model: &Model, lanes: usize) -> Self {
        let effects: Vec<Active> =
            model.terms().iter().map(|term| Active::new(term.effect(), lanes)).collect();
        let on = |slot: Slot| -> Vec<usize> {
            (0..effects.len()).filter(|k| effects[*k].effect.about().acts_on(slot)).collect()
        };
        let elements = || effects.iter().filter_map(|active| active.effect.element());
        let shows = |k: &usize| {
            let element = effects[*k].effect.element();
            element.is_some_and(|e| e.shown(Parameters::new(&[], 0), &[], &mut []))
        };
        Self {
            lanes,
            smooth: on(Slot::SmoothForce),
            level: on(Slot::FrictionLevel),
            drives: on(Slot::Drive),
            memories: on(Slot::Memory),
            attached: on(Slot::Attached),
            sensors: on(Slot::Sensor),
            contact: on(Slot::Contact).first().copied(),
            shows: (0..effects.len()).filter(shows).collect(),
            iterations: elements().map(Element::iterations).max().unwrap_or(0),
            effects,
            mass: vec![1.0; lanes],
            time: vec![0.0; lanes],
            position: vec![0.0; lanes],
            velocity: vec![0.0; lanes],
            slope: vec![0.0; lanes],
            dwell: vec![0.0; lanes],
            sliding: vec![0.0; lanes],
            reads_dwell: model.terms().iter().any(|term| term.effect().reads_dwell()),
            past: Past::new(lanes, 0.0),
            fresh: Vec::new(),
            scratch: Scratch::new(lanes),
        }
    }

    /// Gives lane `i` the parameters `values`, in the order of [`Model::addresses`]; the lane has to
    /// be started afterwards. Extra values are ignored.
    pub fn set_values(&mut self, i: usize, values: &[f64]) {
        let Some((mass, values)) = values.split_first() else { return };
        self.mass[i] = *mass;
        let lanes = self.lanes;
        let slots = self
            .effects
            .iter_mut()
            .flat_map(|active| active.values.iter_mut().skip(i).step_by(lanes));
        for (slot, value) in slots.zip(values) {
            *slot = *value;
        }
    }

    /// Makes room for what drives and memories have to remember. To be called when parameters have
    /// changed and before lanes are started.
    pub fn keep_pasts(&mut self) {
        let lanes = self.lanes;
        let mut longest = 0.0f64;
        for active in &mut self.effects {
            let p = Parameters::new(&active.values, lanes);
            if let Some(drive) = active.effect.drive() {
                active.past = Past::new(lanes, drive.memory(p));
            }
            if let Some(memory) = active.effect.memory() {
                longest = longest.max(memory.memory(p));
            }
        }
        self.past = Past::new(lanes, longest);
        for i in 0..lanes {
            self.start(i, &Start::default());
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

    /// Positions as the sensor shows them, m or rad.
    pub fn shown(&self) -> Cow<'_, [f64]> {
        let mut shown = Cow::Borrowed(&self.position[..]);
        for active in self.shows.iter().map(|k| &self.effects[*k]) {
            if let Some(element) = active.effect.element() {
                let p = Parameters::new(&active.values, self.lanes);
                element.shown(p, &self.loaded(active), shown.to_mut());
            }
        }
        for active in self.sensors.iter().map(|k| &self.effects[*k]) {
            if let Some(sensor) = active.effect.sensor() {
                sensor.show(Parameters::new(&active.values, self.lanes), shown.to_mut());
            }
        }
        shown
    }

    /// Velocities of what the encoder is on, m/s or rad/s.
    pub fn shown_velocity(&self) -> Cow<'_, [f64]> {
        let mut shown = Cow::Borrowed(&self.velocity[..]);
        for active in self.shows.iter().map(|k| &self.effects[*k]) {
            if let Some(element) = active.effect.element() {
                let p = Parameters::new(&active.values, self.lanes);
                element.shown_velocity(p, &self.loaded(active), shown.to_mut());
            }
        }
        shown
    }

    /// State of an element that is no contact; lanes that were started since the last step have none yet.
    fn loaded<'a>(&self, active: &'a Active) -> Cow<'a, [f64]> {
        let mut state = Cow::Borrowed(&active.element[..]);
        for (i, start) in &self.fresh {
            if let Some(lane) = active.loaded(*i, self.lanes, 0.0, start) {
                scatter(&lane, state.to_mut(), *i, self.lanes);
            }
        }
        state
    }

    /// Velocities, m/s or rad/s.
    pub fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    /// Keeps count of stick and slip, see [`Plants::sliding`], also where no effect depends on it.
    #[must_use]
    pub fn watched(mut self) -> Self {
        self.reads_dwell = true;
        self
    }

    /// 1 where a lane slides at the end of the last step, 0 where its friction holds; for plants that
    /// are [`Plants::watched`].
    pub fn sliding(&self) -> &[f64] {
        &self.sliding
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
        self.dwell[i] = start.came.and_then(|came| came.rested).unwrap_or(0.0);
        let slides = start.velocity != 0.0 && (self.contact.is_none() || start.used.abs() >= 1.0);
        self.sliding[i] = f64::from(u8::from(slides));
        if self.past.is_kept() {
            self.past.start(i, start.time, start.velocity, 0.0);
        }
        for active in &mut self.effects {
            active.start(i, self.lanes, start);
        }
        self.fresh.push((i, *start));
    }

    /// Loads the elements of lanes that were started, at the friction level where they are: for all
    /// of them at once.
    pub(super) fn load_elements(&mut self) {
        let fresh = std::mem::take(&mut self.fresh);
        let s = &mut self.scratch;
        s.left.fill(0.0);
        s.time.copy_from_slice(&self.time);
        s.position.copy_from_slice(&self.position);
        s.velocity.copy_from_slice(&self.velocity);
        for (direction, velocity) in s.direction.iter_mut().zip(&self.velocity) {
            *direction = sign(*velocity);
        }
        for (i, start) in &fresh {
            s.direction[*i] = sign(start.used);
            // A level may depend on the load: that of the last step was another plant's.
            s.drive[*i] = start.command;
        }
        self.recall();
        self.scratch.level.fill(0.0);
        self.call_level();
        keep_positive(&mut self.scratch.level);
        for (i, start) in fresh {
            let (level, lanes) = (self.scratch.level[i], self.lanes);
            for active in &mut self.effects {
                active.load_element(i, lanes, level, &start);
            }
        }
    }

    /// Whether plant `i` is where numbers reach. What its sensor shows can leave them before the position does.
    pub(crate) fn is_finite(&self, i: usize) -> bool {
        let state = [self.position()[i], self.velocity()[i], self.shown()[i]];
        state.iter().all(|x| x.is_finite())
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
        let s = &mut self.scratch;
        for sum in [&mut s.remembered, &mut s.force, &mut s.damping, &mut s.level] {
            sum.fill(0.0);
        }
        self.call_smooth();
        self.call_level();
        keep_positive(&mut self.scratch.level);
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
        let memory = effect.memory().map_or(0, Memory::states);
        Self {
            effect,
            values: vec![0.0; effect.about().parameters.len() * lanes],
            element: vec![0.0; element * lanes],
            drive: vec![0.0; drive * lanes],
            memory: vec![0.0; memory * lanes],
            past: Past::new(lanes, 0.0),
        }
    }

    fn parameters(&self, i: usize, lanes: usize) -> Vec<f64> {
        self.values.iter().skip(i).step_by(lanes).copied().collect()
    }

    fn start(&mut self, i: usize, lanes: usize, start: &Start) {
        if let Some(memory) = self.effect.memory() {
            let mut state = vec![0.0; memory.states()];
            let begun = Begun { velocity: start.velocity, came: start.came };
            memory.start(&self.parameters(i, lanes), &begun, &mut state);
            scatter(&state, &mut self.memory, i, lanes);
        }
        if let Some(drive) = self.effect.drive() {
            let mut state = vec![0.0; drive.states()];
            drive.start(&self.parameters(i, lanes), start.command, &mut state);
            scatter(&state, &mut self.drive, i, lanes);
            if self.past.is_kept() {
                // The integral of a command that has always been there.
                self.past.start(i, start.time, 0.0, start.command);
            }
        }
    }

    fn load_element(&mut self, i: usize, lanes: usize, level: f64, start: &Start) {
        if let Some(state) = self.loaded(i, lanes, level, start) {
            scatter(&state, &mut self.element, i, lanes);
        }
    }

    /// State of the element in lane `i` at the start.
    fn loaded(&self, i: usize, lanes: usize, level: f64, start: &Start) -> Option<Vec<f64>> {
        let element = self.effect.element()?;
        let mut state = vec![0.0; element.states()];
        let onset = Onset { level, used: start.used, velocity: start.velocity };
        element.start(&self.parameters(i, lanes), &onset, &mut state);
        Some(state)
    }
}

fn scatter(state: &[f64], all: &mut [f64], i: usize, lanes: usize) {
    for (state, slot) in state.iter().zip(all.iter_mut().skip(i).step_by(lanes)) {
        *slot = *state;
    }
}
