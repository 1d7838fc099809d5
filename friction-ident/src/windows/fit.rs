//! Fits the starts of several windows at once: all their trial runs are lanes of one batch.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::Window;
use super::start::Data;
use crate::effects::Slot;
use crate::model::Model;
use crate::simulator::{Plants, Start};

/// Windows that are simulated together.
pub(crate) const TOGETHER: usize = 8;

/// A window on its way to the best start.
struct Trial {
    segment: usize,
    samples: Range<usize>,
    /// Best start so far and its sum of squares.
    best: Start,
    squares: f64,
    /// Start to be tried next.
    next: Start,
}

/// Simulates and fits windows of one model.
pub(crate) struct Fitter<'a> {
    data: &'a Data<'a>,
    plants: Plants,
    /// Lanes per window: the start, its displaced neighbours, and the start at rest.
    each: usize,
    /// Displacements of position, velocity and utilisation for the differences.
    step: [f64; 3],
    /// Positions of all lanes, sample after sample.
    track: Vec<f64>,
    /// Errors at the best start of each window.
    best: Vec<Vec<f64>>,
}

impl<'a> Fitter<'a> {
    pub fn new(model: &Model, data: &'a Data<'a>) -> Self {
        let each = if model.acts_on(Slot::Contact) { 5 } else { 4 };
        let dx = (2.0 * data.noise).max(1e-9);
        let step = [dx, 4.0 * dx / data.options.length, 0.1];
        let plants = Plants::uniform(model, each * TOGETHER);
        let best = vec![Vec::new(); TOGETHER];
        Self { data, plants, each, step, track: Vec::new(), best }
    }

    /// Gives all lanes the parameters `values` of a model.
    pub fn set_values(&mut self, values: &[f64]) {
        (0..self.plants.lanes()).for_each(|i| self.plants.set_values(i, values));
        self.plants.keep_pasts();
    }

    /// Errors of window `w` of the last fit at its samples, at the best start.
    pub fn errors(&self, w: usize, errors: &mut [f64]) {
        errors.copy_from_slice(&self.best[w]);
    }

    pub fn fit(&mut self, windows: &[(usize, Range<usize>)]) -> Vec<Window> {
        let mut trials: Vec<Trial> = windows.iter().map(|window| self.trial(window)).collect();
        // One pass more than steps: the last step has to be tried.
        for _ in 0..=self.data.options.iterations {
            self.run(&trials);
            for (w, trial) in trials.iter_mut().enumerate() {
                self.improve(w, trial);
            }
        }
        trials.into_iter().map(Trial::into_window).collect()
    }

    fn trial(&self, (segment, samples): &(usize, Range<usize>)) -> Trial {
        let first = samples.start;
        let (position, velocity) = self.data.guess(*segment, first);
        let command =
            self.data.force[first.saturating_sub(1).max(self.data.segments[*segment].start)];
        let start = Start { time: self.data.time[first], command, ..Start::at(position, velocity) };
        let samples = samples.clone();
        Trial { segment: *segment, samples, best: start, squares: f64::INFINITY, next: start }
    }

    /// The starts of a window's lanes.
    fn starts(&self, trial: &Trial) -> [Start; 5] {
        let next = trial.next;
        let [dx, dv, du] = self.step;
        let rest =
            Start { velocity: 0.0, used: if self.each == 5 { next.used } else { 0.0 }, ..next };
        let displaced = Start { position: next.position + dx, ..next };
        let faster = Start { velocity: next.velocity + dv, ..next };
        // Towards the middle: at full sliding there is no further out.
        let inward = if next.used > 0.0 { -du } else { du };
        let tighter = Start { used: next.used + inward, ..next };
        [next, displaced, faster, rest, tighter]
    }

    /// Simulates all lanes over their windows.
    fn run(&mut self, trials: &[Trial]) {
        let (data, each) = (self.data, self.each);
        let longest = trials.iter().map(|trial| trial.samples.len()).max().unwrap_or(0);
        let lanes = self.plants.lanes();
        for (w, trial) in trials.iter().enumerate() {
            for (j, start) in self.starts(trial)[..each].iter().enumerate() {
                self.plants.start(w * each + j, start);
            }
        }
        self.track.clear();
        self.track.extend_from_slice(&self.plants.shown());
        let (mut duration, mut command) = (vec![0.0; lanes], vec![0.0; lanes]);
        for k in 0..longest.saturating_sub(1) {
            for step in 0..data.steps {
                for (w, trial) in trials.iter().enumerate() {
                    let (length, force) = data.step(&trial.samples, k, step);
                    duration[w * each..(w + 1) * each].fill(length);
                    command[w * each..(w + 1) * each].fill(force);
                }
                self.plants.step(&duration, &command);
            }
            self.track.extend_from_slice(&self.plants.shown());
        }
    }

    /// Takes what the lanes of window `w` say into its trial.
    fn improve(&mut self, w: usize, trial: &mut Trial) {
        let starts = self.starts(trial);
        let tried = [(0, starts[0]), (3, starts[3])];
        for (lane, start) in tried {
            let squares = self.squares(w, lane, trial);
            if squares < trial.squares {
                (trial.squares, trial.best) = (squares, start);
                self.best[w] =
                    (0..trial.samples.len()).map(|k| self.error(w, lane, trial, k)).collect();
            }
        }
        let improved = trial.best == starts[0] || trial.best == starts[3];
        if !improved {
            // A step too far: half way back.
            trial.next = middle(&trial.best, &trial.next);
            return;
        }
        // The derivatives were taken at the first lane; after rest only the position follows.
        let at_rest = trial.best == starts[3] && starts[3] != starts[0];
        trial.next = self.newton(w, trial, at_rest);
    }

    fn squares(&self, w: usize, lane: usize, trial: &Trial) -> f64 {
        let sum: f64 =
            (0..trial.samples.len()).map(|k| self.error(w, lane, trial, k).powi(2)).sum();
        if sum.is_finite() { sum } else { f64::INFINITY }
    }

    fn error(&self, w: usize, lane: usize, trial: &Trial, k: usize) -> f64 {
        self.data.position[trial.samples.start + k] - self.at(w, lane, k)
    }

    fn at(&self, w: usize, lane: usize, k: usize) -> f64 {
        self.track[k * self.plants.lanes() + w * self.each + lane]
    }

    /// The next start by Gauss-Newton from the first lane, or from rest.
    fn newton(&self, w: usize, trial: &Trial, at_rest: bool) -> Start {
        let (base, lanes): (usize, &[usize]) = match (at_rest, self.each) {
            (true, _) => (3, &[1]),
            (false, 5) => (0, &[1, 2, 4]),
            (false, _) => (0, &[1, 2]),
        };
        let count = lanes.len();
        let (mut left, mut right) = (DMatrix::zeros(count, count), DVector::zeros(count));
        let mut row = vec![0.0; count];
        for k in 0..trial.samples.len() {
            for (slot, lane) in row.iter_mut().zip(lanes) {
                *slot = self.at(w, *lane, k) - self.at(w, 0, k);
            }
            let error = self.error(w, base, trial, k);
            for i in 0..count {
                right[i] += row[i] * error;
                for j in 0..count {
                    left[(i, j)] += row[i] * row[j];
                }
            }
        }
        for i in 0..count {
            left[(i, i)] *= 1.0 + 1e-6;
            left[(i, i)] += f64::MIN_POSITIVE;
        }
        let Some(change) = left.cholesky().map(|cholesky| cholesky.solve(&right)) else {
            return trial.best;
        };
        self.moved(trial, lanes, &change)
    }

    fn moved(&self, trial: &Trial, lanes: &[usize], change: &DVector<f64>) -> Start {
        let mut next = trial.best;
        let inward = if trial.next.used > 0.0 { -self.step[2] } else { self.step[2] };
        for (lane, change) in lanes.iter().zip(change.iter()).filter(|(_, c)| c.is_finite()) {
            match lane {
                1 => next.position += change * self.step[0],
                2 => next.velocity += change * self.step[1],
                _ => next.used = (next.used + change * inward).clamp(-1.0, 1.0),
            }
        }
        next
    }
}

fn middle(a: &Start, b: &Start) -> Start {
    Start {
        position: 0.5 * (a.position + b.position),
        velocity: 0.5 * (a.velocity + b.velocity),
        used: 0.5 * (a.used + b.used),
        ..*a
    }
}

impl Trial {
    fn into_window(self) -> Window {
        let rms = (self.squares / self.samples.len() as f64).sqrt();
        let Self { segment, samples, best, .. } = self;
        Window { samples, segment, rms, position: best.position, velocity: best.velocity }
    }
}
