//! After how many samples a signal repeats itself.

/// The scan for the period looks at about this many samples.
const COARSE: usize = 1500;
/// What differs from cycle to cycle, as a share of the signal's own deviation.
const COARSE_MATCH: f64 = 0.1;
const MATCH: f64 = 0.02;

/// Number of samples after which a signal repeats itself, at least twice: the shortest one; nothing where it does not.
pub fn period(values: &[f64]) -> Option<usize> {
    let stride = values.len().div_ceil(COARSE).max(1);
    let coarse: Vec<f64> = values.iter().copied().step_by(stride).collect();
    let spread = deviation(&coarse);
    if spread == 0.0 {
        return None;
    }
    // A smooth signal is like itself after a few samples: first it must become unlike.
    let lags = 1..=coarse.len() / 2;
    let unlike = lags.clone().find(|&lag| difference(&coarse, lag) > spread)?;
    let candidates = (unlike..*lags.end()).filter(|&lag| {
        let here = difference(&coarse, lag);
        here < COARSE_MATCH * spread && here <= difference(&coarse, lag + 1)
    });
    candidates.take(20).find_map(|lag| {
        let best = refined(values, lag * stride, stride)?;
        (difference(values, best) < MATCH * spread).then_some(best)
    })
}

fn refined(values: &[f64], near: usize, stride: usize) -> Option<usize> {
    let lags = near.saturating_sub(stride)..=(near + stride).min(values.len() / 2);
    lags.min_by(|&a, &b| difference(values, a).total_cmp(&difference(values, b)))
}

/// Root mean square of `x(k + lag) - x(k)`.
pub(super) fn difference(values: &[f64], lag: usize) -> f64 {
    let pairs = values.iter().zip(&values[lag..]);
    let squares: f64 = pairs.map(|(a, b)| (b - a).powi(2)).sum();
    (squares / (values.len() - lag).max(1) as f64).sqrt()
}

fn deviation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / values.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn motion(samples: u32, period: f64) -> Vec<f64> {
        let at = |k: u32| TAU * f64::from(k) / period;
        (0..samples).map(|k| at(k).sin() + 0.3 * (3.0 * at(k) + 1.0).cos()).collect()
    }

    #[test]
    fn a_motion_of_four_cycles_has_their_period() {
        assert!(period(&motion(24_841, 6240.0)).unwrap().abs_diff(6240) < 3);
    }

    #[test]
    fn of_a_hundred_cycles_it_is_one_not_several() {
        assert_eq!(period(&motion(20_000, 200.0)), Some(200));
    }

    #[test]
    fn a_motion_without_repeats_has_no_period() {
        let rising: Vec<f64> =
            (0..9000).map(|k| (1e-6 * f64::from(k) * f64::from(k)).sin()).collect();
        assert_eq!(period(&rising), None);
        assert_eq!(period(&[1.0; 500]), None);
    }
}
