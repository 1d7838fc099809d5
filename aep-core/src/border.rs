//! What happens to a component that leaves the domain.

use serde::{Deserialize, Serialize};

use crate::Scalar;

/// What happens to a component that a mutation moved out of the domain. The paper does not say.
///
/// The choice is not a detail: a component pushed onto the border by [`Border::Clamp`] has no way
/// back when steps shrink, and in many dimensions nearly every child of a large step has some
/// component outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Border {
    /// Put it on the limit.
    Clamp,
    /// Mirror it at the limits, as often as needed.
    Reflect,
    /// Draw the step again, up to 100 times; then as [`Border::KeepComponent`].
    Resample,
    /// Keep the parent's value of this component.
    KeepComponent,
    /// Leave it outside: the problem must be defined there.
    Allow,
}

const TRIES: usize = 100;

impl Border {
    /// All choices, for command lines and experiments.
    pub const ALL: [Self; 5] =
        [Self::Clamp, Self::Reflect, Self::Resample, Self::KeepComponent, Self::Allow];

    /// The value of a component that was moved from `parent` to `proposal`; `redraw` makes another
    /// proposal. A proposal that is not finite never survives.
    #[inline]
    pub fn settle<T: Scalar>(
        self,
        proposal: T,
        parent: T,
        (lower, upper): (T, T),
        redraw: impl FnMut() -> T,
    ) -> T {
        if lower <= proposal && proposal <= upper {
            return proposal;
        }
        self.settle_outside(proposal, parent, (lower, upper), redraw)
    }

    #[cold]
    fn settle_outside<T: Scalar>(
        self,
        proposal: T,
        parent: T,
        (lower, upper): (T, T),
        mut redraw: impl FnMut() -> T,
    ) -> T {
        match self {
            Self::Clamp if !proposal.is_nan() => proposal.max(lower).min(upper),
            Self::Reflect if proposal.is_finite() => reflect(proposal, lower, upper),
            Self::Allow if proposal.is_finite() => proposal,
            Self::Resample => {
                (0..TRIES).map(|_| redraw()).find(|p| lower <= *p && *p <= upper).unwrap_or(parent)
            }
            _ => parent,
        }
    }
}

/// Mirrors `x` at both limits: the triangle wave of period 2 (upper - lower).
fn reflect<T: Scalar>(x: T, lower: T, upper: T) -> T {
    let width = upper - lower;
    let period = width + width;
    let phase = (x - lower) % period;
    let phase = if phase < T::zero() { phase + period } else { phase };
    let inside = if phase > width { period - phase } else { phase };
    (lower + inside).max(lower).min(upper)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_choice_does_what_it_says() {
        let settle = |border: Border, x: f64| border.settle(x, 0.5, (0.0, 1.0), || 0.25);
        assert_eq!(settle(Border::Clamp, 1.5), 1.0);
        assert_eq!(settle(Border::Reflect, 1.25), 0.75);
        assert_eq!(settle(Border::Reflect, -2.25), 0.25);
        assert_eq!(settle(Border::Resample, 1.5), 0.25);
        assert_eq!(settle(Border::KeepComponent, 1.5), 0.5);
        assert_eq!(settle(Border::Allow, 1.5), 1.5);
    }

    #[test]
    fn a_step_that_is_not_finite_never_survives() {
        for border in Border::ALL {
            for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let settled = border.settle(x, 0.5, (0.0, 1.0), || f64::NAN);
                assert!((0.0..=1.0).contains(&settled), "{border:?} {x}");
            }
        }
    }
}
