//! From command to force: what the drive does in between.

use std::collections::VecDeque;

/// Delay, limit and lag, in this order.
#[derive(Clone, Debug)]
pub struct Drive {
    /// Commands on their way, one per step of the integrator.
    coming: VecDeque<f64>,
    limit: f64,
    lag: f64,
    second_order: bool,
    middle: f64,
    force: f64,
}

impl Drive {
    /// A drive that follows at once and gives any force.
    pub fn ideal() -> Self {
        Self {
            coming: VecDeque::new(),
            limit: f64::INFINITY,
            lag: 0.0,
            second_order: false,
            middle: 0.0,
            force: 0.0,
        }
    }

    /// With a delay of so many steps.
    #[must_use]
    pub fn delayed(mut self, steps: usize) -> Self {
        self.coming = VecDeque::from(vec![0.0; steps]);
        self
    }

    /// With a largest force.
    #[must_use]
    pub fn limited(mut self, limit: f64) -> Self {
        self.limit = limit;
        self
    }

    /// With a time constant, s; of second order it is that of two equal lags in a row.
    #[must_use]
    pub fn lagging(mut self, lag: f64, second_order: bool) -> Self {
        (self.lag, self.second_order) = (lag, second_order);
        self
    }

    /// Force in the step after `command`.
    pub fn follow(&mut self, command: f64, h: f64) -> f64 {
        self.coming.push_back(command);
        let arrived = self.coming.pop_front().unwrap_or(command).clamp(-self.limit, self.limit);
        if self.lag <= 0.0 {
            self.force = arrived;
            return arrived;
        }
        let left = (-h / self.lag).exp();
        self.middle = arrived + (self.middle - arrived) * left;
        let towards = if self.second_order { self.middle } else { arrived };
        self.force = towards + (self.force - towards) * left;
        self.force
    }

    /// The force it gives now.
    pub fn force(&self) -> f64 {
        self.force
    }
}
