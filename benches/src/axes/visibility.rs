//! How much of a recording the base model cannot imitate.
//!
//! The equation of motion is weighed with a smooth window, its second derivative taken over to the window by
//! differences: `sum phi_k (x_{k+1} - 2 x_k + x_{k-1}) / T` is exactly the integral of the acceleration under the
//! piecewise linear window through `phi_k`, whatever the acceleration does between samples. No filter, no
//! derivative of counts. Where the body rests the force says nothing of the friction and is left out, which keeps
//! the equation true.

use std::f64::consts::PI;

use super::machine::{Force, Machine};
use super::record::Run;

/// Sampling intervals in a window: it passes what lies below 5 % of the sampling frequency.
const WINDOW: usize = 20;
/// Share of the windows, the worst ones, that count.
const WORST: f64 = 0.05;

/// Root mean square, over the worst 5 % of the windows, of the force that mass, friction and what else `base`
/// names leave after least squares.
pub fn error(machine: &Machine, run: &Run, base: &[&str]) -> f64 {
    let points = points(machine, run, base);
    let phi: Vec<f64> = (0..WINDOW)
        .map(|k| {
            let s = (PI * (k as f64 + 0.5) / WINDOW as f64).sin();
            2.0 * s * s / WINDOW as f64
        })
        .collect();
    let rows: Vec<Vec<f64>> = points
        .windows(WINDOW)
        .step_by(WINDOW / 2)
        .map(|window| {
            let mut row = vec![0.0; window[0].len()];
            for (phi, point) in phi.iter().zip(window) {
                row.iter_mut().zip(point).for_each(|(row, value)| *row += phi * value);
            }
            row
        })
        .collect();
    let mut squares = residual_squares(&rows);
    squares.sort_unstable_by(|a, b| b.total_cmp(a));
    let count = ((squares.len() as f64 * WORST).ceil() as usize).clamp(1, squares.len());
    (squares[..count].iter().sum::<f64>() / count as f64).sqrt()
}

/// At each inner sample, over the interval: mass, viscous and Coulomb friction, what the base has besides, and
/// last the force.
fn points(machine: &Machine, run: &Run, base: &[&str]) -> Vec<Vec<f64>> {
    let force = |k: usize, half: usize| -> f64 {
        // Between samples a measured force is a line; a command is held.
        let (here, next) = (run.force[k], run.force[(k + 1).min(run.force.len() - 1)]);
        let (near, far) = if half == 0 { (here, next) } else { (next, here) };
        match machine.force {
            Force::Command => here,
            Force::Measured => (2.0 * near + far) / 3.0,
        }
    };
    let inner = 1..run.time.len() - 1;
    inner
        .map(|k| {
            let (before, after) = (run.time[k] - run.time[k - 1], run.time[k + 1] - run.time[k]);
            let length = 0.5 * (before + after);
            let over = |value: &dyn Fn(usize, usize) -> f64| {
                (before * value(k - 1, 1) + after * value(k, 0)) / length
            };
            let x = &run.position;
            let bend = (x[k + 1] - x[k]) / after - (x[k] - x[k - 1]) / before;
            let moving = over(&|k, half| run.moving[k][half]);
            let mut point = vec![
                bend / length,
                0.5 * (x[k + 1] - x[k - 1]) / length,
                over(&|k, half| run.sign[k][half]),
            ];
            if base.contains(&"offset") {
                point.push(moving);
            }
            if base.contains(&"gravity-pendulum") {
                point.extend([moving * x[k].sin(), moving * x[k].cos()]);
            }
            point.push(over(&|k, half| run.moving[k][half] * force(k, half)));
            point
        })
        .collect()
}

/// Squares of what least squares of the last column on the others leave.
fn residual_squares(rows: &[Vec<f64>]) -> Vec<f64> {
    let count = rows[0].len() - 1;
    let scale: Vec<f64> = (0..=count)
        .map(|c| rows.iter().map(|row| row[c] * row[c]).sum::<f64>().sqrt().max(f64::MIN_POSITIVE))
        .collect();
    // Normal equations of scaled columns, by elimination; the ridge is for columns that are all zero.
    let mut table = vec![vec![0.0; count + 1]; count];
    for row in rows {
        for a in 0..count {
            for b in 0..=count {
                table[a][b] += row[a] / scale[a] * row[b] / scale[b];
            }
        }
    }
    for pivot in 0..count {
        table[pivot][pivot] += 1e-12;
        let own = table[pivot].clone();
        for (a, line) in table.iter_mut().enumerate() {
            if a != pivot {
                let factor = line[pivot] / own[pivot];
                line.iter_mut().zip(&own).for_each(|(value, own)| *value -= factor * own);
            }
        }
    }
    let weights: Vec<f64> =
        (0..count).map(|a| table[a][count] / table[a][a] * scale[count] / scale[a]).collect();
    rows.iter()
        .map(|row| {
            let model: f64 = row.iter().zip(&weights).map(|(value, weight)| value * weight).sum();
            (row[count] - model).powi(2)
        })
        .collect()
}
