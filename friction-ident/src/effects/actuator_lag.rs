//! The current loop: the force follows its command like a first-order lag.

use super::{About, Advance, Apart, Before, Begin, Drive, Effect, Parameter, Parameters, Slot};
use crate::axis::Quantity;
use crate::effects::CDynamics;
use crate::signal::derivative;

/// `tau F' + F = u`.
#[derive(Clone, Copy, Debug)]
pub struct ActuatorLag;

/// `tau^2 F'' + 2 zeta tau F' + F = u`: a current loop that overshoots, a valve, a filter in the drive.
#[derive(Clone, Copy, Debug)]
struct SecondOrder;

static SECOND_ORDER: SecondOrder = SecondOrder;
static FORMS: [&dyn Effect; 1] = [&SECOND_ORDER];

static SECOND_ORDER_ABOUT: About = About {
    name: "actuator-lag:second-order",
    title: "second-order lag of the actuator",
    equation: "tau^2 F'' + 2 zeta tau F' + F = u",
    parameters: &[
        Parameter {
            low: 0.0,
            ..Parameter::shape(
                "tau",
                "time constant, 1/(2 pi f) of the undamped frequency f",
                Quantity::Time,
                (1e-5, 0.05),
                1e-3,
            )
            .linear()
        },
        Parameter::shape("zeta", "damping ratio", Quantity::One, (0.1, 3.0), 0.7),
    ],
    slots: &[Slot::Drive],
    shows: "a residual proportional to the first and the second derivative of the force; it may ring after a step",
    reference: "W. Leonhard, Control of Electrical Drives, Springer",
};

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

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 1,
            start: "{s0} = command;",
            drive: "{
    const double ratio = duration / {tau}, left = exp(-ratio), off = {s0} - force;
    const double mean = ratio > 1e-8 ? (1.0 - left) / ratio : 1.0;
    {s0} = force + off * left;
    force = force + off * (isfinite(ratio) ? mean : 0.0);
}",
            ..CDynamics::NONE
        })
    }

    fn lateness(&self, values: &[f64]) -> Option<f64> {
        values.first().copied()
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some("actuator-lag:second-order")
    }

    /// Two equal lags in a row: damped just enough not to ring.
    fn begins_flexible(&self, _before: &Before<'_>) -> Begin {
        Begin::at([("zeta", 1.0)])
    }

    fn told_apart(&self) -> &'static [Apart] {
        &[Apart {
            from: &["input-delay"],
            experiment: "add a fast sine sweep (to a third of the sampling frequency): a delay turns the phase in \
                         proportion to frequency, a lag also lowers the gain",
        }]
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }
}

/// Helper functions in C.
const SECOND_ORDER_IN_C: &str = include_str!("../export/c/second_order.c");

impl Effect for SecondOrder {
    fn about(&self) -> &'static About {
        &SECOND_ORDER_ABOUT
    }

    fn lateness(&self, values: &[f64]) -> Option<f64> {
        let [tau, zeta] = values else { return None };
        Some(2.0 * zeta * tau)
    }

    fn whatever(&self) -> &'static [&'static str] {
        &["zeta"]
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 2,
            helpers: &[SECOND_ORDER_IN_C],
            start: "{s0} = command;\n{s1} = 0.0;",
            drive: "{
    const double t = duration / {tau};
    if (!isfinite(t)) {
        {s0} = force;
        {s1} = 0.0;
    } else {
        const double off = {s0} - force, rate = {s1};
        double even, odd, off_then, rate_then, mean;
        lag_response({zeta}, t, &even, &odd);
        off_then = (even + {zeta} * odd) * off + odd * rate;
        rate_then = (even - {zeta} * odd) * rate - odd * off;
        mean = t > 1e-5 ? (2.0 * {zeta} * (off - off_then) + rate - rate_then) / t : off + 0.5 * t * rate;
        {s0} = force + off_then;
        {s1} = rate_then;
        force = force + mean;
    }
}",
            ..CDynamics::NONE
        })
    }

    /// Alone it would fit anything a little.
    fn is_only_flexible(&self) -> bool {
        true
    }

    /// It is a delay with what other people's filters make.
    fn shows_beside_given_force(&self) -> bool {
        false
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }
}

/// `(e^(-zeta t) cosh(k t), e^(-zeta t) sinh(k t)/k)`, `k^2 = zeta^2 - 1` of either sign, at the time `t` in units of `tau`.
fn response(zeta: f64, t: f64) -> (f64, f64) {
    let square = zeta * zeta - 1.0;
    let k = square.abs().sqrt();
    let fades = (-zeta * t).exp();
    if fades == 0.0 && square < 0.0 {
        (0.0, 0.0)
    } else if k * t < 1e-4 {
        let bend = square * t * t;
        (fades * (1.0 + bend / 2.0), fades * t * (1.0 + bend / 6.0))
    } else if square < 0.0 {
        let (sin, cos) = (k * t).sin_cos();
        (fades * cos, fades * sin / k)
    } else {
        // Apart, as the hyperbolic functions alone overflow.
        let (slow, fast) = ((-t / (zeta + k)).exp(), (-(zeta + k) * t).exp());
        (0.5 * (slow + fast), 0.5 * (slow - fast) / k)
    }
}

/// States: the force, `tau` times its derivative, and the response over a step as long as the last one.
impl Drive for SecondOrder {
    fn states(&self) -> usize {
        5
    }

    fn start(&self, _p: &[f64], command: f64, state: &mut [f64]) {
        state.copy_from_slice(&[command, 0.0, 0.0, 1.0, 0.0]);
    }

    fn advance(&self, p: Parameters<'_>, step: &Advance<'_>, state: &mut [f64], force: &mut [f64]) {
        let lanes = force.len();
        let (at, rest) = state.split_at_mut(lanes);
        let (rates, rest) = rest.split_at_mut(lanes);
        let (last, rest) = rest.split_at_mut(lanes);
        let (evens, odds) = rest.split_at_mut(lanes);
        for (i, force) in force.iter_mut().enumerate() {
            let (command, tau, zeta) = (*force, p.get(0)[i], p.get(1)[i]);
            let t = step.duration[i] / tau;
            if !t.is_finite() {
                (at[i], rates[i]) = (command, 0.0);
                continue;
            }
            // Exact for a command that is constant over the step, as is the mean force.
            if t != last[i] {
                last[i] = t;
                (evens[i], odds[i]) = response(zeta, t);
            }
            let (even, odd) = (evens[i], odds[i]);
            let (off, rate) = (at[i] - command, rates[i]);
            let off_then = (even + zeta * odd) * off + odd * rate;
            let rate_then = (even - zeta * odd) * rate - odd * off;
            // The equation itself, integrated over the step; for a short one that is a difference of what is nearly equal.
            let mean = if t > 1e-5 {
                (2.0 * zeta * (off - off_then) + rate - rate_then) / t
            } else {
                off + 0.5 * t * rate
            };
            *force = command + mean;
            (at[i], rates[i]) = (command + off_then, rate_then);
        }
    }

    fn invert(&self, p: &[f64], time: &[f64], force: &mut [f64]) {
        let slope = derivative(time, force);
        let bend = derivative(time, &slope);
        for (force, (slope, bend)) in force.iter_mut().zip(slope.iter().zip(bend)) {
            *force += p[0] * (2.0 * p[1] * slope + p[0] * bend);
        }
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
    use super::super::testing::along_and_simulated;
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

    /// Force and `tau` times its rate after `time` s under a command of 10 N, and the impulse until then.
    fn second(tau: f64, zeta: f64, step: f64, count: u32) -> ([f64; 2], f64) {
        let (mut state, mut impulse, past) = ([2.0, -1.0, 0.0, 1.0, 0.0], 0.0, Past::default());
        for _ in 0..count {
            let mut force = [10.0];
            let advance = Advance { duration: &[step], end: &[0.0], past: &past };
            SECOND_ORDER.advance(
                Parameters::new(&[tau, zeta], 1),
                &advance,
                &mut state,
                &mut force,
            );
            impulse += force[0] * step;
        }
        ([state[0], state[1]], impulse)
    }

    #[test]
    fn the_second_order_form_is_exact_in_steps_of_any_length_and_damping() {
        for zeta in [0.2, 0.7, 1.0 - 1e-12, 1.0, 1.0 + 1e-7, 1.5, 3.0] {
            let (whole, sum) = second(2e-3, zeta, 5e-3, 1);
            let (parts, impulse) = second(2e-3, zeta, 5e-6, 1000);
            assert!((whole[0] - parts[0]).abs() < 1e-9 && (whole[1] - parts[1]).abs() < 1e-9);
            assert!((sum - impulse).abs() < 1e-10, "{zeta}: {sum} {impulse}");
            // Against Euler's method with a mean of both ends, at a step of 0.1 us.
            let (mut force, mut rate) = (2.0, -1.0);
            for _ in 0..50_000 {
                let h = 1e-7 / 2e-3;
                let slope = |f: f64, g: f64| (g, 10.0 - f - 2.0 * zeta * g);
                let a = slope(force, rate);
                let b = slope(force + h * a.0, rate + h * a.1);
                force += 0.5 * h * (a.0 + b.0);
                rate += 0.5 * h * (a.1 + b.1);
            }
            assert!((whole[0] - force).abs() < 1e-6 && (whole[1] - rate).abs() < 1e-6, "{zeta}");
        }
    }

    #[test]
    fn the_second_order_form_takes_any_time_constant() {
        let (state, impulse) = second(0.0, 0.7, 1e-3, 3);
        assert_eq!((state, impulse), ([10.0, 0.0], 10.0 * 1e-3 * 3.0));
        for zeta in [0.1, 3.0] {
            let (state, impulse) = second(1e-9, zeta, 1e-3, 3);
            assert!((state[0] - 10.0).abs() < 1e-9 && (impulse - 0.03).abs() < 1e-6);
        }
        let (state, impulse) = second(1e6, 0.7, 1e-3, 3);
        assert!((state[0] - 2.0).abs() < 1e-6 && (impulse - 0.006).abs() < 1e-9);
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let values = [("tau", 4e-3), ("zeta", 0.6)];
        let left = along_and_simulated(&[("actuator-lag:second-order", &values)], Some(0.2));
        assert!(left < 1.0, "{left}");
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
