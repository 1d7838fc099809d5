//! Sensors: what is shown of the position.

use super::Parameters;

/// What is shown of the position.
pub trait Sensor: Sync + Send {
    /// Replaces true positions, one per lane, by what the sensor shows.
    fn show(&self, p: Parameters<'_>, position: &mut [f64]);

    /// Takes the sensor's own error out of a motion that it showed, to first order in that error.
    fn correct(&self, p: &[f64], shown: &mut Shown<'_>);
}

/// A smoothed motion as a [`Sensor`] showed it; all slices are equally long.
#[derive(Debug)]
pub struct Shown<'a> {
    /// m or rad.
    pub position: &'a mut [f64],
    /// m/s or rad/s.
    pub velocity: &'a mut [f64],
    /// m/s^2 or rad/s^2.
    pub acceleration: &'a mut [f64],
    /// Frequency at which the smoother let half of an amplitude pass, Hz; infinite without one.
    pub cutoff: f64,
}
