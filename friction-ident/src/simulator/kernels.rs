//! The arithmetic of a step, lane by lane. See the module above for the equations.

use crate::simd::{sign, vectorised};

/// Share of a displacement by which an iteration moves it that no later one mends: a few times the rounding.
const SETTLED: f64 = 1e-14;

/// Cuts off at 0, unlike `max` without hiding a NaN.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn positive(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}

vectorised! {
    pub(super) fn advance(duration: &[f64], time: &mut [f64]) {
        for (time, duration) in time.iter_mut().zip(duration) {
            *time += duration;
        }
    }

    /// Time at rest; it begins anew where a slide ends.
    pub(super) fn count_rest(slides: &[f64], left: &[f64], sliding: &mut [f64], dwell: &mut [f64]) {
        let n = slides.len();
        let (left, sliding, dwell) = (&left[..n], &mut sliding[..n], &mut dwell[..n]);
        for i in 0..n {
            let rests = slides[i] == 0.0;
            let before = if rests && sliding[i] > 0.0 { 0.0 } else { dwell[i] };
            dwell[i] = before + if rests { left[i] } else { 0.0 };
            sliding[i] = slides[i];
        }
    }

    pub(super) fn displace(left: &[f64], mean: &[f64], displacement: &mut [f64]) {
        for ((displacement, left), mean) in displacement.iter_mut().zip(left).zip(mean) {
            *displacement = left * mean;
        }
    }

    pub(super) fn divide(push: &[f64], inertia: &[f64], mean: &mut [f64]) {
        for ((mean, push), inertia) in mean.iter_mut().zip(push).zip(inertia) {
            *mean = push / inertia;
        }
    }

    pub(super) fn predict(
        x: &[f64],
        v: &[f64],
        slope: &[f64],
        left: &[f64],
        time: &[f64],
        middle: &mut [f64],
        predicted: &mut [f64],
        direction: &mut [f64],
        when: &mut [f64],
        force: &mut [f64],
        damping: &mut [f64],
        level: &mut [f64],
    ) {
        let n = x.len();
        let (v, slope, left, time) = (&v[..n], &slope[..n], &left[..n], &time[..n]);
        let (middle, predicted) = (&mut middle[..n], &mut predicted[..n]);
        let (direction, when) = (&mut direction[..n], &mut when[..n]);
        let (force, damping) = (&mut force[..n], &mut damping[..n]);
        let level = &mut level[..n];
        for i in 0..n {
            // The sums over effects begin here.
            force[i] = 0.0;
            damping[i] = 0.0;
            level[i] = 0.0;
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
    pub(super) fn direct(v: &[f64], drive: &[f64], force: &[f64], elements: &[f64], direction: &mut [f64]) {
        let n = v.len();
        let (drive, force) = (&drive[..n], &force[..n]);
        let (elements, direction) = (&elements[..n], &mut direction[..n]);
        for i in 0..n {
            let pushed = sign(drive[i] - force[i] - elements[i]);
            direction[i] = if v[i] == 0.0 { pushed } else { direction[i] };
        }
    }

    /// Lanes at rest with less than the level upon them spend what is left at rest, where nothing accelerates.
    pub(super) fn rest(
        v: &[f64],
        drive: &[f64],
        force: &[f64],
        elements: &[f64],
        level: &[f64],
        left: &mut [f64],
        slope: &mut [f64],
        dwell: &mut [f64],
        time: &mut [f64],
        taken: &mut [f64],
    ) {
        let n = v.len();
        let (drive, force, elements) = (&drive[..n], &force[..n], &elements[..n]);
        let (level, left, slope) = (&level[..n], &mut left[..n], &mut slope[..n]);
        let (dwell, time, taken) = (&mut dwell[..n], &mut time[..n], &mut taken[..n]);
        for i in 0..n {
            let applied = drive[i] - force[i] - elements[i];
            let rests = v[i] == 0.0 && applied.abs() <= level[i];
            let spent = if rests { left[i] } else { 0.0 };
            slope[i] = if spent > 0.0 { 0.0 } else { slope[i] };
            dwell[i] += spent;
            time[i] += spent;
            taken[i] = spent;
            left[i] -= spent;
        }
    }

    pub(super) fn balance(
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

    /// The same with a contact that carries the friction level, which is cut off at 0 on the way.
    pub(super) fn balance_elastic(
        mass: &[f64],
        v: &[f64],
        left: &[f64],
        drive: &[f64],
        force: &[f64],
        damping: &[f64],
        predicted: &[f64],
        level: &mut [f64],
        inertia: &mut [f64],
        push: &mut [f64],
    ) {
        let n = mass.len();
        let (v, left, drive, force) = (&v[..n], &left[..n], &drive[..n], &force[..n]);
        let (damping, predicted, level) = (&damping[..n], &predicted[..n], &mut level[..n]);
        let (inertia, push) = (&mut inertia[..n], &mut push[..n]);
        for i in 0..n {
            level[i] = positive(level[i]);
            let slope = if damping[i] < 0.0 { 0.0 } else { damping[i] };
            let others = drive[i] - force[i] + slope * predicted[i];
            inertia[i] = 2.0 * mass[i] + left[i] * slope;
            push[i] = 2.0 * mass[i] * v[i] + left[i] * others;
        }
    }

    /// Cuts off at 0.
    pub(super) fn keep_positive(values: &mut [f64]) {
        for value in values {
            *value = positive(*value);
        }
    }

    /// A step of Newton in the lanes that are open still; a lane that moves no more stays as it is, so that it ends the
    /// same beside whatever others.
    pub(super) fn newton(
        left: &[f64],
        inertia: &[f64],
        push: &[f64],
        elements: &[f64],
        stiffness: &[f64],
        mean: &mut [f64],
        displacement: &mut [f64],
        open: &mut [f64],
        any_open: &mut bool,
    ) {
        let n = left.len();
        let (inertia, push, elements) = (&inertia[..n], &push[..n], &elements[..n]);
        let (stiffness, mean) = (&stiffness[..n], &mut mean[..n]);
        let (displacement, open) = (&mut displacement[..n], &mut open[..n]);
        let mut count = 0u64;
        for i in 0..n {
            let (r, before) = (left[i], displacement[i]);
            let linear = elements[i] - stiffness[i] * before;
            let next = (push[i] - r * linear) / (inertia[i] + r * r * stiffness[i]);
            let moved = r * next;
            let goes_on = open[i] > 0.0;
            mean[i] = if goes_on { next } else { mean[i] };
            displacement[i] = if goes_on { moved } else { before };
            let settled = (moved - before).abs() <= SETTLED * moved.abs();
            open[i] = if settled { 0.0 } else { open[i] };
            count += u64::from(open[i] > 0.0);
        }
        *any_open = count > 0;
    }

    pub(super) fn close_elastic(
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

    /// Whether two slices differ anywhere: without a way out in the middle, which would keep the compiler from
    /// taking several lanes at once.
    pub(super) fn differ(a: &[f64], b: &[f64], answer: &mut bool) {
        let b = &b[..a.len()];
        let mut count = 0u64;
        for i in 0..a.len() {
            count += u64::from(a[i] != b[i]);
        }
        *answer = count > 0;
    }

    pub(super) fn invert(duration: &[f64], rate: &mut [f64]) {
        for (rate, duration) in rate.iter_mut().zip(duration) {
            *rate = 1.0 / duration;
        }
    }

    /// Takes the piece, up to the stop where there is one in it. Without a friction level there is nothing to stop
    /// for. A lane that rested has `taken` the time of its rest.
    pub(super) fn close_rigid(
        mean: &[f64],
        direction: &[f64],
        level: &[f64],
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
        let (direction, level, left) = (&direction[..n], &level[..n], &mut left[..n]);
        let (displacement, taken) = (&mut displacement[..n], &mut taken[..n]);
        let (x, v, slope) = (&mut x[..n], &mut v[..n], &mut slope[..n]);
        let (dwell, sliding, time) = (&mut dwell[..n], &mut sliding[..n], &mut time[..n]);
        for i in 0..n {
            let (r, v0) = (left[i], v[i]);
            let moves = r > 0.0;
            let change = 2.0 * (mean[i] - v0);
            let end = v0 + change;
            let stops = moves && level[i] > 0.0 && end * direction[i] <= 0.0;
            // A lane that cannot leave its rest, because the level rises with speed, stays there.
            let held = stops && v0 == 0.0;
            // Constant acceleration up to the stop.
            let share = if stops && !held { -v0 / change } else { 1.0 };
            let spent = share * r;
            let moved = if stops { 0.5 * v0 * spent } else { r * mean[i] };
            taken[i] = if moves { spent } else { taken[i] };
            displacement[i] = if moves { moved } else { 0.0 };
            x[i] += displacement[i];
            time[i] += if moves { spent } else { 0.0 };
            slope[i] = if held { 0.0 } else if moves { change / r } else { slope[i] };
            // Where an observer moved the velocity of what rests, friction takes it back: that is no slide.
            let breaks_away = sliding[i] > 0.0 || change * direction[i] > 0.0;
            let rests_on = held || stops && sliding[i] == 0.0;
            dwell[i] = if rests_on { dwell[i] + spent } else if stops { 0.0 } else { dwell[i] };
            v[i] = if stops { 0.0 } else if moves { end } else { v0 };
            sliding[i] = if moves { f64::from(!stops && breaks_away) } else { sliding[i] };
            left[i] = if stops && !held { r - spent } else { 0.0 };
        }
    }
}
