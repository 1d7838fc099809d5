//! Where a problem is defined: limits, scale and name of each component.

use serde::{Deserialize, Serialize};

use crate::{ConfigError, Scalar, random};

/// How an algorithm sees a component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scale {
    /// As it is.
    #[default]
    Linear,
    /// By its natural logarithm; the lower limit must be positive. For parameters whose order of
    /// magnitude is unknown: a step then multiplies instead of adding.
    Log,
}

/// The box an algorithm searches in.
///
/// A problem sees *problem coordinates* x; an algorithm works in *search coordinates* u, which are
/// u = x on a linear and u = ln x on a logarithmic component. Ask/tell, evaluators and reports all
/// use problem coordinates.
///
/// ```
/// use aep_core::{Domain, Scale};
/// let domain = Domain::new(vec![-1.0, 1e-6], vec![1.0, 1e3])?
///     .with_scales(vec![Scale::Linear, Scale::Log])?
///     .with_names(["offset", "stiffness"])?;
/// assert_eq!(domain.name(1), "stiffness");
/// # Ok::<(), aep_core::ConfigError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "", try_from = "Unchecked<T>")]
pub struct Domain<T: Scalar = f64> {
    lower: Vec<T>,
    upper: Vec<T>,
    scales: Vec<Scale>,
    names: Vec<String>,
    search_lower: Vec<T>,
    search_upper: Vec<T>,
}

/// What a domain is written as: whatever reads it has it checked again. A checkpoint tells fields by their order alone, so that
/// those that follow from others are read, too.
#[derive(Deserialize)]
#[serde(bound = "")]
struct Unchecked<T: Scalar> {
    lower: Vec<T>,
    upper: Vec<T>,
    scales: Vec<Scale>,
    names: Vec<String>,
    #[serde(rename = "search_lower")]
    _search_lower: Vec<T>,
    #[serde(rename = "search_upper")]
    _search_upper: Vec<T>,
}

impl<T: Scalar> TryFrom<Unchecked<T>> for Domain<T> {
    type Error = ConfigError;

    fn try_from(read: Unchecked<T>) -> Result<Self, ConfigError> {
        let domain = Self::new(read.lower, read.upper)?.with_scales(read.scales)?;
        if read.names.is_empty() { Ok(domain) } else { domain.with_names(read.names) }
    }
}

impl<T: Scalar> Domain<T> {
    /// The box between `lower` and `upper`, linear in every component.
    ///
    /// # Errors
    /// When there is no component, the lengths differ, or a pair of limits is not finite with
    /// lower < upper.
    pub fn new(lower: Vec<T>, upper: Vec<T>) -> Result<Self, ConfigError> {
        if lower.is_empty() {
            return Err(ConfigError::EmptyDomain);
        }
        check_length("upper limits", upper.len(), lower.len())?;
        for (component, (&lo, &hi)) in lower.iter().zip(&upper).enumerate() {
            if !(lo < hi && (hi - lo).is_finite()) {
                let (lower, upper) = (lo.as_f64(), hi.as_f64());
                return Err(ConfigError::Limits { component, lower, upper });
            }
        }
        let scales = vec![Scale::Linear; lower.len()];
        let (search_lower, search_upper) = (lower.clone(), upper.clone());
        Ok(Self { lower, upper, scales, names: Vec::new(), search_lower, search_upper })
    }

    /// The cube [`lower`, `upper`]^`dimension`.
    ///
    /// # Errors
    /// As [`Domain::new`], and when that many limits do not fit into memory.
    pub fn cube(dimension: usize, lower: T, upper: T) -> Result<Self, ConfigError> {
        ConfigError::require_fits("domain", 1, dimension)?;
        Self::new(vec![lower; dimension], vec![upper; dimension])
    }

    /// Sets the scale of every component.
    ///
    /// # Errors
    /// When the length is wrong, a logarithmic component reaches zero or below, or its limits have the same logarithm.
    pub fn with_scales(mut self, scales: Vec<Scale>) -> Result<Self, ConfigError> {
        check_length("scales", scales.len(), self.dimension())?;
        for (component, scale) in scales.iter().enumerate() {
            let (lower, upper) = (self.lower[component], self.upper[component]);
            if *scale == Scale::Log && lower <= T::zero() {
                return Err(ConfigError::LogLimit { component, lower: lower.as_f64() });
            }
            let (low, high) = (encode(*scale, lower), encode(*scale, upper));
            if low >= high {
                let (lower, upper) = (lower.as_f64(), upper.as_f64());
                return Err(ConfigError::Limits { component, lower, upper });
            }
            (self.search_lower[component], self.search_upper[component]) = (low, high);
        }
        self.scales = scales;
        Ok(self)
    }

    /// Names the components, for reports and traces.
    ///
    /// # Errors
    /// When there is not one name per component.
    pub fn with_names<S: Into<String>>(
        mut self,
        names: impl IntoIterator<Item = S>,
    ) -> Result<Self, ConfigError> {
        let names: Vec<String> = names.into_iter().map(Into::into).collect();
        check_length("names", names.len(), self.dimension())?;
        self.names = names;
        Ok(self)
    }

    /// Number of components.
    pub fn dimension(&self) -> usize {
        self.lower.len()
    }

    /// Lower limits in problem coordinates.
    pub fn lower(&self) -> &[T] {
        &self.lower
    }

    /// Upper limits in problem coordinates.
    pub fn upper(&self) -> &[T] {
        &self.upper
    }

    /// Scale of each component.
    pub fn scales(&self) -> &[Scale] {
        &self.scales
    }

    /// Name of a component: the given one or `z1`, `z2`, ...
    pub fn name(&self, component: usize) -> String {
        self.names.get(component).cloned().unwrap_or_else(|| format!("z{}", component + 1))
    }

    /// Lower limits in search coordinates.
    #[inline]
    pub fn search_lower(&self) -> &[T] {
        &self.search_lower
    }

    /// Upper limits in search coordinates.
    #[inline]
    pub fn search_upper(&self) -> &[T] {
        &self.search_upper
    }

    /// Whether search and problem coordinates are the same.
    pub fn is_linear(&self) -> bool {
        self.scales.iter().all(|scale| *scale == Scale::Linear)
    }

    /// Whether `x` (problem coordinates) lies inside the limits.
    pub fn contains(&self, x: &[T]) -> bool {
        x.len() == self.dimension()
            && x.iter().zip(&self.lower).zip(&self.upper).all(|((x, lo), hi)| lo <= x && x <= hi)
    }

    /// Problem to search coordinates.
    pub fn encode(&self, x: &[T], u: &mut [T]) {
        for ((u, &x), scale) in u.iter_mut().zip(x).zip(&self.scales) {
            *u = encode(*scale, x);
        }
    }

    /// Search to problem coordinates. What is inside the search limits stays inside the limits,
    /// in spite of rounding.
    pub fn decode(&self, u: &[T], x: &mut [T]) {
        for (j, ((x, &u), scale)) in x.iter_mut().zip(u).zip(&self.scales).enumerate() {
            *x = match scale {
                Scale::Linear => u,
                Scale::Log if self.search_lower[j] <= u && u <= self.search_upper[j] => {
                    u.exp().max(self.lower[j]).min(self.upper[j])
                }
                Scale::Log => u.exp(),
            };
        }
    }

    /// `x` (problem coordinates) moved by a `share` of the width of the domain along `component`, on its
    /// scale, and no further than the limits.
    pub fn shifted(&self, component: usize, x: T, share: T) -> T {
        let (lower, upper) = (self.lower[component], self.upper[component]);
        let shifted = match self.scales[component] {
            Scale::Linear => x + share * (upper - lower),
            Scale::Log => x * (upper / lower).powf(share),
        };
        num_traits::clamp(shifted, lower, upper)
    }

    /// Where `x` (problem coordinates) lies between the limits of `component`, on its scale: 0 at the
    /// lower, 1 at the upper one.
    pub fn share(&self, component: usize, x: T) -> T {
        let (lower, upper) = (self.lower[component], self.upper[component]);
        match self.scales[component] {
            Scale::Linear => (x - lower) / (upper - lower),
            Scale::Log => (x / lower).ln() / (upper / lower).ln(),
        }
    }

    /// A position drawn uniformly in search coordinates.
    pub fn sample(&self, rng: &mut random::Stream, u: &mut [T]) {
        let mut local = rng.clone();
        for ((u, &lo), &hi) in u.iter_mut().zip(&self.search_lower).zip(&self.search_upper) {
            *u = (lo + (hi - lo) * random::uniform(&mut local)).max(lo).min(hi);
        }
        *rng = local;
    }
}

fn encode<T: Scalar>(scale: Scale, x: T) -> T {
    match scale {
        Scale::Linear => x,
        Scale::Log => x.ln(),
    }
}

fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), ConfigError> {
    if found == expected {
        return Ok(());
    }
    Err(ConfigError::Length { what, found, expected })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_limits_are_refused_with_their_component() {
        let bad = |lo: f64, hi: f64| Domain::new(vec![0.0, lo], vec![1.0, hi]).unwrap_err();
        for (lo, hi) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
            assert!(matches!(bad(lo, hi), ConfigError::Limits { component: 1, .. }));
        }
        assert_eq!(Domain::<f64>::new(vec![], vec![]).unwrap_err(), ConfigError::EmptyDomain);
    }

    #[test]
    fn a_log_component_round_trips_inside_its_limits() {
        let domain = Domain::new(vec![1e-7], vec![3e3]).unwrap();
        let domain = domain.with_scales(vec![Scale::Log]).unwrap();
        let mut x = [0.0];
        domain.decode(domain.search_upper(), &mut x);
        assert!(domain.contains(&x));
        domain.decode(domain.search_lower(), &mut x);
        assert!(domain.contains(&x));
    }

    #[test]
    fn a_shift_moves_by_its_share_and_stops_at_the_limits() {
        let domain = Domain::new(vec![-1.0, 1e-2], vec![3.0, 1e4]).unwrap();
        let domain = domain.with_scales(vec![Scale::Linear, Scale::Log]).unwrap();
        for (component, x) in [(0, 0.5_f64), (1, 7.0)] {
            let from = domain.share(component, x);
            let to = domain.share(component, domain.shifted(component, x, 0.25));
            assert!((to - from - 0.25).abs() < 1e-12);
            assert_eq!(domain.shifted(component, x, 2.0), domain.upper()[component]);
            assert_eq!(domain.shifted(component, x, -2.0), domain.lower()[component]);
        }
    }

    #[test]
    fn a_log_component_with_zero_is_refused() {
        let domain = Domain::cube(1, 0.0, 1.0).unwrap();
        let error = domain.with_scales(vec![Scale::Log]).unwrap_err();
        assert!(error.to_string().contains("positive lower limit"));
    }
}
