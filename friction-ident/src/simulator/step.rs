//! One step of all lanes.

use super::plants::Plants;
use crate::effects::Parameters;
use crate::simd::{sign, vectorised};

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
        if s.left != duration {
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
        );
        self.call_smooth();
        self.recall();
    }

    fn elastic_piece(&mut self) {
        self.predict();
        self.call_level();
        self.balance(false);
        if !self.solve_contact() {
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
        self.scratch.displacement.fill(0.0);
        if !self.attached.is_empty() {
            self.respond_elements();
        }
        let s = &mut self.scratch;
        direct(&self.velocity, &s.drive, &s.force, &s.elements, &mut s.direction);
        self.call_level();
        let s = &mut self.scratch;
        rest(
            &self.velocity,
            &s.drive,
            &s.force,
            &s.elements,
            &s.level,
            &mut s.left,
            &mut self.dwell,
            &mut self.time,
            &mut s.taken,
        );
        // A lane that rests takes its elements through the time of its rest.
        let rests = !self.attached.is_empty();
        if rests {
            self.commit_elements();
        }
        self.balance(true);
        if self.attached.is_empty() {
            let s = &mut self.scratch;
            divide(&s.push, &s.inertia, &mut s.mean);
        } else {
            self.newton();
        }
        let s = &mut self.scratch;
        close_rigid(
            &s.mean,
            &s.direction,
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
        if rests {
            self.commit_elements();
        }
        if !self.memories.is_empty() {
            self.remember();
        }
    }

    /// Momentum balance of the piece without its elements; the friction level acts as a force where
    /// no contact carries it.
    fn balance(&mut self, rigid: bool) {
        let s = &mut self.scratch;
        let level = if rigid { &s.level } else { &s.zero };
        balance(
            &self.mass,
            &self.velocity,
            &s.left,
            &s.drive,
            &s.force,
            &s.damping,
            &s.velocity,
            level,
            &s.direction,
            &mut s.inertia,
            &mut s.push,
        );
    }

    /// Mean velocity with the elements, by Newton from no displacement.
    fn newton(&mut self) {
        self.scratch.displacement.fill(0.0);
        for _ in 0..=self.iterations {
            self.respond_elements();
            let s = &mut self.scratch;
            newton(
                &s.left,
                &s.inertia,
                &s.push,
                &s.elements,
                &s.stiffness,
                &mut s.mean,
                &mut s.displacement,
            );
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

vectorised! {
    fn advance(duration: &[f64], time: &mut [f64]) {
        for (time, duration) in time.iter_mut().zip(duration) {
            *time += duration;
        }
    }

    /// Time at rest; it begins anew where a slide ends.
    fn count_rest(slides: &[f64], left: &[f64], sliding: &mut [f64], dwell: &mut [f64]) {
        let n = slides.len();
        let (left, sliding, dwell) = (&left[..n], &mut sliding[..n], &mut dwell[..n]);
        for i in 0..n {
            let rests = slides[i] == 0.0;
            let before = if rests && sliding[i] > 0.0 { 0.0 } else { dwell[i] };
            dwell[i] = before + if rests { left[i] } else { 0.0 };
            sliding[i] = slides[i];
        }
    }

    fn displace(left: &[f64], mean: &[f64], displacement: &mut [f64]) {
        for ((displacement, left), mean) in displacement.iter_mut().zip(left).zip(mean) {
            *displacement = left * mean;
        }
    }

    fn divide(push: &[f64], inertia: &[f64], mean: &mut [f64]) {
        for ((mean, push), inertia) in mean.iter_mut().zip(push).zip(inertia) {
            *mean = push / inertia;
        }
    }

    fn predict(
        x: &[f64],
        v: &[f64],
        slope: &[f64],
        left: &[f64],
        time: &[f64],
        middle: &mut [f64],
        predicted: &mut [f64],
        direction: &mut [f64],
        when: &mut [f64],
    ) {
        let n = x.len();
        let (v, slope, left, time) = (&v[..n], &slope[..n], &left[..n], &time[..n]);
        let (middle, predicted) = (&mut middle[..n], &mut predicted[..n]);
        let (direction, when) = (&mut direction[..n], &mut when[..n]);
        for i in 0..n {
            let half = 0.5 * left[i];
            when[i] = time[i] + half;
            let s = sign(v[i]);
            middle[i] = x[i] + half * v[i];
            // The prediction stays on this side of a stop: what comes behind it is another piece.
            let along = (v[i] + half * slope[i]) * s;
            predicted[i] = if along < 0.0 { 0.0 } else { along * s };
            direction[i] = s;
        }
    }

    /// Direction in which a lane at rest is pushed.
    fn direct(v: &[f64], drive: &[f64], force: &[f64], elements: &[f64], direction: &mut [f64]) {
        let n = v.len();
        let (drive, force) = (&drive[..n], &force[..n]);
        let (elements, direction) = (&elements[..n], &mut direction[..n]);
        for i in 0..n {
            let pushed = sign(drive[i] - force[i] - elements[i]);
            direction[i] = if v[i] == 0.0 { pushed } else { direction[i] };
        }
    }

    /// Lanes at rest with less than the level upon them spend what is left at rest.
    fn rest(
        v: &[f64],
        drive: &[f64],
        force: &[f64],
        elements: &[f64],
        level: &[f64],
        left: &mut [f64],
        dwell: &mut [f64],
        time: &mut [f64],
        taken: &mut [f64],
    ) {
        let n = v.len();
        let (drive, force, elements) = (&drive[..n], &force[..n], &elements[..n]);
        let (level, left, dwell) = (&level[..n], &mut left[..n], &mut dwell[..n]);
        let (time, taken) = (&mut time[..n], &mut taken[..n]);
        for i in 0..n {
            let applied = drive[i] - force[i] - elements[i];
            let rests = v[i] == 0.0 && applied.abs() <= level[i];
            let spent = if rests { left[i] } else { 0.0 };
            dwell[i] += spent;
            time[i] += spent;
            taken[i] = spent;
            left[i] -= spent;
        }
    }

    fn balance(
        mass: &[f64],
        v: &[f64],
        left: &[f64],
        drive: &[f64],
        force: &[f64],
        damping: &[f64],
        predicted: &[f64],
        level: &[f64],
        direction: &[f64],
        inertia: &mut [f64],
        push: &mut [f64],
    ) {
        let n = mass.len();
        let (v, left, drive, force) = (&v[..n], &left[..n], &drive[..n], &force[..n]);
        let (damping, predicted) = (&damping[..n], &predicted[..n]);
        let (level, direction) = (&level[..n], &direction[..n]);
        let (inertia, push) = (&mut inertia[..n], &mut push[..n]);
        for i in 0..n {
            let slope = if damping[i] < 0.0 { 0.0 } else { damping[i] };
            let others = drive[i] - force[i] - level[i] * direction[i] + slope * predicted[i];
            inertia[i] = 2.0 * mass[i] + left[i] * slope;
            push[i] = 2.0 * mass[i] * v[i] + left[i] * others;
        }
    }

    fn newton(
        left: &[f64],
        inertia: &[f64],
        push: &[f64],
        elements: &[f64],
        stiffness: &[f64],
        mean: &mut [f64],
        displacement: &mut [f64],
    ) {
        let n = left.len();
        let (inertia, push, elements) = (&inertia[..n], &push[..n], &elements[..n]);
        let (stiffness, mean) = (&stiffness[..n], &mut mean[..n]);
        let displacement = &mut displacement[..n];
        for i in 0..n {
            let r = left[i];
            let linear = elements[i] - stiffness[i] * displacement[i];
            mean[i] = (push[i] - r * linear) / (inertia[i] + r * r * stiffness[i]);
            displacement[i] = r * mean[i];
        }
    }

    fn close_elastic(
        left: &[f64],
        rate: &[f64],
        mean: &[f64],
        x: &mut [f64],
        v: &mut [f64],
        slope: &mut [f64],
        time: &mut [f64],
    ) {
        let n = left.len();
        let (rate, mean) = (&rate[..n], &mean[..n]);
        let (x, v, slope, time) = (&mut x[..n], &mut v[..n], &mut slope[..n], &mut time[..n]);
        for i in 0..n {
            let moves = left[i] > 0.0;
            let change = if moves { 2.0 * (mean[i] - v[i]) } else { 0.0 };
            slope[i] = if moves { change * rate[i] } else { slope[i] };
            x[i] += left[i] * mean[i];
            v[i] += change;
            time[i] += left[i];
        }
    }

    fn invert(duration: &[f64], rate: &mut [f64]) {
        for (rate, duration) in rate.iter_mut().zip(duration) {
            *rate = 1.0 / duration;
        }
    }

    /// Takes the piece, up to the stop where there is one in it.
    fn close_rigid(
        mean: &[f64],
        direction: &[f64],
        left: &mut [f64],
        displacement: &mut [f64],
        taken: &mut [f64],
        x: &mut [f64],
        v: &mut [f64],
        slope: &mut [f64],
        dwell: &mut [f64],
        sliding: &mut [f64],
        time: &mut [f64],
    ) {
        let n = mean.len();
        let (direction, left) = (&direction[..n], &mut left[..n]);
        let (displacement, taken) = (&mut displacement[..n], &mut taken[..n]);
        let (x, v, slope) = (&mut x[..n], &mut v[..n], &mut slope[..n]);
        let (dwell, sliding, time) = (&mut dwell[..n], &mut sliding[..n], &mut time[..n]);
        for i in 0..n {
            let (r, v0) = (left[i], v[i]);
            let moves = r > 0.0;
            let change = 2.0 * (mean[i] - v0);
            let end = v0 + change;
            let stops = moves && end * direction[i] <= 0.0;
            // A lane that cannot leave its rest, because the level rises with speed, stays there.
            let held = stops && v0 == 0.0;
            // Constant acceleration up to the stop.
            let share = if stops && !held { -v0 / change } else { 1.0 };
            let spent = share * r;
            let moved = if stops { 0.5 * v0 * spent } else { r * mean[i] };
            taken[i] = if moves { spent } else { 0.0 };
            displacement[i] = if moves { moved } else { 0.0 };
            x[i] += displacement[i];
            time[i] += taken[i];
            slope[i] = if held { 0.0 } else if moves { change / r } else { slope[i] };
            dwell[i] = if held { dwell[i] + r } else if stops { 0.0 } else { dwell[i] };
            v[i] = if stops { 0.0 } else if moves { end } else { v0 };
            sliding[i] = if moves { if stops { 0.0 } else { 1.0 } } else { sliding[i] };
            left[i] = if stops && !held { r - spent } else { 0.0 };
        }
    }
}
