//! A second body with friction of its own, behind anything that pulls it along.

use super::Parameters;
use crate::simd::sign;

/// Most trials for the mean velocity of the load; a linear connection needs two.
const TRIALS: usize = 60;

/// The body behind the connection.
#[derive(Clone, Copy, Debug)]
pub(super) struct Load {
    /// kg or kg m^2; may be 0.
    pub mass: f64,
    /// Coulomb friction on the ground, N or N m.
    pub level: f64,
    /// Viscous friction on the ground, N s/m or N m s/rad.
    pub viscous: f64,
}

/// What pulls the load along in a step: mean force on it, and its slope, against how far the mass runs
/// ahead of the load in the step. It must not decrease.
pub(super) trait Connection {
    fn pull(&self, ahead: f64) -> (f64, f64);
}

/// A step of the load.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pulled {
    /// Mean force on the mass, and its slope against the displacement of the mass.
    pub force: f64,
    pub slope: f64,
    /// Mean velocity of the load.
    pub mean: f64,
}

impl Load {
    pub(super) fn of(p: Parameters<'_>, i: usize, at: [usize; 3]) -> Self {
        let [mass, level, viscous] = at.map(|k| p.get(k)[i]);
        Self { mass, level, viscous }
    }

    /// The force that keeps it moving at `velocity`.
    pub(super) fn drag(self, velocity: f64) -> f64 {
        self.level * sign(velocity) + self.viscous * velocity
    }

    /// A step of `r > 0` from `velocity`, in which the mass moves by `moved`: with the load's mean velocity `u`
    /// `2 m_L (u - v_L) / r = N(moved - r u) - d_L u - F`. The friction `F` in `-F_L..F_L` is set-valued:
    ///
    /// * all of it while the load goes on in its direction;
    /// * what it takes where that brings the load to rest at the end of the step, or keeps it there;
    /// * none of it where the load turns back within the step and has not yet gone back further than it went.
    ///
    /// `F u` is never negative, so that friction never drives the load; `u` grows with `N`, so that the implicit
    /// step has one solution; and at `F_L = 0` nothing is left of it. First order where the load stops or turns.
    pub(super) fn step(
        self,
        velocity: f64,
        r: f64,
        moved: f64,
        connection: &impl Connection,
    ) -> Pulled {
        let inertia = 2.0 * self.mass / r + self.viscous;
        let momentum = 2.0 * self.mass * velocity / r;
        // What friction would have to take for the load to have the mean velocity `u`.
        let to_take = |u: f64| momentum + connection.pull(moved - r * u).0 - inertia * u;
        let s = if velocity < 0.0 { -1.0 } else { 1.0 };
        let (stop, turn) = (s * to_take(0.5 * velocity), s * to_take(0.0));
        let slides = if self.level <= 0.0 {
            Ok(0.0)
        } else if stop > self.level {
            Ok(s * self.level)
        } else if stop >= 0.0 {
            Err(0.5 * velocity)
        } else if turn >= 0.0 {
            Ok(0.0)
        } else if turn >= -self.level {
            Err(0.0)
        } else {
            Ok(-s * self.level)
        };
        let mean = match slides {
            Ok(friction) => {
                let free = momentum - friction;
                slide(0.5 * velocity, r, moved, inertia, free, connection)
            }
            Err(held) => held,
        };
        let (force, stiffness) = connection.pull(moved - r * mean);
        let yields = inertia / (inertia + r * stiffness).max(f64::MIN_POSITIVE);
        let slope = if slides.is_ok() { stiffness * yields } else { stiffness };
        Pulled { force, slope, mean }
    }
}

/// Solves `inertia u = free + N(moved - r u)` by Newton within a bracket.
fn slide(
    guess: f64,
    r: f64,
    moved: f64,
    inertia: f64,
    free: f64,
    connection: &impl Connection,
) -> f64 {
    let (mut low, mut high, mut u) = (f64::NEG_INFINITY, f64::INFINITY, guess);
    for _ in 0..TRIALS {
        let (force, stiffness) = connection.pull(moved - r * u);
        let lacks = free + force - inertia * u;
        let slope = inertia + r * stiffness;
        if slope <= 0.0 {
            // Nothing holds it anywhere.
            return u;
        }
        if lacks > 0.0 {
            low = u;
        } else {
            high = u;
        }
        let newton = u + lacks / slope;
        let inside = newton >= low && newton <= high;
        let next = if inside { newton } else { f64::midpoint(low, high) };
        let settled = (next - u).abs() <= 4.0 * f64::EPSILON * next.abs();
        u = next;
        if settled {
            break;
        }
    }
    u
}
