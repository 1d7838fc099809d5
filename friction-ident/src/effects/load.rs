//! A second body with friction of its own, behind anything that pulls it along.

use crate::simd::sign;

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

/// What pulls the load along in a step, against how far the mass runs ahead of it in the step.
pub(super) trait Connection {
    /// Mean force on the load, which must not decrease.
    fn pull(&self, ahead: f64) -> Pull;

    /// Where `inertia` times what the mass runs ahead and the pull are `total` together; `inertia > 0`.
    fn run_ahead(&self, inertia: f64, total: f64) -> f64;
}

/// What a connection does over a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    /// Mean force on the load, and its slope.
    pub force: f64,
    pub slope: f64,
    /// Whether the connection is what it was taken for.
    pub holds: bool,
}

/// A step of the load.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pulled {
    /// Mean force on the mass, and its slope against the displacement of the mass.
    pub force: f64,
    pub slope: f64,
    /// Mean velocity of the load.
    pub mean: f64,
    /// Whether the connection was what it was taken for wherever it was asked.
    pub holds: bool,
}

impl Load {
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
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    pub(super) fn step(
        self,
        velocity: f64,
        r: f64,
        moved: f64,
        connection: &impl Connection,
    ) -> Pulled {
        let Self { mass, level, viscous } = self;
        let moves = r > 0.0;
        let rate = if moves { 1.0 / r } else { 1.0 };
        let inertia = 2.0 * mass * rate + viscous;
        let momentum = 2.0 * mass * velocity * rate;
        let (s, half) = (if velocity < 0.0 { -1.0 } else { 1.0 }, 0.5 * velocity);
        // What friction would have to take for the load to stop at the end of the step, and to stay at rest.
        let stopping = connection.pull(moved - r * half);
        let resting = connection.pull(moved);
        let stop = s * (momentum + stopping.force - inertia * half);
        let turn = s * (momentum + resting.force);
        let stops = level > 0.0 && stop >= 0.0 && stop <= level;
        let rests = level > 0.0 && stop < 0.0 && turn < 0.0 && turn >= -level;
        let back = if stop < 0.0 && turn < -level { -s * level } else { 0.0 };
        let friction = if stop > level { s * level } else { back };
        let free = momentum - friction;
        // A load of nothing that nothing holds goes along.
        let per_way = (inertia * rate).max(f64::MIN_POSITIVE);
        let ahead = connection.run_ahead(per_way, per_way * moved - free);
        let sliding = connection.pull(ahead);
        let yielding = sliding.slope * per_way / (per_way + sliding.slope);
        let pulled = if stops { stopping.force } else { sliding.force };
        let slope = if stops { stopping.slope } else { yielding };
        let mean = if stops { half } else { (moved - ahead) * rate };
        let pulled = if rests { resting.force } else { pulled };
        let slope = if rests { resting.slope } else { slope };
        let mean = if rests { 0.0 } else { mean };
        Pulled {
            force: if moves { pulled } else { resting.force },
            slope: if moves { slope } else { 0.0 },
            mean: if moves { mean } else { velocity },
            holds: !moves || stopping.holds && resting.holds && sliding.holds,
        }
    }
}
