//! A force that repeats itself over time, whatever the axis does: another machine, a pump, a hum of the supply.

use super::{BEGIN, END};
use crate::axis::Quantity;
use crate::effects::{
    About, Effect, Motion, Parameter, Parameters, Periodic, Repeats, Slot, Smooth,
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
}
