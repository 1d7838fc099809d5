//! Sums of cosines along the stroke, `sum_{k=1..n} c_k cos(k pi u)`, `u` from 0 at its begin to 1 at its end: parameters
//! `c_1 .. c_n`, begin and end. Level beyond both ends.

use super::Parameters;
use crate::simd::{sin_cos_of_turns, vectorised};

/// Lanes that are computed side by side.
const WIDTH: usize = 8;

/// The sums of `W` lanes from `at` on, and where in the stroke they are.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn sums<const W: usize>(
    p: Parameters<'_>,
    count: usize,
    at: usize,
    position: &[f64],
) -> ([f64; W], [f64; W]) {
    let of = |k: usize| &p.get(k)[at..at + W];
    let (start, end, position) = (of(count), of(count + 1), &position[at..at + W]);
    let (mut sum, mut place, mut first) = ([0.0; W], [0.0; W], [0.0; W]);
    for i in 0..W {
        let u = (position[i] - start[i]) / (end[i] - start[i]);
        let u = if u < 0.0 { 0.0 } else { u };
        place[i] = if u > 1.0 { 1.0 } else { u };
        (_, first[i]) = sin_cos_of_turns(0.5 * place[i]);
    }
    // Chebyshev: cos (k + 1) a = 2 cos a cos k a - cos (k - 1) a.
    let (mut before, mut now) = ([1.0; W], first);
    for k in 0..count {
        let amplitude = of(k);
        for i in 0..W {
            sum[i] += amplitude[i] * now[i];
            (before[i], now[i]) = (now[i], 2.0 * first[i] * now[i] - before[i]);
        }
    }
    (sum, place)
}

/// Does a `$block` of as many lanes as go side by side, then one lane after the other.
macro_rules! in_blocks {
    ($lanes:expr, $block:ident($($arg:expr),*)) => {
        let lanes = $lanes;
        let whole = lanes - lanes % WIDTH;
        for at in (0..whole).step_by(WIDTH) {
            $block::<WIDTH>(at, $($arg),*);
        }
        for at in whole..lanes {
            $block::<1>(at, $($arg),*);
        }
    };
}

#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn add_block<const W: usize>(
    at: usize,
    p: Parameters<'_>,
    count: usize,
    position: &[f64],
    level: &mut [f64],
) {
    let (sum, _) = sums::<W>(p, count, at, position);
    let level = &mut level[at..at + W];
    for i in 0..W {
        level[i] += sum[i];
    }
}

#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn add_with_slopes_block<const W: usize>(
    at: usize,
    p: Parameters<'_>,
    count: usize,
    position: &[f64],
    level: &mut [f64],
) {
    let (sum, u) = sums::<W>(p, count, at, position);
    let (slope, bend) = (&p.get(count + 2)[at..at + W], &p.get(count + 3)[at..at + W]);
    let level = &mut level[at..at + W];
    for i in 0..W {
        let ends = slope[i] * (u[i] - 0.5) + bend[i] * (u[i] * u[i] - u[i] + 1.0 / 6.0);
        level[i] += sum[i] + ends;
    }
}

#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn damp_block<const W: usize>(
    at: usize,
    p: Parameters<'_>,
    count: usize,
    position: &[f64],
    velocity: &[f64],
    force: &mut [f64],
    damping: &mut [f64],
) {
    let (sum, _) = sums::<W>(p, count, at, position);
    let velocity = &velocity[at..at + W];
    let (force, damping) = (&mut force[at..at + W], &mut damping[at..at + W]);
    for i in 0..W {
        force[i] += sum[i] * velocity[i];
        // Where it takes away from the damping of the others, their sum still counts.
        damping[i] += sum[i];
    }
}

#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn take_block<const W: usize>(
    at: usize,
    p: Parameters<'_>,
    count: usize,
    position: &[f64],
    of: &[f64],
    from: &mut [f64],
) {
    let (sum, _) = sums::<W>(p, count, at, position);
    let (of, from) = (&of[at..at + W], &mut from[at..at + W]);
    for i in 0..W {
        from[i] -= sum[i] * of[i];
    }
}

vectorised! {
    /// Adds the sum of `count` cosines.
    pub(super) fn add(p: Parameters<'_>, count: usize, position: &[f64], level: &mut [f64]) {
        in_blocks!(level.len(), add_block(p, count, position, level));
    }

    /// The same with a slope at either end: parameters `p_1` and `p_2` behind the others.
    pub(super) fn add_with_slopes(
        p: Parameters<'_>,
        count: usize,
        position: &[f64],
        level: &mut [f64],
    ) {
        in_blocks!(level.len(), add_with_slopes_block(p, count, position, level));
    }

    /// Takes the sum as a share `of` something from another.
    pub(super) fn take(
        p: Parameters<'_>,
        count: usize,
        position: &[f64],
        of: &[f64],
        from: &mut [f64],
    ) {
        in_blocks!(from.len(), take_block(p, count, position, of, from));
    }

    /// A damping that is the sum.
    pub(super) fn damp(
        p: Parameters<'_>,
        count: usize,
        position: &[f64],
        velocity: &[f64],
        force: &mut [f64],
        damping: &mut [f64],
    ) {
        in_blocks!(force.len(), damp_block(p, count, position, velocity, force, damping));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_beside_each_other_have_the_bits_of_a_lane_alone() {
        let lanes = 2 * WIDTH + 3;
        let values: Vec<Vec<f64>> =
            (0..lanes).map(|i| vec![1.0 + i as f64, -0.5, 0.3 * i as f64, -0.1, 0.2]).collect();
        let mixed: Vec<f64> = (0..5).flat_map(|k| values.iter().map(move |v| v[k])).collect();
        let position: Vec<f64> = (0..lanes).map(|i| -0.15 + 0.03 * i as f64).collect();
        let mut level = vec![0.0; lanes];
        add(Parameters::new(&mixed, lanes), 3, &position, &mut level);
        for i in 0..lanes {
            let mut alone = [0.0];
            add(Parameters::new(&values[i], 1), 3, &position[i..=i], &mut alone);
            assert_eq!(alone[0].to_bits(), level[i].to_bits());
        }
    }
}
