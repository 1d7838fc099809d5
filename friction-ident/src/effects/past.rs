//! A signal's recent past, lane by lane, for delays.

use std::cell::Cell;

/// Samples of a signal on each lane's own times. Between samples it is linear; before the first one
/// it has the slope that it was started with.
#[derive(Clone, Debug, Default)]
pub struct Past {
    lanes: usize,
    /// `time[slot * lanes + i]`, increasing with the slot.
    time: Vec<f64>,
    value: Vec<f64>,
    /// First slot that lane `i` may see.
    first: Vec<usize>,
    /// Slope of lane `i` before its first sample.
    slope: Vec<f64>,
    /// How many slots back the last question led: the next one leads nearly as far.
    back: Vec<Cell<usize>>,
    /// How long samples are kept, s.
    length: f64,
}

/// Slots between two clean-ups.
const CLEAN: usize = 256;

/// Slots that are kept beyond the length: who asks for a mean asks for a step more.
const MARGIN: usize = 4;

impl Past {
    /// An empty past that reaches back over `length` s.
    pub fn new(lanes: usize, length: f64) -> Self {
        let (first, slope, back) = (vec![0; lanes], vec![0.0; lanes], vec![Cell::new(1); lanes]);
        Self { lanes, first, slope, back, length, ..Self::default() }
    }

    /// Whether anybody needs it.
    pub fn is_kept(&self) -> bool {
        self.length > 0.0
    }

    /// Forgets lane `i` and begins with `value` at `time`, reached at `slope`.
    pub fn start(&mut self, i: usize, time: f64, value: f64, slope: f64) {
        if self.time.is_empty() {
            self.time.resize(self.lanes, f64::NEG_INFINITY);
            self.value.resize(self.lanes, 0.0);
        }
        let last = self.slots() - 1;
        self.first[i] = last;
        self.slope[i] = slope;
        self.time[last * self.lanes + i] = time;
        self.value[last * self.lanes + i] = value;
    }

    /// Adds a sample to every lane.
    pub fn push(&mut self, time: &[f64], value: &[f64]) {
        self.time.extend_from_slice(time);
        self.value.extend_from_slice(value);
        if self.slots().is_multiple_of(CLEAN) {
            self.clean();
        }
    }

    /// Value of lane `i` at `time`.
    pub fn at(&self, i: usize, time: f64) -> f64 {
        let (low, high) = (self.first[i], self.slots() - 1);
        if time <= self.time(low, i) {
            return self.value(low, i) + self.slope[i] * (time - self.time(low, i));
        }
        if time >= self.time(high, i) {
            return self.value(high, i);
        }
        let slot = self.slot(i, time, low, high);
        let (from, to) = (self.time(slot, i), self.time(slot + 1, i));
        let share = if to > from { (time - from) / (to - from) } else { 0.0 };
        self.value(slot, i) + share * (self.value(slot + 1, i) - self.value(slot, i))
    }

    /// The slot between `low` and `high` that `time` follows on.
    fn slot(&self, i: usize, time: f64, low: usize, high: usize) -> usize {
        let mut slot = high.saturating_sub(self.back[i].get()).clamp(low, high - 1);
        while slot > low && self.time(slot, i) > time {
            slot -= 1;
        }
        while slot + 1 < high && self.time(slot + 1, i) <= time {
            slot += 1;
        }
        self.back[i].set(high - slot);
        slot
    }

    /// Time and value of the newest sample of lane `i`.
    pub fn newest(&self, i: usize) -> (f64, f64) {
        let last = self.slots() - 1;
        (self.time(last, i), self.value(last, i))
    }

    /// The time of the last sample of each lane.
    pub fn newest_times(&self) -> &[f64] {
        &self.time[(self.slots() - 1) * self.lanes..]
    }

    fn slots(&self) -> usize {
        self.time.len() / self.lanes.max(1)
    }

    fn time(&self, slot: usize, i: usize) -> f64 {
        self.time[slot * self.lanes + i]
    }

    fn value(&self, slot: usize, i: usize) -> f64 {
        self.value[slot * self.lanes + i]
    }

    /// Drops the slots that no lane can reach any more.
    fn clean(&mut self) {
        let reach = |i: usize| {
            let oldest = self.newest(i).0 - self.length;
            (self.first[i]..self.slots() - 1).take_while(|s| self.time(s + 1, i) < oldest).count()
                + self.first[i]
        };
        let drop = (0..self.lanes).map(reach).min().unwrap_or(0).saturating_sub(MARGIN);
        self.time.drain(..drop * self.lanes);
        self.value.drain(..drop * self.lanes);
        for first in &mut self.first {
            *first = first.saturating_sub(drop);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_linear_between_samples_and_goes_on_before_the_first() {
        let mut past = Past::new(2, 10.0);
        past.start(0, 0.0, 1.0, 0.0);
        past.start(1, 5.0, -1.0, 0.5);
        past.push(&[1.0, 7.0], &[3.0, 3.0]);
        assert_eq!((past.at(0, 0.25), past.at(0, -4.0), past.at(0, 9.0)), (1.5, 1.0, 3.0));
        assert_eq!((past.at(1, 6.0), past.at(1, 4.0)), (1.0, -1.5));
    }

    #[test]
    fn old_samples_are_dropped_and_young_ones_are_not() {
        let mut past = Past::new(1, 0.05);
        past.start(0, 0.0, 0.0, 0.0);
        for k in 1..5000 {
            let t = f64::from(k) * 1e-3;
            past.push(&[t], &[t * t]);
            let back = (t - 0.05).max(0.0);
            assert!((past.at(0, back) - back * back).abs() < 1e-6);
        }
        assert!(past.slots() < 2 * CLEAN);
    }

    #[test]
    fn a_lane_that_starts_anew_does_not_see_what_was_before() {
        let mut past = Past::new(1, 1.0);
        past.start(0, 0.0, 1.0, 0.0);
        past.push(&[0.1], &[2.0]);
        past.start(0, 0.1, 7.0, 0.0);
        assert_eq!(past.at(0, 0.05), 7.0);
    }
}
