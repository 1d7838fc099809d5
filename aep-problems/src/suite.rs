//! The usual suite: functions of any dimension.

use std::f64::consts::{E, PI, TAU};

use crate::{Definition, Dimension, Shift};

const ANY: Dimension = Dimension::Any { least: 1, usual: 10 };
const TWO_UP: Dimension = Dimension::Any { least: 2, usual: 10 };

/// The sphere.
pub const SPHERE: Definition = Definition {
    name: "sphere",
    equation: "sum z_i^2",
    character: "unimodal, separable, perfectly conditioned",
    reference: "I. Rechenberg, Evolutionsstrategie, 1973",
    dimension: ANY,
    limits: (-5.12, 5.12),
    cost: |z| z.iter().map(|z| z * z).sum(),
    optimum: |n| vec![0.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// The ellipsoid of condition 10^6.
pub const ELLIPSOID: Definition = Definition {
    name: "ellipsoid",
    equation: "sum 10^(6 (i-1)/(n-1)) z_i^2",
    character: "unimodal, separable, condition 10^6",
    reference: "N. Hansen, A. Ostermeier, Evolutionary Computation 9(2), 2001",
    dimension: ANY,
    limits: (-5.0, 5.0),
    cost: |z| {
        let last = z.len().saturating_sub(1).max(1) as f64;
        z.iter().enumerate().map(|(i, z)| 1e6f64.powf(i as f64 / last) * z * z).sum()
    },
    optimum: |n| vec![0.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// The sum of the squares of all partial sums: Schwefel's problem 1.2.
pub const SCHWEFEL_1_2: Definition = Definition {
    name: "schwefel-1.2",
    equation: "sum_i (sum_{j<=i} z_j)^2",
    character: "unimodal, not separable, condition about n^2",
    reference: "H.-P. Schwefel, Numerical Optimization of Computer Models, 1981",
    dimension: ANY,
    limits: (-65.0, 65.0),
    cost: |z| {
        let mut sum = 0.0;
        z.iter().fold(0.0, |cost, z| {
            sum += z;
            cost + sum * sum
        })
    },
    optimum: |n| vec![0.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// Rosenbrock's valley in n dimensions.
pub const ROSENBROCK: Definition = Definition {
    name: "rosenbrock",
    equation: "sum 100 (z_{i+1} - z_i^2)^2 + (1 - z_i)^2",
    character: "curved narrow valley, a second local minimum from n = 4 on",
    reference: "H. H. Rosenbrock, Computer Journal 3, 1960",
    dimension: TWO_UP,
    limits: (-5.0, 10.0),
    cost: |z| {
        z.windows(2).map(|w| 100.0 * (w[1] - w[0] * w[0]).powi(2) + (1.0 - w[0]).powi(2)).sum()
    },
    optimum: |n| vec![1.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// Rastrigin's function.
pub const RASTRIGIN: Definition = Definition {
    name: "rastrigin",
    equation: "10 n + sum z_i^2 - 10 cos(2 pi z_i)",
    character: "about 11^n regular minima, separable",
    reference: "H. Muehlenbein, D. Schomisch, J. Born, Parallel Computing 17, 1991",
    dimension: ANY,
    limits: (-5.12, 5.12),
    cost: |z| z.iter().map(|z| 10.0 + z * z - 10.0 * (TAU * z).cos()).sum(),
    optimum: |n| vec![0.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// Ackley's function.
pub const ACKLEY: Definition = Definition {
    name: "ackley",
    equation: "20 + e - 20 exp(-0.2 sqrt(sum z_i^2 / n)) - exp(sum cos(2 pi z_i) / n)",
    character: "many shallow minima around one funnel",
    reference: "D. H. Ackley, A Connectionist Machine for Genetic Hillclimbing, 1987",
    dimension: ANY,
    limits: (-32.0, 32.0),
    cost: |z| {
        let n = z.len() as f64;
        let square = z.iter().map(|z| z * z).sum::<f64>() / n;
        let wave = z.iter().map(|z| (TAU * z).cos()).sum::<f64>() / n;
        (20.0 + E - 20.0 * (-0.2 * square.sqrt()).exp() - wave.exp()).max(0.0)
    },
    optimum: |n| vec![0.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// Griewank's function.
pub const GRIEWANK: Definition = Definition {
    name: "griewank",
    equation: "1 + sum z_i^2 / 4000 - prod cos(z_i / sqrt(i))",
    character: "many minima; easier in many dimensions than in few",
    reference: "A. O. Griewank, J. Optimization Theory and Applications 34, 1981",
    dimension: ANY,
    limits: (-600.0, 600.0),
    cost: |z| {
        let square = z.iter().map(|z| z * z).sum::<f64>() / 4000.0;
        let wave = |(i, z): (usize, &f64)| (z / ((i + 1) as f64).sqrt()).cos();
        1.0 + square - z.iter().enumerate().map(wave).product::<f64>()
    },
    optimum: |n| vec![0.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// Schwefel's function 2.26.
pub const SCHWEFEL: Definition = Definition {
    name: "schwefel",
    equation: "418.9829 n - sum z_i sin(sqrt|z_i|)",
    character: "the second best minimum is far away from the best, which is near the border",
    reference: "H.-P. Schwefel, Numerical Optimization of Computer Models, 1981",
    dimension: ANY,
    limits: (-500.0, 500.0),
    cost: |z| {
        z.iter().map(|z| 418.982_887_272_433_7 - z * z.abs().sqrt().sin()).sum::<f64>().max(0.0)
    },
    optimum: |n| vec![420.968_746_359_982; n],
    tolerance: 1e-6,
    shift: Shift::Wrap,
};

/// Levy's function.
pub const LEVY: Definition = Definition {
    name: "levy",
    equation: "sin^2(pi w_1) + sum (w_i - 1)^2 (1 + 10 sin^2(pi w_i + 1)) + (w_n - 1)^2 (1 + sin^2(2 pi w_n)), w = 1 + (z - 1) / 4",
    character: "many minima in a valley",
    reference: "A. V. Levy, A. Montalvo, SIAM J. Sci. Stat. Comput. 6, 1985",
    dimension: TWO_UP,
    limits: (-10.0, 10.0),
    cost: |z| {
        let w = |i: usize| 1.0 + (z[i] - 1.0) / 4.0;
        let last = z.len() - 1;
        let middle =
            |i: usize| (w(i) - 1.0).powi(2) * (1.0 + 10.0 * (PI * w(i) + 1.0).sin().powi(2));
        let end = (w(last) - 1.0).powi(2) * (1.0 + (TAU * w(last)).sin().powi(2));
        (PI * w(0)).sin().powi(2) + (0..last).map(middle).sum::<f64>() + end
    },
    optimum: |n| vec![1.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};

/// The sum of different powers.
pub const POWERS: Definition = Definition {
    name: "powers",
    equation: "sum |z_i|^(2 + 4 (i-1)/(n-1))",
    character: "unimodal, sensitivities diverge towards the optimum",
    reference: "N. Hansen et al., BBOB f14, INRIA RR-6829, 2009",
    dimension: ANY,
    limits: (-5.0, 5.0),
    cost: |z| {
        let last = z.len().saturating_sub(1).max(1) as f64;
        z.iter().enumerate().map(|(i, z)| z.abs().powf(2.0 + 4.0 * i as f64 / last)).sum()
    },
    optimum: |n| vec![0.0; n],
    tolerance: 1e-8,
    shift: Shift::Translate,
};
