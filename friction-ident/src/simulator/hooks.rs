//! Calls of the effects' hooks for all lanes.

use super::kernels::keep_positive;
use super::plants::Plants;
use crate::effects::{
    Advance, Balance, Memory, Motion, Parameters, Recalled, Response, Smooth, Step, Taken,
};
use crate::simd::vectorised;

impl Plants {
    pub(super) fn call_drives(&mut self, duration: &[f64], command: &[f64]) {
        let Self { effects, drives, scratch: s, time, lanes, .. } = self;
        s.drive.copy_from_slice(command);
        if drives.is_empty() {
            return;
        }
        add(time, duration, &mut s.time);
        for k in drives.iter() {
            let active = &mut effects[*k];
            let Some(drive) = active.effect.drive() else { continue };
            if active.past.is_kept() {
                for (i, integral) in s.mean.iter_mut().enumerate() {
                    *integral = active.past.newest(i).1 + duration[i] * s.drive[i];
                }
                active.past.push(&s.time, &s.mean);
            }
            let step = Advance { duration, end: &s.time, past: &active.past };
            let p = Parameters::new(&active.values, *lanes);
            drive.advance(p, &step, &mut active.drive, &mut s.drive);
        }
    }

    /// Adds the smooth forces to what the prediction has set to 0.
    pub(super) fn call_smooth(&mut self) {
        let Self { effects, smooth, scratch: s, slope, dwell, lanes, .. } = self;
        let motion = Motion {
            time: &s.time,
            position: &s.position,
            velocity: &s.velocity,
            acceleration: slope,
            direction: &s.direction,
            level_velocity: &s.velocity,
            dwell,
            bond: &s.bond,
            drive_force: &s.drive,
        };
        for k in smooth.iter() {
            let active = &effects[*k];
            let mut out = Smooth { force: &mut s.force, damping: &mut s.damping };
            let p = Parameters::new(&active.values, *lanes);
            active.effect.smooth_force(p, &motion, &mut out);
        }
    }

    /// Lets the memories say what the level sees.
    pub(super) fn recall(&mut self) {
        let Self { effects, memories, scratch: s, slope, dwell, past, lanes, .. } = self;
        if memories.is_empty() {
            return;
        }
        s.level_velocity.copy_from_slice(&s.velocity);
        s.bond.fill(1.0);
        s.remembered.fill(0.0);
        let motion = Motion {
            time: &s.time,
            position: &s.position,
            velocity: &s.velocity,
            acceleration: slope,
            direction: &s.direction,
            level_velocity: &s.velocity,
            dwell,
            bond: &s.zero,
            drive_force: &s.drive,
        };
        for k in memories.iter() {
            let active = &effects[*k];
            let Some(memory) = active.effect.memory() else { continue };
            let mut out = Recalled {
                level_velocity: &mut s.level_velocity,
                bond: &mut s.bond,
                level: &mut s.remembered,
            };
            let p = Parameters::new(&active.values, *lanes);
            memory.recall(p, &motion, past, &active.memory, &mut out);
        }
    }

    /// Adds up the friction level from 0, not yet cut off at 0, and that at rest where the contact wants it.
    pub(super) fn call_level(&mut self) {
        if !self.memories.is_empty() {
            self.scratch.level.copy_from_slice(&self.scratch.remembered);
        }
        self.sum_level(false);
        let contact = self.contact.and_then(|k| self.effects[k].effect.element());
        if contact.is_some_and(crate::effects::Element::needs_breakaway) {
            std::mem::swap(&mut self.scratch.level, &mut self.scratch.breakaway);
            self.scratch.level.copy_from_slice(&self.scratch.remembered);
            self.sum_level(true);
            keep_positive(&mut self.scratch.level);
            std::mem::swap(&mut self.scratch.level, &mut self.scratch.breakaway);
        }
    }

    fn sum_level(&mut self, at_rest: bool) {
        let Self { effects, level, memories, scratch: s, slope, dwell, lanes, .. } = self;
        let seen = if memories.is_empty() { &s.velocity } else { &s.level_velocity };
        let motion = Motion {
            time: &s.time,
            position: &s.position,
            velocity: if at_rest { &s.zero } else { &s.velocity },
            acceleration: if at_rest { &s.zero } else { slope },
            direction: &s.direction,
            level_velocity: if at_rest { &s.zero } else { seen },
            dwell,
            bond: &s.bond,
            drive_force: &s.drive,
        };
        for k in level.iter() {
            let active = &effects[*k];
            let p = Parameters::new(&active.values, *lanes);
            active.effect.friction_level(p, &motion, &mut s.level);
        }
    }

    /// Solves the balance in closed form where a contact is the only element and can.
    pub(super) fn solve_contact(&mut self) -> bool {
        let Self { effects, contact, attached, scratch: s, lanes, .. } = self;
        let Some(k) = contact.filter(|_| attached.is_empty()) else { return false };
        let active = &mut effects[k];
        let Some(element) = active.effect.element() else { return false };
        let balance = Balance {
            duration: &s.left,
            inertia: &s.inertia,
            push: &s.push,
            level: &s.level,
            breakaway: &s.breakaway,
        };
        let p = Parameters::new(&active.values, *lanes);
        element.solve(p, &balance, &mut active.element, &mut s.mean)
    }

    /// Mean force and stiffness of the elements at the displacement so far.
    pub(super) fn respond_elements(&mut self) {
        let Self { effects, contact, attached, scratch: s, lanes, .. } = self;
        s.elements.fill(0.0);
        s.stiffness.fill(0.0);
        for k in attached.iter().chain(contact.iter()) {
            let active = &effects[*k];
            let Some(element) = active.effect.element() else { continue };
            let is_contact = Some(*k) == *contact;
            let step = Step {
                duration: &s.left,
                open: &s.open,
                displacement: &s.displacement,
                level: if is_contact { &s.level } else { &s.zero },
                breakaway: if is_contact { &s.breakaway } else { &s.zero },
            };
            let mut out = Response { force: &mut s.elements, stiffness: &mut s.stiffness };
            element.respond(
                Parameters::new(&active.values, *lanes),
                &step,
                &active.element,
                &mut out,
            );
        }
    }

    /// Takes the piece into the states of the elements.
    pub(super) fn commit_elements(&mut self) {
        let Self { effects, contact, attached, scratch: s, lanes, .. } = self;
        for k in attached.iter().chain(contact.iter()) {
            let active = &mut effects[*k];
            let Some(element) = active.effect.element() else { continue };
            let is_contact = Some(*k) == *contact;
            let step = Step {
                duration: &s.taken,
                open: &s.taken,
                displacement: &s.displacement,
                level: if is_contact { &s.level } else { &s.zero },
                breakaway: if is_contact { &s.breakaway } else { &s.zero },
            };
            element.commit(Parameters::new(&active.values, *lanes), &step, &mut active.element);
        }
    }

    /// Takes the piece into the states of the memories.
    pub(super) fn remember(&mut self) {
        let Self { effects, memories, level, scratch: s, dwell, sliding, lanes, .. } = self;
        let mut kept = memories.iter().filter_map(|k| effects[*k].effect.memory());
        if kept.any(Memory::takes_hump) {
            for k in level.iter() {
                let active = &effects[*k];
                let p = Parameters::new(&active.values, *lanes);
                active.effect.hump(p, &s.level_velocity, &mut s.hump);
            }
        }
        let taken = Taken {
            duration: &s.taken,
            displacement: &s.displacement,
            sliding,
            dwell,
            hump: &s.hump,
        };
        for k in memories.iter() {
            let active = &mut effects[*k];
            if let Some(memory) = active.effect.memory() {
                memory.remember(
                    Parameters::new(&active.values, *lanes),
                    &taken,
                    &mut active.memory,
                );
            }
        }
    }
}

vectorised! {
    fn add(a: &[f64], b: &[f64], sum: &mut [f64]) {
        for ((sum, a), b) in sum.iter_mut().zip(a).zip(b) {
            *sum = a + b;
        }
    }
}
