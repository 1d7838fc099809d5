//! Input delay: bus cycle, computation, dead time of the drive.

use super::{About, Advance, Drive, Effect, Parameter, Parameters, Slot};
use crate::axis::Quantity;
use crate::effects::CDynamics;
use crate::effects::c_dynamics::PAST;

/// `F(t) = u(t - T_d)`.
#[derive(Clone, Copy, Debug)]
pub struct InputDelay;

static ABOUT: About = About {
    name: "input-delay",
    title: "delay of the command",
    equation: "F(t) = u(t - T_d)",
    parameters: &[Parameter {
        low: 0.0,
        ..Parameter::shape("T_d", "delay", Quantity::Time, (1e-5, 0.05), 1e-3).linear()
    }],
    slots: &[Slot::Drive],
    shows: "as a lag at low frequency; phase linear in frequency",
    reference: "O. J. M. Smith, Chem. Eng. Progress 53, 1957",
};

impl Effect for InputDelay {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            helpers: &[PAST],
            // A little more, so that a delay of 0 keeps its past as well.
            input: "fmax(1e-6, {T_d})",
            drive: "{
    const double sum = m->input.value[m->input.end - 1] + duration * force;
    if (!past_push(&m->input, end, sum)) {
        return 0;
    }
    if (duration > 0.0) {
        const double to = end - {T_d};
        force = (past_at(&m->input, to) - past_at(&m->input, to - duration)) / duration;
    }
}",
            ..CDynamics::NONE
        })
    }

    fn lateness(&self, values: &[f64]) -> Option<f64> {
        values.first().copied()
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }
}

impl Drive for InputDelay {
    fn memory(&self, p: Parameters<'_>) -> f64 {
        // A little more, so that a delay of 0 keeps its past as well.
        p.get(0).iter().fold(1e-6, |longest: f64, delay| longest.max(*delay))
    }

    fn advance(
        &self,
        p: Parameters<'_>,
        step: &Advance<'_>,
        _state: &mut [f64],
        force: &mut [f64],
    ) {
        for (i, force) in force.iter_mut().enumerate().filter(|(i, _)| step.duration[*i] > 0.0) {
            let to = step.end[i] - p.get(0)[i];
            let impulse = step.past.at(i, to) - step.past.at(i, to - step.duration[i]);
            *force = impulse / step.duration[i];
        }
    }

    fn invert(&self, p: &[f64], time: &[f64], force: &mut [f64]) {
        let given = force.to_vec();
        let mut k = 0;
        for (force, t) in force.iter_mut().zip(time) {
            let then = t + p[0];
            while k + 2 < time.len() && time[k + 1] < then {
                k += 1;
            }
            if k + 1 < time.len() {
                let share = ((then - time[k]) / (time[k + 1] - time[k])).min(1.0);
                *force = given[k] + share * (given[k + 1] - given[k]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;
    use crate::model::Model;
    use crate::simulator::{Input, Start, simulate};
    use missing_physics::Hold;

    #[test]
    fn the_momentum_comes_a_delay_later_even_a_fraction_of_a_step() {
        let model =
            Model::new(Axis::Linear, 2.0).and_then(|m| m.with("input-delay", &[("T_d", 3.4e-3)]));
        let time: Vec<f64> = (0..600).map(|k| f64::from(k) * 1e-3).collect();
        let force: Vec<f64> = time.iter().map(|t| if *t < 0.1 { 1.0 } else { 5.0 }).collect();
        let start = Start { command: 1.0, ..Start::default() };
        let input = Input::new(&time, &force, Hold::ZeroOrder);
        let out = simulate(&model.unwrap(), &input, &start).unwrap();
        for (v, t) in out.velocity.iter().zip(&time) {
            let exact = 0.5 * (t + 4.0 * (t - 0.1034).max(0.0));
            assert!((v - exact).abs() < 1e-9, "{t}: {v} {exact}");
        }
    }

    #[test]
    fn the_inverse_asks_for_the_force_of_a_delay_later() {
        let time: Vec<f64> = (0..50).map(|k| f64::from(k) * 1e-3).collect();
        let mut force: Vec<f64> = time.iter().map(|t| 3.0 * t).collect();
        InputDelay.invert(&[1.5e-3], &time, &mut force);
        for (force, t) in force.iter().zip(&time).take(48) {
            assert!((force - 3.0 * (t + 1.5e-3)).abs() < 1e-12);
        }
    }
}
