//! Loops over lanes, compiled for several instruction sets and chosen at run time.
//!
//! The body of a [`vectorised!`] function is a plain loop; the compiler vectorises it for each
//! instruction set. No fused multiply-add is enabled, and every lane is computed on its own: results
//! are the same to the bit on every machine and for every number of lanes.

use std::ops::Range;
use std::sync::OnceLock;

/// Instruction sets in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstructionSet {
    /// What every machine of the target has.
    Baseline,
    /// 4 lanes.
    Avx2,
    /// 8 lanes.
    Avx512,
}

/// The best one that this machine has, or the one named in `AEP_SIMD` (`baseline`, `avx2`, `avx512`)
/// where that is less.
#[inline]
pub fn instruction_set() -> InstructionSet {
    static CHOSEN: OnceLock<InstructionSet> = OnceLock::new();
    *CHOSEN.get_or_init(|| {
        let most = detect();
        match std::env::var("AEP_SIMD").as_deref() {
            Ok("baseline") => InstructionSet::Baseline,
            Ok("avx2") if most != InstructionSet::Baseline => InstructionSet::Avx2,
            _ => most,
        }
    })
}

#[cfg(target_arch = "x86_64")]
fn detect() -> InstructionSet {
    let wide = is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl");
    if wide {
        InstructionSet::Avx512
    } else if is_x86_feature_detected!("avx2") {
        InstructionSet::Avx2
    } else {
        InstructionSet::Baseline
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn detect() -> InstructionSet {
    InstructionSet::Baseline
}

/// `x` within `+-cap`; unlike `clamp` it takes any `cap`.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub(crate) fn limited(x: f64, cap: f64) -> f64 {
    x.max(-cap).min(cap)
}

/// Lanes that are left out together: as many as the widest instruction set takes at once.
pub(crate) const STRETCH: usize = 8;

/// The stretches of lanes of which one at least is open, above 0.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub(crate) fn open_stretches(open: &[f64]) -> impl Iterator<Item = Range<usize>> {
    let stretches = open.chunks(STRETCH).enumerate();
    let open = stretches.filter(|(_, lanes)| lanes.iter().any(|open| *open > 0.0));
    open.map(|(k, lanes)| k * STRETCH..k * STRETCH + lanes.len())
}

/// -1, 0 or 1.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub(crate) fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}

/// Bits of a float's mantissa, of 1, and of 2^52, which turns a whole number in its mantissa into a float at once.
const MANTISSA: u64 = (1 << 52) - 1;
const ONE: u64 = 0x3ff0_0000_0000_0000;
const WHOLE: u64 = 0x4330_0000_0000_0000;

/// Natural logarithm of a normal, positive `x`, to two units of the last place of the larger of it and 1: the
/// standard one is a call, which keeps a loop from being vectorised.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub(crate) fn ln(x: f64) -> f64 {
    let bits = x.to_bits();
    let mantissa = f64::from_bits((bits & MANTISSA) | ONE);
    let exponent = f64::from_bits((bits >> 52) | WHOLE) - (4_503_599_627_370_496.0 + 1023.0);
    let upper = mantissa > std::f64::consts::SQRT_2;
    let mantissa = if upper { 0.5 * mantissa } else { mantissa };
    let exponent = if upper { exponent + 1.0 } else { exponent };
    // ln m = 2 artanh f, |f| < 0.172.
    let f = (mantissa - 1.0) / (mantissa + 1.0);
    let q = f * f;
    let sum = 1.0 / 15.0 + q * (1.0 / 17.0 + q * (1.0 / 19.0 + q / 21.0));
    let sum = 1.0 / 9.0 + q * (1.0 / 11.0 + q * (1.0 / 13.0 + q * sum));
    let sum = 1.0 + q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * sum)));
    exponent * std::f64::consts::LN_2 + 2.0 * f * sum
}

/// `x^n` of an `x` that is not negative and a positive `n`.
#[inline(always)]
pub(crate) fn power(x: f64, n: f64) -> f64 {
    // So little that its power is 0 to rounding, and its logarithm is finite.
    const TINY: f64 = 1e-150;
    exp(n * ln(x.max(TINY)))
}

/// One over the factorials of 0 to 13.
const OF_EXP: [f64; 14] = {
    let mut out = [1.0; 14];
    let mut n = 1;
    while n < 14 {
        out[n] = out[n - 1] / n as f64;
        n += 1;
    }
    out
};
/// The logarithm of 2 in two parts, the first with so few digits that its multiples are exact.
const LN_2: (f64, f64) = (0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10);
/// Where the exponential function leaves the normal numbers.
const EXPONENTS: (f64, f64) = (-708.0, 709.0);

/// `e^x - 1` of what is left of `x` beside a multiple of ln 2, and that power of 2.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn exp_parts(x: f64) -> (f64, f64) {
    let x = if x < EXPONENTS.0 { EXPONENTS.0 } else { x };
    let x = if x > EXPONENTS.1 { EXPONENTS.1 } else { x };
    let shifted = x * std::f64::consts::LOG2_E + ROUNDING;
    let whole = shifted - ROUNDING;
    let r = x - whole * LN_2.0 - whole * LN_2.1;
    let (c, q) = (&OF_EXP, r * r);
    // Two chains beside each other.
    let even = q * (c[2] + q * (c[4] + q * (c[6] + q * (c[8] + q * (c[10] + q * c[12])))));
    let odd = c[3] + q * (c[5] + q * (c[7] + q * (c[9] + q * (c[11] + q * c[13]))));
    // The lowest bits of the shifted number are the whole one.
    let power = f64::from_bits((shifted.to_bits() << 52).wrapping_add(ONE));
    (even + (r + q * r * odd), power)
}

/// `e^x` to two units of the last place, at its least 3e-308 and at its most 8e307: the standard one is a call.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    let (part, power) = exp_parts(x);
    power + power * part
}

/// Hyperbolic tangent, to three units of the last place.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub(crate) fn tanh(x: f64) -> f64 {
    let size = x.abs();
    let size = if size > 20.0 { 20.0 } else { size };
    let (part, power) = exp_parts(2.0 * size);
    // e^2x - 1, without a difference of near equals.
    let grown = power * part + (power - 1.0);
    (grown / (grown + 2.0)).copysign(x)
}

/// Added to a number below 2^51 and taken away again it leaves the nearest whole number.
const ROUNDING: f64 = 6_755_399_441_055_744.0;

/// One over the factorials of 1, 3, 5 .. and of 0, 2, 4 .., with alternating signs: the series of sine and cosine.
const TERMS: usize = 9;
const OF_SINE: [f64; TERMS] = series(2.0);
const OF_COSINE: [f64; TERMS] = series(1.0);

const fn series(mut k: f64) -> [f64; TERMS] {
    let mut out = [1.0; TERMS];
    let mut n = 1;
    while n < TERMS {
        out[n] = -out[n - 1] / (k * (k + 1.0));
        k += 2.0;
        n += 1;
    }
    out
}

/// The sum of a series in `q`, its terms in pairs: a chain of half the length.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn summed(c: &[f64; TERMS], q: f64) -> f64 {
    let (square, pair) = (q * q, |k: usize| c[k] + q * c[k + 1]);
    pair(0) + square * (pair(2) + square * (pair(4) + square * (pair(6) + square * c[8])))
}

/// Sine and cosine of so many turns (below 2^49), to 4e-16: the standard ones are calls.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub(crate) fn sin_cos_of_turns(turns: f64) -> (f64, f64) {
    let nearest = |x: f64| (x + ROUNDING) - ROUNDING;
    let quarters = nearest(4.0 * turns);
    // Within an eighth of a turn the series converge fast.
    let angle = std::f64::consts::TAU * (turns - 0.25 * quarters);
    let square = angle * angle;
    let (sin, cos) = (angle * summed(&OF_SINE, square), summed(&OF_COSINE, square));
    // Of the number of quarters the last two binary digits count.
    let halves = nearest(0.5 * quarters - 0.25);
    let odd = quarters - 2.0 * halves;
    let sign = 1.0 - 2.0 * (halves - 2.0 * nearest(0.5 * halves - 0.25));
    let swapped = odd != 0.0;
    let (sin, cos) = if swapped { (cos, -sin) } else { (sin, cos) };
    (sign * sin, sign * cos)
}

/// Defines functions whose bodies are compiled for every [`InstructionSet`].
macro_rules! vectorised {
    ($($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $ty:ty),* $(,)?) $body:block)*) => {$(
        $(#[$meta])*
        #[inline]
        #[allow(clippy::too_many_arguments, reason = "one slice per quantity")]
        #[cfg_attr(target_arch = "x86_64", expect(unsafe_code, reason = "features are detected"))]
        $vis fn $name($($arg: $ty),*) {
            #[allow(clippy::inline_always, reason = "it must be compiled anew for each set")]
            #[inline(always)]
            #[allow(clippy::too_many_arguments, reason = "one slice per quantity")]
            fn generic($($arg: $ty),*) $body

            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                #[allow(clippy::too_many_arguments, reason = "one slice per quantity")]
                fn avx2($($arg: $ty),*) { generic($($arg),*); }

                #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
                #[allow(clippy::too_many_arguments, reason = "one slice per quantity")]
                fn avx512($($arg: $ty),*) { generic($($arg),*); }

                match $crate::simd::instruction_set() {
                    // SAFETY: `instruction_set` returns only what the machine has.
                    $crate::simd::InstructionSet::Avx512 => unsafe { avx512($($arg),*) },
                    // SAFETY: as above.
                    $crate::simd::InstructionSet::Avx2 => unsafe { avx2($($arg),*) },
                    $crate::simd::InstructionSet::Baseline => generic($($arg),*),
                }
            }
            #[cfg(not(target_arch = "x86_64"))]
            generic($($arg),*);
        }
    )*};
}

pub(crate) use vectorised;

vectorised! {
    /// `sum += value` in every lane.
    pub(crate) fn add_to(sum: &mut [f64], value: &[f64]) {
        for (sum, value) in sum.iter_mut().zip(value) {
            *sum += value;
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_logarithm_is_that_of_the_standard_library() {
        for k in -3000..3000 {
            let x = (f64::from(k) * 0.0137).exp();
            let (found, exact) = (super::ln(x), x.ln());
            assert!(
                (found - exact).abs() <= 4.5e-16 * exact.abs().max(1.0),
                "{x}: {found} {exact}"
            );
        }
    }

    #[test]
    fn a_power_is_that_of_the_standard_library_and_none_of_nothing() {
        for (x, n) in [(1e-9f64, 0.2), (0.3, 8.0), (1.0, 2.5), (700.0, 1.7)] {
            assert!((super::power(x, n) / x.powf(n) - 1.0).abs() < 1e-13, "{x} {n}");
        }
        assert!(super::power(0.0, 0.2) < 1e-29);
    }

    #[test]
    fn the_exponential_function_is_that_of_the_standard_library() {
        for k in -40_000..40_000 {
            let x = f64::from(k) * 0.0173;
            let (found, exact) = (super::exp(x), x.exp());
            assert!((found / exact - 1.0).abs() < 5e-16, "{x}: {found:e} {exact:e}");
        }
        assert_eq!((super::exp(0.0), super::exp(-0.0)), (1.0, 1.0));
        assert!(
            super::exp(-1e9) < 1e-300 && super::exp(1e9) > 1e300 && super::exp(f64::NAN).is_nan()
        );
    }

    #[test]
    fn the_hyperbolic_tangent_is_that_of_the_standard_library() {
        for k in -4000..4000 {
            let x = f64::from(k).powi(3) * 1e-9;
            let (found, exact) = (super::tanh(x), x.tanh());
            assert!((found - exact).abs() <= 7e-16 * exact.abs(), "{x}: {found:e} {exact:e}");
        }
        assert_eq!((super::tanh(1e300), super::tanh(-1e300)), (1.0, -1.0));
    }

    #[test]
    fn sine_and_cosine_are_those_of_the_standard_library() {
        for k in -4000..4000 {
            let turns = f64::from(k) * 0.001_371;
            let (sin, cos) = super::sin_cos_of_turns(turns);
            let part = std::f64::consts::TAU * (turns - turns.round());
            assert!((sin - part.sin()).abs() < 6e-16, "{turns}: {sin} {}", part.sin());
            assert!((cos - part.cos()).abs() < 6e-16, "{turns}: {cos} {}", part.cos());
        }
    }

    vectorised! {
        fn scaled(factor: f64, values: &[f64], out: &mut [f64]) {
            for (out, value) in out.iter_mut().zip(values) {
                *out = factor / (1.0 + value * value) - 0.1 * value;
            }
        }
    }

    #[test]
    fn a_vectorised_loop_computes_what_the_plain_one_does() {
        let values: Vec<f64> = (0..37).map(|k| f64::from(k) * 0.37 - 3.0).collect();
        let mut out = vec![0.0; 37];
        scaled(1.7, &values, &mut out);
        for (out, v) in out.iter().zip(&values) {
            assert_eq!(out.to_bits(), (1.7 / (1.0 + v * v) - 0.1 * v).to_bits());
        }
    }
}
