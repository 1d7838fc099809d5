//! One body under a push and set-valued friction, from event to event.
//!
//! Within a step the push is constant; the body stops at the instant at which its velocity is zero, rests
//! where the friction holds the push, and leaves in the direction of the push where it does not.

/// A body that slides.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Position, m or rad.
    pub x: f64,
    /// Velocity: exactly zero at rest.
    pub v: f64,
    /// Mass or inertia.
    pub mass: f64,
}

impl Body {
    /// At rest at `x`.
    pub fn at(x: f64, mass: f64) -> Self {
        Self { x, v: 0.0, mass }
    }

    /// Position in the middle of a step of `h`, to first order: where a push that depends on it is taken.
    pub fn middle(&self, h: f64) -> f64 {
        self.x + 0.5 * h * self.v
    }

    /// A step of `h` under `push`, with the friction `level` of a direction and a viscous coefficient.
    pub fn advance(&mut self, push: f64, level: impl Fn(f64) -> f64, viscous: f64, h: f64) {
        let inert = self.mass + 0.5 * viscous * h;
        let mut left = h;
        if self.v != 0.0 {
            let direction = self.v.signum();
            let a = (push - direction * level(direction) - viscous * self.v) / inert;
            let end = self.v + a * h;
            if end * direction > 0.0 {
                self.x += 0.5 * (self.v + end) * h;
                self.v = end;
                return;
            }
            let stop = (-self.v / a).min(h);
            self.x += 0.5 * self.v * stop;
            self.v = 0.0;
            left -= stop;
        }
        let excess = push.abs() - level(push.signum());
        if excess > 0.0 {
            self.v = push.signum() * excess / inert * left;
            self.x += 0.5 * self.v * left;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 2e-5;

    #[test]
    fn coulomb_friction_brakes_to_a_stop_at_the_exact_place() {
        let mut body = Body { x: 0.0, v: 0.37, mass: 3.0 };
        for _ in 0..20_000 {
            body.advance(0.0, |_| 5.0, 0.0, STEP);
        }
        let way = 3.0 * 0.37_f64.powi(2) / (2.0 * 5.0);
        assert_eq!(body.v, 0.0);
        assert!((body.x - way).abs() < 1e-12, "{} m instead of {way} m", body.x);
    }

    #[test]
    fn viscous_friction_lets_the_velocity_decay_exponentially() {
        let mut body = Body { x: 0.0, v: 0.2, mass: 30.0 };
        for _ in 0..5_000 {
            body.advance(0.0, |_| 0.0, 400.0, STEP);
        }
        let wanted = 0.2 * (-0.1 * 400.0 / 30.0_f64).exp();
        assert!((body.v / wanted - 1.0).abs() < 1e-7);
    }

    #[test]
    fn a_body_holds_below_the_level_and_leaves_above_it() {
        let mut body = Body::at(0.0, 2.0);
        for _ in 0..100 {
            body.advance(4.999, |_| 5.0, 10.0, STEP);
        }
        assert_eq!((body.x, body.v), (0.0, 0.0));
        body.advance(-6.0, |_| 5.0, 0.0, STEP);
        assert!((body.v + 0.5 * STEP).abs() < 1e-15);
    }

    #[test]
    fn a_block_on_a_pulled_spring_sticks_and_slips_with_the_period_of_the_closed_form() {
        let (mass, stiffness, pull, rest, slide) = (2.0, 800.0, 0.01, 6.0, 4.0);
        let mut body = Body::at(0.0, mass);
        let (mut starts, mut lengths) = (Vec::new(), Vec::new());
        for k in 0..(20.0 / STEP) as usize {
            let t = (k as f64 + 0.5) * STEP;
            let push = stiffness * (pull * t - body.middle(STEP));
            let (level, before) = (if body.v == 0.0 { rest } else { slide }, body.v);
            body.advance(push, |_| level, 0.0, STEP);
            if before == 0.0 && body.v != 0.0 {
                starts.push(t);
                lengths.push(body.x);
            }
        }
        // While it slides the stretch swings about slide / k; it stops where the stretch grows at the
        // speed of the pull again.
        let omega = f64::sqrt(stiffness / mass);
        let drop = (rest - slide) / stiffness;
        let slip = 2.0 / omega * (std::f64::consts::PI - (drop * omega / pull).atan());
        let period = slip + 2.0 * drop / pull;
        let count = starts.len();
        assert!(count > 10);
        let seen = (starts[count - 1] - starts[0]) / (count - 1) as f64;
        assert!((seen / period - 1.0).abs() < 1e-3, "{seen} s instead of {period} s");
        let way = (lengths[count - 1] - lengths[0]) / (count - 1) as f64;
        assert!((way / (pull * period) - 1.0).abs() < 1e-3);
    }
}
