//! Backlash: after a reversal the drive crosses a gap before it moves the load again.

mod two_mass;

use super::{
    About, AsFound, Begun, Came, Effect, Memory, Motion, Parameter, Parameters, Past, Recalled,
    Refused, Slot, Taken,
};
use crate::axis::Quantity;
use crate::effects::CDynamics;
use crate::effects::c_dynamics::LIMITED;
use crate::simd::sign;

/// The load's share `F_L` of the friction is missing while the drive is inside the gap `b`.
///
/// Without the load's inertia: the impact at the end of the gap is not part of the law.
#[derive(Clone, Copy, Debug)]
pub struct Backlash;

const WIDTH: Parameter =
    Parameter::shape("b", "width of the gap", Quantity::Length, (1e-6, 0.1), 2e-5);

/// A gap below this multiple of the least one is none.
const CLOSED: f64 = 1.05;
/// Counts of the position within which nothing is known of a gap: each of the two readings between which it is crossed is
/// half a count from where the drive is, on either side.
const COUNTS: f64 = 2.0;
/// A contact is turned around over twice the distance that it gives from rest.
const REVERSAL: f64 = 2.0;

static FORMS: [&dyn Effect; 1] = [&two_mass::TwoMass];
static ABOUT: About = About {
    name: "backlash",
    title: "backlash",
    equation: "-F_L s while the drive is inside the gap, over the distance b after each reversal",
    parameters: &[
        Parameter::level("F_L", "friction of the load behind the gap", Quantity::Force, 200.0, 4.0),
        WIDTH,
    ],
    slots: &[Slot::Memory],
    shows: "after a reversal the force drops to the inner part over the distance b, at every speed",
    reference: "M. Nordin, P.-O. Gutman, Automatica 38, 2002",
};

impl Effect for Backlash {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 1,
            helpers: &[LIMITED],
            start: "{s0} = 0.5 * sign(velocity);",
            recall: "{
    const double towards = m->direction == 0.0 ? sign(m->drive) : m->direction;
    m->remembered -= {s0} * towards < 0.5 ? {F_L} : 0.0;
}",
            remember: "{s0} = limited({s0} + m->displacement / {b}, 0.5);",
            ..CDynamics::NONE
        })
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }

    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        closed(found, 1)
    }
}

/// Why a gap is none that is as narrow as its search allows, a coupling then, that no encoder sees, or that the model's
/// contact crosses before it slides: where friction turns over such a distance anyway, a gap is the shape of that.
fn closed(found: &AsFound<'_>, width: usize) -> Option<Refused> {
    let width = (width, "b");
    let narrow = found.at_least(width, CLOSED, "the gap is as narrow as it may be");
    let hidden = "the gap is narrower than two counts of the position";
    let within = "friction turns over as long a distance without the gap";
    narrow
        .or_else(|| found.within(width, COUNTS * found.count, hidden))
        .or_else(|| found.within(width, REVERSAL * found.give, within))
}

/// State: place of the drive in the gap, -1/2..1/2 of its width.
impl Memory for Backlash {
    fn states(&self) -> usize {
        1
    }

    fn start(&self, p: &[f64], begun: &Begun, state: &mut [f64]) {
        state[0] = match begun.came {
            // From the other side at the last reversal.
            Some(Came { way, .. }) => (way / p[1] - 0.5 * sign(way)).clamp(-0.5, 0.5),
            None => 0.5 * sign(begun.velocity),
        };
    }

    fn recall(
        &self,
        p: Parameters<'_>,
        m: &Motion<'_>,
        _past: &Past,
        state: &[f64],
        out: &mut Recalled<'_>,
    ) {
        for (i, level) in out.level.iter_mut().enumerate() {
            // At the side towards which it moves, or is pushed, it takes the load with it.
            let towards =
                if m.direction[i] == 0.0 { sign(m.drive_force[i]) } else { m.direction[i] };
            let inside = state[i] * towards < 0.5;
            *level -= if inside { p.get(0)[i] } else { 0.0 };
        }
    }

    fn remember(&self, p: Parameters<'_>, taken: &Taken<'_>, state: &mut [f64]) {
        for (i, state) in state.iter_mut().enumerate() {
            *state = (*state + taken.displacement[i] / p.get(1)[i]).clamp(-0.5, 0.5);
        }
    }

    /// At an end of the gap both sides move together.
    fn correct(&self, p: Parameters<'_>, displacement: &[f64], state: &mut [f64]) {
        for (i, state) in state.iter_mut().enumerate() {
            let moved = (*state + displacement[i] / p.get(1)[i]).clamp(-0.5, 0.5);
            *state = if state.abs() < 0.5 { moved } else { *state };
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::axis::Axis;
    use crate::driven::{MeasuredMotion, force_along};
    use crate::model::Model;

    #[test]
    fn the_force_drops_over_the_gap_after_a_reversal_and_nowhere_else() {
        let model = Model::new(Axis::Linear, 1.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 10.0)]))
            .and_then(|m| m.with("backlash", &[("F_L", 4.0), ("b", 1e-3)]))
            .unwrap();
        let time: Vec<f64> = (0..400).map(|k| f64::from(k) * 1e-3).collect();
        let forth = |k: usize| if k < 200 { k } else { 400 - k };
        let x: Vec<f64> = (0..400).map(|k| forth(k) as f64 * 1e-4).collect();
        let v: Vec<f64> = (0..400).map(|k| if k <= 200 { 0.1 } else { -0.1 }).collect();
        let none = vec![0.0; 400];
        let force = force_along(&model, &MeasuredMotion::new(&time, &x, &v, &none).unwrap());
        assert!(force[..=200].iter().all(|f| *f == 10.0));
        assert!(force[201..209].iter().all(|f| *f == -6.0));
        assert!(force[211..].iter().all(|f| *f == -10.0));
    }
}
