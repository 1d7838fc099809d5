//! A periodogram with a smoothed background, and the lines that stand above it.
//!
//! Pieces are tapered (Hann) and their periodograms averaged. The background at a frequency is the
//! median of the neighbouring bins, which a line does not move, divided by the median of an
//! exponential variable. A bin of noise over its background then follows an F distribution with 2 and
//! `2 M` degrees of freedom: `P(ratio > x) = (1 + x / M)^-M`, where `M` says how well the median is
//! known. That is so however many pieces were averaged: pieces that repeat the same motion repeat the
//! same residual and average nothing out. Over all bins `p = 1 - (1 - P)^bins`.

use std::f64::consts::{LN_2, PI};

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

/// Fewest and most neighbours to either side that the background is taken from.
const NEIGHBOURS: (usize, usize) = (8, 60);
/// Bins to either side that a tapered line reaches into.
const REACH: usize = 3;
/// Neighbouring bins of a tapered periodogram are correlated: this many count as one.
const CORRELATED: f64 = 1.5;
/// Stretches of a piece in which a line must be found with the same phase, two to a length.
const STRETCHES: usize = 8;
/// Share `|sum z|² / (n sum |z|²)` of their amplitudes that must remain: a line throughout has nearly 1,
/// one in a third of the piece a third, a burst in one stretch `1 / n`.
const THROUGHOUT: f64 = 0.2;
/// Shortest piece.
const LEAST: usize = 64;
/// Samples over which a sine is turned on from the first of them.
const TURNED: usize = 256;

/// Averaged periodogram of pieces, bin `k` at the frequency `k * step`.
pub struct Periodogram {
    /// Distance of the bins, in periods per unit of the abscissa.
    pub step: f64,
    power: Vec<f64>,
    background: Vec<f64>,
    /// How well the background is known, bin by bin.
    certainty: Vec<f64>,
    length: usize,
    pieces: Vec<Vec<f64>>,
}

/// A bin that stands above the background.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Frequency, interpolated between bins.
    pub frequency: f64,
    /// Amplitude of the line.
    pub amplitude: f64,
    /// Chance of such a bin anywhere in a spectrum without lines.
    pub p_value: f64,
}

impl Periodogram {
    /// The periodogram of `pieces`, sampled every `interval`. Pieces shorter than half of the longest
    /// are left out. Nothing where they are too short.
    pub fn new(pieces: &[Vec<f64>], interval: f64) -> Option<Self> {
        let length = pieces.iter().map(Vec::len).max()?;
        if length < LEAST || interval.is_nan() || interval <= 0.0 {
            return None;
        }
        let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
        let mut power = vec![0.0; length / 2 + 1];
        let mut used = 0.0;
        for piece in pieces.iter().filter(|piece| 2 * piece.len() >= length) {
            let mean = piece.iter().sum::<f64>() / piece.len() as f64;
            let mut tapered = vec![0.0; length];
            let mut energy = 0.0;
            for (k, value) in piece.iter().enumerate() {
                let taper = 0.5 - 0.5 * (2.0 * PI * (k as f64 + 0.5) / piece.len() as f64).cos();
                tapered[k] = taper * (value - mean);
                energy += taper * taper;
            }
            let mut bins = transform.make_output_vec();
            transform.process(&mut tapered, &mut bins).ok()?;
            power.iter_mut().zip(&bins).for_each(|(sum, bin)| *sum += bin.norm_sqr() / energy);
            used += 1.0;
        }
        for value in &mut power {
            *value /= used;
        }
        let step = 1.0 / (length as f64 * interval);
        let (background, certainty) = (0..power.len()).map(|k| background(&power, k)).unzip();
        Some(Self { step, power, background, certainty, length, pieces: pieces.to_vec() })
    }

    /// Bins that are looked at: not the lowest, which have no neighbours below, nor the last.
    fn bins(&self) -> std::ops::Range<usize> {
        REACH..self.power.len().saturating_sub(1)
    }

    /// Peaks with at most this p-value over all bins, most significant first. Each is looked at closely only when it is
    /// asked for: a long recording has thousands.
    pub fn peaks(&self, alpha: f64) -> impl Iterator<Item = Peak> {
        let mut peaks: Vec<(usize, Peak)> = self
            .bins()
            .filter(|&k| self.is_highest(k))
            .map(|k| (k, self.peak(k)))
            .filter(|(_, peak)| peak.p_value <= alpha)
            .collect();
        peaks.sort_by(|a, b| {
            let height = |k: usize| self.power[k] / self.background[k];
            a.1.p_value.total_cmp(&b.1.p_value).then(height(b.0).total_cmp(&height(a.0)))
        });
        let throughout = |(k, peak): &(usize, Peak)| self.is_throughout(*k, peak.frequency);
        peaks.into_iter().filter(throughout).map(|(_, peak)| peak)
    }

    fn is_highest(&self, k: usize) -> bool {
        let around = k.saturating_sub(REACH)..(k + REACH + 1).min(self.power.len());
        self.background[k] > 0.0 && around.into_iter().all(|j| self.power[j] <= self.power[k])
    }

    /// Whether a line has the same phase in enough of the stretches of its pieces. The lowest bins have
    /// too few periods in a stretch to tell.
    fn is_throughout(&self, k: usize, frequency: f64) -> bool {
        if k < 2 * STRETCHES {
            return true;
        }
        let turn = 2.0 * PI * frequency / (self.step * self.length as f64);
        let (mut together, mut apart) = (0.0, 0.0);
        for piece in self.pieces.iter().filter(|piece| 2 * piece.len() >= self.length) {
            let length = piece.len() / STRETCHES;
            let starts = (0..=piece.len() - length).step_by((length / 2).max(1));
            let count = starts.clone().count() as f64;
            let (mut sum, mut squares) = ((0.0, 0.0), 0.0);
            for start in starts {
                let z = tapered_amplitude(&piece[start..start + length], start, turn);
                sum = (sum.0 + z.0, sum.1 + z.1);
                squares += z.0 * z.0 + z.1 * z.1;
            }
            together += sum.0 * sum.0 + sum.1 * sum.1;
            apart += count * squares;
        }
        together >= THROUGHOUT * apart
    }

    fn peak(&self, k: usize) -> Peak {
        let ratio = self.power[k] / self.background[k];
        let certainty = self.certainty[k];
        let single = -certainty * (ratio / certainty).ln_1p();
        // 1 - (1 - P)^bins without losing small values.
        let p_value = -(self.bins().len() as f64 * (-single.exp()).ln_1p()).exp_m1();
        // Ratio of neighbouring amplitudes of a Hann-tapered line between two bins.
        let amplitude = |j: usize| self.power[j].sqrt();
        let up = amplitude(k + 1) >= amplitude(k - 1);
        let beside = amplitude(if up { k + 1 } else { k - 1 }) / amplitude(k);
        let off = ((2.0 * beside - 1.0) / (beside + 1.0)).clamp(0.0, 0.5);
        let at = k as f64 + if up { off } else { -off };
        let above = (self.power[k] - self.background[k]).max(0.0);
        let frequency = at * self.step;
        Peak { frequency, amplitude: self.amplitude(above) / lobe(off), p_value }
    }

    /// Amplitude of a sine that gives a bin this power.
    fn amplitude(&self, power: f64) -> f64 {
        // Sum of squares of a Hann taper over the square of its sum: 1.5 / length.
        (4.0 * power * 1.5 / self.length as f64).sqrt()
    }

    /// Frequency, amplitude, and the amplitude from which a bin would be called a line, bin by bin.
    pub fn curves(&self, alpha: f64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let single = -((-alpha).ln_1p() / self.bins().len() as f64).exp_m1();
        let needed = |k: usize| {
            let certainty = self.certainty[k];
            certainty * ((-single.ln() / certainty).exp() - 1.0) * self.background[k]
        };
        let frequency = self.bins().map(|k| k as f64 * self.step).collect();
        let found = self.bins().map(|k| self.amplitude(self.power[k])).collect();
        (frequency, found, self.bins().map(|k| self.amplitude(needed(k))).collect())
    }
}

/// Complex amplitude of a stretch that begins at sample `start`, by `turn` per sample.
fn tapered_amplitude(stretch: &[f64], start: usize, turn: f64) -> (f64, f64) {
    let count = stretch.len() as f64;
    let mean = stretch.iter().sum::<f64>() / count.max(1.0);
    let mut sum = Complex::new(0.0, 0.0);
    for (first, chunk) in stretch.chunks(TURNED).enumerate() {
        let first = first * TURNED;
        // Turned on from the first sample of a chunk: no sine for each sample, and errors do not add up.
        let (mut wave, mut taper) = (
            Complex::cis(turn * (start + first) as f64),
            Complex::cis(2.0 * PI * (first as f64 + 0.5) / count),
        );
        let (on, along) = (Complex::cis(turn), Complex::cis(2.0 * PI / count));
        for value in chunk {
            sum += wave * ((0.5 - 0.5 * taper.re) * (value - mean));
            (wave, taper) = (wave * on, taper * along);
        }
    }
    (sum.re, sum.im)
}

/// Height of a Hann-tapered line this far from a bin, of 1 on it.
fn lobe(off: f64) -> f64 {
    if off.abs() < 1e-6 {
        return 1.0;
    }
    (PI * off).sin() / (PI * off) / (1.0 - off * off)
}

/// Background at a bin, and how well it is known.
fn background(power: &[f64], k: usize) -> (f64, f64) {
    // Narrower towards low frequencies, where spectra of motions are steep.
    let width = (k / 2).clamp(NEIGHBOURS.0, NEIGHBOURS.1);
    let from = k.saturating_sub(width + REACH).max(1);
    let to = (k + width + REACH + 1).min(power.len());
    let mut around: Vec<f64> =
        (from..to).filter(|j| j.abs_diff(k) > REACH).map(|j| power[j]).collect();
    if around.is_empty() {
        return (0.0, 2.0);
    }
    let middle = around.len() / 2;
    let median = *around.select_nth_unstable_by(middle, f64::total_cmp).1;
    // The median of m exponential variables has a relative variance of 1 / (m ln² 2).
    let certainty = (around.len() as f64 * LN_2 * LN_2 / CORRELATED).max(2.0);
    (median / LN_2, certainty)
}
