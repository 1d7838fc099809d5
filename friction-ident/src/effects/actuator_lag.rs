//! The current loop: the force follows its command like a first-order lag.

use super::{About, Advance, Drive, Effect, Parameter, Parameters, Slot};
use crate::axis::Quantity;
use crate::signal::derivative;

/// `tau F' + F = u`.
#[derive(Clone, Copy, Debug)]
pub struct ActuatorLag;

static ABOUT: About = About {
    name: "actuator-lag",
    title: "first-order lag of the actuator",
    equation: "tau F' + F = u",
    parameters: &[Parameter {
        low: 0.0,
        ..Parameter::shape("tau", "time constant", Quantity::Time, (1e-5, 0.05), 1e-3).linear()
    }],
    slots: &[Slot::Drive],
    shows: "a residual proportional to the derivative of the force, hence to jerk",
    reference: "W. Leonhard, Control of Electrical Drives, Springer",
};

impl Effect for ActuatorLag {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }
}

impl Drive for ActuatorLag {
    fn states(&self) -> usize {
        1
    }

    fn start(&self, _p: &[f64], command: f64, state: &mut [f64]) {
        state[0] = command;
    }

    fn advance(&self, p: Parameters<'_>, step: &Advance<'_>, state: &mut [f64], force: &mut [f64]) {
        for (i, (force, state)) in force.iter_mut().zip(state).enumerate() {
            // Exact for a command that is constant over the step; the mean force is what the
            // momentum of the mass sees.
            let (command, ratio) = (*force, step.duration[i] / p.get(0)[i]);
            let left = (-ratio).exp();
            let mean = if ratio > 1e-8 { (1.0 - left) / ratio } else { 1.0 };
            let mean = if ratio.is_finite() { mean } else { 0.0 };
            *force = command + (*state - command) * mean;
            *state = command + (*state - command) * left;
        }
    }

    fn invert(&self, p: &[f64], time: &[f64], force: &mut [f64]) {
        let slope = derivative(time, force);
        for (force, slope) in force.iter_mut().zip(slope) {
            *force += p[0] * slope;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Past;
    use super::*;

    fn step(tau: f64, state: &mut [f64], force: &mut [f64]) {
        let (duration, past) = ([1e-3], Past::default());
        let step = Advance { duration: &duration, end: &[0.0], past: &past };
        ActuatorLag.advance(Parameters::new(&[tau], 1), &step, state, force);
    }

    #[test]
    fn a_step_of_the_command_arrives_exponentially_and_its_mean_is_exact() {
        let (mut state, mut impulse) = ([0.0], 0.0);
        for _ in 0..5 {
            let mut force = [10.0];
            step(2e-3, &mut state, &mut force);
            impulse += force[0] * 1e-3;
        }
        let left = (-2.5f64).exp();
        assert!((state[0] - 10.0 * (1.0 - left)).abs() < 1e-12);
        assert!((impulse - 10.0 * (5e-3 - 2e-3 * (1.0 - left))).abs() < 1e-12);
    }

    #[test]
    fn without_a_time_constant_nothing_changes() {
        let (mut state, mut force) = ([3.0], [10.0]);
        step(0.0, &mut state, &mut force);
        assert_eq!((state[0], force[0]), (10.0, 10.0));
    }

    #[test]
    fn the_inverse_adds_the_derivative() {
        let time: Vec<f64> = (0..50).map(|k| f64::from(k) * 1e-3).collect();
        let mut force: Vec<f64> = time.iter().map(|t| 4.0 * t).collect();
        ActuatorLag.invert(&[0.01], &time, &mut force);
        for (force, time) in force.iter().zip(&time) {
            assert!((force - 4.0 * time - 0.04).abs() < 1e-9);
        }
    }
}
