//! What a reading is worth that says the same as those beside it.
//!
//! The error of a count is a new one wherever the axis comes to another count. At rest it is one and the same, however
//! often it is read: a thousand samples of a standstill would speak for a model whose axis stops a tenth of a count
//! nearer to what was read as a thousand independent errors do. Slow motion makes runs of equal readings, too, but of a
//! steady one they differ by one sample at most.

use std::ops::Range;

/// Worth of each sample of a rounded `position`, in pieces that have nothing to do with each other: 1, or less in a run that
/// is longer than both runs beside it by more than one sample, which is worth one more than the longer one of them.
pub(super) fn worth(position: &[f64], segments: &[Range<usize>]) -> Vec<f64> {
    let mut worth = vec![1.0; position.len()];
    for segment in segments {
        let runs: Vec<usize> =
            position[segment.clone()].chunk_by(|a, b| a == b).map(<[f64]>::len).collect();
        let mut first = segment.start;
        for (k, run) in runs.iter().enumerate() {
            let before = k.checked_sub(1).map_or(0, |k| runs[k]);
            let most = before.max(runs.get(k + 1).copied().unwrap_or(0)) + 1;
            worth[first..first + run].fill((most as f64 / *run as f64).min(1.0));
            first += run;
        }
    }
    worth
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How long each reading stays, one count further each time.
    fn readings(runs: &[usize]) -> Vec<f64> {
        let each = runs.iter().enumerate();
        each.flat_map(|(k, run)| std::iter::repeat_n(k as f64, *run)).collect()
    }

    fn of_runs(runs: &[usize]) -> Vec<f64> {
        let position = readings(runs);
        let mut worth = worth(&position, std::slice::from_ref(&(0..position.len()))).into_iter();
        runs.iter().map(|run| worth.by_ref().take(*run).sum()).collect()
    }

    #[test]
    fn samples_of_a_motion_are_worth_one_each_however_slow_it_is() {
        for runs in [
            vec![1; 50],
            vec![1, 2, 1, 1, 2],
            vec![2, 3, 2, 3],
            vec![400; 3],
            vec![17, 16, 8, 4, 2, 1],
        ] {
            let expected: Vec<f64> = runs.iter().map(|run| *run as f64).collect();
            assert_eq!(of_runs(&runs), expected);
        }
    }

    #[test]
    fn a_rest_is_worth_one_more_than_the_longer_run_beside_it_however_long_it_is() {
        for rest in [100, 10_000] {
            let worths = of_runs(&[4, 4, 5, rest, 3, 4, 4]);
            for (worth, expected) in worths.iter().zip([4.0, 4.0, 5.0, 6.0, 3.0, 4.0, 4.0]) {
                assert!((worth - expected).abs() < 1e-9, "{rest}: {worth} {expected}");
            }
        }
    }

    #[test]
    fn a_piece_has_nothing_to_do_with_what_is_read_before_and_after_it() {
        let position = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        let sum = |pieces: &[Range<usize>]| worth(&position, pieces).iter().sum::<f64>();
        assert_eq!(sum(std::slice::from_ref(&(0..8))), 8.0);
        assert_eq!(sum(&[0..4, 4..8]), 2.0);
        // What lies in no piece counts in no comparison.
        assert_eq!(worth(&position, &[]), [1.0; 8]);
    }
}
