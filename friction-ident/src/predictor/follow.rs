//! Models along a recording, sample by sample.

use super::gain::Gain;
use super::strips::Strip;
use super::{Predictor, STEP, STEP_OF_TWO, VECTOR};
use crate::effects::Slot;
use crate::model::Model;
use crate::simulator::{Input, Plants, SimulationError, Start};

/// What happens to a model at a sample.
pub(super) struct Step {
    /// Measured less shown position, m or rad.
    pub error: f64,
    /// What is added to position and velocity after it.
    pub fed: (f64, f64),
    /// Whether the model rests at its end.
    pub rests: bool,
}

impl Predictor {
    /// Runs models of the same effects along the recording, each at its own setting, every piece from its begin to its
    /// end; tells what happens at every sample but the first of a piece: its number, that of the model, and the step.
    pub(super) fn follow(
        &self,
        trials: &[(Model, usize)],
        see: impl FnMut(usize, usize, &Step),
    ) -> Result<(), SimulationError> {
        self.follow_errors(trials, |n, shown| self.position[n] - shown, see)
    }

    /// The same with errors of the caller's: from the number of the sample and the position that a model shows there.
    pub(super) fn follow_errors(
        &self,
        trials: &[(Model, usize)],
        mut error: impl FnMut(usize, f64) -> f64,
        mut see: impl FnMut(usize, usize, &Step),
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
        mut error: impl FnMut(usize, f64) -> f64,
        mut see: impl FnMut(usize, usize, &Step),
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
        let gain: Vec<&Gain> = trials.iter().map(|(_, setting)| self.gain(*setting)).collect();
        let at_rest: Vec<&Gain> =
            trials.iter().map(|(_, s)| self.gain_of(if *s < rungs { *s } else { 0 })).collect();
        let step = if two { STEP_OF_TWO } else { STEP };
        let input = Input::new(&self.time, &self.force, self.hold).with_max_step(step);
        let all = models.len();
        let (mut length, mut command) = (vec![0.0; all], vec![0.0; all]);
        let (mut dx, mut dv) = (vec![0.0; all], vec![0.0; all]);
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
                    command[lanes(s)].fill(input.mean(at(strip), part, steps));
                }
                plants.step(&length, &command);
            }
            let (shown, velocity) = (plants.shown(), plants.velocity());
            for (s, strip) in strips.iter().enumerate() {
                let n = at(strip) + 1;
                let told = strip.from + j + 1 == n && strip.tells.contains(&n);
                for (i, lane) in lanes(s).take(count).enumerate() {
                    let error = error(n, shown[lane]);
                    let rests = velocity[lane].abs() < self.rest_speed;
                    let g = if rests { at_rest[i] } else { gain[i] };
                    let finite = error.is_finite();
                    let fed = if finite { error.clamp(-self.fed_back, self.fed_back) } else { 0.0 };
                    dx[lane] = g.position[n] * fed;
                    dv[lane] = g.velocity[n] * fed;
                    if told {
                        see(n, i, &Step { error, fed: (dx[lane], dv[lane]), rests });
                    }
                }
            }
            for i in used..all {
                (dx[i], dv[i]) = (dx[used - 1], dv[used - 1]);
            }
            plants.correct(&dx, &dv);
        }
        Ok(())
    }

    /// Where a plant starts at a sample of a piece that goes on until `end`: at rest, unless the next samples move by
    /// more than their noise.
    fn start(&self, first: usize, end: usize) -> Start {
        let next = (first + 4).min(end - 1);
        let moved = self.position[next] - self.position[first];
        let moves = moved.abs() > 6.0 * self.noise.position;
        let duration = (self.time[next] - self.time[first]).max(f64::MIN_POSITIVE);
        let velocity = if moves { moved / duration } else { 0.0 };
        let command = self.force[first];
        Start { time: self.time[first], command, ..Start::at(self.position[first], velocity) }
    }
}
