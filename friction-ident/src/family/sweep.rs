//! Columns of laws that are periodic along the stroke, for many periods at once.

use std::f64::consts::TAU;

use missing_physics::Fitted;
use rayon::prelude::*;

use super::FrictionFamily;
use crate::effects::encoder::feigned;
use crate::effects::search::OfWave;

/// Periods per sweep.
const SWEEP: usize = 64;

/// Sines and cosines of `2 pi x f` at positions `x` for evenly spaced spatial frequencies `f`, 1/m: one
/// rotation per frequency takes the place of a sine and a cosine. Over some hundred steps it is exact to 1e-12.
struct Sweep {
    wave: Vec<(f64, f64)>,
    turn: Vec<(f64, f64)>,
}

impl Sweep {
    fn new(positions: &[f64], first: f64, step: f64) -> Self {
        let waves = |frequency: f64| -> Vec<(f64, f64)> {
            positions.iter().map(|x| (TAU * (x * frequency)).sin_cos()).collect()
        };
        Self { wave: waves(first), turn: waves(step) }
    }

    fn advance(&mut self) {
        for ((sin, cos), (turn_sin, turn_cos)) in self.wave.iter_mut().zip(&self.turn) {
            (*sin, *cos) = (*sin * turn_cos + *cos * turn_sin, *cos * turn_cos - *sin * turn_sin);
        }
    }
}

impl FrictionFamily {
    /// Columns of a force of these periods, from its sine and cosine. A force that depends on position alone is the same
    /// with any contact; what a drive does to it is a few degrees of phase, which the refinement after the
    /// screening mends.
    pub(super) fn repeated(&self, columns: OfWave, periods: &[Vec<f64>]) -> Vec<Vec<Vec<f64>>> {
        self.sweep(periods, |_, wave| columns(wave))
    }

    /// Columns of a gain of the drive of these periods: what of its force it brings besides.
    pub(super) fn gains(&self, periods: &[Vec<f64>]) -> Vec<Vec<Vec<f64>>> {
        let drive = &self.prepared.force;
        self.sweep(periods, |_, wave| {
            let pairs = || wave.iter().zip(drive);
            vec![
                pairs().map(|((sin, _), drive)| -drive * sin).collect(),
                pairs().map(|((_, cos), drive)| -drive * cos).collect(),
            ]
        })
    }

    /// Columns of encoders whose errors have these periods: the inertia of a motion that there is not. The
    /// friction that such a motion feigns is left to the refinement after the screening.
    pub(super) fn encoders(&self, model: &Fitted, periods: &[Vec<f64>]) -> Vec<Vec<Vec<f64>>> {
        let (p, mass) = (&self.prepared, self.mass_of(model));
        self.sweep(periods, |period, wave| {
            let (mut a, mut b) = (Vec::with_capacity(wave.len()), Vec::with_capacity(wave.len()));
            for (wave, (v, acceleration)) in wave.iter().zip(p.velocity.iter().zip(&p.acceleration))
            {
                let (sine, cosine) = feigned(*wave, period, *v, *acceleration, p.cutoff);
                a.push(-mass * sine);
                b.push(-mass * cosine);
            }
            vec![a, b]
        })
    }

    /// Columns for periods that are evenly spaced in spatial frequency, as [`super::limits::periods`]
    /// makes them.
    fn sweep(
        &self,
        periods: &[Vec<f64>],
        columns: impl Fn(f64, &[(f64, f64)]) -> Vec<Vec<f64>> + Sync,
    ) -> Vec<Vec<Vec<f64>>> {
        let frequency = |k: usize| 1.0 / periods[k][0];
        let step = if periods.len() > 1 { frequency(1) - frequency(0) } else { 0.0 };
        let chunks: Vec<Vec<Vec<Vec<f64>>>> = (0..periods.len())
            .step_by(SWEEP)
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|first| {
                let mut sweep = Sweep::new(&self.prepared.position, frequency(first), step);
                let mut next = |k: usize| -> Vec<Vec<f64>> {
                    let columns = columns(periods[k][0], &sweep.wave);
                    sweep.advance();
                    columns.iter().map(|column| self.prepared.compare(column)).collect()
                };
                (first..periods.len().min(first + SWEEP)).map(&mut next).collect()
            })
            .collect();
        chunks.into_iter().flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use missing_physics::ModelFamily;
    use missing_physics::statistics::basis::dot;

    use super::super::Options;
    use super::*;
    use crate::challenge::{Hide, Level, generate};

    #[test]
    fn the_columns_of_an_encoder_are_what_its_error_changes() {
        let made = generate(&Hide::Nothing, 2, Level::Clear).unwrap();
        let family = FrictionFamily::new(&made.recording, &Options::default()).unwrap();
        let model = family.fitted(&made.truth.model).unwrap();
        let prediction = missing_physics::fit::predict(&family, &model);
        let term = family.terms().iter().position(|term| term.name == "encoder").unwrap();
        for period in [3e-3, 8e-3] {
            let quick = family.encoders(&model, &[vec![period]]).swap_remove(0);
            let slow =
                missing_physics::family::columns(&family, &model, &prediction, term, &[period]);
            for (quick, slow) in quick.iter().zip(&slow) {
                let left: Vec<f64> = quick.iter().zip(slow).map(|(a, b)| a - b).collect();
                let share = (dot(&left, &left) / dot(slow, slow)).sqrt();
                // The friction that is left out.
                assert!(share < 0.1, "{period}: {share}");
            }
        }
    }

    #[test]
    fn the_columns_of_a_gain_are_those_of_the_law() {
        let made = generate(&Hide::Nothing, 2, Level::Clear).unwrap();
        let family = FrictionFamily::new(&made.recording, &Options::default()).unwrap();
        let model = Fitted { terms: vec![0], values: vec![1.0] };
        let prediction = missing_physics::fit::predict(&family, &model);
        let at = family.terms().iter().position(|term| term.name == "motor-gain:ripple").unwrap();
        let shapes = family.shapes(at);
        let last = &shapes[shapes.len() - 2..];
        for (quick, shape) in
            family.columns_of_shapes(&model, &prediction, at, last).iter().zip(last)
        {
            let slow = family.columns(&model, &prediction, at, shape);
            assert_eq!(slow.len(), quick.len());
            for (a, b) in quick.iter().zip(&slow).flat_map(|(a, b)| a.iter().zip(b)) {
                assert!((a - b).abs() < 1e-9, "{a} {b}");
            }
        }
    }

    #[test]
    fn the_columns_of_six_harmonics_are_those_of_the_law() {
        let made = generate(&Hide::Nothing, 2, Level::Clear).unwrap();
        let family = FrictionFamily::new(&made.recording, &Options::default()).unwrap();
        let model = Fitted { terms: vec![0], values: vec![1.0] };
        let prediction = missing_physics::fit::predict(&family, &model);
        let at = family.terms().iter().position(|term| term.name == "ripple:harmonics").unwrap();
        let shapes = family.shapes(at);
        let main = family.terms().iter().position(|term| term.name == "ripple").unwrap();
        assert_eq!(shapes.len(), family.shapes(main).len());
        let last = &shapes[shapes.len() - 2..];
        let quick = family.columns_of_shapes(&model, &prediction, at, last);
        for (quick, shape) in quick.iter().zip(last) {
            let slow = family.columns(&model, &prediction, at, shape);
            assert_eq!(slow.len(), quick.len());
            for (a, b) in quick.iter().zip(&slow).flat_map(|(a, b)| a.iter().zip(b)) {
                assert!((a - b).abs() < 1e-9, "{a} {b}");
            }
        }
    }

    #[test]
    fn a_sweep_gives_the_waves_of_every_frequency() {
        let positions = [0.0, 0.013, -0.4, 0.11];
        let mut sweep = Sweep::new(&positions, 12.0, 3.3);
        for k in 0..300 {
            for (x, (sin, cos)) in positions.iter().zip(&sweep.wave) {
                let angle = TAU * x * (12.0 + 3.3 * f64::from(k));
                assert!((sin - angle.sin()).abs() < 1e-10 && (cos - angle.cos()).abs() < 1e-10);
            }
            sweep.advance();
        }
    }
}
