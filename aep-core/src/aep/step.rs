//! How long AEP's steps are: the readings of the paper and the documented variants.

use serde::{Deserialize, Serialize};

use crate::{Domain, Population, Scalar};

/// What s is in N(0, s).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Spread {
    /// The standard deviation, as the paper's text says.
    StandardDeviation,
    /// The variance, as its printed results need: steps shrink with the square root of the cost.
    Variance,
}

/// Whether s is divided by the number of components n.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Division {
    /// s = beta f.
    Whole,
    /// s = beta f / n, as Fogel's evolutionary programming does in places.
    PerComponent,
}

/// What takes the place of f in s = beta f.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StepScale {
    /// The cost itself, by the paper. Converges only if the smallest cost is 0; of a negative cost
    /// the magnitude is taken.
    Cost,
    /// The cost above a known smallest cost.
    AboveReference(f64),
    /// The cost relative to the population:
    /// (f - `f_best`) / (`f_median` - `f_best`) + `floor`, free of the cost's unit and offset. The
    /// floor keeps the best individual moving.
    Relative {
        /// Scale of the best individual's steps.
        floor: f64,
    },
    /// 1: the cost plays no part, s = beta. Only the unit then makes steps shrink, so this needs
    /// [`StepUnit::Population`] or [`StepUnit::Covariance`] to converge.
    Constant,
}

/// The length that a step is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StepUnit {
    /// 1 in every component, by the paper.
    Absolute,
    /// The width of the domain (in search coordinates).
    Domain,
    /// The standard deviation of each component over the better `share` of the population: shrinks
    /// as the population converges and follows differently scaled parameters.
    Population {
        /// Part of the population that counts, in (0, 1].
        share: f64,
    },
    /// The covariance of the better `share` of the population: follows parameters that only change
    /// well together. A step is drawn from N(0, s^2 C); at age 1 it is mirrored, if need be, into
    /// the half-space that the directions d point into.
    Covariance {
        /// Part of the population that counts, in (0, 1].
        share: f64,
    },
}

/// Which components of a child differ from its parent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Components {
    /// All, by the paper.
    All,
    /// With `probability`, each component moves with probability `share` only (at least one does):
    /// for costs with many minima along the axes.
    Mixed {
        /// Part of the children that are made this way.
        probability: f64,
        /// Part of the components that then move.
        share: f64,
    },
}

/// What happens to an individual that has had no success for long.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum AgeLimit {
    /// Its steps grow for ever, by the paper.
    Unlimited,
    /// Beyond this age its steps grow no more.
    Saturate(u32),
    /// Beyond this age its children descend from a better individual, chosen at random; its own
    /// position is given up only when such a child is better.
    Adopt(u32),
}

/// Scale and unit of a generation's steps.
#[derive(Clone, Debug)]
pub(super) struct Steps<T> {
    offset: T,
    factor: T,
    floor: T,
    /// Unit of each component.
    pub(super) units: Vec<T>,
    /// Rows whose random combination has the covariance of the better part, one after the other;
    /// empty unless the unit is the covariance.
    pub(super) deviations: Vec<T>,
}

impl<T: Scalar> Steps<T> {
    pub(super) fn new(scale: StepScale) -> Self {
        let (zero, one) = (T::zero(), T::one());
        let (offset, factor, floor) = match scale {
            StepScale::Constant => (zero, zero, one),
            StepScale::AboveReference(reference) => (T::of(reference), one, zero),
            StepScale::Cost | StepScale::Relative { .. } => (zero, one, zero),
        };
        Self { offset, factor, floor, units: Vec::new(), deviations: Vec::new() }
    }

    /// The value that multiplies beta.
    #[inline]
    pub(super) fn scale(&self, cost: T) -> T {
        ((cost - self.offset) * self.factor).abs() + self.floor
    }

    pub(super) fn update<I>(
        &mut self,
        (scale, unit): (StepScale, StepUnit),
        population: &Population<T, I>,
        domain: &Domain<T>,
    ) {
        if let StepScale::Relative { floor } = scale {
            self.relate(&population.costs, T::of(floor));
        }
        match unit {
            StepUnit::Population { share } | StepUnit::Covariance { share } => {
                self.spread(population, share);
                if let StepUnit::Population { .. } = unit {
                    self.deviations.clear();
                }
            }
            _ if self.units.is_empty() => self.units = fixed_units(unit, domain),
            _ => {}
        }
    }

    fn relate(&mut self, costs: &[T], floor: T) {
        let (best, median) = best_and_median(costs);
        let width = median - best;
        let usable = width > T::zero() && width.is_finite();
        self.offset = best;
        self.factor = if usable { T::one() / width } else { T::zero() };
        self.floor = floor;
    }

    /// Deviations of the better part from its mean, divided by the root of their number, and their
    /// lengths per component. Large populations are represented by a part of their members.
    fn spread<I>(&mut self, population: &Population<T, I>, share: f64) {
        let dimension = population.positions.dimension();
        let order = population.ranking();
        let count =
            ((order.len() as f64 * share).round() as usize).clamp(2.min(order.len()), order.len());
        let stride = count.div_ceil((4 * dimension).max(40));
        let members: Vec<usize> = order[..count].iter().step_by(stride).copied().collect();
        let weight = T::one() / T::of(members.len() as f64);
        let mut mean = vec![T::zero(); dimension];
        for &i in &members {
            add_scaled(&mut mean, population.positions.row(i), weight);
        }
        self.units = vec![T::zero(); dimension];
        self.deviations.clear();
        for &i in &members {
            for (j, (z, mean)) in population.positions.row(i).iter().zip(&mean).enumerate() {
                let deviation = (*z - *mean) * weight.sqrt();
                self.units[j] = self.units[j] + deviation * deviation;
                self.deviations.push(deviation);
            }
        }
        self.units.iter_mut().for_each(|unit| *unit = unit.sqrt());
    }
}

/// `sum += factor * row`.
#[inline]
pub(super) fn add_scaled<T: Scalar>(sum: &mut [T], row: &[T], factor: T) {
    for (sum, value) in sum.iter_mut().zip(row) {
        *sum = *sum + factor * *value;
    }
}

fn fixed_units<T: Scalar>(unit: StepUnit, domain: &Domain<T>) -> Vec<T> {
    let limits = domain.search_lower().iter().zip(domain.search_upper());
    limits.map(|(&lo, &hi)| if unit == StepUnit::Domain { hi - lo } else { T::one() }).collect()
}

fn best_and_median<T: Scalar>(costs: &[T]) -> (T, T) {
    let mut sorted = costs.to_vec();
    let middle = sorted.len() / 2;
    let (below, median, _) = sorted.select_nth_unstable_by(middle, |a, b| {
        a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal)
    });
    (below.iter().copied().fold(*median, T::min), *median)
}
