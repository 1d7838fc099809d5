//! A Kalman filter over three states and the smoother behind it.
//!
//! The smoother is that of Bryson and Frazier (G. J. Bierman, Factorization Methods for Discrete Sequential
//! Estimation, 1977, ch. X): the estimates are those of Rauch, Tung and Striebel, but no covariance is inverted, and at rest
//! one is nearly singular.

use crate::predictor::gain::Motion;

type Vector = [f64; 3];
type Matrix = [[f64; 3]; 3];

/// Mean and covariance of the distance in position and in velocity, and of the force.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    mean: Vector,
    covariance: Matrix,
}

/// How they go from one sample to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transition {
    matrix: Matrix,
    noise: Matrix,
}

/// A sample on the way forwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// From the sample before.
    pub transition: Transition,
    /// What the samples before say.
    pub predicted: Moments,
    /// What was measured beyond that, and its variance; nothing where nothing was.
    pub surprise: Option<(f64, f64)>,
}

impl Transition {
    /// A mass with damping under the force, which gains the variance `gained` before it acts, and under a force of
    /// variance `white` that is another one in every interval.
    pub fn moving(motion: &Motion, gained: f64, white: f64) -> Self {
        let Motion { decay, way, moved, gained: speed } = *motion;
        let (by_force, by_white) = ([moved, speed, 1.0], [moved, speed, 0.0]);
        Self {
            matrix: [[1.0, way, moved], [0.0, decay, speed], [0.0, 0.0, 1.0]],
            noise: from_fn(|i, j| {
                gained * by_force[i] * by_force[j] + white * by_white[i] * by_white[j]
            }),
        }
    }

    /// The model rests for `t` s, so that no force acts on it: the true axis moves at about `speed`, and what the
    /// force is afterwards has nothing to do with what it was.
    pub fn at_rest(t: f64, speed: f64, prior: f64) -> Self {
        let (way, square) = (t * speed, speed * speed);
        Self {
            matrix: [[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]],
            noise: [[way * way, 0.0, 0.0], [0.0, square, 0.0], [0.0, 0.0, prior]],
        }
    }
}

impl Moments {
    /// Means of zero and these variances.
    pub fn independent(variances: Vector) -> Self {
        let covariance = from_fn(|i, j| if i == j { variances[i] } else { 0.0 });
        Self { mean: [0.0; 3], covariance }
    }

    /// One interval later.
    pub fn predicted(&self, transition: &Transition) -> Self {
        let Transition { matrix, noise } = transition;
        let covariance = product(&product(matrix, &self.covariance), &transposed(matrix));
        Self {
            mean: applied(matrix, &self.mean),
            covariance: from_fn(|i, j| covariance[i][j] + noise[i][j]),
        }
    }

    /// What a measured position says beyond the predicted one, and its variance.
    pub fn surprise(&self, measured: f64, noise: f64) -> (f64, f64) {
        (measured - self.mean[0], self.covariance[0][0] + noise)
    }

    /// After a measurement.
    pub fn updated(&self, surprise: f64, variance: f64) -> Self {
        let gain: Vector = std::array::from_fn(|i| self.covariance[i][0] / variance);
        Self {
            mean: std::array::from_fn(|i| self.mean[i] + gain[i] * surprise),
            covariance: from_fn(|i, j| self.covariance[i][j] - gain[i] * self.covariance[0][j]),
        }
    }

    /// After the model was moved by `fed` in position and velocity.
    pub fn moved(mut self, fed: (f64, f64)) -> Self {
        self.mean[0] -= fed.0;
        self.mean[1] -= fed.1;
        self
    }
}

/// Force and its variance at every sample, from all of them.
pub(super) fn forces(steps: &[Step]) -> Vec<(f64, f64)> {
    let (mut r, mut n): (Vector, Matrix) = ([0.0; 3], [[0.0; 3]; 3]);
    let mut told = Vec::with_capacity(steps.len());
    for step in steps.iter().rev() {
        let Moments { mean, covariance: p } = &step.predicted;
        if let Some((surprise, variance)) = step.surprise {
            // What the samples from here on say of the prediction.
            let kept = from_fn(|i, j| {
                f64::from(u8::from(i == j)) - if j == 0 { p[i][0] / variance } else { 0.0 }
            });
            r = applied(&transposed(&kept), &r);
            n = product(&product(&transposed(&kept), &n), &kept);
            r[0] += surprise / variance;
            n[0][0] += 1.0 / variance;
        }
        let row = &p[2];
        let force = mean[2] + dot(row, &r);
        told.push((force, (p[2][2] - dot(row, &applied(&n, row))).max(0.0)));
        let matrix = &step.transition.matrix;
        r = applied(&transposed(matrix), &r);
        n = product(&product(&transposed(matrix), &n), matrix);
    }
    told.reverse();
    told
}

fn from_fn(entry: impl Fn(usize, usize) -> f64) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn applied(a: &Matrix, b: &Vector) -> Vector {
    std::array::from_fn(|i| dot(&a[i], b))
}

fn transposed(a: &Matrix) -> Matrix {
    from_fn(|i, j| a[j][i])
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    from_fn(|i, j| (0..3).map(|k| a[i][k] * b[k][j]).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Least squares over every unknown at once: the start, and all noise on the way.
    #[test]
    fn the_smoother_finds_what_least_squares_over_the_whole_way_find() {
        let motion = Motion::over(0.1, (2.0, 0.5));
        let transition = Transition::moving(&motion, 0.3, 0.02);
        let rest = Transition::at_rest(0.1, 0.2, 4.0);
        let (noise, measured) = (0.01, [0.1, -0.05, 0.3, 0.5, 0.2, 0.6, 1.0]);
        let start = Moments::independent([0.01, 0.5, 4.0]);
        let count = measured.len();
        let transitions: Vec<&Transition> =
            (0..count).map(|k| if k == 3 { &rest } else { &transition }).collect();
        let (mut at, mut steps) = (start, Vec::new());
        for (k, y) in measured.iter().enumerate() {
            at = at.predicted(transitions[k]);
            let surprise = Some(at.surprise(*y, noise)).filter(|_| k != 5);
            steps.push(Step { transition: *transitions[k], predicted: at, surprise });
            if let Some((surprise, variance)) = surprise {
                at = at.updated(surprise, variance);
            }
        }
        // The joint covariance of all states, then what the measurements say of it, one after the other.
        let size = 3 * (count + 1);
        let mut joint = vec![vec![0.0; size]; size];
        for (i, row) in joint.iter_mut().take(3).enumerate() {
            row[i] = start.covariance[i][i];
        }
        for (k, Transition { matrix, noise }) in transitions.iter().enumerate() {
            let (old, new) = (3 * k, 3 * (k + 1));
            for i in 0..3 {
                let row: Vec<f64> = (0..new)
                    .map(|j| (0..3).map(|l| matrix[i][l] * joint[old + l][j]).sum())
                    .collect();
                for (j, value) in row.into_iter().enumerate() {
                    joint[new + i][j] = value;
                    joint[j][new + i] = value;
                }
            }
            for i in 0..3 {
                for j in 0..3 {
                    let value: f64 = (0..3).map(|l| joint[new + i][old + l] * matrix[j][l]).sum();
                    joint[new + i][new + j] = value + noise[i][j];
                }
            }
        }
        let mut mean = vec![0.0; size];
        for (k, y) in measured.iter().enumerate().filter(|(k, _)| *k != 5) {
            let seen = 3 * (k + 1);
            let variance = joint[seen][seen] + noise;
            let gain: Vec<f64> = (0..size).map(|i| joint[i][seen] / variance).collect();
            let (surprise, row) = (y - mean[seen], joint[seen].clone());
            for i in 0..size {
                mean[i] += gain[i] * surprise;
                for j in 0..size {
                    joint[i][j] -= gain[i] * row[j];
                }
            }
        }
        for (k, (force, variance)) in forces(&steps).into_iter().enumerate() {
            let at = 3 * (k + 1) + 2;
            assert!((force - mean[at]).abs() < 1e-9, "{k}: {force} {}", mean[at]);
            assert!((variance - joint[at][at]).abs() < 1e-9, "{k}: {variance}");
        }
    }
}
