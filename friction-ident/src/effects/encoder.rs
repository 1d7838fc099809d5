//! The encoder: an error within each period of its grating, or within each turn.

mod harmonics;

use crate::effects::CDynamics;
use std::f64::consts::TAU;

use super::own::{Own, turned};
use super::{
    About, Apart, AsFound, Effect, Parameter, Parameters, Periodic, Refused, Repeats, Sensor,
    Shown, Slot,
};
use crate::axis::Quantity;
use crate::simd::{sin_cos_of_turns, vectorised};

/// `x + a sin(2 pi x/p) + b cos(2 pi x/p)` is shown.
///
/// Its resolution is a matter of the recording: see [`crate::closed_loop::Setup`].
#[derive(Clone, Copy, Debug)]
pub struct Encoder;

static FORMS: [&dyn Effect; 1] = [&harmonics::Harmonics];

const PERIOD: Parameter = Parameter::shape(
    "p",
    "period: of the grating, or way per turn",
    Quantity::Length,
    (1e-6, 20.0),
    5e-3,
);
const PERIODIC: Periodic =
    Periodic { period: "p", of: Repeats::Sensor, ranked: true, columns: None, shortest: None };
const SHOWS: &str =
    "a line whose frequency is speed/p and whose force grows with the square of the speed";
const REFERENCE: &str = "P. L. M. Heydemann, Applied Optics 20, 1981";

static ABOUT: About = About {
    name: "encoder",
    title: "periodic error of the encoder (sub-division, eccentricity)",
    equation: "x + a sin(2 pi x/p) + b cos(2 pi x/p) is shown",
    parameters: &[
        Parameter::signed("a", "sine amplitude", Quantity::Length, 0.1, 1e-6),
        Parameter::signed("b", "cosine amplitude", Quantity::Length, 0.1, 1e-6),
        PERIOD,
    ],
    slots: &[Slot::Sensor],
    shows: SHOWS,
    reference: REFERENCE,
};

/// Counts that a wave is larger than: some ten places where an axis rests again and again, each rounded by 0.29 counts (rms),
/// make a wave of this size between them.
const COUNTS: f64 = 0.1;
/// Counts that a period is longer than: rounding itself repeats from count to count.
const SHORTEST: f64 = 2.0;

/// Order of the low-pass filter, forwards and backwards, behind [`passed`].
const ORDER: i32 = 8;

/// Share of a sine of `frequency` that passes a smoother with this cut-off, both Hz.
fn passed(frequency: f64, cutoff: f64) -> f64 {
    1.0 / (1.0 + (frequency / cutoff).powi(ORDER))
}

/// Accelerations that unit amplitudes `a` and `b` feign while an axis moves with `velocity` and
/// `acceleration`; `wave` is the sine and cosine of `2 pi x/p`.
pub fn feigned(
    (sin, cos): (f64, f64),
    period: f64,
    velocity: f64,
    acceleration: f64,
    cutoff: f64,
) -> (f64, f64) {
    let w = TAU / period;
    let part = passed(velocity.abs() / period, cutoff);
    let (turn, bend) = (part * w * acceleration, part * (w * velocity).powi(2));
    (turn * cos - bend * sin, -turn * sin - bend * cos)
}

/// Whether a reading with these amplitudes of sine and cosine, two for each harmonic, rises with the position everywhere.
fn runs_forwards(amplitudes: &[f64], period: f64) -> bool {
    let slopes =
        (1..).zip(amplitudes.chunks(2)).map(|(k, pair)| f64::from(k) * pair[0].hypot(pair[1]));
    TAU * slopes.sum::<f64>() < period
}

impl Effect for Encoder {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some("encoder:harmonics")
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            shown: "{
    const double a = 6.283185307179586 * (position / {p});
    position += {a} * sin(a) + {b} * cos(a);
}",
            ..CDynamics::NONE
        })
    }

    /// What the sensor shows is in that force already.
    fn shows_beside_given_force(&self) -> bool {
        false
    }

    fn is_possible(&self, values: &[f64]) -> bool {
        runs_forwards(&values[..2], values[2])
    }

    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        as_rounding_makes(1, found)
    }

    fn told_apart(&self) -> &'static [Apart] {
        &[Apart {
            from: &["ripple"],
            experiment: "cover the same stroke at constant speeds a factor of three apart: a ripple keeps its force, what an \
                         error of the encoder feigns grows with the square of the speed",
        }]
    }

    fn sensor(&self) -> Option<&dyn Sensor> {
        Some(self)
    }

    fn periodic(&self) -> Option<Periodic> {
        Some(PERIODIC)
    }

    fn in_recording(&self, values: &[f64], own: Own) -> Option<Vec<f64>> {
        let Own::Home(home) = own else { return None };
        let (a, b) = turned((values[0], values[1]), 1, home, values[2]);
        Some(vec![a, b, values[2]])
    }
}

impl Sensor for Encoder {
    fn show(&self, p: Parameters<'_>, position: &mut [f64]) {
        wave(p, position);
    }

    fn correct(&self, p: &[f64], shown: &mut Shown<'_>) {
        corrected((p[0], p[1]), p[2], shown);
    }
}

/// Why so many harmonics are none, if so.
fn as_rounding_makes(harmonics: usize, found: &AsFound<'_>) -> Option<Refused> {
    let (amplitudes, rest) = found.values.split_at(2 * harmonics);
    let value = amplitudes.iter().map(|a| a * a).sum::<f64>().sqrt();
    let limit = COUNTS * found.count;
    let meaning = "it is as small as what rounding to counts makes of a few places at rest";
    let small = Refused { name: "amplitude", value, limit, unit_of: "a", meaning };
    let (value, limit) = (rest[0], SHORTEST * found.count);
    let meaning = "its period is that of the counts";
    let short = Refused { name: "p", value, limit, unit_of: "p", meaning };
    (small.value <= small.limit).then_some(small).or((value <= limit).then_some(short))
}

/// Takes a wave out of a motion that was shown with it.
fn corrected((a, b): (f64, f64), period: f64, shown: &mut Shown<'_>) {
    let w = TAU / period;
    for i in 0..shown.position.len() {
        let (v, wave) = (shown.velocity[i], (w * shown.position[i]).sin_cos());
        let (sine, cosine) = feigned(wave, period, v, shown.acceleration[i], shown.cutoff);
        let part = passed(v.abs() / period, shown.cutoff);
        shown.position[i] -= part * (a * wave.0 + b * wave.1);
        shown.velocity[i] -= part * w * v * (a * wave.1 - b * wave.0);
        shown.acceleration[i] -= a * sine + b * cosine;
    }
}

vectorised! {
    /// Adds the error at each position.
    fn wave(p: Parameters<'_>, position: &mut [f64]) {
        let lanes = position.len();
        let [a, b, period] = std::array::from_fn(|k| &p.get(k)[..lanes]);
        for i in 0..lanes {
            let (sin, cos) = sin_cos_of_turns(position[i] / period[i]);
            position[i] += a[i] * sin + b[i] * cos;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(position: f64) -> f64 {
        let mut shown = [position];
        Encoder.show(Parameters::new(&[2e-7, 1e-7, 2e-5], 1), &mut shown);
        shown[0]
    }

    #[test]
    fn the_error_repeats_with_the_period() {
        let error = |x: f64| shown(x) - x;
        assert!((error(5e-6) - 2e-7).abs() < 1e-15 && (error(0.0) - 1e-7).abs() < 1e-15);
        assert!((error(3.3e-6) - error(2.33e-5)).abs() < 1e-15);
    }

    #[test]
    fn a_wave_as_small_as_what_rounding_makes_is_none() {
        let refused = |a: f64, b: f64, p: f64| {
            let found = AsFound {
                values: &[a, b, p],
                least: &[-1e-4, -1e-4, 1e-6],
                most: &[1e-4, 1e-4, 0.05],
                mass: 30.0,
                force: 5.0,
                count: 1e-6,
                give: 0.0,
            };
            Encoder.refused(&found).map(|refused| (refused.value, refused.limit))
        };
        assert_eq!(refused(-5.5e-8, 0.0, 5e-3), Some((5.5e-8, 1e-7)));
        assert!(refused(6e-8, -7e-8, 5e-3).is_some());
        assert_eq!(refused(8e-8, -7e-8, 5e-3), None);
        // As long as a count or two it is the rounding, however large.
        assert_eq!(refused(3e-7, 0.0, 1.9e-6), Some((1.9e-6, 2e-6)));
        assert_eq!(refused(3e-7, 0.0, 2.1e-6), None);
    }

    #[test]
    fn a_shown_motion_is_corrected_to_first_order() {
        // x = 1 mm sin(t) is shown with an error of 1e-4 of the period.
        let p = [3e-8, -1e-8, 3e-4];
        let at = |t: f64| {
            let mut x = [1e-3 * t.sin()];
            Encoder.show(Parameters::new(&p, 1), &mut x);
            x[0]
        };
        for k in 0..40 {
            let (t, h) = (0.1 * f64::from(k), 1e-4);
            let (before, now, after) = (at(t - h), at(t), at(t + h));
            let (mut x, mut v) = ([now], [(after - before) / (2.0 * h)]);
            let mut a = [(after - 2.0 * now + before) / (h * h)];
            let (false_x, false_a) = (now - 1e-3 * t.sin(), a[0] + 1e-3 * t.sin());
            let (position, velocity, acceleration) = (&mut x[..], &mut v[..], &mut a[..]);
            let cutoff = f64::INFINITY;
            Encoder.correct(&p, &mut Shown { position, velocity, acceleration, cutoff });
            assert!((x[0] - 1e-3 * t.sin()).abs() < 2e-3 * false_x.abs() + 1e-12);
            assert!((v[0] - 1e-3 * t.cos()).abs() < 2e-6 * 1e-3 + 1e-9);
            assert!((a[0] + 1e-3 * t.sin()).abs() < 3e-3 * false_a.abs() + 1e-7, "{k}: {a:?}");
        }
    }

    #[test]
    fn a_reading_runs_forwards_everywhere() {
        assert!(Encoder.is_possible(&[0.1, 0.1, 0.9]) && !Encoder.is_possible(&[0.1, 0.1, 0.88]));
        let both = |p: f64| harmonics::Harmonics.is_possible(&[0.1, 0.0, 0.0, 0.05, p]);
        assert!(both(1.26) && !both(1.25));
    }

    #[test]
    fn what_the_smoother_takes_out_is_not_corrected() {
        let (mut x, mut v, mut a) = ([0.0], [0.1], [0.0]);
        // 0.1 m/s over 1 mm is 100 Hz, five times the cut-off.
        Encoder.correct(
            &[0.0, 1e-6, 1e-3],
            &mut Shown { position: &mut x, velocity: &mut v, acceleration: &mut a, cutoff: 20.0 },
        );
        assert!(x[0].abs() < 1e-11 && a[0].abs() < 1e-5 * 0.4, "{x:?} {a:?}");
    }
}
