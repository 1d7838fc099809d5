//! An error of the encoder whose wave is no sine: its two signals differ in size and do not stand at right angles.

use super::{
    About, AsFound, CDynamics, Effect, Own, PERIOD, PERIODIC, Parameter, Parameters, Periodic,
    Quantity, REFERENCE, Refused, SHOWS, Sensor, Shown, Slot, as_rounding_makes, corrected,
    runs_forwards, turned,
};
use crate::simd::{sin_cos_of_turns, vectorised};

/// `x + sum_k a_k sin(2 pi k x/p) + b_k cos(2 pi k x/p)` of two harmonics is shown.
#[derive(Clone, Copy, Debug)]
pub struct Harmonics;

const fn amplitude(name: &'static str, meaning: &'static str) -> Parameter {
    Parameter::signed(name, meaning, Quantity::Length, 0.1, 1e-6)
}

static ABOUT: About = About {
    name: "encoder:harmonics",
    title: "periodic error of the encoder, two harmonics",
    equation: "x + a sin(u) + b cos(u) + a_2 sin(2 u) + b_2 cos(2 u) is shown, u = 2 pi x/p",
    parameters: &[
        amplitude("a", "sine amplitude"),
        amplitude("b", "cosine amplitude"),
        amplitude("a_2", "sine amplitude of the second harmonic"),
        amplitude("b_2", "cosine amplitude of the second harmonic"),
        PERIOD,
    ],
    slots: &[Slot::Sensor],
    shows: SHOWS,
    reference: REFERENCE,
};

impl Effect for Harmonics {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    /// Alone it would fit anything a little.
    fn is_only_flexible(&self) -> bool {
        true
    }

    /// What the plain form took for its wave is the first harmonic or the second one.
    fn other_valleys(&self, fitted: &[f64]) -> Vec<Vec<f64>> {
        let &[a, b, a_2, b_2, p] = fitted else { return Vec::new() };
        vec![vec![0.0, 0.0, a, b, 2.0 * p], vec![a_2, b_2, 0.0, 0.0, 0.5 * p]]
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            shown: "{
    const double u = 6.283185307179586 * (position / {p});
    position += {a} * sin(u) + {b} * cos(u) + {a_2} * sin(2.0 * u) + {b_2} * cos(2.0 * u);
}",
            ..CDynamics::NONE
        })
    }

    fn shows_beside_given_force(&self) -> bool {
        false
    }

    fn is_possible(&self, values: &[f64]) -> bool {
        runs_forwards(&values[..4], values[4])
    }

    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        as_rounding_makes(2, found)
    }

    fn sensor(&self) -> Option<&dyn Sensor> {
        Some(self)
    }

    fn periodic(&self) -> Option<Periodic> {
        Some(Periodic { ranked: false, ..PERIODIC })
    }

    fn in_recording(&self, values: &[f64], own: Own) -> Option<Vec<f64>> {
        let Own::Home(home) = own else { return None };
        let (a, b) = turned((values[0], values[1]), 1, home, values[4]);
        let (a_2, b_2) = turned((values[2], values[3]), 2, home, values[4]);
        Some(vec![a, b, a_2, b_2, values[4]])
    }
}

impl Sensor for Harmonics {
    fn show(&self, p: Parameters<'_>, position: &mut [f64]) {
        waves(p, position);
    }

    fn correct(&self, p: &[f64], shown: &mut Shown<'_>) {
        corrected((p[0], p[1]), p[4], shown);
        corrected((p[2], p[3]), 0.5 * p[4], shown);
    }
}

vectorised! {
    /// Adds the error at each position.
    fn waves(p: Parameters<'_>, position: &mut [f64]) {
        let lanes = position.len();
        let [a, b, a_2, b_2, period] = std::array::from_fn(|k| &p.get(k)[..lanes]);
        for i in 0..lanes {
            let (sin, cos) = sin_cos_of_turns(position[i] / period[i]);
            let (twice_sin, twice_cos) = (2.0 * sin * cos, 1.0 - 2.0 * sin * sin);
            position[i] += a[i] * sin + b[i] * cos + a_2[i] * twice_sin + b_2[i] * twice_cos;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Encoder;
    use super::*;

    #[test]
    fn without_a_second_harmonic_it_is_the_plain_form_and_that_has_half_the_period() {
        for x in [-3.3e-4, 0.0, 1.1e-5, 2.7e-4] {
            let shown = |a: f64, second: f64| {
                let mut shown = [x];
                let p = [a, -1e-7, second, 0.5 * second, 2e-4];
                Harmonics.show(Parameters::new(&p, 1), &mut shown);
                shown[0]
            };
            let plain = |a: f64, b: f64, period: f64| {
                let mut shown = [x];
                Encoder.show(Parameters::new(&[a, b, period], 1), &mut shown);
                shown[0]
            };
            assert!((shown(2e-7, 0.0) - plain(2e-7, -1e-7, 2e-4)).abs() < 1e-17);
            let second = shown(2e-7, 1e-7) - shown(2e-7, 0.0);
            assert!((second - (plain(1e-7, 5e-8, 1e-4) - x)).abs() < 1e-17, "{x}");
        }
    }

    #[test]
    fn with_one_harmonic_alone_another_valley_shows_the_same() {
        let shown = |p: &[f64]| {
            let mut shown = [2.7e-5];
            Harmonics.show(Parameters::new(p, 1), &mut shown);
            shown[0]
        };
        for (fitted, valley) in
            [([2e-7, -1e-7, 0.0, 0.0, 2e-4], 0), ([0.0, 0.0, 2e-7, -1e-7, 2e-4], 1)]
        {
            let valleys = Harmonics.other_valleys(&fitted);
            assert_eq!(valleys[valley].last(), Some(&[4e-4, 1e-4][valley]));
            assert!((shown(&valleys[valley]) - shown(&fitted)).abs() < 1e-17);
        }
    }
}
