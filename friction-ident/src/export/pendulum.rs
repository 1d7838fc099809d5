//! A weight as a rigid body: formats of rigid bodies know no torque `M sin(q - q_0)`, but a centre of mass and gravity.

/// Gravity in the exported files, m/s^2.
pub(super) const GRAVITY: f64 = 9.80665;

/// A body that turns about the y axis, gravity along -z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pendulum {
    /// kg.
    pub mass: f64,
    /// Centre of mass at the angle 0: x and z, m.
    pub place: [f64; 2],
    /// About its centre of mass, kg m^2.
    pub inertia: f64,
}

impl Pendulum {
    /// The body of the moment of inertia `inertia` about its axis whose weight makes `torque sin(q - zero)`. Only
    /// `m g l` is measured: the arm is chosen so that half of the inertia lies in the centre of mass.
    pub fn new(inertia: f64, torque: f64, zero: f64) -> Self {
        if torque == 0.0 {
            return Self { mass: 1.0, place: [0.0; 2], inertia };
        }
        let zero = if torque < 0.0 { zero + std::f64::consts::PI } else { zero };
        let arm = 0.5 * inertia * GRAVITY / torque.abs();
        let mass = torque.abs() / (GRAVITY * arm);
        let place = [arm * zero.sin(), -arm * zero.cos()];
        Self { mass, place, inertia: inertia - mass * arm * arm }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weight_and_inertia_are_those_of_the_model() {
        for (inertia, torque, zero) in [(0.02, 1.5, 0.3), (3.0, -0.1, -2.0), (1e-3, 40.0, 0.0)] {
            let body = Pendulum::new(inertia, torque, zero);
            let [x, z] = body.place;
            assert!((body.inertia + body.mass * (x * x + z * z) - inertia).abs() < 1e-12 * inertia);
            assert!(body.inertia > 0.0 && body.mass > 0.0);
            for angle in [-1.0, 0.0, 0.7_f64, 2.5] {
                // Turned about y, x' = x cos q + z sin q; a weight at x' resists with m g x' on the other side of the axis.
                let turned = x * angle.cos() + z * angle.sin();
                let resists = -body.mass * GRAVITY * turned;
                let exact = torque * (angle - zero).sin();
                assert!(
                    (resists - exact).abs() < 1e-9 * torque.abs(),
                    "{angle}: {resists} {exact}"
                );
            }
        }
    }
}
