//! The Kalman gain of a mass with damping, sample by sample.

use std::ops::Range;

/// Gain and expected innovation at every sample.
#[derive(Clone, Debug)]
pub(super) struct Gain {
    /// Share of the error that goes to the position.
    pub position: Vec<f64>,
    /// What of it goes to the velocity, 1/s.
    pub velocity: Vec<f64>,
    /// Factor that brings an error to the size that it would have at a typical sample.
    pub relative: Vec<f64>,
    /// Standard deviation of the innovation at a typical sample.
    pub expected: f64,
}

/// Covariance of position and velocity.
#[derive(Clone, Copy)]
struct Covariance {
    xx: f64,
    xv: f64,
    vv: f64,
}

/// Time-varying gains for irregular sampling as for regular: the Riccati recursion of `(mass, damping)` under
/// `(position, force)` noise, the force held over a sampling interval.
pub(super) fn gains(
    time: &[f64],
    segments: &[Range<usize>],
    counted: &[usize],
    stale: &[bool],
    (mass, damping): (f64, f64),
    (noise, force): (f64, f64),
) -> Gain {
    let samples = time.len();
    let (mut position, mut velocity) = (vec![0.0; samples], vec![0.0; samples]);
    let mut innovation = vec![1.0; samples];
    for segment in segments {
        let first =
            (time.get(segment.start + 1).copied().unwrap_or(0.0) - time[segment.start]).abs();
        let speed = if first > 0.0 { 10.0 * noise / first } else { 0.0 };
        let mut p = Covariance { xx: noise * noise, xv: 0.0, vv: speed * speed };
        for k in segment.start + 1..segment.end {
            p = p.predicted(time[k] - time[k - 1], (mass, damping), force);
            if stale[k] {
                // Nothing was measured.
                continue;
            }
            let s = p.xx + noise * noise;
            (position[k], velocity[k]) = (p.xx / s, p.xv / s);
            innovation[k] = s.sqrt();
            p = Covariance {
                xx: p.xx - p.xx * p.xx / s,
                xv: p.xv - p.xx * p.xv / s,
                vv: p.vv - p.xv * p.xv / s,
            };
        }
    }
    let mut sorted: Vec<f64> = counted.iter().map(|k| innovation[*k]).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let expected = sorted.get(sorted.len() / 2).copied().unwrap_or(1.0);
    let relative = innovation.iter().map(|s| expected / s).collect();
    Gain { position, velocity, relative, expected }
}

/// How a mass with damping moves over an interval, and what a force that is held over it adds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    /// Share of the velocity that is left.
    pub decay: f64,
    /// Way per velocity, s.
    pub way: f64,
    /// Way per force, m/N or rad/(N m).
    pub moved: f64,
    /// Velocity per force.
    pub gained: f64,
}

impl Motion {
    /// Over `t` s of a plant of `(mass, damping)`.
    pub fn over(t: f64, (mass, damping): (f64, f64)) -> Self {
        let decay = (-damping * t / mass).exp();
        let way = if damping * t < 1e-9 * mass { t } else { mass / damping * (1.0 - decay) };
        Self { decay, way, moved: t * t / (2.0 * mass), gained: t / mass }
    }
}

impl Covariance {
    fn predicted(self, t: f64, plant: (f64, f64), force: f64) -> Self {
        let Motion { decay, way, moved, gained } = Motion::over(t, plant);
        let (gx, gv) = (force * moved, force * gained);
        Self {
            xx: self.xx + 2.0 * way * self.xv + way * way * self.vv + gx * gx,
            xv: decay * (self.xv + way * self.vv) + gx * gv,
            vv: decay * decay * self.vv + gv * gv,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_noise_of_the_force_the_filter_trusts_the_model_more_and_more() {
        let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 1e-3).collect();
        let counted: Vec<usize> = (1..2000).collect();
        let gain = gains(
            &time,
            std::slice::from_ref(&(0..2000)),
            &counted,
            &[false; 2000],
            (10.0, 100.0),
            (1e-6, 0.0),
        );
        assert!(gain.position[1999] < 0.01 && gain.velocity[1999].abs() < 1.0);
        assert!((gain.expected / 1e-6 - 1.0).abs() < 0.05, "{}", gain.expected);
    }

    #[test]
    fn a_free_mass_under_white_force_has_the_gain_of_the_tracking_index() {
        // P. R. Kalata 1984: beta = 2 (2 - alpha) - 4 sqrt(1 - alpha) for any tracking index.
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 1e-3).collect();
        let counted: Vec<usize> = (1..4000).collect();
        let gain = gains(
            &time,
            std::slice::from_ref(&(0..4000)),
            &counted,
            &[false; 4000],
            (1.0, 0.0),
            (1e-6, 0.5),
        );
        let (alpha, beta) = (gain.position[3999], gain.velocity[3999] * 1e-3);
        let expected = 2.0 * (2.0 - alpha) - 4.0 * (1.0 - alpha).sqrt();
        assert!((beta - expected).abs() < 1e-6, "{beta} {expected}");
    }
}
