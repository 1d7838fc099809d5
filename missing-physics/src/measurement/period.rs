//! After how many samples a signal repeats itself.
//!
//! Looked for is the shortest lag by which a signal differs little from itself (the difference function of the
//! pitch detector YIN, A. de Cheveigné and H. Kawahara, 2002), on ever longer stretches from the middle in ever coarser
//! steps. What a stretch shows is found again on the whole signal, sample by sample, so that time grows with its length.

/// Steps of a stretch.
const STRETCH: usize = 4096;
/// Finer steps in a coarser one.
const COARSER: usize = 4;
/// What differs from cycle to cycle, as a share of the signal's own deviation: in coarse steps, and sample by sample.
const NEAR: f64 = 0.1;
const MATCH: f64 = 0.02;
/// A signal that is this much like itself again within so few samples has too few of them to tell one cycle from several.
const ALIKE: f64 = 0.7;
const FEWEST: usize = 32;
/// Most lags of a stretch that are tried on the whole signal.
const TRIED: usize = 20;
/// How far from where coarser steps show it a lag is looked for.
const AROUND: usize = 3;
/// A lag is known to about this share of a sample.
const KNOWN: f64 = 0.05;

/// Number of samples after which a signal repeats itself, at least twice: that of one cycle, not of several. Nothing
/// where it does not, or where a cycle has fewer than 32 samples.
pub fn period(values: &[f64]) -> Option<f64> {
    let spread = deviation(values);
    let mut coarser: Vec<Vec<f64>> = Vec::new();
    loop {
        let whole = coarser.last().map_or(values, Vec::as_slice);
        let minima = minima(middle(whole), spread);
        let too_few = |minimum: &Minimum| minimum.lag < FEWEST as f64;
        if coarser.is_empty() && minima.first().is_some_and(too_few) {
            return None;
        }
        let near = minima.iter().filter(|minimum| minimum.is_within(NEAR * spread)).take(TRIED);
        let levels: Vec<&[f64]> =
            std::iter::once(values).chain(coarser.iter().map(Vec::as_slice)).collect();
        if let Some(found) = near.into_iter().find_map(|near| on_all(&levels, near.lag, spread)) {
            return Some(found);
        }
        if whole.len() <= STRETCH {
            return None;
        }
        let mean = |step: &[f64]| step.iter().sum::<f64>() / COARSER as f64;
        coarser.push(whole.chunks_exact(COARSER).map(mean).collect());
    }
}

/// Root mean square of `x(k + lag) - x(k)`.
pub(super) fn difference(values: &[f64], lag: usize) -> f64 {
    square(values, lag).sqrt()
}

fn square(values: &[f64], lag: usize) -> f64 {
    let pairs = values.iter().zip(values.get(lag..).unwrap_or_default());
    let squares: f64 = pairs.map(|(a, b)| (b - a).powi(2)).sum();
    squares / values.len().saturating_sub(lag).max(1) as f64
}

fn deviation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / values.len().max(1) as f64).sqrt()
}

fn middle(values: &[f64]) -> &[f64] {
    let length = values.len().min(STRETCH);
    let first = (values.len() - length) / 2;
    &values[first..first + length]
}

/// A lag by which a signal differs less from itself than by those beside it.
struct Minimum {
    /// Between the steps, too.
    lag: f64,
    /// Mean square of what differs.
    square: f64,
}

impl Minimum {
    /// Of a parabola through the squares at a lag and those beside it: a cycle need not be whole steps long.
    fn around(lag: usize, [before, here, after]: [f64; 3]) -> Self {
        let curvature = before - 2.0 * here + after;
        let off = if curvature > 0.0 { (before - after) / (2.0 * curvature) } else { 0.0 };
        let off = off.clamp(-0.5, 0.5);
        Self { lag: lag as f64 + off, square: here - 0.25 * (before - after) * off }
    }

    fn is_within(&self, difference: f64) -> bool {
        self.square < difference * difference
    }
}

/// Where a stretch is much like itself again after it has become unlike itself, the shortest lag first: a smooth signal
/// is always like itself a few samples later.
fn minima(stretch: &[f64], spread: f64) -> Vec<Minimum> {
    let squares: Vec<f64> = (0..=stretch.len() / 2 + 1).map(|lag| square(stretch, lag)).collect();
    let unlike = squares.iter().position(|square| *square > spread * spread);
    let unlike = unlike.unwrap_or(squares.len());
    let around = squares.windows(3).enumerate().skip(unlike);
    let lowest = around.filter(|(_, s)| s[1] <= s[0] && s[1] <= s[2]);
    let minima = lowest.map(|(before, s)| Minimum::around(before + 1, [s[0], s[1], s[2]]));
    minima.filter(|minimum| minimum.is_within(ALIKE * spread)).collect()
}

/// The lag that is `near` one in the last of `levels`, where the whole signal repeats itself by it. Each level has
/// steps that are means of those before it.
fn on_all(levels: &[&[f64]], near: f64, spread: f64) -> Option<f64> {
    let mut near = near;
    for (level, values) in levels.iter().enumerate().rev() {
        let middle = near.round() as usize;
        let lags = middle.saturating_sub(AROUND).max(1)..=middle + AROUND;
        let squares: Vec<(usize, f64)> = lags.map(|lag| (lag, square(values, lag))).collect();
        let inner = squares.windows(3).min_by(|a, b| a[1].1.total_cmp(&b[1].1))?;
        let minimum = Minimum::around(inner[1].0, [inner[0].1, inner[1].1, inner[2].1]);
        if !minimum.is_within(if level == 0 { MATCH } else { NEAR } * spread) {
            return None;
        }
        near = if level == 0 { minimum.lag } else { minimum.lag * COARSER as f64 };
    }
    let whole = near.round();
    let lag = if (near - whole).abs() < KNOWN { whole } else { near };
    (2.0 * lag <= levels.first()?.len() as f64).then_some(lag)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn sines(samples: usize, period: f64) -> Vec<f64> {
        let turn = |k: usize| TAU * k as f64 / period;
        (0..samples).map(|k| turn(k).sin() + 0.3 * (3.0 * turn(k) + 1.0).cos()).collect()
    }

    /// Noise between -1 and 1 of a linear congruential generator.
    fn noise(samples: usize) -> Vec<f64> {
        let mut state = 1_u64;
        let next = |_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        (0..samples).map(next).collect()
    }

    #[test]
    fn a_period_is_that_of_one_cycle_however_many_there_are() {
        // Two cycles to 50,000, whole and between two samples.
        for (samples, cycle) in [
            (400, 200.0),
            (20_000, 200.0),
            (24_841, 6240.0),
            (20_000, 200.3),
            (20_400, 40.8),
            (600_000, 43_211.0),
            (500_000, 66.5),
            (1_000_000, 40.0),
            (1_000_000, 499_999.0),
        ] {
            let found = period(&sines(samples, cycle));
            let off = found.map(|found| (found - cycle).abs());
            assert!(off.is_some_and(|off| off < 0.02), "{samples} of {cycle}: {found:?}");
        }
        assert_eq!(period(&sines(20_000, 200.0)), Some(200.0));
    }

    #[test]
    fn a_motion_to_and_fro_with_rests_has_a_period() {
        let trapezoid = |k: usize| ((k % 300) as f64 - 150.0).abs().clamp(40.0, 110.0);
        let values: Vec<f64> = (0..30_000).map(trapezoid).collect();
        assert_eq!(period(&values), Some(300.0));
        // Of a short burst in each cycle it is no matter what repeats within it, nor that the middle is at rest.
        let burst = |k: usize| if k % 50_000 < 9000 { (k % 50_000) as f64 * 0.01 } else { 0.0 };
        let values: Vec<f64> = (0..250_000).map(|k| burst(k).sin()).collect();
        assert_eq!(period(&values), Some(50_000.0));
    }

    #[test]
    fn little_noise_hides_no_period_and_noise_alone_has_none() {
        let noise = noise(20_000);
        let noisy = |share: f64| -> Vec<f64> {
            sines(20_000, 200.0).iter().zip(&noise).map(|(a, b)| a + share * b).collect()
        };
        assert_eq!(period(&noisy(0.01)).map(f64::round), Some(200.0));
        assert_eq!(period(&noisy(0.2)), None);
        assert_eq!(period(&noise), None);
    }

    #[test]
    fn what_does_not_repeat_has_no_period() {
        let ramp: Vec<f64> = (0..9000).map(f64::from).collect();
        let chirp: Vec<f64> = ramp.iter().map(|k| (1e-6 * k * k).sin()).collect();
        let climbing: Vec<f64> = ramp.iter().map(|k| (k * 0.05).sin() + 1e-3 * k).collect();
        let fading: Vec<f64> = ramp.iter().map(|k| (k * 0.05).sin() * (-k / 4e3).exp()).collect();
        let once = sines(399, 200.0);
        let slow: Vec<f64> = ramp.iter().map(|k| k * k).collect();
        for values in [ramp, chirp, climbing, fading, once, slow, vec![1.0; 500], vec![3.0], vec![]]
        {
            assert_eq!(period(&values), None, "{:?}", &values[..values.len().min(3)]);
        }
    }

    #[test]
    fn a_cycle_of_too_few_samples_is_not_told_and_nor_are_several_of_it() {
        for cycle in [2.5, 5.0, 7.3, 12.4, 20.4] {
            assert_eq!(period(&sines(5000, cycle)), None, "{cycle}");
        }
    }
}
