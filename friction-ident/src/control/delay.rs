//! A delay line of samples, reckoned in samples so that an exported controller repeats it to the bit.

/// The value of a signal `delay` samples ago, linear between samples; 0 before the first one.
#[derive(Clone, Debug, PartialEq)]
pub struct Delay {
    /// The newest values, oldest first once the line is full.
    line: Vec<f64>,
    head: usize,
    fraction: f64,
}

/// Longest delay, samples.
const MOST: f64 = 1e7;

impl Delay {
    /// A line that reaches back over `samples` (0 to 10^7, need not be whole).
    pub fn new(samples: f64) -> Self {
        // What is no number is no delay.
        let samples = if samples.is_nan() { 0.0 } else { samples.clamp(0.0, MOST) };
        let whole = samples.floor();
        Self { line: vec![0.0; whole as usize + 2], head: 0, fraction: samples - whole }
    }

    /// Values that the line holds.
    pub fn length(&self) -> usize {
        self.line.len()
    }

    /// Part of a sample beyond the whole ones, 0..1.
    pub fn fraction(&self) -> f64 {
        self.fraction
    }

    /// Takes the newest value and gives the delayed one.
    pub fn pass(&mut self, value: f64) -> f64 {
        self.line[self.head] = value;
        self.head = (self.head + 1) % self.line.len();
        // The head is now at the oldest value, the one after it is a sample younger.
        let (oldest, younger) =
            (self.line[self.head], self.line[(self.head + 1) % self.line.len()]);
        younger + self.fraction * (oldest - younger)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_comes_back_late_by_the_delay() {
        for delay in [0.0, 0.4, 1.0, 5.0, 7.3] {
            let mut line = Delay::new(delay);
            for k in 0..50 {
                let late = line.pass(f64::from(k));
                if f64::from(k) >= delay + 1.0 {
                    assert!((late - (f64::from(k) - delay)).abs() < 1e-12, "{delay} {k}: {late}");
                }
            }
        }
    }

    #[test]
    fn before_the_first_sample_there_was_rest() {
        let mut line = Delay::new(3.0);
        let seen: Vec<f64> = (0..5).map(|_| line.pass(1.0)).collect();
        assert_eq!(seen, [0.0, 0.0, 0.0, 1.0, 1.0]);
    }
}
