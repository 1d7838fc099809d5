//! Loops over the components of a position, compiled for several widths of vector registers and
//! chosen at run time.
//!
//! Each component is computed on its own and nothing is fused or reordered, so results are the same
//! to the bit on every machine.

use multiversion::multiversion;

use crate::Scalar;

/// Rows shorter than this are not worth the choice.
const WORTH_IT: usize = 16;

/// Defines functions that run a plain loop on short rows and its wider twins on long ones; the first
/// argument is the row.
macro_rules! wide {
    ($($(#[$meta:meta])* fn $name:ident<T: Scalar>($row:ident: $type:ty $(, $arg:ident: $ty:ty)* $(,)?) $(-> $out:ty)? $body:block)*) => {$(
        $(#[$meta])*
        #[inline]
        pub(crate) fn $name<T: Scalar>($row: $type $(, $arg: $ty)*) $(-> $out)? {
            #[inline(always)]
            fn plain<T: Scalar>($row: $type $(, $arg: $ty)*) $(-> $out)? $body

            #[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
            fn wide<T: Scalar>($row: $type $(, $arg: $ty)*) $(-> $out)? {
                plain($row $(, $arg)*)
            }

            if $row.len() < WORTH_IT { plain($row $(, $arg)*) } else { wide($row $(, $arg)*) }
        }
    )*};
}

wide! {
    /// `row = base + sigma units row`.
    fn step<T: Scalar>(row: &mut [T], base: &[T], units: &[T], sigma: T) {
        for ((z, base), unit) in row.iter_mut().zip(base).zip(units) {
            *z = *base + sigma * *unit * *z;
        }
    }

    /// `row = base + directions |sigma units row|`.
    fn step_along<T: Scalar>(row: &mut [T], base: &[T], units: &[T], sigma: T, directions: &[i8]) {
        for (((z, base), unit), direction) in row.iter_mut().zip(base).zip(units).zip(directions) {
            let length = (sigma * *unit * *z).abs();
            *z = *base + length * T::of(f64::from(*direction));
        }
    }

    /// Whether all components are within their limits.
    fn all_within<T: Scalar>(row: &[T], lower: &[T], upper: &[T]) -> bool {
        let within = row.iter().zip(lower).zip(upper).map(|((x, lo), hi)| (lo <= x, x <= hi));
        within.fold(true, |all, (above, below)| all & above & below)
    }

    /// Mirrors what is outside the limits back into them.
    fn reflect<T: Scalar>(row: &mut [T], base: &[T], lower: &[T], upper: &[T]) {
        for (((x, base), lower), upper) in row.iter_mut().zip(base).zip(lower).zip(upper) {
            *x = crate::border::reflect(*x, *base, *lower, *upper);
        }
    }

    /// The sign of the last move where there was one.
    fn turn<T: Scalar>(directions: &mut [i8], from: &[T], to: &[T]) {
        for ((direction, from), to) in directions.iter_mut().zip(from).zip(to) {
            let moved = i8::from(to > from) - i8::from(to < from);
            *direction = if moved == 0 { *direction } else { moved };
        }
    }
}
