//! Hysteresis of another shape: how sharply it bends, and where on its way back.

use super::hysteresis::{Branch, Hysteresis, LENGTH, SHOWS, SIZE, follow, turn};
use super::within_a_count;
use crate::axis::Quantity;
use crate::effects::c_dynamics::PAST;
use crate::effects::memory::since_begin;
use crate::effects::{
    About, AsFound, Begun, CDynamics, Effect, Memory, Motion, Parameter, Parameters, Past,
    Recalled, Refused, Slot, Taken,
};
use crate::simd::{exp, limited, ln, sign, vectorised};

/// `level += F_h h s` with `l dh = (1 - |h|^n (1 - beta + beta sgn(h dx))) dx`: on the way out it bends the more sharply the
/// greater `n`; on the way back it has the slope of its begin until it is gone with `beta` 1/2, twice that at first with 1,
/// and none with 0. With `n` and `beta` 1 it is [`Hysteresis`].
#[derive(Clone, Copy, Debug)]
pub struct BoucWen;

static ABOUT: About = About {
    name: "reversal-decay:bouc-wen",
    title: "hysteresis of cables and seals, Bouc-Wen",
    equation: "F_h h s, l dh = (1 - |h|^n (1 - beta + beta sgn(h dx))) dx",
    parameters: &[
        SIZE,
        LENGTH,
        Parameter::shape("n", "how sharply it bends", Quantity::One, (0.5, 10.0), 1.5),
        Parameter::shape(
            "beta",
            "share that turns with the direction",
            Quantity::One,
            (0.0, 1.0),
            0.5,
        )
        .linear(),
    ],
    slots: &[Slot::Memory],
    shows: SHOWS,
    reference: "Y.-K. Wen, J. Engineering Mechanics Division ASCE 102, 1976",
};

impl Effect for BoucWen {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 1,
            helpers: &[PAST, HYSTERESIS],
            slow: "1e-9",
            start: "{s0} = sign(velocity);",
            recall: "{
    const double ahead = fmax(m->when - m->slow.time[m->slow.end - 1], 0.0) * fabs(m->predicted);
    const double to = sign(m->predicted == 0.0 ? m->drive : m->predicted);
    m->remembered += {F_h} * fabs(to) * bent(to * {s0}, ahead / {l}, {n}, {beta});
}",
            remember: "if (m->sliding > 0.0 && m->displacement != 0.0) {
    const double to = sign(m->displacement);
    {s0} = to * bent(to * {s0}, fabs(m->displacement) / {l}, {n}, {beta});
}",
            ..CDynamics::NONE
        })
    }

    /// Beside the plain form it would fit everything that has a memory a little.
    fn is_only_flexible(&self) -> bool {
        true
    }

    fn whatever(&self) -> &'static [&'static str] {
        &["n", "beta"]
    }

    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        within_a_count(found)
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }
}

/// Helper: `bent(share, way, n, beta)`, as [`bent`].
const HYSTERESIS: &str = include_str!("../../export/c/hysteresis.c");

/// Least share whose power has a slope: below 1 the slope at 0 has no bound.
const LEAST: f64 = 1e-3;

/// Slope of the share towards the way that it goes, and the derivative of that slope.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn slope(share: f64, n: f64, beta: f64) -> (f64, f64) {
    let size = if share.abs() > LEAST { share.abs() } else { LEAST };
    let power = exp(n * ln(size));
    let back = 2.0 * beta - 1.0;
    let turns = if share < 0.0 { back } else { -1.0 };
    let outwards = if share < 0.0 { -1.0 } else { 1.0 };
    (1.0 + turns * power, turns * outwards * n * power / size)
}

/// The share of the force, positive in the direction of motion, after a `way` in units of `l`: the slope and its derivative
/// at the begin, integrated exactly (Rosenbrock's method of second order; exact for `n` and `beta` 1
/// from shares above [`LEAST`]).
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn bent(share: f64, way: f64, n: f64, beta: f64) -> f64 {
    let (slope, bend) = slope(share, n, beta);
    let x = bend * way;
    let grown = if x.abs() < 1e-6 { way } else { (exp(x) - 1.0) / bend };
    limited(share + slope * grown, 1.0)
}

/// `n` and `beta` of the lanes.
struct Bent<'a> {
    sharply: &'a [f64],
    beta: &'a [f64],
}

impl<'a> Bent<'a> {
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn new(p: Parameters<'a>, lanes: usize) -> Self {
        Self { sharply: &p.get(2)[..lanes], beta: &p.get(3)[..lanes] }
    }
}

impl Branch for Bent<'_> {
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn turned(&self, lane: usize, share: f64, way: f64) -> f64 {
        bent(share, way, self.sharply[lane], self.beta[lane])
    }

    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn slope(&self, lane: usize, share: f64) -> f64 {
        slope(share, self.sharply[lane], self.beta[lane]).0
    }
}

/// The states of [`Hysteresis`].
impl Memory for BoucWen {
    fn states(&self) -> usize {
        Hysteresis.states()
    }

    fn start(&self, p: &[f64], begun: &Begun, state: &mut [f64]) {
        Hysteresis.start(p, begun, state);
    }

    fn memory(&self, p: Parameters<'_>) -> f64 {
        Memory::memory(&Hysteresis, p)
    }

    fn recall(
        &self,
        p: Parameters<'_>,
        m: &Motion<'_>,
        past: &Past,
        state: &[f64],
        out: &mut Recalled<'_>,
    ) {
        let (begin, share) = (past.newest_times(), &state[..out.level.len()]);
        recall(p, begin, m.time, m.velocity, m.drive_force, share, out.level);
    }

    fn remember(&self, p: Parameters<'_>, taken: &Taken<'_>, state: &mut [f64]) {
        let (share, direction) = state.split_at_mut(taken.sliding.len());
        turn_around(p, taken.sliding, taken.displacement, share, direction);
    }

    fn correct(&self, p: Parameters<'_>, displacement: &[f64], state: &mut [f64]) {
        let (share, direction) = state.split_at_mut(displacement.len());
        follow_on(p, displacement, direction, share);
    }
}

vectorised! {
    fn turn_around(
        p: Parameters<'_>,
        sliding: &[f64],
        moved: &[f64],
        share: &mut [f64],
        direction: &mut [f64],
    ) {
        turn(p.get(1), (sliding, moved), share, direction, &Bent::new(p, sliding.len()));
    }

    fn follow_on(p: Parameters<'_>, displacement: &[f64], direction: &[f64], share: &mut [f64]) {
        follow(p.get(1), displacement, direction, share, &Bent::new(p, share.len()));
    }

    fn recall(
        p: Parameters<'_>,
        begin: &[f64],
        now: &[f64],
        velocity: &[f64],
        drive_force: &[f64],
        share: &[f64],
        level: &mut [f64],
    ) {
        let n = level.len();
        let (size, length, begin, now) = (&p.get(0)[..n], &p.get(1)[..n], &begin[..n], &now[..n]);
        let (sharply, beta) = (&p.get(2)[..n], &p.get(3)[..n]);
        let (velocity, drive_force, share) = (&velocity[..n], &drive_force[..n], &share[..n]);
        for i in 0..n {
            let way = since_begin(begin[i], now[i]) * velocity[i].abs() / length[i];
            // At rest the drive says where it will go.
            let to = sign(if velocity[i] == 0.0 { drive_force[i] } else { velocity[i] });
            level[i] += size[i] * to.abs() * bent(to * share[i], way, sharply[i], beta[i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{LEAST, bent};
    use crate::effects::testing::along_and_simulated;

    /// Many small steps of the equation.
    fn integrated(share: f64, way: f64, n: f64, beta: f64) -> f64 {
        let steps = 20_000;
        (0..steps).fold(share, |h: f64, _| {
            let slope = 1.0 - h.abs().powf(n) * (1.0 - beta + beta * h.signum());
            h + slope * way / f64::from(steps)
        })
    }

    #[test]
    fn with_n_and_beta_1_it_is_the_plain_hysteresis() {
        for share in [-1.0, -0.4, 0.0, 0.7, 1.0] {
            for way in [1e-9, 1e-3, 0.5, 30.0] {
                let exact = 1.0 + (share - 1.0) * f64::exp(-way);
                let least = LEAST * f64::min(way, 1.0) + 1e-12;
                assert!((bent(share, way, 1.0, 1.0) - exact).abs() < least, "{share} {way}");
            }
        }
    }

    #[test]
    fn with_beta_one_half_it_comes_back_straight() {
        for way in [1e-3, 0.3, 0.99] {
            assert!((bent(-1.0, way, 3.0, 0.5) + 1.0 - way).abs() < 1e-9, "{way}");
        }
    }

    proptest! {
        #[test]
        fn steps_as_short_as_samples_follow_the_equation(
            share in -1.0..1.0, n in 1.0..10.0, beta in 0.0..1.0,
        ) {
            let stepped = (0..100).fold(share, |h, _| bent(h, 0.01, n, beta));
            let exact = integrated(share, 1.0, n, beta);
            prop_assert!((stepped - exact).abs() < 2e-3, "{} {}", stepped, exact);
        }

        #[test]
        fn it_never_leaves_its_bounds(
            share in -1.0..=1.0, way in 0.0..1e9, n in 0.5..10.0, beta in 0.0..1.0,
        ) {
            prop_assert!((-1.0..=1.0).contains(&bent(share, way, n, beta)));
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let values = [("F_h", 3.0), ("l", 0.01), ("n", 2.0), ("beta", 0.5)];
        let left = along_and_simulated(&[("reversal-decay:bouc-wen", &values)], None);
        assert!(left < 0.01, "{left}");
    }
}
