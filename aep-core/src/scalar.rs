//! The number type of positions and costs: [`f32`] or [`f64`].

use std::fmt::{Debug, Display};

use num_traits::Float;
use serde::{Serialize, de::DeserializeOwned};

/// A floating-point number an optimizer can work in, implemented for [`f32`] and [`f64`].
///
/// One name in place of a dozen bounds: generic code writes `T: Scalar`. Random numbers are drawn
/// in `f64` and converted, so that a run in `f32` sees the same stream as one in `f64`.
pub trait Scalar:
    Float + Debug + Display + Default + Send + Sync + Serialize + DeserializeOwned + 'static
{
    /// The nearest value to `value`.
    fn of(value: f64) -> Self;

    /// This value as an `f64` (exact for both implementations).
    fn as_f64(self) -> f64;
}

impl Scalar for f64 {
    #[inline]
    fn of(value: f64) -> Self {
        value
    }

    #[inline]
    fn as_f64(self) -> f64 {
        self
    }
}

impl Scalar for f32 {
    #[inline]
    fn of(value: f64) -> Self {
        value as Self
    }

    #[inline]
    fn as_f64(self) -> f64 {
        f64::from(self)
    }
}
