//! What half and one and a half times each threshold do to hits, extras and false alarms.

use missing_physics::Thresholds;

use super::case::Wanted;
use super::judge::{Answer, Outcome};

/// Head of the table.
pub const HEAD: &str = "| thresholds | named first | with something besides | wrong | silent or unexplained | \
                        alarms where nothing is hidden | unlisted, honest | mean s |\n|---|---|---|---|---|---|---|---|";

/// Without the last digits of a product.
fn shown(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// The thresholds as they are, and each of them at a half and at one and a half times its value.
pub fn variations(thresholds: Thresholds) -> Vec<(String, Thresholds)> {
    let all = thresholds;
    let number = |name: &str, value: f64, set: &dyn Fn(&mut Thresholds, f64)| {
        [0.5, 1.5].map(|factor| {
            let mut varied = all;
            set(&mut varied, factor * value);
            (format!("{name} {}", shown(factor * value)), varied)
        })
    };
    let count = |name: &str, value: usize, set: &dyn Fn(&mut Thresholds, usize)| {
        [0.5, 1.5].map(|factor| {
            let value = (factor * value as f64).round() as usize;
            let mut varied = all;
            set(&mut varied, value);
            (format!("{name} {value}"), varied)
        })
    };
    let each = [
        number("better", all.better, &|varied, value| varied.better = value),
        number("share", all.share, &|varied, value| varied.share = value),
        // They are multiples of the budget: what is beyond it counts.
        number("complete 1 +", all.complete - 1.0, &|varied, value| varied.complete = 1.0 + value),
        number("local 1 +", all.local - 1.0, &|varied, value| varied.local = 1.0 + value),
        number("chance", all.chance, &|varied, value| varied.chance = value),
        count("beam", all.beam, &|varied, value| varied.beam = value),
        count("fitted", all.fitted, &|varied, value| varied.fitted = value),
        count("most", all.most, &|varied, value| varied.most = value),
    ];
    std::iter::once(("as they are".to_owned(), all)).chain(each.into_iter().flatten()).collect()
}

/// A row: what was said of the recordings, each with what was to be said.
pub fn row(name: &str, outcomes: &[(Wanted, Outcome)]) -> String {
    let of = |wanted: Wanted| outcomes.iter().filter(move |o| o.0 == wanted).map(|o| &o.1);
    let names = || of(Wanted::Name);
    let count = |answers: &[Answer]| names().filter(|o| answers.contains(&o.answer)).count();
    let besides = names().filter(|o| o.extra > 0 && o.answer != Answer::Wrong).count();
    let all = names().count();
    let nulls = of(Wanted::Silence).count();
    let alarms = of(Wanted::Silence).filter(|o| matches!(o.answer, Answer::Wrong)).count();
    let unlisted = of(Wanted::Unexplained).count();
    let honest = of(Wanted::Unexplained).filter(|o| o.right).count();
    let seconds = outcomes.iter().map(|o| o.1.wall_s).sum::<f64>() / outcomes.len().max(1) as f64;
    format!(
        "| {name} | {} of {all} (+{}) | {besides} | {} | {} | {alarms} of {nulls} | {honest} of {unlisted} | {seconds:.1} |",
        count(&[Answer::First]),
        count(&[Answer::InSet]),
        count(&[Answer::Wrong]),
        count(&[Answer::Silent, Answer::Unexplained, Answer::Refused]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_threshold_is_varied_to_either_side() {
        let varied = variations(Thresholds::default());
        assert_eq!(varied.len(), 17);
        let unlike = |k: usize| varied[k].1 != Thresholds::default();
        assert!((1..17).all(unlike) && !unlike(0));
        assert_eq!((varied[11].0.as_str(), varied[11].1.beam), ("beam 2", 2));
    }

    #[test]
    fn a_row_counts_what_was_said() {
        let outcome = |answer, extra, right| Outcome {
            answer,
            said: String::new(),
            extra,
            right,
            size_error: None,
            visibility: 1.0,
            wall_s: 2.0,
        };
        let outcomes = [
            (Wanted::Name, outcome(Answer::First, 0, true)),
            (Wanted::Name, outcome(Answer::First, 1, false)),
            (Wanted::Name, outcome(Answer::Wrong, 1, false)),
            (Wanted::Silence, outcome(Answer::Wrong, 1, false)),
            (Wanted::Silence, outcome(Answer::Silent, 0, true)),
            (Wanted::Unexplained, outcome(Answer::Unexplained, 0, true)),
        ];
        let row = row("x", &outcomes);
        assert_eq!(row, "| x | 2 of 3 (+0) | 1 | 1 | 0 | 1 of 2 | 1 of 1 | 2.0 |");
    }
}
