//! One step of all lanes.

use super::kernels::{
    advance, balance, balance_elastic, close_elastic, close_rigid, count_rest, differ, direct,
    displace, divide, invert, keep_positive, newton, predict, rest,
};
use super::plants::Plants;
use crate::effects::Parameters;

/// Events within one step after which a lane rests for what is left of it. A step has two in a
/// reversal; more come from a step that is too long for the plant.
const MAX_PIECES: usize = 6;

impl Plants {
    /// Advances every lane by its `duration` (s) under its `command`, the mean over the step.
    pub fn step(&mut self, duration: &[f64], command: &[f64]) {
        if !self.fresh.is_empty() {
            self.load_elements();
        }
        self.call_drives(duration, command);
        if self.contact.is_some() {
            self.set_duration(duration);
            self.elastic_piece();
        } else {
            self.scratch.left.copy_from_slice(duration);
            self.rigid_pieces();
        }
        if self.past.is_kept() {
            self.past.push(&self.time, &self.velocity);
        }
    }

    /// An elastic step is one piece: its length and the rate that belongs to it seldom change.
    fn set_duration(&mut self, duration: &[f64]) {
        let s = &mut self.scratch;
        let mut changed = true;
        differ(&s.left, duration, &mut changed);
        if changed {
            s.left.copy_from_slice(duration);
            invert(duration, &mut s.rate);
        }
    }

    fn rigid_pieces(&mut self) {
        for _ in 0..MAX_PIECES {
            self.rigid_piece();
            if self.scratch.left.iter().all(|left| *left <= 0.0) {
                return;
            }
        }
        // What is left after so many events is spent at rest.
        advance(&self.scratch.left, &mut self.time);
    }

    /// Middle of the piece that is left, the smooth forces there, and what memories say.
    fn predict(&mut self) {
        let s = &mut self.scratch;
        predict(
            &self.position,
            &self.velocity,
            &self.slope,
            &s.left,
            &self.time,
            &mut s.position,
            &mut s.velocity,
            &mut s.direction,
            &mut s.time,
            &mut s.force,
            &mut s.damping,
            &mut s.level,
        );
        self.call_smooth();
        self.recall();
    }

    fn elastic_piece(&mut self) {
        self.predict();
        self.call_level();
        let s = &mut self.scratch;
        balance_elastic(
            &self.mass,
            &self.velocity,
            &s.left,
            &s.drive,
            &s.force,
            &s.damping,
            &s.velocity,
            &mut s.level,
            &mut s.inertia,
            &mut s.push,
        );
        if !self.solve_contact() {
            // From no displacement what a contact gives is concave on either side: Newton comes from below.
            self.scratch.displacement.fill(0.0);
            self.newton();
            self.scratch.taken.copy_from_slice(&self.scratch.left);
            self.commit_elements();
        }
        let s = &mut self.scratch;
        close_elastic(
            &s.left,
            &s.rate,
            &s.mean,
            &mut self.position,
            &mut self.velocity,
            &mut self.slope,
            &mut self.time,
        );
        self.watch_contact();
    }

    fn rigid_piece(&mut self) {
        self.predict();
        let attached = !self.attached.is_empty();
        // Only where a lane stands it matters what its elements do while it does not move.
        if attached && self.velocity.contains(&0.0) {
            self.scratch.displacement.fill(0.0);
            self.scratch.open.copy_from_slice(&self.scratch.left);
            self.respond_elements();
        }
        let s = &mut self.scratch;
        direct(&self.velocity, &s.drive, &s.force, &s.elements, &mut s.direction);
        self.call_level();
        let s = &mut self.scratch;
        keep_positive(&mut s.level);
        rest(
            &self.velocity,
            &s.drive,
            &s.force,
            &s.elements,
            &s.level,
            &mut s.left,
            &mut self.slope,
            &mut self.dwell,
            &mut self.time,
            &mut s.taken,
        );
        self.balance();
        if attached {
            // A second body is soft and stiff in turn: most likely the mass goes on as it does.
            let s = &mut self.scratch;
            displace(&s.left, &self.velocity, &mut s.displacement);
            self.newton();
        } else {
            let s = &mut self.scratch;
            divide(&s.push, &s.inertia, &mut s.mean);
        }
        let s = &mut self.scratch;
        close_rigid(
            &s.mean,
            &s.direction,
            &s.level,
            &mut s.left,
            &mut s.displacement,
            &mut s.taken,
            &mut self.position,
            &mut self.velocity,
            &mut self.slope,
            &mut self.dwell,
            &mut self.sliding,
            &mut self.time,
        );
        // A lane that rests takes its elements and memories through the time of its rest.
        if attached {
            self.commit_elements();
        }
        if !self.memories.is_empty() {
            self.remember();
        }
    }

    /// Momentum balance of the piece without its elements, with the friction level as a force.
    fn balance(&mut self) {
        let s = &mut self.scratch;
        balance(
            &self.mass,
            &self.velocity,
            &s.left,
            &s.drive,
            &s.force,
            &s.damping,
            &s.velocity,
            &s.level,
            &s.direction,
            &mut s.inertia,
            &mut s.push,
        );
    }

    /// Mean velocity with the elements, by Newton from the displacement at hand.
    fn newton(&mut self) {
        self.scratch.open.copy_from_slice(&self.scratch.left);
        for _ in 0..=self.iterations {
            self.respond_elements();
            let mut any_open = false;
            let s = &mut self.scratch;
            newton(
                &s.left,
                &s.inertia,
                &s.push,
                &s.elements,
                &s.stiffness,
                &mut s.mean,
                &mut s.displacement,
                &mut s.open,
                &mut any_open,
            );
            if !any_open {
                break;
            }
        }
    }

    /// Rest and sliding of an elastic contact, and the memories that depend on it.
    fn watch_contact(&mut self) {
        let watched = !self.memories.is_empty() || self.reads_dwell;
        let Some(k) = self.contact.filter(|_| watched) else { return };
        let (active, s) = (&self.effects[k], &mut self.scratch);
        let Some(element) = active.effect.element() else { return };
        let p = Parameters::new(&active.values, self.lanes);
        element.sliding(p, &s.level, &active.element, &mut s.taken);
        count_rest(&s.taken, &s.left, &mut self.sliding, &mut self.dwell);
        if !self.memories.is_empty() {
            let s = &mut self.scratch;
            s.taken.copy_from_slice(&s.left);
            displace(&s.left, &s.mean, &mut s.displacement);
            self.remember();
        }
    }
}
