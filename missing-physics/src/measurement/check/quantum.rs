//! The size of one count of a channel.

/// Fewest different values from which a count can be told.
const FEWEST: usize = 8;
/// Share of the increments that must be whole multiples of the count.
const SHARE: f64 = 0.98;
/// A decimal increment below this share of the span is the last digit of the file.
const LAST_DIGIT: f64 = 5e-7;
/// How far from a whole multiple an increment may be, in counts.
const TOLERANCE: f64 = 0.1;

/// The increment that the values are multiples of; nothing where they are continuous.
///
/// The different values are sorted; the smallest difference that recurs is the first guess, the mean
/// of the differences near it the second. It is accepted where practically all differences of up to
/// a few counts are whole multiples of it: noise spreads the differences evenly, counting does not.
pub(super) fn of(values: &[f64]) -> Option<f64> {
    let mut levels = values.to_vec();
    levels.sort_unstable_by(f64::total_cmp);
    let span = levels.last()? - levels.first()?;
    // Values that differ by rounding only are one level.
    let rounding = span * 1e-10;
    levels.dedup_by(|b, a| *b - *a <= rounding);
    if levels.len() < FEWEST {
        return few(&levels);
    }
    let mut steps: Vec<f64> = levels.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_unstable_by(f64::total_cmp);
    // The very smallest step may be a freak; where most steps are long, only a few are one count.
    let guesses = [0, steps.len() / 200, steps.len() / 50, steps.len() / 10];
    let mut counts = guesses.into_iter().filter_map(|index| refined(&steps, steps[index]));
    let quantum = counts.find(|quantum| is_count(&steps, *quantum))?;
    (!is_last_digit(quantum, span)).then_some(quantum)
}

/// Whether the increment is the last digit of the file, not a count of the instrument: a power of
/// ten far below all that happens.
fn is_last_digit(quantum: f64, span: f64) -> bool {
    let power = quantum.log10();
    (power - power.round()).abs() < 1e-3 && quantum < LAST_DIGIT * span
}

/// With a handful of levels, such as those of a coarse sensor, all steps must agree.
fn few(levels: &[f64]) -> Option<f64> {
    let steps: Vec<f64> = levels.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let smallest = steps.iter().copied().reduce(f64::min)?;
    (levels.len() > 2 && are_whole(&steps, smallest)).then_some(smallest)
}

fn refined(steps: &[f64], guess: f64) -> Option<f64> {
    let near: Vec<f64> =
        steps.iter().copied().filter(|step| (step / guess - 1.0).abs() < 0.3).collect();
    (near.len() >= 3).then(|| near.iter().sum::<f64>() / near.len() as f64)
}

fn is_count(steps: &[f64], quantum: f64) -> bool {
    // Many counts away the error of the quantum itself would count.
    let near = steps.partition_point(|step| *step < 20.5 * quantum);
    near >= FEWEST && are_whole(&steps[..near], quantum)
}

fn are_whole(steps: &[f64], quantum: f64) -> bool {
    let counts = steps.iter().map(|step| step / quantum);
    let whole = counts.filter(|n| *n > 0.5 && (n - n.round()).abs() < TOLERANCE).count();
    whole as f64 >= SHARE * steps.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sweep(samples: usize) -> impl Iterator<Item = f64> {
        (0..samples).map(|k| (k as f64 * 0.013).sin() + 0.3 * (k as f64 * 0.0071).cos())
    }

    #[test]
    fn an_encoder_has_a_count_and_a_smooth_signal_has_none() {
        for count in [1e-4, 1e-3, 0.037] {
            let values: Vec<f64> = sweep(5000).map(|x| (x / count).round() * count).collect();
            let found = of(&values).unwrap();
            assert!((found / count - 1.0).abs() < 1e-3, "{found} for {count}");
        }
        assert_eq!(of(&sweep(5000).collect::<Vec<f64>>()), None);
    }

    #[test]
    fn digits_of_a_printed_number_far_below_its_changes_are_no_count() {
        let values: Vec<f64> = sweep(5000).map(|x| (x * 1e9).round() * 1e-9).collect();
        assert_eq!(of(&values), None);
    }

    #[test]
    fn two_levels_say_nothing_of_a_count() {
        assert_eq!(of(&[0.0, 1.0, 0.0, 1.0]), None);
        assert_eq!(of(&[0.0; 20]), None);
        assert_eq!(of(&[0.0, 1.0, 2.0, 4.0]), Some(1.0));
    }
}
