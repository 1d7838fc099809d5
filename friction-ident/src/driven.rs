//! The plant driven along a measured motion: which force must the drive command so that the model
//! follows the measurement?
//!
//! `F = m a + smooth forces + level h`: `h` is the direction of sliding, or what the elastic contact
//! makes of the measured displacements. The effects' hooks are those of the simulator; effects
//! without memory take one lane per sample.

use std::borrow::Cow;
use std::ops::Range;

use crate::effects::{
    Effect, Leg, Motion, Onset, ParameterRole, Parameters, Shown, Slot, Smooth, broadcast,
};
use crate::model::{MASS, Model, ModelEffect, address};
use crate::simd::sign;

mod memory;

/// Samples that go through the hooks at once: large enough to hide the calls, small enough for the
/// first-level cache.
const BLOCK: usize = 128;
/// Samples over which the load of a contact at the start of a segment is averaged.
const STARTING: usize = 5;

/// Channels of a motion that do not fit together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MotionError {
    /// A channel has more or fewer values than there are times.
    #[error("{channel} has {values} values, but there are {samples} times")]
    Length {
        /// Which channel.
        channel: &'static str,
        /// Its values.
        values: usize,
        /// Number of times.
        samples: usize,
    },
    /// A segment reaches beyond the samples.
    #[error("segment {start}..{end} reaches beyond the {samples} samples")]
    Segment {
        /// First sample.
        start: usize,
        /// One past the last sample.
        end: usize,
        /// Number of times.
        samples: usize,
    },
}

/// A measured, smoothed motion. SI units.
#[derive(Clone, Debug)]
pub struct MeasuredMotion<'a> {
    time: &'a [f64],
    position: &'a [f64],
    velocity: &'a [f64],
    acceleration: &'a [f64],
    drive_force: Option<&'a [f64]>,
    segments: Vec<Range<usize>>,
    rest_velocity: f64,
    cutoff: f64,
}

/// Share of the top speed below which a motion counts as rest, unless something else is asked for.
const REST: f64 = 1e-3;

impl<'a> MeasuredMotion<'a> {
    /// One piece of motion, one value per time.
    ///
    /// # Errors
    /// [`MotionError::Length`].
    pub fn new(
        time: &'a [f64],
        position: &'a [f64],
        velocity: &'a [f64],
        acceleration: &'a [f64],
    ) -> Result<Self, MotionError> {
        check("position", position, time)?;
        check("velocity", velocity, time)?;
        check("acceleration", acceleration, time)?;
        let segments = std::iter::once(0..time.len()).collect();
        let rest_velocity = REST * velocity.iter().fold(0.0, |top: f64, v| top.max(v.abs()));
        let drive_force = None;
        let cutoff = f64::INFINITY;
        Ok(Self {
            time,
            position,
            velocity,
            acceleration,
            drive_force,
            segments,
            rest_velocity,
            cutoff,
        })
    }

    /// The same in several pieces; contact and memory start anew in each.
    ///
    /// # Errors
    /// [`MotionError::Segment`].
    pub fn with_segments(mut self, segments: &[Range<usize>]) -> Result<Self, MotionError> {
        let samples = self.time.len();
        if let Some(bad) = segments.iter().find(|s| s.end > samples || s.start > s.end) {
            return Err(MotionError::Segment { start: bad.start, end: bad.end, samples });
        }
        self.segments = segments.to_vec();
        Ok(self)
    }

    /// The same with the measured force of the drive, for effects that depend on the load.
    ///
    /// # Errors
    /// [`MotionError::Length`].
    pub fn with_drive_force(mut self, force: &'a [f64]) -> Result<Self, MotionError> {
        check("drive force", force, self.time)?;
        self.drive_force = Some(force);
        Ok(self)
    }

    /// The same with rest wherever the speed is at most `velocity`, for effects that depend on the
    /// time at rest. Without it, rest is below 0.1 % of the top speed.
    #[must_use]
    pub fn with_rest_velocity(mut self, velocity: f64) -> Self {
        self.rest_velocity = velocity;
        self
    }

    /// The same of a motion whose smoother lets half of an amplitude pass at `frequency`, Hz, for
    /// errors of the sensor: what was smoothed away needs no correction.
    #[must_use]
    pub fn with_cutoff(mut self, frequency: f64) -> Self {
        self.cutoff = frequency;
        self
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Mean direction of motion from half a step before each sample to half a step after: the sign of
    /// the velocity, except where it changes. A sign at the sample alone would be off by up to half a step,
    /// which at a reversal is a pulse of the whole friction.
    pub(crate) fn sliding(&self) -> Vec<f64> {
        let mut mean: Vec<f64> = self.velocity.iter().map(|v| sign(*v)).collect();
        for segment in &self.segments {
            let v = &self.velocity[segment.clone()];
            for k in 1..v.len().saturating_sub(1) {
                let half = |other: f64| mean_sign(f64::midpoint(v[k], other), v[k]);
                let changes = v[k - 1] * v[k] < 0.0 || v[k] * v[k + 1] < 0.0;
                if changes {
                    mean[segment.start + k] = 0.5 * (half(v[k - 1]) + half(v[k + 1]));
                }
            }
        }
        mean
    }
}

fn check(channel: &'static str, values: &[f64], time: &[f64]) -> Result<(), MotionError> {
    let (values, samples) = (values.len(), time.len());
    if values == samples { Ok(()) } else { Err(MotionError::Length { channel, values, samples }) }
}

/// The force that the drive must command for `model` to follow `motion`, N or N m.
pub fn force_along(model: &Model, motion: &MeasuredMotion<'_>) -> Vec<f64> {
    let corrected = Corrected::of(model, motion);
    let motion = &corrected.motion(motion);
    let walk = Walk::new(model, motion);
    let mut force = walk.smooth.clone();
    for ((force, friction), a) in force.iter_mut().zip(&walk.friction).zip(motion.acceleration) {
        *force += friction + model.mass() * a;
    }
    add(&mut force, &walk.attached);
    walk.invert_drive(model, &mut force);
    walk.withhold(model, &mut force);
    force
}

/// The force of [`force_along`] as `rest + sum_k value_k column_k` over the mass and all amplitude
/// parameters. Exact without a contact; with one, the contact's utilisation `h` is the model's own.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Address of each column.
    pub addresses: Vec<String>,
    /// Force per unit of the parameter, one value per sample.
    pub columns: Vec<Vec<f64>>,
    /// Force of whatever has no amplitude.
    pub rest: Vec<f64>,
}

/// Mean sign of a velocity that goes linearly from `from` to `to`.
fn mean_sign(from: f64, to: f64) -> f64 {
    if from * to < 0.0 { (from + to) / (from.abs() + to.abs()) } else { sign(from + to) }
}

/// Splits [`force_along`] into columns.
pub fn columns_along(model: &Model, motion: &MeasuredMotion<'_>) -> Columns {
    let corrected = Corrected::of(model, motion);
    let motion = &corrected.motion(motion);
    let walk = Walk::new(model, motion);
    let mut addresses = vec![MASS.to_owned()];
    let mut columns = vec![motion.acceleration.to_vec()];
    for term in model.terms() {
        let about = term.effect().about();
        for (k, parameter) in about.parameters.iter().enumerate() {
            if parameter.role == ParameterRole::Amplitude {
                addresses.push(address(term.effect(), parameter.name));
                columns.push(walk.column(term, k));
            }
        }
    }
    let mut rest = walk.attached.clone();
    rest.resize(motion.len(), 0.0);
    for column in columns.iter_mut().chain(std::iter::once(&mut rest)) {
        walk.invert_drive(model, column);
    }
    walk.withhold(model, &mut rest);
    Columns { addresses, columns, rest }
}

/// A motion without the errors of the model's sensor.
struct Corrected<'a> {
    position: Cow<'a, [f64]>,
    velocity: Cow<'a, [f64]>,
    acceleration: Cow<'a, [f64]>,
}

impl<'a> Corrected<'a> {
    fn of(model: &Model, motion: &MeasuredMotion<'a>) -> Self {
        let mut corrected = Self {
            position: motion.position.into(),
            velocity: motion.velocity.into(),
            acceleration: motion.acceleration.into(),
        };
        for term in model.terms() {
            let Some(sensor) = term.effect().sensor() else { continue };
            let shown = &mut Shown {
                position: corrected.position.to_mut(),
                velocity: corrected.velocity.to_mut(),
                acceleration: corrected.acceleration.to_mut(),
                cutoff: motion.cutoff,
            };
            sensor.correct(term.values(), shown);
        }
        corrected
    }

    fn motion(&'a self, motion: &MeasuredMotion<'a>) -> MeasuredMotion<'a> {
        MeasuredMotion {
            position: &self.position,
            velocity: &self.velocity,
            acceleration: &self.acceleration,
            ..motion.clone()
        }
    }
}

/// A model's friction along a motion.
struct Walk<'a> {
    motion: &'a MeasuredMotion<'a>,
    direction: Vec<f64>,
    level_velocity: Cow<'a, [f64]>,
    dwell: Vec<f64>,
    bond: Vec<f64>,
    /// Level that memories add; empty without any.
    remembered: Vec<f64>,
    drive_force: Cow<'a, [f64]>,
    /// Force of everything smooth.
    smooth: Vec<f64>,
    mass: f64,
    /// Whether the model stands beside a given force.
    beside: bool,
    /// Friction force.
    friction: Vec<f64>,
    /// Utilisation of the friction level, -1..1.
    used: Vec<f64>,
    /// Force of attached bodies; empty without any.
    attached: Vec<f64>,
}

impl<'a> Walk<'a> {
    fn new(model: &Model, motion: &'a MeasuredMotion<'a>) -> Self {
        let samples = motion.len();
        let drive_force = motion.drive_force.map_or_else(|| vec![0.0; samples].into(), Cow::from);
        let mut walk = Self {
            motion,
            direction: motion.velocity.iter().map(|v| sign(*v)).collect(),
            level_velocity: Cow::from(motion.velocity),
            dwell: vec![0.0; samples],
            bond: vec![1.0; samples],
            remembered: Vec::new(),
            drive_force,
            smooth: Vec::new(),
            mass: model.mass(),
            beside: model.timing().is_some(),
            friction: Vec::new(),
            used: Vec::new(),
            attached: Vec::new(),
        };
        if model.terms().iter().any(|term| term.effect().reads_dwell()) {
            walk.dwell = memory::dwell(motion);
        }
        walk.recall(model.terms());
        walk.smooth = walk.smooth_force(model.terms());
        let level = walk.friction_level(model.terms());
        let breakaway = walk.breakaway(model.terms(), &level);
        walk.slide(model, &level, &breakaway);
        for term in model.terms().iter().filter(|t| t.effect().about().acts_on(Slot::Attached)) {
            let force = walk.element(term, &vec![0.0; samples], &vec![0.0; samples]);
            walk.attached.resize(samples, 0.0);
            add(&mut walk.attached, &force);
            if walk.beside {
                walk.release(term);
            }
        }
        walk
    }

    /// Friction force and utilisation at `level`.
    fn slide(&mut self, model: &Model, level: &[f64], breakaway: &[f64]) {
        let contact = model.terms().iter().find(|t| t.effect().about().acts_on(Slot::Contact));
        if let Some(contact) = contact {
            self.friction = self.element(contact, level, breakaway);
            let used =
                |(force, level): (&f64, &f64)| if *level > 0.0 { force / level } else { 0.0 };
            self.used = self.friction.iter().zip(level).map(used).collect();
        } else {
            self.used = self.motion.sliding();
            self.friction = level.iter().zip(&self.used).map(|(l, used)| l * used).collect();
        }
    }

    /// Takes away what an attached body would be if it were fixed to the mass: the given force has that already.
    fn release(&mut self, term: &ModelEffect) {
        let about = term.effect().about();
        let value = |name: &str| about.parameter(name).map_or(0.0, |k| term.values()[k]);
        let (mass, level, damping) = (value("m_L"), value("F_L"), value("d_L"));
        let sliding = self.motion.sliding();
        for (k, force) in self.attached.iter_mut().enumerate() {
            *force -= mass * self.motion.acceleration[k]
                + level * sliding[k]
                + damping * self.motion.velocity[k];
        }
    }

    /// Force of a term's element along the motion.
    fn element(&self, term: &ModelEffect, level: &[f64], breakaway: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; self.motion.len()];
        let Some(element) = term.effect().element() else { return force };
        let mut state = vec![0.0; element.states()];
        for segment in self.motion.segments.iter().filter(|segment| !segment.is_empty()) {
            let path = self.path(segment, level, breakaway);
            let level = level[segment.start];
            let used = self.used_at_start(segment, level);
            let velocity = self.motion.velocity[segment.start];
            element.start(term.values(), &Onset { level, used, velocity }, &mut state);
            element.along(term.values(), &path, &mut state, &mut force[segment.clone()]);
        }
        force
    }

    /// Utilisation of the friction level at the start of a segment. A contact that starts at rest and
    /// never slides keeps its first load for ever, so that it matters: at rest it carries what the
    /// drive, less the inertia, puts on it.
    fn used_at_start(&self, segment: &Range<usize>, level: f64) -> f64 {
        let first = self.direction[segment.clone()].iter().find(|d| **d != 0.0);
        let sliding = first.copied().unwrap_or(0.0);
        if self.motion.drive_force.is_none() || level <= 0.0 {
            return sliding;
        }
        let window = segment.start..segment.end.min(segment.start + STARTING);
        let count = window.len() as f64;
        let load = |k: usize| {
            self.drive_force[k] - self.smooth[k] - self.mass * self.motion.acceleration[k]
        };
        (window.map(load).sum::<f64>() / count / level).clamp(-1.0, 1.0)
    }

    /// The steps to the samples of a segment.
    fn path(&self, segment: &Range<usize>, level: &[f64], breakaway: &[f64]) -> Vec<Leg> {
        let (time, position) = (self.motion.time, self.motion.position);
        let step = |k: usize| {
            let before = if k == segment.start { k } else { k - 1 };
            Leg {
                duration: time[k] - time[before],
                displacement: position[k] - position[before],
                level: level[k],
                breakaway: breakaway[k],
            }
        };
        segment.clone().map(step).collect()
    }

    fn smooth_force(&self, terms: &[ModelEffect]) -> Vec<f64> {
        let mut damping = [0.0; BLOCK];
        self.sum(terms, Slot::SmoothForce, |effect, p, m, force| {
            let damping = &mut damping[..force.len()];
            effect.smooth_force(p, m, &mut Smooth { force, damping });
        })
    }

    fn friction_level(&self, terms: &[ModelEffect]) -> Vec<f64> {
        let mut level = self.sum(terms, Slot::FrictionLevel, |effect, p, m, level| {
            effect.friction_level(p, m, level);
        });
        add(&mut level, &self.remembered);
        // Beside a given force only what its level lacks is known, which may be negative.
        if !self.beside {
            for level in &mut level {
                *level = level.max(0.0);
            }
        }
        level
    }

    /// Friction level at rest, where the contact wants it.
    fn breakaway(&self, terms: &[ModelEffect], level: &[f64]) -> Vec<f64> {
        let mut elements = terms.iter().filter_map(|term| term.effect().element());
        if !elements.any(crate::effects::Element::needs_breakaway) {
            return level.to_vec();
        }
        let rest = [0.0; BLOCK];
        let mut breakaway = self.sum(terms, Slot::FrictionLevel, |effect, p, m, level| {
            let rest = &rest[..level.len()];
            let m = Motion { velocity: rest, acceleration: rest, level_velocity: rest, ..*m };
            effect.friction_level(p, &m, level);
        });
        add(&mut breakaway, &self.remembered);
        breakaway
    }

    /// Column of amplitude `k` of `term`.
    fn column(&self, term: &ModelEffect, k: usize) -> Vec<f64> {
        let unit = &[term.with_unit_amplitude(k)];
        let mut column = self.smooth_force(unit);
        // Not `friction_level`: a column may be negative, only the sum of all is cut off.
        let mut level =
            self.sum(unit, Slot::FrictionLevel, |e, p, m, out| e.friction_level(p, m, out));
        if unit[0].effect().about().acts_on(Slot::Memory) {
            add(&mut level, &self.remembered_by(&unit[0]));
        }
        for ((column, level), used) in column.iter_mut().zip(level).zip(&self.used) {
            *column += level * used;
        }
        column
    }

    /// Sums a hook over all terms that act on `slot`, block by block.
    fn sum(
        &self,
        terms: &[ModelEffect],
        slot: Slot,
        mut hook: impl FnMut(&dyn Effect, Parameters<'_>, &Motion<'_>, &mut [f64]),
    ) -> Vec<f64> {
        let active: Vec<(&dyn Effect, Vec<f64>)> = terms
            .iter()
            .filter(|term| term.effect().about().acts_on(slot))
            .map(|term| (term.effect(), broadcast(term.values(), BLOCK)))
            .collect();
        let mut out = vec![0.0; self.motion.len()];
        for (block, out) in out.chunks_mut(BLOCK).enumerate() {
            let start = block * BLOCK;
            let motion = self.motion_of(start..start + out.len());
            for (effect, values) in &active {
                hook(*effect, Parameters::new(values, BLOCK), &motion, out);
            }
        }
        out
    }

    fn motion_of(&self, r: Range<usize>) -> Motion<'_> {
        Motion {
            time: &self.motion.time[r.clone()],
            position: &self.motion.position[r.clone()],
            velocity: &self.motion.velocity[r.clone()],
            acceleration: &self.motion.acceleration[r.clone()],
            direction: &self.direction[r.clone()],
            level_velocity: &self.level_velocity[r.clone()],
            dwell: &self.dwell[r.clone()],
            bond: &self.bond[r.clone()],
            drive_force: &self.drive_force[r],
        }
    }

    /// Replaces the force on the mass by the command that causes it.
    fn invert_drive(&self, model: &Model, force: &mut [f64]) {
        for term in model.terms().iter().rev() {
            let Some(drive) = term.effect().drive() else { continue };
            for segment in &self.motion.segments {
                let time = &self.motion.time[segment.clone()];
                drive.invert(term.values(), time, &mut force[segment.clone()]);
            }
        }
    }

    /// Adds what the drive never delivers of the recorded command.
    fn withhold(&self, model: &Model, force: &mut [f64]) {
        for drive in model.terms().iter().filter_map(|term| Some((term, term.effect().drive()?))) {
            drive.1.withhold(drive.0.values(), &self.drive_force, force);
        }
    }
}

fn add(to: &mut [f64], from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
}

#[cfg(test)]
mod tests;
