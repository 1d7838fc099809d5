//! The unit cube: search coordinates as shares of the domain's width, for methods with one step size.

use crate::{Border, Domain, Scalar};

/// The unit cube of a domain's dimension.
#[derive(Clone, Debug)]
pub(crate) struct Cube {
    middle: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Cube {
    pub fn new(dimension: usize) -> Self {
        let [middle, lower, upper] = [0.5, 0.0, 1.0].map(|share| vec![share; dimension]);
        Self { middle, lower, upper }
    }

    /// Search coordinates as shares.
    pub fn shares<T: Scalar>(domain: &Domain<T>, search: &[T]) -> Vec<f64> {
        let limits = domain.search_lower().iter().zip(domain.search_upper());
        search.iter().zip(limits).map(|(&u, (&lo, &hi))| ((u - lo) / (hi - lo)).as_f64()).collect()
    }

    /// Shares in problem coordinates, mirrored into the domain where they lie outside.
    pub fn place<T: Scalar>(&self, domain: &Domain<T>, shares: &[f64], out: &mut [T]) {
        let mut inside = shares.to_vec();
        Border::Reflect.settle(&mut inside, &self.middle, (&self.lower, &self.upper), |_| 0.5);
        let limits = domain.search_lower().iter().zip(domain.search_upper());
        let search: Vec<T> = inside
            .into_iter()
            .zip(limits)
            .map(|(share, (lo, hi))| (*lo + (*hi - *lo) * T::of(share)).max(*lo).min(*hi))
            .collect();
        domain.decode(&search, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_come_back_and_what_lies_outside_is_mirrored() {
        let domain = Domain::new(vec![-2.0, 10.0], vec![6.0, 20.0]).unwrap();
        let cube = Cube::new(2);
        let mut out = [0.0; 2];
        cube.place(&domain, &Cube::shares(&domain, &[4.0, 12.0]), &mut out);
        assert_eq!(out, [4.0, 12.0]);
        cube.place(&domain, &[1.25, -0.1], &mut out);
        assert_eq!(out, [4.0, 11.0]);
        // Not a number becomes the middle.
        cube.place(&domain, &[f64::NAN, 0.5], &mut out);
        assert_eq!(out, [2.0, 15.0]);
    }
}
