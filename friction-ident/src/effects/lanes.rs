//! Structure of arrays: one lane is one plant, or one sample of a measured motion.
//!
//! Every hook of an effect works on a whole slice of lanes, so that choosing effects at run time
//! costs one call per effect and step for all plants together, and the loops vectorise.

/// Parameters of one effect: for each of them one value per lane.
#[derive(Clone, Copy, Debug)]
pub struct Parameters<'a> {
    values: &'a [f64],
    lanes: usize,
}

impl<'a> Parameters<'a> {
    /// `values[k * lanes + i]` is parameter `k` in lane `i`.
    pub fn new(values: &'a [f64], lanes: usize) -> Self {
        Self { values, lanes }
    }

    /// Parameter `k`, one value per lane.
    #[inline]
    pub fn get(&self, k: usize) -> &'a [f64] {
        &self.values[k * self.lanes..(k + 1) * self.lanes]
    }

    /// Number of parameters.
    pub fn parameters(&self) -> usize {
        self.values.len() / self.lanes.max(1)
    }

    /// Number of lanes.
    #[inline]
    pub fn lanes(&self) -> usize {
        self.lanes
    }
}

/// `values` repeated over `lanes` lanes, as [`Parameters::new`] wants them.
pub fn broadcast(values: &[f64], lanes: usize) -> Vec<f64> {
    values.iter().flat_map(|&value| std::iter::repeat_n(value, lanes)).collect()
}

/// Where the plant is, lane by lane.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// Time, s.
    pub time: &'a [f64],
    /// Position, m or rad.
    pub position: &'a [f64],
    /// Velocity, m/s or rad/s.
    pub velocity: &'a [f64],
    /// Acceleration, m/s^2 or rad/s^2; in a simulation its mean over the last step.
    pub acceleration: &'a [f64],
    /// Direction of sliding, or of the sliding that impends at rest: -1 or 1 (0 where none does).
    pub direction: &'a [f64],
    /// The velocity that the friction level follows: `velocity`, unless an effect remembers.
    pub level_velocity: &'a [f64],
    /// Time at rest so far, s; while sliding the length of the last rest.
    pub dwell: &'a [f64],
    /// How much of the static hump has formed, 0..1; 1 unless an effect lets it grow with dwell.
    pub bond: &'a [f64],
    /// Force of the drive on the mass, N or N m.
    pub drive_force: &'a [f64],
}

/// Forces that resist the motion, with their slope against velocity.
///
/// The simulator takes the slope implicitly, which keeps strong damping stable at any step. It may
/// be left at 0 where it is small or negative.
#[derive(Debug)]
pub struct Smooth<'a> {
    /// To be added to: resisting force, N or N m.
    pub force: &'a mut [f64],
    /// To be added to: its slope against velocity where that is positive, from rest or at the velocity.
    pub damping: &'a mut [f64],
}
