//! The sampled loop without friction levels: is it stable, and how does it respond?
//!
//! A mass `m` with damping `c` under a force that is held for a sampling interval `T` moves exactly by
//! `x' = x + b v + (T - b) u / c`, `v' = a v + (1 - a) u / c` with `a = exp(-c T / m)`,
//! `b = (1 - a) m / c` (limits for `c = 0`); PD from encoder differences is
//! `u = K_P (r - x) + K_D (r' - (x - x_last) / T)`.

use nalgebra::Matrix3;

/// Mass, damping and gains of a sampled PD loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearLoop {
    /// kg or kg m^2.
    pub mass: f64,
    /// N s/m or N m s/rad.
    pub damping: f64,
    /// N/m or N m/rad.
    pub proportional: f64,
    /// N s/m or N m s/rad.
    pub derivative: f64,
    /// s.
    pub sample_time: f64,
}

impl LinearLoop {
    /// The loop as `s' = A s` with the state `(x, v, x_last)`, reference at 0.
    pub fn matrix(&self) -> Matrix3<f64> {
        let t = self.sample_time;
        let decay = (-self.damping * t / self.mass).exp();
        let (reach, gain_x, gain_v) = if self.damping * t < 1e-9 * self.mass {
            (t, 0.5 * t * t / self.mass, t / self.mass)
        } else {
            let reach = (1.0 - decay) * self.mass / self.damping;
            (reach, (t - reach) / self.damping, (1.0 - decay) / self.damping)
        };
        // u = -(K_P + K_D / T) x + K_D / T x_last.
        let rate = self.derivative / t;
        let (now, before) = (-(self.proportional + rate), rate);
        Matrix3::new(
            1.0 + gain_x * now,
            reach,
            gain_x * before,
            gain_v * now,
            decay,
            gain_v * before,
            1.0,
            0.0,
            0.0,
        )
    }

    /// Factor by which a deviation shrinks from sample to sample in the long run: below 1 the loop is
    /// stable, and only then.
    pub fn spectral_radius(&self) -> f64 {
        self.matrix().complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;
    use crate::closed_loop::{Pd, Setup, closed_loop};
    use crate::model::Model;
    use crate::reference::Reference;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    const PAPER: LinearLoop = LinearLoop {
        mass: 33.34,
        damping: 416.2,
        proportional: 9.806_65e5,
        derivative: 4.903_325e3,
        sample_time: 5e-3,
    };

    #[test]
    fn the_printed_gains_per_count_and_sample_in_kgf_hang_on_the_viscous_friction() {
        let radius = |damping| LinearLoop { damping, ..PAPER }.spectral_radius();
        assert!((radius(0.0) - 1.023).abs() < 1e-3 && (radius(416.2) - 0.987).abs() < 1e-3);
        let weaker = LinearLoop { proportional: 5e4, derivative: 250.0, ..PAPER };
        assert!((weaker.spectral_radius() - 0.960).abs() < 1e-3);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn pd_without_friction_follows_the_discrete_response(
            mass in 5.0f64..80.0, damping in 0.0f64..600.0, wn in 10.0f64..60.0, zeta in 0.2f64..1.0,
        ) {
            let (proportional, derivative) = (mass * wn * wn, 2.0 * zeta * mass * wn);
            let linear = LinearLoop { mass, damping, proportional, derivative, sample_time: 5e-3 };
            let model = Model::new(Axis::Linear, mass).unwrap().with("viscous", &[("F_v", damping)]).unwrap();
            // A step of 1 mm away from where the loop starts.
            let n = 120;
            let mut position = vec![1e-3; n];
            position[0] = 0.0;
            let reference =
                Reference { sample_time: 5e-3, position, velocity: vec![0.0; n], acceleration: vec![0.0; n] };
            let setup = Setup { encoder_resolution: 0.0, max_step: 5e-5, ..Setup::default() };
            let run = closed_loop(&model, &reference, &mut Pd::new(proportional, derivative), &setup).unwrap();
            let mut state = Vector3::new(-1e-3, 0.0, -1e-3);
            let size = linear.spectral_radius().max(1.0).powi(n as i32);
            for k in 1..n {
                let exact = state.x + 1e-3;
                prop_assert!((run.position[k] - exact).abs() < 2e-6 * size, "{k}: {} {exact}", run.position[k]);
                state = linear.matrix() * state;
            }
        }
    }
}
