//! Parameter intervals that stay honest when residuals are autocorrelated.
//!
//! The covariance is the sandwich `(JᵀJ)⁻¹ Ω (JᵀJ)⁻¹`, where Ω sums the scores `Jᵀr` over whole blocks
//! of time (a batch-means estimate): neighbouring residuals that err together count once. The
//! classical covariance is a lower limit.

use std::collections::BTreeMap;

use aep_core::Scale;
use nalgebra::{DMatrix, DVector};

use crate::family::{ModelFamily, TermParameter};
use crate::fit::Fit;
use crate::report::Estimate;

/// Blocks of time over which scores are summed.
const BLOCKS: usize = 40;
/// Half-width of a 95 % interval in standard errors (Student's t, about 35 degrees of freedom).
const STUDENT: f64 = 2.03;
/// Curvature added to every direction, relative to that of a single parameter.
const UNSEEN: f64 = 1e-9;
/// A parameter on a logarithmic scale is called identifiable where its interval spans less than
/// this factor to either side.
const WIDEST_FACTOR: f64 = 3.0;

/// Every parameter of the fit with its 95 % interval; `weights` are those of the fit.
pub fn estimates(
    family: &dyn ModelFamily,
    fit: &Fit,
    weights: &[f64],
) -> BTreeMap<String, Estimate> {
    let errors = standard_errors(fit, weights);
    fit.model
        .parameters(family)
        .zip(&fit.model.values)
        .zip(errors)
        .map(|(((term, parameter), value), error)| {
            (term.key(parameter), estimate(parameter, *value, error))
        })
        .collect()
}

fn estimate(parameter: &TermParameter, value: f64, error: f64) -> Estimate {
    let reach = STUDENT * error;
    let (low, high) = match parameter.scale {
        // Beyond e^50 an interval is everything.
        Scale::Log => (value * (-reach.min(50.0)).exp(), value * reach.min(50.0).exp()),
        Scale::Linear => (value - reach, value + reach),
    };
    let (low, high) = (low.max(parameter.lower), high.min(parameter.upper));
    let at_bound = value <= parameter.lower || value >= parameter.upper;
    let narrow = match parameter.scale {
        Scale::Log => reach < WIDEST_FACTOR.ln(),
        Scale::Linear => reach < value.abs().max(0.5 * parameter.start.abs()),
    };
    Estimate {
        value,
        low,
        high,
        unit: parameter.unit.clone(),
        identifiable: narrow && (!at_bound || parameter.scale == Scale::Linear),
    }
}

/// Standard errors on each parameter's own scale; infinite where the data do not see it.
fn standard_errors(fit: &Fit, weights: &[f64]) -> Vec<f64> {
    let mut errors = vec![f64::INFINITY; fit.jacobian.len()];
    let Some(covariance) = Covariance::of(fit, weights) else { return errors };
    for (position, &k) in covariance.seen.iter().enumerate() {
        let classical = covariance.classical[(position, position)];
        let sandwich = covariance.sandwich[(position, position)];
        errors[k] = sandwich.max(classical).sqrt() / covariance.lengths[k];
    }
    errors
}

/// What a fit says of all parameters together: parameters that are not determined one by one may well be in their
/// combinations.
#[derive(Clone, Debug)]
pub struct Covariance {
    /// Parameters that the data see.
    seen: Vec<usize>,
    lengths: Vec<f64>,
    sandwich: DMatrix<f64>,
    classical: DMatrix<f64>,
}

impl Covariance {
    /// Of the parameters of a fit, each on its own scale; `weights` are those of the fit.
    pub fn of(fit: &Fit, weights: &[f64]) -> Option<Self> {
        let (points, parameters) = (fit.residual.len(), fit.jacobian.len());
        let lengths: Vec<f64> = fit
            .jacobian
            .iter()
            .map(|column| crate::fit::weighted_square(column, weights).sqrt())
            .collect();
        let seen: Vec<usize> = (0..parameters).filter(|&k| lengths[k] > 0.0).collect();
        let row = |i: usize| {
            DVector::from_iterator(
                seen.len(),
                seen.iter().map(|&k| fit.jacobian[k][i] * weights[i] / lengths[k]),
            )
        };
        let mut normal = DMatrix::zeros(seen.len(), seen.len());
        let mut scores = vec![DVector::zeros(seen.len()); BLOCKS];
        let mut square = 0.0;
        for i in 0..points {
            let jacobian = row(i);
            let residual = fit.residual[i] * weights[i];
            square += residual * residual;
            normal.ger(1.0, &jacobian, &jacobian, 1.0);
            scores[i * BLOCKS / points].axpy(residual, &jacobian, 1.0);
        }
        let used = weights.iter().filter(|weight| **weight > 0.0).count();
        let freedom = used.saturating_sub(seen.len()).max(1) as f64;
        let mut omega = DMatrix::zeros(seen.len(), seen.len());
        for score in &scores {
            omega.ger(1.0, score, score, 1.0);
        }
        // Directions that the data do not see at all get a variance that is large but finite, so that
        // those it sees keep theirs.
        let unseen = DMatrix::identity(seen.len(), seen.len()) * UNSEEN;
        let inverse = (normal + unseen).cholesky().map(|c| c.inverse())?;
        let correction = BLOCKS as f64 / (BLOCKS - 1) as f64;
        let sandwich = &inverse * omega * &inverse * correction;
        let classical = inverse.map(|value| value * square / freedom);
        Some(Self { seen, lengths, sandwich, classical })
    }

    /// Half-width of the 95 % interval of a quantity with these derivatives by the parameters, each on its own scale;
    /// infinite where it depends on one that the data do not see.
    pub fn reach(&self, derivatives: &[f64]) -> f64 {
        let sees = |k: &usize| self.seen.contains(k);
        if (0..derivatives.len()).any(|k| derivatives[k] != 0.0 && !sees(&k)) {
            return f64::INFINITY;
        }
        let scaled = self.seen.iter().map(|k| derivatives[*k] / self.lengths[*k]);
        let along = DVector::from_iterator(self.seen.len(), scaled);
        let variance = |of: &DMatrix<f64>| (of * &along).dot(&along);
        STUDENT * variance(&self.sandwich).max(variance(&self.classical)).max(0.0).sqrt()
    }
}
