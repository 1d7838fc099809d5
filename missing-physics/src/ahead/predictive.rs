//! What fitted parameters cost where models are compared.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// What rounding leaves of a curvature.
const ROUNDING: f64 = 1e-12;
/// What it costs where nobody can say what the data know of the parameters, nats: more than any model gains.
const UNKNOWN: Cost = Cost { moved: 0.0, open: 1e12 };

/// Curvature of a loss over the parameters, and the way down: minus its gradient.
#[derive(Clone, Debug)]
pub struct Bowl {
    /// The curvature.
    pub matrix: DMatrix<f64>,
    /// The way down.
    pub moment: DVector<f64>,
}

/// What the loss of all folds is larger by where each is foretold by the others, nats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// For the parameters that each would move. Of errors that are worth more it is more.
    pub moved: f64,
    /// For what the others leave open of the parameters.
    pub open: f64,
}

/// What fitted parameters cost where each fold is foretold by the `prior` and the other folds. The parameters
/// are spread as these leave them open, and errors change with them as they do at first order:
/// `(g' H_-^-1 g + ln |H| / |H_-|) / 2` with the gradient `g` of the fold, `H` of all, `H_-` of the others, at the bottom of
/// all. Where the others know a parameter, that is a refit without the fold; where they do not, it costs the logarithm of how
/// much better the fold knows it (C. Bishop, Pattern Recognition and Machine Learning, 2006, 3.3.2).
pub fn cost(prior: Bowl, folds: &[Bowl]) -> Cost {
    let mut all = prior;
    for fold in folds {
        all.matrix += &fold.matrix;
        all.moment += &fold.moment;
    }
    // In units in which the data say as much of each rounding takes no parameter for another.
    let unit = DMatrix::from_diagonal(&all.matrix.diagonal().map(|value| 1.0 / value.sqrt()));
    let known = |matrix: &DMatrix<f64>| -> Option<Cholesky<f64, Dyn>> {
        let rounded = DMatrix::from_diagonal_element(unit.nrows(), unit.nrows(), ROUNDING);
        Cholesky::new(&unit * matrix * &unit + rounded)
    };
    let Some(whole) = known(&all.matrix) else { return UNKNOWN };
    let step = &unit * whole.solve(&(&unit * &all.moment));
    let mut cost = Cost { moved: 0.0, open: 0.0 };
    for fold in folds {
        let Some(others) = known(&(&all.matrix - &fold.matrix)) else { return UNKNOWN };
        let push = &unit * (&fold.moment - &fold.matrix * &step);
        cost.moved += 0.5 * push.dot(&others.solve(&push));
        cost.open += 0.5 * (whole.ln_determinant() - others.ln_determinant());
    }
    cost
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// Folds of a linear model with errors of 1: what each error changes by with the parameters, and the errors at `at`.
    fn linear(seed: u64, at: &DVector<f64>) -> Vec<(DMatrix<f64>, DVector<f64>)> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut normal = || StandardNormal.sample(&mut random);
        let mut fold = || {
            let by = DMatrix::from_fn(8, at.len(), |_, _| normal());
            let errors = DVector::from_fn(8, |_, _| normal()) + &by * at;
            (by, errors)
        };
        (0..5).map(|_| fold()).collect()
    }

    fn bowl((by, errors): &(DMatrix<f64>, DVector<f64>)) -> Bowl {
        Bowl { matrix: by.transpose() * by, moment: -by.transpose() * errors }
    }

    fn flat(curvature: f64) -> Bowl {
        Bowl { matrix: DMatrix::from_diagonal_element(3, 3, curvature), moment: DVector::zeros(3) }
    }

    #[test]
    fn it_is_what_the_other_folds_foretell_less_well() {
        for seed in 0..20 {
            // Anywhere: the cost is that at the bottom.
            let data = linear(seed, &DVector::from_vec(vec![0.3, -1.0, 2.0]));
            let folds: Vec<Bowl> = data.iter().map(bowl).collect();
            let least = |without: Option<usize>| {
                let parts = folds.iter().enumerate().filter(|(k, _)| Some(*k) != without);
                let (mut matrix, mut moment) = (flat(1e-4).matrix, DVector::zeros(3));
                for (_, part) in parts {
                    matrix += &part.matrix;
                    moment += &part.moment;
                }
                let inverse = matrix.try_inverse().unwrap();
                (&inverse * moment, inverse)
            };
            let (bottom, _) = least(None);
            let expected: f64 = data
                .iter()
                .enumerate()
                .map(|(k, (by, errors))| {
                    let (step, open) = least(Some(k));
                    let spread = DMatrix::identity(8, 8) + by * open * by.transpose();
                    let (foretold, fitted) = (errors + by * step, errors + by * &bottom);
                    let square = foretold.dot(&(spread.clone().try_inverse().unwrap() * &foretold));
                    0.5 * (square + spread.determinant().ln() - fitted.norm_squared())
                })
                .sum();
            let found = cost(flat(1e-4), &folds);
            let found = found.moved + found.open;
            assert!((found / expected - 1.0).abs() < 1e-3, "seed {seed}: {found} {expected}");
        }
    }

    #[test]
    fn what_only_one_fold_knows_costs_a_logarithm() {
        let one = |curvature: f64, push: f64| Bowl {
            matrix: DMatrix::from_element(1, 1, curvature),
            moment: DVector::from_element(1, push),
        };
        for curvature in [1.0, 1e3, 1e6] {
            let folds = [one(curvature, 50.0), one(0.0, 0.0), one(0.0, 0.0)];
            let bottom = 50.0 / (1.0 + curvature);
            let (moved, open) = (0.5 * bottom * bottom, 0.5 * (1.0 + curvature).ln());
            let found = cost(one(1.0, 0.0), &folds);
            assert!((found.moved / moved - 1.0).abs() < 1e-5, "{curvature}: {found:?}");
            assert!((found.open / open - 1.0).abs() < 1e-5, "{curvature}: {found:?}");
        }
    }

    #[test]
    fn nobody_knows_what_is_no_number() {
        let mut folds: Vec<Bowl> = linear(1, &DVector::zeros(3)).iter().map(bowl).collect();
        folds[2].matrix[(0, 1)] = f64::NAN;
        folds[2].matrix[(1, 0)] = f64::NAN;
        assert_eq!(cost(flat(1e-4), &folds), UNKNOWN);
        folds[2].matrix.fill(f64::INFINITY);
        assert_eq!(cost(flat(1e-4), &folds), UNKNOWN);
    }
}
