//! Low-pass filters without phase shift: a Butterworth filter of order 4, run forwards and backwards,
//! for whole signals, and a symmetric kernel for single points of one.
//!
//! A causal filter delays position against force and biases viscous friction by -18 % and Coulomb
//! friction by +14 % on real data; run in both directions it delays nothing.

use std::f64::consts::PI;

use missing_physics::statistics::basis::dot;

/// Second-order sections of the filter.
const SECTIONS: usize = 2;
/// Samples by which a signal is extended (point-symmetric at its ends), in periods of the cut-off.
const EXTENSION: f64 = 3.0;

/// A low-pass filter for uniformly sampled signals. Amplitude 1/2 at the cut-off frequency.
#[derive(Clone, Debug)]
pub struct LowPass {
    /// `b0, b1, b2, a1, a2` of each section.
    sections: [[f64; 5]; SECTIONS],
    extension: usize,
}

impl LowPass {
    /// A filter with this cut-off as a share of the sampling frequency; it is kept below 0.49.
    pub fn new(cutoff: f64) -> Self {
        let cutoff = cutoff.clamp(1e-6, 0.49);
        // Bilinear transformation with the frequency prewarped.
        let k = (PI * cutoff).tan();
        let sections = std::array::from_fn(|i| {
            // Poles of the analogue prototype at angles pi (2 i + 1) / 8 from the imaginary axis.
            let damping = 2.0 * (PI * (2 * i + 1) as f64 / (4 * SECTIONS) as f64).sin();
            let norm = 1.0 / (1.0 + damping * k + k * k);
            let b0 = k * k * norm;
            let a1 = 2.0 * (k * k - 1.0) * norm;
            let a2 = (1.0 - damping * k + k * k) * norm;
            [b0, 2.0 * b0, b0, a1, a2]
        });
        Self { sections, extension: (EXTENSION / cutoff).ceil() as usize }
    }

    /// The filtered signal.
    pub fn run(&self, signal: &[f64]) -> Vec<f64> {
        let n = signal.len();
        if n < 2 {
            return signal.to_vec();
        }
        let reach = self.extension.min(n - 1);
        let (first, last) = (signal[0], signal[n - 1]);
        let mut extended = Vec::with_capacity(n + 2 * reach);
        extended.extend((1..=reach).rev().map(|k| 2.0 * first - signal[k]));
        extended.extend_from_slice(signal);
        extended.extend((1..=reach).map(|k| 2.0 * last - signal[n - 1 - k]));
        self.pass(extended.iter_mut());
        self.pass(extended.iter_mut().rev());
        extended[reach..reach + n].to_vec()
    }

    /// One direction, started in the steady state of the first value.
    fn pass<'a>(&self, mut signal: impl Iterator<Item = &'a mut f64>) {
        let Some(first) = signal.next() else { return };
        let mut state = self.sections.map(|section| steady(section, *first));
        *first = self.step(&mut state, *first);
        for value in signal {
            *value = self.step(&mut state, *value);
        }
    }

    #[inline]
    fn step(&self, state: &mut [[f64; 2]; SECTIONS], input: f64) -> f64 {
        let mut value = input;
        for ([b0, b1, b2, a1, a2], z) in self.sections.iter().zip(state) {
            let out = b0 * value + z[0];
            z[0] = b1 * value - a1 * out + z[1];
            z[1] = b2 * value - a2 * out;
            value = out;
        }
        value
    }
}

/// State of a section (transposed direct form II, gain 1) after a long time at `value`.
fn steady([b0, _, b2, _, a2]: [f64; 5], value: f64) -> [f64; 2] {
    [(1.0 - b0) * value, (b2 - a2) * value]
}

/// A symmetric low-pass kernel: a sinc under a Hann window, two periods of the cut-off to either side.
/// Where only every tenth value of the filtered signal is needed it is several times cheaper than the
/// recursive filter.
#[derive(Clone, Debug)]
pub struct Kernel {
    weights: Vec<f64>,
}

impl Kernel {
    /// A kernel with this cut-off (amplitude 1/2) as a share of the sampling frequency.
    pub fn new(cutoff: f64) -> Self {
        let reach = Self::reach_of(cutoff) as i32;
        let raw: Vec<f64> = (-reach..=reach)
            .map(|k| {
                let x = f64::from(k) * cutoff * 2.0 * PI;
                let sinc = if k == 0 { 1.0 } else { x.sin() / x };
                let part = f64::from(k) / f64::from(reach + 1);
                sinc * (0.5 + 0.5 * (PI * part).cos())
            })
            .collect();
        let sum: f64 = raw.iter().sum();
        Self { weights: raw.iter().map(|weight| weight / sum).collect() }
    }

    /// Autocorrelation of white noise behind it at every `stride`-th sample, from lag `stride` on.
    pub fn colour(&self, stride: usize) -> Vec<f64> {
        let square = dot(&self.weights, &self.weights);
        (stride..self.weights.len())
            .step_by(stride)
            .map(|lag| {
                dot(&self.weights[lag..], &self.weights[..self.weights.len() - lag]) / square
            })
            .collect()
    }

    /// Samples that it needs to either side.
    pub fn reach_of(cutoff: f64) -> usize {
        (2.0 / cutoff).ceil() as usize
    }

    /// The filtered signal at `index`, which must be `reach` away from both ends.
    pub fn at(&self, signal: &[f64], index: usize) -> f64 {
        let reach = self.weights.len() / 2;
        dot(&self.weights, &signal[index - reach..=index + reach])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernel_passes_low_frequencies_halves_the_cut_off_and_stops_high_ones() {
        let kernel = Kernel::new(0.05);
        let gain = |frequency: f64| {
            let wave: Vec<f64> =
                (0..201).map(|k| (2.0 * PI * frequency * f64::from(k - 100)).cos()).collect();
            kernel.at(&wave, 100)
        };
        assert!((gain(0.0) - 1.0).abs() < 1e-12);
        assert!((gain(0.02) - 1.0).abs() < 0.01);
        assert!((gain(0.05) - 0.5).abs() < 0.01);
        assert!(gain(0.1).abs() < 0.01 && gain(0.3).abs() < 0.01);
    }

    #[test]
    fn white_noise_behind_the_kernel_has_the_colour_of_a_sinc() {
        // A sharp low-pass at f gives sin(2 pi f k) / (2 pi f k); the taper makes it a little shorter.
        let colour = Kernel::new(0.05).colour(8);
        assert!((colour[0] - 0.234).abs() < 0.1 && (colour[1] + 0.189).abs() < 0.08, "{colour:?}");
        assert!(colour.iter().all(|rho| rho.abs() < 1.0));
    }

    #[test]
    fn it_agrees_with_scipy() {
        // scipy.signal.sosfiltfilt(butter(4, 0.08, output="sos"), x, padlen=59), SciPy 1.17.
        let x: Vec<f64> =
            (0..60).map(|k| (0.3 * f64::from(k)) % 1.0 + if k > 20 { 1.0 } else { 0.0 }).collect();
        let y = LowPass::new(0.04).run(&x);
        for (k, expected) in SCIPY {
            assert!((y[k] - expected).abs() < 1e-9, "{k}: {} {expected}", y[k]);
        }
    }

    const SCIPY: [(usize, f64); 5] = [
        (0, 0.000_054_287_421),
        (10, 0.435_194_113_187),
        (20, 0.913_050_046_277),
        (30, 1.488_593_151_081),
        (59, 1.699_779_834_190),
    ];

    #[test]
    fn a_straight_line_passes_unchanged() {
        let line: Vec<f64> = (0..400).map(|k| 3.0 - 0.01 * f64::from(k)).collect();
        let out = LowPass::new(0.05).run(&line);
        let inner = line.iter().zip(&out).skip(80).take(240);
        assert!(inner.into_iter().all(|(a, b)| (a - b).abs() < 1e-6));
    }

    #[test]
    fn a_sine_in_the_pass_band_is_neither_delayed_nor_damped() {
        let sine: Vec<f64> = (0..2000).map(|k| (0.02 * f64::from(k)).sin()).collect();
        let out = LowPass::new(0.04).run(&sine);
        let inner = sine.iter().zip(&out).skip(200).take(1600);
        let worst = inner.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-3, "{worst}");
    }
}
