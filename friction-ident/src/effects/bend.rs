//! A force that bends towards a limit: what knees of gains and soft limits of drives have in common.

use crate::simd::{exp, limited, ln, power};

/// `u / (1 + |u inverse|^n)^(1/n)`: `u` while it is small, no more than one over `inverse`.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub(super) fn bent(u: f64, inverse: f64, n: f64) -> f64 {
    let share = inverse * u.abs();
    // Either side of the limit by the power of what is below 1, so that none overflows.
    let beyond = power(share.min(1.0 / share), n);
    limited(u, 1.0 / inverse) * exp(-ln(1.0 + beyond) / n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_law_on_either_side_of_the_limit_and_far_beyond() {
        for n in [1.0, 2.5, 8.0] {
            for u in [-150.0f64, -100.0, -3.0, 20.0, 99.0, 250.0] {
                let law = u / (1.0 + (0.01 * u.abs()).powf(n)).powf(1.0 / n);
                assert!((bent(u, 0.01, n) / law - 1.0).abs() < 1e-9, "{u} {n}");
            }
            assert_eq!(bent(0.0, 0.01, n), 0.0);
            assert!((bent(1e60, 0.01, n) - 100.0).abs() < 1e-9);
        }
    }
}
