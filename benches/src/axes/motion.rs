//! Motions as machines make them.

use std::f64::consts::TAU;

use super::random::Stream;

/// A wanted position, sample after sample.
#[derive(Clone, Debug)]
pub struct Path {
    interval: f64,
    positions: Vec<f64>,
}

impl Path {
    /// Begins at 0.
    pub fn new(interval: f64) -> Self {
        Self { interval, positions: vec![0.0] }
    }

    /// All positions.
    pub fn into_positions(self) -> Vec<f64> {
        self.positions
    }

    fn here(&self) -> f64 {
        self.positions.last().copied().unwrap_or(0.0)
    }

    fn shape(&mut self, time: f64, place: impl Fn(f64) -> f64) -> &mut Self {
        let start = self.here();
        for k in 1..=(time / self.interval).round() as usize {
            self.positions.push(start + place(k as f64 * self.interval));
        }
        self
    }

    /// Stays.
    pub fn dwell(&mut self, time: f64) -> &mut Self {
        self.shape(time, |_| 0.0)
    }

    /// At constant speed, begun and ended at once.
    pub fn ramp(&mut self, way: f64, speed: f64) -> &mut Self {
        self.shape(way.abs() / speed, |t| speed.copysign(way) * t)
    }

    /// With limited speed and acceleration.
    pub fn trapezoid(&mut self, way: f64, speed: f64, acceleration: f64) -> &mut Self {
        let speed = speed.min((way.abs() * acceleration).sqrt());
        let rise = speed / acceleration;
        let end = way.abs() / speed + rise;
        self.shape(end, |t| {
            let (up, down) = (t.min(rise), (t - (end - rise)).max(0.0));
            let gone = 0.5 * acceleration * up * up + speed * (t - rise).max(0.0)
                - 0.5 * acceleration * down * down;
            gone.copysign(way)
        })
    }

    /// A polynomial of fifth order with this largest speed: velocity and acceleration vanish at its ends.
    pub fn quintic(&mut self, way: f64, speed: f64) -> &mut Self {
        let end = 1.875 * way.abs() / speed;
        self.shape(end, |t| {
            let s = (t / end).min(1.0);
            way * s * s * s * (10.0 + s * (6.0 * s - 15.0))
        })
    }

    /// A sine whose frequency grows evenly from `low` to `high` Hz, its amplitude falling inversely; back
    /// to its start at the end.
    pub fn chirp(&mut self, amplitude: f64, low: f64, high: f64, time: f64) -> &mut Self {
        self.shape(time, |t| {
            let frequency = low + (high - low) * t / time;
            let phase = TAU * (low * t + 0.5 * (high - low) * t * t / time);
            amplitude * low / frequency * phase.sin() * edge(t, time)
        })
    }

    /// Sines of (amplitude, Hz, phase).
    pub fn sines(&mut self, parts: &[(f64, f64, f64)], time: f64) -> &mut Self {
        self.shape(time, |t| {
            let sum: f64 = parts.iter().map(|(a, f, phase)| a * (TAU * f * t + phase).sin()).sum();
            sum * edge(t, time)
        })
    }
}

/// Rises from 0 to 1 and falls again within half a second at either end.
fn edge(t: f64, time: f64) -> f64 {
    let rise = |t: f64| (t / 0.5).clamp(0.0, 1.0);
    let s = rise(t).min(rise(time - t));
    s * s * (3.0 - 2.0 * s)
}

/// A table: ramps with reversals and rests, trapezoids, a chirp, three sines.
pub fn table(interval: f64, random: &mut Stream) -> Vec<f64> {
    let mut path = Path::new(interval);
    let f = random.between(0.85, 1.15);
    path.dwell(0.3);
    for (way, speed, rest) in
        [(1.5e-3, 1e-3, 0.1), (6e-4, 5e-4, 0.5), (1e-4, 1e-4, 1.5), (3e-3, 4e-3, 0.05)]
    {
        path.ramp(way, speed * f).dwell(rest).ramp(-way, speed * f).dwell(0.5 * rest);
    }
    let stroke = random.between(0.022, 0.03);
    path.trapezoid(stroke, 0.03 * f, 0.3).dwell(0.2);
    for (speed, acceleration) in [(0.05, 0.5), (0.1, 1.5), (0.02, 0.4)] {
        path.trapezoid(-2.0 * stroke, speed * f, acceleration)
            .dwell(random.between(0.02, 0.4))
            .trapezoid(2.0 * stroke, speed * f, acceleration);
    }
    path.trapezoid(-stroke, 0.05, 0.5).dwell(0.3);
    path.chirp(0.02, 0.4, random.between(5.0, 8.0), 6.0).dwell(0.2);
    let mut sine = |amplitude: f64, frequency: f64| {
        (amplitude, frequency * random.between(0.9, 1.1), random.between(0.0, TAU))
    };
    let sines = [sine(0.012, 0.35), sine(0.005, 1.1), sine(0.0015, 2.9)];
    path.sines(&sines, 6.0);
    path.into_positions()
}

/// A joint of a robot at work, to `speed` rad/s: quintic moves with rests, then several sines.
pub fn joint(interval: f64, speed: f64, random: &mut Stream) -> Vec<f64> {
    let mut path = Path::new(interval);
    path.dwell(0.2);
    for part in [0.4, 1.0, 0.15, 0.7, 0.3] {
        let (way, speed) = (random.between(0.5, 1.0) * (0.3 + 0.7 * part), part * speed);
        let side = random.sign();
        path.quintic(side * way, speed).dwell(random.between(0.05, 0.5));
        path.quintic(-0.4 * side * way, speed).dwell(random.between(0.0, 0.1));
        path.quintic(-0.6 * side * way, speed).dwell(random.between(0.05, 0.3));
    }
    let mut sine = |part: f64, frequency: f64| {
        let frequency = frequency * random.between(0.9, 1.1);
        (part * speed / (TAU * frequency), frequency, random.between(0.0, TAU))
    };
    let sines = [sine(0.4, 0.15), sine(0.25, 0.4), sine(0.15, 0.9), sine(0.1, 1.9)];
    path.sines(&sines, 8.0);
    path.into_positions()
}

/// A spindle with positioning moves up to 0.3 m/s and interpolated contours.
pub fn spindle(interval: f64, random: &mut Stream) -> Vec<f64> {
    let mut path = Path::new(interval);
    let stroke = random.between(0.2, 0.32);
    path.dwell(0.2);
    for (part, speed) in [(1.0, 0.3), (0.5, 0.1), (0.08, 0.02), (0.9, 0.2), (0.015, 5e-3)] {
        let (way, speed) = (part * stroke, speed * random.between(0.9, 1.0));
        path.trapezoid(way, speed, 2.0).dwell(random.between(0.05, 0.2));
        path.quintic(-way, speed).dwell(random.between(0.05, 0.2));
    }
    let sines = [(0.02, random.between(0.4, 0.6), 0.0), (0.002, random.between(2.0, 3.0), 1.0)];
    path.sines(&sines, 4.0);
    path.into_positions()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moves_end_where_they_should() {
        let mut path = Path::new(1e-3);
        path.trapezoid(0.1, 0.2, 2.0).quintic(-0.05, 0.1).ramp(-0.02, 0.01);
        assert!((path.here() - 0.03).abs() < 2e-5, "{}", path.here());
        path.sines(&[(0.1, 1.0, 0.3)], 3.0).chirp(0.1, 0.5, 5.0, 4.0);
        assert!((path.here() - 0.03).abs() < 2e-5);
    }
}
