//! A gain that is constant for small currents and falls beyond a knee: iron that saturates, an amplifier that runs out of
//! voltage.

use crate::axis::Quantity;
use crate::effects::bend::bent;
use crate::effects::{About, Advance, CDynamics, Drive, Effect, Parameter, Parameters, Slot};
use crate::simd::{exp, ln, vectorised};

/// Of the command `1/c` a third is lost, however sharp the knee is: from a gain that falls from the first newton on (`n` = 1,
/// the form `current`) over what is close to a hyperbolic tangent (2.5) to a limit of the drive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knee;

static ABOUT: About = About {
    name: "motor-gain:knee",
    title: "gain that falls beyond a knee (magnetic saturation)",
    equation: "F = u / (1 + (1.5^n - 1) (c |u|)^n)^(1/n)",
    parameters: &[
        Parameter::shape(
            "c",
            "one over the command of which a third is lost",
            Quantity::PerForce,
            (1e-6, 1e3),
            1e-3,
        ),
        Parameter::shape("n", "sharpness of the knee", Quantity::One, (1.0, 8.0), 2.5).linear(),
    ],
    slots: &[Slot::Drive],
    shows: "nothing is missing while the command is small; the larger it is the more is, of either sign",
    reference: "J. F. Gieras, Permanent Magnet Motor Technology, CRC Press 2010 (magnetic saturation)",
};

impl Effect for Knee {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            drive: "force /= pow(1.0 + (pow(1.5, {n}) - 1.0) * pow({c} * fabs(force), {n}), 1.0 / {n});",
            ..CDynamics::NONE
        })
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }
}

impl Drive for Knee {
    fn advance(
        &self,
        p: Parameters<'_>,
        _step: &Advance<'_>,
        _state: &mut [f64],
        force: &mut [f64],
    ) {
        lose(p.get(0), p.get(1), force);
    }

    fn invert(&self, p: &[f64], _time: &[f64], force: &mut [f64]) {
        let most = 1.0 / inverse_limit(p[0], p[1]);
        for force in force {
            // No command yields more: there the largest one that is sensible.
            let left = 1.0 - (force.abs() / most).powf(p[1]);
            *force /= left.max(0.0).powf(1.0 / p[1]).max(LEAST_GAIN);
        }
    }
}

/// Least share of the gain that a command is told for.
const LEAST_GAIN: f64 = 0.01;

/// One over the force that no command exceeds: `(1.5^n - 1)^(1/n) c`, so that it overflows nowhere.
#[inline(always)]
fn inverse_limit(c: f64, n: f64) -> f64 {
    const LN: f64 = 0.405_465_108_108_164_4;
    1.5 * c * exp(ln(1.0 - exp(-n * LN)) / n)
}

vectorised! {
    fn lose(bend: &[f64], sharpness: &[f64], force: &mut [f64]) {
        for ((force, c), n) in force.iter_mut().zip(bend).zip(sharpness) {
            *force = bent(*force, inverse_limit(*c, *n), *n);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::current::Current;
    use super::super::tests::through;
    use super::*;

    #[test]
    fn a_third_of_the_stated_command_is_lost_however_sharp_the_knee_is() {
        for n in [1.0, 2.5, 8.0] {
            let force = through(&Knee, &[0.01, n], &[100.0, -100.0]);
            let third = 100.0 / 1.5;
            assert!(
                (force[0] - third).abs() < 1e-9 && (force[1] + third).abs() < 1e-9,
                "{force:?}"
            );
        }
        assert_eq!(through(&Knee, &[0.01, 2.0], &[0.0]), [0.0]);
    }

    #[test]
    fn it_comes_from_the_gain_that_falls_at_once_and_goes_to_a_limit() {
        let commands = [-80.0, 30.0, 110.0];
        let [falls, at_once] = [(&Knee as &dyn Drive, &[0.02, 1.0][..]), (&Current, &[0.01])]
            .map(|(effect, p)| through(effect, p, &commands));
        assert!(falls.iter().zip(&at_once).all(|(a, b)| (a - b).abs() < 1e-9), "{falls:?}");
        let sharp = through(&Knee, &[1.0 / 150.0, 60.0], &[-80.0, 30.0]);
        assert!((sharp[0] + 80.0).abs() < 1e-4 && (sharp[1] - 30.0).abs() < 1e-9, "{sharp:?}");
    }

    #[test]
    fn a_force_that_no_command_yields_has_a_finite_one() {
        let mut force = [150.0];
        Knee.invert(&[0.02, 2.0], &[0.0], &mut force);
        assert!(force[0].is_finite());
    }
}
