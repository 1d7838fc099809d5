//! What foretells a value from the few before it, for every order: Yule and Walker's equations by Levinson's recursion
//! (N. Levinson, 1947).
//!
//! The filter is monic: what it leaves of errors has the likelihood of those errors (G. E. P. Box and G. M. Jenkins,
//! 1970), whatever its order.

use std::ops::Range;

use crate::statistics::basis::{add_scaled, dot};

/// Predictors of every order from none: the first values of a run have fewer before them.
#[derive(Clone, Debug, PartialEq)]
pub struct Autoregression {
    orders: Vec<Predictor>,
}

/// What predicts a value from those before it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Predictor {
    /// The nearest one first.
    pub coefficients: Vec<f64>,
    /// Sum of the squares that are left.
    pub left: f64,
}

impl Autoregression {
    /// Of values that nothing foretells.
    pub fn none() -> Self {
        Self { orders: vec![Predictor { coefficients: Vec::new(), left: 1.0 }] }
    }

    /// Of values of which those in a run follow each other, up to an order. Reflections count as `most` at most: a value
    /// that would be known from the others is known by nobody so well.
    pub fn of(values: &[f64], runs: &[Range<usize>], order: usize, most: f64) -> Self {
        let product = |lag: usize| -> f64 {
            let long = runs.iter().filter(|run| run.len() > lag);
            long.map(|run| {
                dot(&values[run.start + lag..run.end], &values[run.start..run.end - lag])
            })
            .sum()
        };
        Self::from_products(&(0..=order).map(product).collect::<Vec<f64>>(), most)
    }

    /// By the sums of products at each lag.
    pub fn from_products(products: &[f64], most: f64) -> Self {
        let square = products.first().copied().unwrap_or_default();
        let mut orders = vec![Predictor { coefficients: Vec::new(), left: square }];
        for order in 1..products.len() {
            let Predictor { coefficients: last, left } = &orders[order - 1];
            let foretold: f64 =
                last.iter().zip((1..order).rev()).map(|(a, lag)| a * products[lag]).sum();
            let reflected = (products[order] - foretold) / left;
            // Nothing is left to foretell, or nothing is known.
            if !reflected.is_finite() || reflected.abs() >= 1.0 {
                break;
            }
            let reflected = reflected.clamp(-most, most);
            let mut coefficients: Vec<f64> =
                last.iter().zip(last.iter().rev()).map(|(a, b)| a - reflected * b).collect();
            coefficients.push(reflected);
            let left = left * (1.0 - reflected * reflected);
            orders.push(Predictor { coefficients, left });
        }
        Self { orders }
    }

    /// The highest order.
    pub fn order(&self) -> usize {
        self.orders.len() - 1
    }

    /// The predictor with this many values before one, or with all that it takes.
    pub fn with_before(&self, known: usize) -> &Predictor {
        &self.orders[known.min(self.order())]
    }

    /// What it leaves of values.
    pub fn left(&self, values: &[f64], runs: &[Range<usize>]) -> Vec<f64> {
        let mut left = vec![0.0; values.len()];
        let all = &self.with_before(self.order()).coefficients;
        for run in runs {
            let known = (run.start + all.len()).min(run.end);
            for k in run.start..known {
                let known = &self.with_before(k - run.start).coefficients;
                let before = values[run.start..k].iter().rev();
                let foretold: f64 = known.iter().zip(before).map(|(a, v)| a * v).sum();
                left[k] = values[k] - foretold;
            }
            left[known..run.end].copy_from_slice(&values[known..run.end]);
            for (lag, a) in (1..).zip(all).take_while(|_| known < run.end) {
                add_scaled(&mut left[known..run.end], -a, &values[known - lag..run.end - lag]);
            }
        }
        left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_of_each_order_follows_from_the_products_at_each_lag() {
        // Each value half of the one before.
        let law = Autoregression::from_products(&[1.0, 0.5, 0.25, 0.125], 1.0);
        assert_eq!(law.order(), 3);
        assert_eq!(law.with_before(9).coefficients, [0.5, 0.0, 0.0]);
        assert!((law.with_before(1).left - 0.75).abs() < 1e-15);
        assert_eq!(law.with_before(0), &Predictor { coefficients: Vec::new(), left: 1.0 });
        // All lags alike: the next value is known from one, and so by nobody.
        assert_eq!(Autoregression::from_products(&[1.0; 4], 1.0).order(), 0);
        assert_eq!(Autoregression::from_products(&[0.0; 4], 1.0).order(), 0);
        let nearly = Autoregression::from_products(&[1.0, 0.9999], 0.9);
        assert_eq!(nearly.with_before(1).coefficients, [0.9]);
    }

    #[test]
    fn runs_have_nothing_to_do_with_each_other() {
        let law = Autoregression::from_products(&[1.0, 0.5], 1.0);
        assert_eq!(law.left(&[2.0, 2.0, 2.0], &[0..2, 2..3]), [2.0, 1.0, 2.0]);
    }
}
