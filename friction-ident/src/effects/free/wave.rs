//! A force that repeats itself over time, whatever the axis does: another machine, a pump, a hum of the supply.

use std::f64::consts::{PI, TAU};

use super::{BEGIN, END};
use crate::axis::Quantity;
use crate::effects::{
    About, AsFound, Effect, Motion, Parameter, Parameters, Periodic, Refused, Repeats, Slot, Smooth,
};
use crate::simd::{sin_cos_of_turns, vectorised};

/// One harmonic over time.
#[derive(Clone, Copy, Debug)]
pub struct ForceWave;

pub(super) static ABOUT: About = About {
    name: "force-wave",
    title: "force that repeats itself over time",
    equation: "a sin(2 pi t/P) + b cos(2 pi t/P), t from the middle of the recording",
    parameters: &[
        BEGIN,
        END,
        Parameter::signed("a", "sine amplitude", Quantity::Force, 100.0, 1.0),
        Parameter::signed("b", "cosine amplitude", Quantity::Force, 100.0, 0.0),
        Parameter::shape("P", "period", Quantity::Time, (1e-4, 1e4), 1.0),
    ],
    slots: &[Slot::SmoothForce],
    shows: "a line at 1/P in the residual's spectrum over time",
    reference: "B. A. Francis, W. M. Wonham, Automatica 12, 1976 (disturbances that an internal model repeats)",
};

impl Effect for ForceWave {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn periodic(&self) -> Option<Periodic> {
        let of = Repeats::ForceOverTime;
        Some(Periodic { period: "P", of, ranked: true, columns: None, shortest: None })
    }

    /// At an even speed the error of rounding is a saw-tooth whose first harmonic is a count over pi, and counts beat with the
    /// samples: what is taken for a force that swings a free mass no further may be that.
    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        let [a, b, period] = *found.values else { return None };
        let (value, limit) = (a.hypot(b), found.mass * (TAU / period).powi(2) * found.count / PI);
        let meaning = "it moves the axis no further than rounding to counts does at an even speed";
        (value <= limit).then_some(Refused {
            name: "amplitude",
            value,
            limit,
            unit_of: "a",
            meaning,
        })
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        swing(p, m.time, out.force);
    }
}

vectorised! {
    fn swing(p: Parameters<'_>, time: &[f64], force: &mut [f64]) {
        let n = force.len();
        let [begin, end, sine, cosine, period] = std::array::from_fn(|k| &p.get(k)[..n]);
        let time = &time[..n];
        for i in 0..n {
            // From the middle, so that a fit of the period leaves the phase alone.
            let middle = 0.5 * (begin[i] + end[i]);
            let (sin, cos) = sin_cos_of_turns((time[i] - middle) / period[i]);
            force[i] += sine[i] * sin + cosine[i] * cos;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::testing::{Point, smooth};

    #[test]
    fn it_repeats_over_time_wherever_the_axis_is() {
        let p = [10.0, 30.0, 2.0, -0.5, 0.4];
        let force =
            |time: f64, x: f64| smooth(&ForceWave, &p, Point { time, ..Point::at(x, 0.1) }).0;
        assert!((force(20.0, 0.0) + 0.5).abs() < 1e-9);
        assert!((force(20.1, 0.0) - 2.0).abs() < 1e-9);
        assert!((force(13.37, 0.0) - force(13.77, 0.3)).abs() < 1e-9);
    }

    /// A position in counts of 1 at an even speed of 0.243 counts a sample, and the force that would swing 28 kg so.
    #[test]
    fn what_swings_the_axis_as_counts_that_beat_with_the_samples_do_is_none() {
        let (mass, speed, samples) = (28.0, 0.243, 10_000);
        let mut sums = (0.0, 0.0);
        for k in 0..samples {
            let place = speed * f64::from(k);
            let (sin, cos) = (TAU * place).sin_cos();
            sums.0 += (place.round() - place) * sin;
            sums.1 += (place.round() - place) * cos;
        }
        let swings = 2.0 / f64::from(samples) * f64::hypot(sums.0, sums.1);
        let refused = |times: f64| {
            let force = times * swings * mass * (TAU * speed).powi(2);
            let values = [0.0, force, 1.0 / speed];
            let (least, most, mass) = (&[0.0; 3][..], &[0.0; 3][..], mass);
            let found =
                AsFound { values: &values, least, most, mass, force: 1.0, count: 1.0, give: 0.0 };
            ForceWave.refused(&found).is_some()
        };
        assert!(refused(0.99) && !refused(1.05), "{swings}");
    }
}
