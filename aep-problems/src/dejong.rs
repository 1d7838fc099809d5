//! De Jong's five functions, as the AEP paper uses them.

use crate::{Definition, Dimension, Shift};

const DE_JONG: &str = "K. A. De Jong, thesis, University of Michigan, 1975";

/// f1: the sphere in three dimensions.
pub const F1: Definition = Definition {
    name: "f1",
    equation: "sum z_i^2",
    character: "unimodal, symmetric, optimum in the middle of the domain",
    reference: DE_JONG,
    dimension: Dimension::Fixed(3),
    limits: (-6.0, 6.0),
    cost: |z| z.iter().map(|z| z * z).sum(),
    optimum: |n| vec![0.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// f2: Rosenbrock's valley in two dimensions.
pub const F2: Definition = Definition {
    name: "f2",
    equation: "100 (z_1^2 - z_2)^2 + (1 - z_1)^2",
    character: "unimodal, curved narrow valley",
    reference: DE_JONG,
    dimension: Dimension::Fixed(2),
    limits: (-6.0, 6.0),
    cost: |z| 100.0 * (z[0] * z[0] - z[1]).powi(2) + (1.0 - z[0]).powi(2),
    optimum: |n| vec![1.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// f3: the step function.
pub const F3: Definition = Definition {
    name: "f3",
    equation: "30 + sum floor(z_i)",
    character: "plateaus, optimum in a corner of the domain",
    reference: DE_JONG,
    dimension: Dimension::Fixed(5),
    limits: (-6.0, 6.0),
    cost: |z| 30.0 + z.iter().map(|z| z.floor()).sum::<f64>(),
    optimum: |n| vec![-5.5; n],
    tolerance: 1e-8,
    shift: Shift::Wrap,
};

/// f4: the quartic in thirty dimensions; its noise is added by [`crate::TestProblem::with_noise`].
pub const F4: Definition = Definition {
    name: "f4",
    equation: "sum z_i^4 (+ N(0, 1) on request)",
    character: "unimodal, flat around the optimum, many components",
    reference: DE_JONG,
    dimension: Dimension::Fixed(30),
    limits: (-1.28, 1.28),
    cost: |z| z.iter().map(|z| (z * z) * (z * z)).sum(),
    optimum: |n| vec![0.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// f5: Shekel's foxholes.
pub const F5: Definition = Definition {
    name: "f5",
    equation: "1 / (1/500 + sum_j 1 / (j + sum_i (z_i - a_ij)^6)), a on the grid {-32, -16, 0, 16, 32}^2",
    character: "25 narrow minima on a plateau; smallest cost 0.998004",
    reference: DE_JONG,
    dimension: Dimension::Fixed(2),
    limits: (-65.0, 65.0),
    cost: foxholes,
    optimum: |_| vec![-31.978_333_774_132_6; 2],
    tolerance: 1e-6,
    shift: Shift::Translate,
};

fn foxholes(z: &[f64]) -> f64 {
    const GRID: [f64; 5] = [-32.0, -16.0, 0.0, 16.0, 32.0];
    let hole = |j: usize| {
        let distance = (z[0] - GRID[j % 5]).powi(6) + (z[1] - GRID[j / 5]).powi(6);
        1.0 / ((j + 1) as f64 + distance)
    };
    1.0 / (0.002 + (0..25).map(hole).sum::<f64>())
}
