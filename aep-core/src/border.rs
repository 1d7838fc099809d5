//! What happens to a component that leaves the domain.

use serde::{Deserialize, Serialize};

use crate::{Scalar, wide};

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

    /// Settles every component of a child that was moved away from `parent`; `redraw` makes another
    /// proposal for a component. A proposal that is not finite never survives.
    #[inline]
    pub fn settle<T: Scalar>(
        self,
        child: &mut [T],
        parent: &[T],
        (lower, upper): (&[T], &[T]),
        redraw: impl FnMut(usize) -> T,
    ) {
        let n = child.len();
        let (lower, upper, parent) = (&lower[..n], &upper[..n], &parent[..n]);
        if wide::all_within(child, lower, upper) {
            return;
        }
        if self == Self::Reflect {
            wide::reflect(child, parent, lower, upper);
        } else {
            self.settle_each(child, parent, (lower, upper), redraw);
        }
    }

    fn settle_each<T: Scalar>(
        self,
        child: &mut [T],
        parent: &[T],
        (lower, upper): (&[T], &[T]),
        mut redraw: impl FnMut(usize) -> T,
    ) {
        for j in 0..child.len() {
            let (proposal, lower, upper) = (child[j], lower[j], upper[j]);
            let within = |z: &T| lower <= *z && *z <= upper;
            if within(&proposal) {
                continue;
            }
            child[j] = match self {
                Self::Clamp if !proposal.is_nan() => proposal.max(lower).min(upper),
                Self::Reflect => reflect(proposal, parent[j], lower, upper),
                Self::Allow if proposal.is_finite() => proposal,
                Self::Resample => (0..TRIES).map(|_| redraw(j)).find(within).unwrap_or(parent[j]),
                _ => parent[j],
            };
        }
    }
}

/// Mirrors `x` at both limits if it is outside: the triangle wave of period 2 (upper - lower), which
/// is the distance to the nearest even multiple of the width. `parent` if `x` is not finite.
///
/// Rounds to the nearest integer by adding and subtracting 1.5 * 2^52. This has no branch and no
/// call, so that a whole position is mirrored in vector registers.
#[inline(always)]
pub(crate) fn reflect<T: Scalar>(x: T, parent: T, lower: T, upper: T) -> T {
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    let width = (upper - lower).as_f64();
    let phase = (x - lower).as_f64() / width;
    let even = ((phase * 0.5 + SHIFT) - SHIFT) * 2.0;
    let distance = (phase - even).abs();
    let mirrored = (lower + T::of(distance * width)).min(upper);
    let outside = if distance <= 1.0 { mirrored } else { parent };
    if lower <= x && x <= upper { x } else { outside }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_choice_does_what_it_says() {
        let settle = |border: Border, x: f64| {
            let mut child = [x];
            border.settle(&mut child, &[0.5], (&[0.0], &[1.0]), |_| 0.25);
            child[0]
        };
        assert_eq!(settle(Border::Clamp, 1.5), 1.0);
        assert_eq!(settle(Border::Reflect, 1.25), 0.75);
        assert_eq!(settle(Border::Reflect, -2.25), 0.25);
        assert_eq!(settle(Border::Reflect, 1e6 + 0.25), 0.25);
        assert_eq!(settle(Border::Resample, 1.5), 0.25);
        assert_eq!(settle(Border::KeepComponent, 1.5), 0.5);
        assert_eq!(settle(Border::Allow, 1.5), 1.5);
    }

    #[test]
    fn a_step_that_is_not_finite_never_survives() {
        for border in Border::ALL {
            for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut child = [x];
                border.settle(&mut child, &[0.5], (&[0.0], &[1.0]), |_| f64::NAN);
                assert!((0.0..=1.0).contains(&child[0]), "{border:?} {x}");
            }
        }
    }
}
