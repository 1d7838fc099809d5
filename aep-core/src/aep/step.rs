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
}

/// The length that one component's step is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StepUnit {
    /// 1 in every component, by the paper.
    Absolute,
    /// The width of the domain (in search coordinates).
    Domain,
    /// The standard deviation of the component over the better half of the population: shrinks as
    /// the population converges and follows differently scaled parameters.
    Population,
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
    pub(super) units: Vec<T>,
}

impl<T: Scalar> Steps<T> {
    pub(super) fn new() -> Self {
        Self { offset: T::zero(), factor: T::one(), floor: T::zero(), units: Vec::new() }
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
        match scale {
            StepScale::Cost => {}
            StepScale::AboveReference(reference) => self.offset = T::of(reference),
            StepScale::Relative { floor } => self.relate(&population.costs, T::of(floor)),
        }
        if unit == StepUnit::Population {
            self.units = spread_of_better_half(population);
        } else if self.units.is_empty() {
            self.units = fixed_units(unit, domain);
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

/// Standard deviation of each component over the individuals not worse than the median.
fn spread_of_better_half<T: Scalar, I>(population: &Population<T, I>) -> Vec<T> {
    let (_, median) = best_and_median(&population.costs);
    let rows = || (0..population.len()).filter(|&i| population.costs[i] <= median);
    let count = T::of(rows().count() as f64);
    let dimension = population.positions.dimension();
    let mut mean = vec![T::zero(); dimension];
    for row in rows() {
        for (mean, z) in mean.iter_mut().zip(population.positions.row(row)) {
            *mean = *mean + *z / count;
        }
    }
    let mut variance = vec![T::zero(); dimension];
    for row in rows() {
        let z = population.positions.row(row);
        for ((variance, z), mean) in variance.iter_mut().zip(z).zip(&mean) {
            *variance = *variance + (*z - *mean).powi(2) / count;
        }
    }
    variance.into_iter().map(T::sqrt).collect()
}
