//! Models along a recording, sample by sample.

use std::ptr;

use super::gain::Gain;
use super::strips::Strip;
use super::{LATE_STEPS, MOST_STEPS, MOST_STEPS_OF_TWO, Predictor, STEP, STEP_OF_TWO, VECTOR};
use crate::effects::Slot;
use crate::model::Model;
use crate::simd::{limited, vectorised};
use crate::simulator::{Input, Plants, SimulationError, Start};

/// What happens to models at a sample, one value for each.
pub(super) struct Step<'a> {
    /// Measured less shown position, m or rad.
    pub error: &'a [f64],
    /// What is added to the position after it, m or rad.
    pub dx: &'a [f64],
    /// What is added to the velocity, m/s or rad/s.
    pub dv: &'a [f64],
    /// Velocity before that.
    pub velocity: &'a [f64],
}

/// Shares of an error that go to the position and to the velocity (1/s), for each model.
struct Shares<'a> {
    gains: Vec<&'a Gain>,
    /// Whether all models are at one setting, as those that differ by a step of a parameter are.
    alike: bool,
    position: Vec<f64>,
    velocity: Vec<f64>,
}

impl<'a> Shares<'a> {
    fn new(gains: Vec<&'a Gain>) -> Self {
        let (count, alike) = (gains.len(), gains.windows(2).all(|two| ptr::eq(two[0], two[1])));
        Self { gains, alike, position: vec![0.0; count], velocity: vec![0.0; count] }
    }

    /// Those of a sample.
    fn set(&mut self, n: usize) {
        if self.alike {
            self.position.fill(self.gains[0].position[n]);
            self.velocity.fill(self.gains[0].velocity[n]);
            return;
        }
        let shares = self.position.iter_mut().zip(&mut self.velocity);
        for ((position, velocity), gain) in shares.zip(&self.gains) {
            (*position, *velocity) = (gain.position[n], gain.velocity[n]);
        }
    }
}

vectorised! {
    /// What is fed back of errors, within a limit; what is no number is not.
    fn feed(
        error: &[f64],
        velocity: &[f64],
        rest_speed: f64,
        most: f64,
        moving: &Shares<'_>,
        at_rest: &Shares<'_>,
        dx: &mut [f64],
        dv: &mut [f64],
    ) {
        let n = error.len();
        let (velocity, dx, dv) = (&velocity[..n], &mut dx[..n], &mut dv[..n]);
        let (gx, gv) = (&moving.position[..n], &moving.velocity[..n]);
        let (rx, rv) = (&at_rest.position[..n], &at_rest.velocity[..n]);
        for i in 0..n {
            let rests = velocity[i].abs() < rest_speed;
            let (x, v) = if rests { (rx[i], rv[i]) } else { (gx[i], gv[i]) };
            let finite = error[i].abs() < f64::INFINITY;
            let fed = if finite { limited(error[i], most) } else { 0.0 };
            dx[i] = x * fed;
            dv[i] = v * fed;
        }
    }
}

impl Predictor {
    /// Runs models of the same effects along the recording, each at its own setting, every piece from its begin to its
    /// end; tells what happens at every sample but the first of a piece.
    pub(super) fn follow(
        &self,
        trials: &[(Model, usize)],
        see: impl FnMut(usize, &Step<'_>),
    ) -> Result<(), SimulationError> {
        self.follow_errors(trials, self.missed(), see)
    }

    /// Errors of positions that models show: what they miss.
    pub(super) fn missed(&self) -> impl Fn(usize, &[f64], &mut [f64]) {
        |n, shown, error| {
            for (error, shown) in error.iter_mut().zip(shown) {
                *error = self.position[n] - shown;
            }
        }
    }

    /// The same with errors of the caller's: from the number of the sample and the positions that models show there.
    pub(super) fn follow_errors(
        &self,
        trials: &[(Model, usize)],
        mut error: impl FnMut(usize, &[f64], &mut [f64]),
        mut see: impl FnMut(usize, &Step<'_>),
    ) -> Result<(), SimulationError> {
        self.segments.iter().try_for_each(|segment| {
            self.side_by_side(&[Strip::whole(segment)], trials, &mut error, &mut see)
        })
    }

    /// The same along strips that are simulated side by side; one that is shorter than others waits at its end.
    pub(super) fn side_by_side(
        &self,
        strips: &[Strip],
        trials: &[(Model, usize)],
        mut error: impl FnMut(usize, &[f64], &mut [f64]),
        mut see: impl FnMut(usize, &Step<'_>),
    ) -> Result<(), SimulationError> {
        let (count, used) = (trials.len(), trials.len() * strips.len());
        let mut models: Vec<Model> =
            strips.iter().flat_map(|_| trials.iter().map(|(model, _)| model.clone())).collect();
        let two = models[0].acts_on(Slot::Attached);
        if two && used > 1 {
            // A vector that is not full costs as much as one that is, plants beside it far more.
            models.resize(used.next_multiple_of(VECTOR), trials[count - 1].0.clone());
        }
        let mut plants = Plants::new(&models)?;
        let rungs = self.ladder.len();
        let gain = trials.iter().map(|(_, setting)| self.gain(*setting)).collect();
        let at_rest =
            trials.iter().map(|(_, s)| self.gain_of(if *s < rungs { *s } else { 0 })).collect();
        let (step, most) = if two { (STEP_OF_TWO, MOST_STEPS_OF_TWO) } else { (STEP, MOST_STEPS) };
        let step = step.max(self.interval / most);
        let step = if models[0].is_late() { step.min(self.interval / LATE_STEPS) } else { step };
        let input = Input::new(&self.time, &self.force, self.hold).with_max_step(step);
        let all = models.len();
        let (mut length, mut command) = (vec![0.0; all], vec![0.0; all]);
        let (mut dx, mut dv, mut errors) = (vec![0.0; all], vec![0.0; all], vec![0.0; count]);
        let (mut moving, mut still) = (Shares::new(gain), Shares::new(at_rest));
        // Lanes that fill a vector go with the last strip.
        let lanes = |s: usize| s * count..if s + 1 < strips.len() { (s + 1) * count } else { all };
        for (s, strip) in strips.iter().enumerate() {
            let start = self.start(strip.from, strip.tells.end);
            lanes(s).for_each(|i| plants.start(i, &start));
        }
        let longest = strips.iter().map(|strip| strip.tells.end - strip.from).max().unwrap_or(0);
        for j in 0..longest.saturating_sub(1) {
            let at = |strip: &Strip| (strip.from + j).min(strip.tells.end - 2);
            let steps = strips.iter().map(|strip| input.steps(at(strip)).0).max().unwrap_or(1);
            for (s, strip) in strips.iter().enumerate() {
                let (own, duration) = input.steps(at(strip));
                let finer = own as f64 / steps as f64;
                length[lanes(s)].fill(if own == steps { duration } else { finer * duration });
            }
            for part in 0..steps {
                for (s, strip) in strips.iter().enumerate() {
                    let n = at(strip);
                    let mean = input.mean(n, part, steps) - self.rounding(n, part, steps);
                    command[lanes(s)].fill(mean);
                }
                plants.step(&length, &command);
            }
            let (shown, velocity) = (plants.shown(), plants.velocity());
            for (s, strip) in strips.iter().enumerate() {
                let n = at(strip) + 1;
                let told = strip.from + j + 1 == n && strip.tells.contains(&n);
                let lanes = s * count..(s + 1) * count;
                moving.set(n);
                still.set(n);
                let velocity = &velocity[lanes.clone()];
                let (dx, dv) = (&mut dx[lanes.clone()], &mut dv[lanes.clone()]);
                error(n, &shown[lanes], &mut errors);
                let (rest_speed, most) = (self.rest_speed, self.fed_back);
                feed(&errors, velocity, rest_speed, most, &moving, &still, dx, dv);
                if told {
                    see(n, &Step { error: &errors, dx, dv, velocity });
                }
            }
            for i in used..all {
                (dx[i], dv[i]) = (dx[used - 1], dv[used - 1]);
            }
            plants.correct(&dx, &dv);
        }
        Ok(())
    }

    /// What is taken from the mean of a sampled force in step `part` of `steps` after sample `n`: a step pushes evenly, and
    /// under a force that rises a mass comes less far than under its mean. Positions at the samples are then those of straight
    /// lines between the values of the force: their second difference is h^2/6m times (1, 4, 1) of these, that of even
    /// pushes h^2/4m times (1, 2, 1).
    fn rounding(&self, n: usize, part: usize, steps: usize) -> f64 {
        let at = |here: bool, n: usize| if here { self.bends[n] } else { 0.0 };
        let bend = at(part == 0, n) + at(part + 1 == steps, n + 1);
        bend * (self.time[n + 1] - self.time[n]) / (24 * steps) as f64
    }

    /// Where a plant starts at a sample of a piece that goes on until `end`: at rest, unless the next samples move by
    /// more than their noise.
    pub(super) fn start(&self, first: usize, end: usize) -> Start {
        let next = (first + 4).min(end - 1);
        let moved = self.position[next] - self.position[first];
        let moves = moved.abs() > 6.0 * self.noise.position;
        let duration = (self.time[next] - self.time[first]).max(f64::MIN_POSITIVE);
        let velocity = if moves { moved / duration } else { 0.0 };
        let (command, came) = (self.force[first], self.came[first]);
        Start { time: self.time[first], command, came, ..Start::at(self.position[first], velocity) }
    }
}
