//! A signal that was recorded beside the motion, as a function of time: what effects that read a column see.

use missing_physics::Recording;

/// Values at instants, straight between them, constant beyond the ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    time: Vec<f64>,
    values: Vec<f64>,
}

impl Signal {
    /// The channel called `name` of a recording; nothing where it has none. Times of its pieces must not overlap.
    pub fn of(recording: &Recording, name: &str) -> Option<Self> {
        let values = recording.channel(name)?.values.clone();
        Some(Self { time: recording.time().to_vec(), values })
    }

    /// Other values at the same instants.
    pub(super) fn with(&self, values: Vec<f64>) -> Self {
        Self { time: self.time.clone(), values }
    }

    /// The value at `time`, s; `near` is where the last search ended, and is moved.
    pub fn at(&self, time: f64, near: &mut usize) -> f64 {
        let last = self.time.len() - 1;
        let mut k = (*near).min(last);
        if self.time[k] > time || self.time.get(k + 8).is_some_and(|t| *t < time) {
            k = self.time.partition_point(|t| *t <= time).saturating_sub(1);
        }
        while k < last && self.time[k + 1] <= time {
            k += 1;
        }
        *near = k;
        let (before, after) = (self.time[k], self.time[(k + 1).min(last)]);
        if after <= before || time <= before {
            return self.values[k];
        }
        let share = (time - before) / (after - before);
        self.values[k] + share * (self.values[k + 1] - self.values[k])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_straight_between_samples_wherever_the_last_search_ended() {
        let time: Vec<f64> = (0..50).map(|k| 0.1 * f64::from(k)).collect();
        let signal = Signal { values: time.iter().map(|t| 3.0 * t + 1.0).collect(), time };
        let mut near = 0;
        for t in [0.0, 0.05, 3.21, 0.77, 4.9, 2.0, 2.01] {
            assert!((signal.at(t, &mut near) - (3.0 * t + 1.0)).abs() < 1e-12, "{t}");
        }
        assert_eq!(
            (signal.at(-1.0, &mut near), signal.at(99.0, &mut near)),
            (1.0, 3.0 * 4.9 + 1.0)
        );
    }
}
