//! Stick or slip, as the paper's compensator tells them from the measured velocity.

/// The state logic of the paper: stick while `|v| <= V_cr`; the dwell time grows in stick, is kept
/// while slipping and begins anew with the next stick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionState {
    critical_velocity: f64,
    sample_time: f64,
    slips: bool,
    dwell: f64,
}

impl MotionState {
    /// At rest, with `critical_velocity` (m/s or rad/s) and `sample_time` (s).
    pub fn new(critical_velocity: f64, sample_time: f64) -> Self {
        Self { critical_velocity, sample_time, slips: false, dwell: 0.0 }
    }

    /// Takes the next measured velocity, m/s or rad/s.
    pub fn see(&mut self, velocity: f64) {
        let slips = velocity.abs() > self.critical_velocity;
        match (self.slips, slips) {
            (false, false) => self.dwell += self.sample_time,
            (true, false) => self.dwell = 0.0,
            (_, true) => {}
        }
        self.slips = slips;
    }

    /// Whether the axis slips.
    pub fn slips(&self) -> bool {
        self.slips
    }

    /// Dwell time `t2`, s: of this rest, or while slipping of the last one.
    pub fn dwell(&self) -> f64 {
        self.dwell
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dwell_grows_in_stick_stays_in_slip_and_begins_anew() {
        let mut state = MotionState::new(6e-4, 5e-3);
        let mut seen = Vec::new();
        for velocity in [0.0, 6e-4, 7e-4, -1e-3, 1e-4, 0.0] {
            state.see(velocity);
            seen.push((state.slips(), (state.dwell() * 1e3).round()));
        }
        let stick = |ms| (false, ms);
        assert_eq!(
            seen,
            [stick(5.0), stick(10.0), (true, 10.0), (true, 10.0), stick(0.0), stick(5.0)]
        );
    }
}
