//! Hysteresis: cables in a chain, seals and wipers that bend before they slide.

use super::within_a_count;
use crate::axis::Quantity;
use crate::effects::c_dynamics::PAST;
use crate::effects::memory::{BEGIN_OF_STEP, since_begin};
use crate::effects::{
    About, AsFound, Begun, CDynamics, Came, Effect, Memory, Motion, Parameter, Parameters, Past,
    Recalled, Refused, Slot, Taken,
};
use crate::simd::{exp, limited, sign, vectorised};

/// `level += F_h h s` with `l dh = (s - h) |dx|`: a force beside the friction of the axis that turns around over a distance
/// after every reversal, from wherever it had come to (after a long way `F_h - 2 F_h exp(-d/l)`: a reversal decay).
#[derive(Clone, Copy, Debug)]
pub struct Hysteresis;

pub(super) const SIZE: Parameter =
    Parameter::level("F_h", "force after a long way in one direction", Quantity::Force, 100.0, 1.0);
pub(super) const LENGTH: Parameter = Parameter::shape(
    "l",
    "distance over which it turns around",
    Quantity::Length,
    (1e-6, 0.1),
    1e-3,
);
pub(super) const SHOWS: &str = "(residual x sign of velocity) against the distance since the last reversal, the same at every \
                                speed; less of it where the way before was short";

static ABOUT: About = About {
    name: "reversal-decay:hysteresis",
    title: "hysteresis of cables and seals",
    equation: "F_h h s, l dh = (s - h) |dx|",
    parameters: &[SIZE, LENGTH],
    slots: &[Slot::Memory],
    shows: SHOWS,
    reference: "P. R. Dahl, Aerospace Corp. TOR-0158, 1968 (here beside a friction that sticks)",
};

impl Effect for Hysteresis {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 1,
            helpers: &[PAST],
            slow: "1e-9",
            start: "{s0} = sign(velocity);",
            recall: "{
    const double ahead = fmax(m->when - m->slow.time[m->slow.end - 1], 0.0) * fabs(m->predicted);
    const double to = sign(m->predicted == 0.0 ? m->drive : m->predicted);
    m->remembered += {F_h} * to * (to + ({s0} - to) * exp(-ahead / {l}));
}",
            remember: "if (m->sliding > 0.0 && m->displacement != 0.0) {
    const double to = sign(m->displacement);
    {s0} = to + ({s0} - to) * exp(-fabs(m->displacement) / {l});
}",
            ..CDynamics::NONE
        })
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some("reversal-decay:bouc-wen")
    }

    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        within_a_count(found)
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }
}

/// States: the share of the force, -1..1, and the direction of the last slide (0 before the first motion).
impl Memory for Hysteresis {
    fn states(&self) -> usize {
        2
    }

    fn start(&self, p: &[f64], begun: &Begun, state: &mut [f64]) {
        let (share, direction) = match begun.came {
            // From the other side at the last reversal.
            Some(Came { way, .. }) => {
                (sign(way) * (1.0 - 2.0 * (-way.abs() / p[1]).exp()), sign(way))
            }
            None => (sign(begun.velocity), sign(begun.velocity)),
        };
        state.copy_from_slice(&[share, direction]);
    }

    fn memory(&self, _p: Parameters<'_>) -> f64 {
        BEGIN_OF_STEP
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

/// How the share in the direction of motion goes, in the lanes.
pub(super) trait Branch {
    /// What it is after a way in units of the length.
    fn turned(&self, lane: usize, share: f64, way: f64) -> f64;

    /// Its slope over that way.
    fn slope(&self, lane: usize, share: f64) -> f64;
}

impl Branch for Hysteresis {
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn turned(&self, _lane: usize, share: f64, way: f64) -> f64 {
        1.0 + (share - 1.0) * exp(-way)
    }

    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn slope(&self, _lane: usize, share: f64) -> f64 {
        1.0 - share
    }
}

/// Takes a piece into the share and the direction.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub(super) fn turn(
    length: &[f64],
    (sliding, moved): (&[f64], &[f64]),
    share: &mut [f64],
    direction: &mut [f64],
    branch: &impl Branch,
) {
    let n = length.len();
    let (sliding, moved) = (&sliding[..n], &moved[..n]);
    let (share, direction) = (&mut share[..n], &mut direction[..n]);
    for i in 0..n {
        // What an axis at rest seems to move is noise, or the vibration of its contact.
        let to = if sliding[i] > 0.0 { sign(moved[i]) } else { 0.0 };
        let turned = branch.turned(i, to * share[i], moved[i].abs() / length[i]);
        share[i] = if to == 0.0 { share[i] } else { to * turned };
        direction[i] = if to == 0.0 { direction[i] } else { to };
    }
}

/// Follows an observer along the branch that it is on, either way, as noise is no reversal.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub(super) fn follow(
    length: &[f64],
    displacement: &[f64],
    direction: &[f64],
    share: &mut [f64],
    branch: &impl Branch,
) {
    let n = length.len();
    let (displacement, direction) = (&displacement[..n], &direction[..n]);
    let share = &mut share[..n];
    for i in 0..n {
        let slope = direction[i].abs() * branch.slope(i, direction[i] * share[i]);
        share[i] = limited(share[i] + slope * displacement[i] / length[i], 1.0);
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
        turn(p.get(1), (sliding, moved), share, direction, &Hysteresis);
    }

    fn follow_on(p: Parameters<'_>, displacement: &[f64], direction: &[f64], share: &mut [f64]) {
        follow(p.get(1), displacement, direction, share, &Hysteresis);
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
        let (velocity, drive_force, share) = (&velocity[..n], &drive_force[..n], &share[..n]);
        for i in 0..n {
            let ahead = since_begin(begin[i], now[i]) * velocity[i].abs();
            // At rest the drive says where it will go.
            let to = sign(if velocity[i] == 0.0 { drive_force[i] } else { velocity[i] });
            level[i] += size[i] * to * (to + (share[i] - to) * exp(-ahead / length[i]));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::axis::Axis;
    use crate::driven::{MeasuredMotion, force_along};
    use crate::effects::testing::along_and_simulated;
    use crate::model::Model;

    const VALUES: [(&str, f64); 2] = [("F_h", 3.0), ("l", 0.01)];

    #[test]
    fn it_turns_around_from_wherever_it_had_come_to() {
        let model = Model::new(Axis::Linear, 1.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 5.0)]))
            .and_then(|m| m.with("reversal-decay:hysteresis", &VALUES))
            .unwrap();
        // At 0.1 m/s: a long way forwards, 4 mm back, forwards again.
        let time: Vec<f64> = (0..1500).map(|k| f64::from(k) * 1e-3).collect();
        let forwards = |k: usize| !(1000..1040).contains(&k);
        let velocity: Vec<f64> =
            (0..time.len()).map(|k| if forwards(k) { 0.1 } else { -0.1 }).collect();
        let (mut x, mut position) = (0.0, Vec::new());
        for v in &velocity {
            x += v * 1e-3;
            position.push(x);
        }
        let none = vec![0.0; time.len()];
        let motion = MeasuredMotion::new(&time, &position, &velocity, &none).unwrap();
        let force = force_along(&model, &motion);
        assert!((force[999] - 8.0).abs() < 1e-3, "{}", force[999]);
        let back = |d: f64| -1.0 + 2.0 * (-d / 0.01).exp();
        let turned = back(0.004);
        for (k, share, friction) in [
            (1001, back(2e-4), -5.0),
            (1038, back(3.9e-3), -5.0),
            (1059, 1.0 + (turned - 1.0) * (-2e-3_f64 / 0.01).exp(), 5.0),
        ] {
            let exact = friction + 3.0 * share;
            assert!((force[k] - exact).abs() < 0.05, "{k}: {} {exact}", force[k]);
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let left = along_and_simulated(&[("reversal-decay:hysteresis", &VALUES)], None);
        assert!(left < 0.01, "{left}");
    }
}
