//! Loops over lanes, compiled for several instruction sets and chosen at run time.
//!
//! The body of a [`vectorised!`] function is a plain loop; the compiler vectorises it for each
//! instruction set. No fused multiply-add is enabled, and every lane is computed on its own: results
//! are the same to the bit on every machine and for every number of lanes.

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
