//! The table of outcomes.

use super::judge::{Answer, Outcome};

/// Head of the table.
pub const HEAD: &str = "\
| kind | hidden | level | visible | runs | right | first | in a set | silent | unexplained | wrong | refused | \
extra effects | size within 15 % | s |\n\
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|";

/// Largest relative error of a size that counts as found.
const NEAR: f64 = 0.15;

/// A row for these outcomes.
pub fn row(kind: &str, hidden: &str, level: &str, outcomes: &[&Outcome]) -> String {
    let count = |answer: Answer| outcomes.iter().filter(|o| o.answer == answer).count();
    let answers = [
        Answer::First,
        Answer::InSet,
        Answer::Silent,
        Answer::Unexplained,
        Answer::Wrong,
        Answer::Refused,
    ]
    .map(|answer| count(answer).to_string())
    .join(" | ");
    let right = outcomes.iter().filter(|o| o.right).count();
    let extra = outcomes.iter().filter(|o| o.extra > 0).count();
    let sizes: Vec<f64> = outcomes.iter().filter_map(|o| o.size_error).collect();
    let near = sizes.iter().filter(|error| **error <= NEAR).count();
    let size = if sizes.is_empty() { "-".to_owned() } else { format!("{near} of {}", sizes.len()) };
    let mut visible: Vec<f64> = outcomes.iter().map(|o| o.visibility).collect();
    visible.sort_unstable_by(f64::total_cmp);
    let visible = visible.get(visible.len() / 2).copied().unwrap_or(0.0);
    let runs = outcomes.len();
    let time = outcomes.iter().fold(0.0, |sum, o| sum + o.wall_s) / runs.max(1) as f64;
    format!(
        "| {kind} | {hidden} | {level} | {visible:.1} | {runs} | {right} | {answers} | {extra} | {size} | {time:.2} |"
    )
}
