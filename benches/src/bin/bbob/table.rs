//! What the runs amount to.

use std::fmt::Write as _;
use std::ops::RangeInclusive;

use aep_core::random::{Purpose, Stream, Streams, index};

use crate::suite::{Plan, Run};

/// Evaluations per component at which solved runs are counted, beside the budget.
const AT: [u64; 2] = [100, 1_000];
/// Functions of each of the suite's groups, counted from 1.
const GROUPS: [(&str, RangeInclusive<usize>); 5] = [
    ("separable", 1..=5),
    ("moderate", 6..=9),
    ("ill-conditioned", 10..=14),
    ("multimodal", 15..=19),
    ("weakly structured", 20..=24),
];
/// Samples of a bootstrap.
const SAMPLES: usize = 1_000;

pub fn csv(runs: &[Run]) -> String {
    let mut text = String::from("method,dimension,function,instance,evaluations,solved\n");
    for run in runs {
        let Run { method, dimension, function, instance, evaluations, .. } = run;
        let solved = run.solved.is_some();
        let _ = writeln!(text, "{method},{dimension},{function},{instance},{evaluations},{solved}");
    }
    text
}

/// The runs of one method in one dimension.
struct Own<'a> {
    runs: Vec<&'a Run>,
    dimension: u64,
    functions: &'a [usize],
}

impl<'a> Own<'a> {
    fn new(plan: &'a Plan, runs: &'a [Run], method: &str, dimension: usize) -> Self {
        let own = |run: &&Run| run.method == method && run.dimension == dimension;
        let runs = runs.iter().filter(own).collect();
        Self { runs, dimension: dimension as u64, functions: &plan.functions }
    }

    /// Share of runs that were solved within so many evaluations per component.
    fn solved(&self, within: u64, functions: &RangeInclusive<usize>) -> f64 {
        let of: Vec<_> = self.runs.iter().filter(|run| functions.contains(&run.function)).collect();
        let limit = within * self.dimension;
        let solved = of.iter().filter(|run| run.solved.is_some_and(|at| at <= limit)).count();
        solved as f64 / of.len() as f64
    }

    fn of(&self, function: usize) -> Vec<&'a Run> {
        self.runs.iter().filter(|run| run.function == function).copied().collect()
    }

    /// Half the width of the 90 % interval of the share solved within the budget: runs of each
    /// function drawn again.
    fn uncertainty(&self, within: u64, rng: &mut Stream) -> f64 {
        let limit = within * self.dimension;
        let functions: Vec<Vec<&Run>> = self.functions.iter().map(|f| self.of(*f)).collect();
        let mut shares: Vec<f64> = (0..SAMPLES)
            .map(|_| {
                let solved = functions.iter().flat_map(|runs| {
                    let again = (0..runs.len()).map(|_| runs[index(rng, runs.len())]);
                    again.collect::<Vec<_>>()
                });
                let solved = solved.filter(|run| run.solved.is_some_and(|at| at <= limit)).count();
                solved as f64 / self.runs.len() as f64
            })
            .collect();
        shares.sort_by(f64::total_cmp);
        0.5 * (shares[SAMPLES * 19 / 20] - shares[SAMPLES / 20])
    }
}

/// Evaluations of all runs per solved run; infinite without one.
fn expected_time<'a>(runs: impl Iterator<Item = &'a Run>) -> f64 {
    let (mut spent, mut solved) = (0, 0);
    for run in runs {
        spent += run.evaluations;
        solved += u64::from(run.solved.is_some());
    }
    if solved == 0 { f64::INFINITY } else { spent as f64 / solved as f64 }
}

/// Shares of solved runs, a table per dimension.
pub fn shares(plan: &Plan, methods: &[&str], runs: &[Run]) -> String {
    let mut text = String::new();
    let mut rng = Streams::new(1, Purpose::Trial, 0).stream(0);
    for &dimension in &plan.dimensions {
        let groups = GROUPS.map(|(name, _)| name).join(" | ");
        let at = AT.map(|at| format!("{at} n")).join(" | ");
        let _ = writeln!(text, "### {dimension} dimensions\n");
        let _ = writeln!(text, "| method | {at} | {} n | {groups} | median ERT / n |", plan.budget);
        let columns = "---:|".repeat(AT.len() + GROUPS.len() + 2);
        let _ = writeln!(text, "|---|{columns}");
        for method in methods {
            let own = Own::new(plan, runs, method, dimension);
            if !own.runs.is_empty() {
                let _ = writeln!(text, "{}", row(plan, method, &own, &mut rng));
            }
        }
        text.push('\n');
    }
    text
}

fn row(plan: &Plan, method: &str, own: &Own<'_>, rng: &mut Stream) -> String {
    let all = 1..=usize::MAX;
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let at = AT.map(|at| percent(own.solved(at, &all))).join(" | ");
    let (whole, about) = (own.solved(plan.budget, &all), own.uncertainty(plan.budget, rng));
    let groups = GROUPS.map(|(_, functions)| {
        let share = own.solved(plan.budget, &functions);
        if share.is_nan() { "-".into() } else { format!("{:.0} %", 100.0 * share) }
    });
    let mut times: Vec<f64> =
        own.functions.iter().map(|f| expected_time(own.of(*f).into_iter())).collect();
    times.sort_by(f64::total_cmp);
    let count = times.len();
    let middle = f64::midpoint(times[(count - 1) / 2], times[count / 2]) / own.dimension as f64;
    let middle = if middle.is_finite() { format!("{middle:.0}") } else { "-".into() };
    let whole = format!("{:.1} ± {:.1} %", 100.0 * whole, 100.0 * about);
    format!("| {method} | {at} | {whole} | {} | {middle} |", groups.join(" | "))
}

/// Expected running time of each function per component, with its 90 % interval.
pub fn times(plan: &Plan, methods: &[&str], runs: &[Run]) -> String {
    let mut text = String::new();
    let mut rng = Streams::new(1, Purpose::Trial, 1).stream(0);
    for &dimension in &plan.dimensions {
        let _ = writeln!(text, "### {dimension} dimensions\n\n| | {} |", methods.join(" | "));
        let _ = writeln!(text, "|---|{}", "---:|".repeat(methods.len()));
        for &function in &plan.functions {
            let cells: Vec<String> = (methods.iter())
                .map(|method| {
                    let own = Own::new(plan, runs, method, dimension);
                    time(&own.of(function), dimension as f64, &mut rng)
                })
                .collect();
            let _ = writeln!(text, "| f{function} | {} |", cells.join(" | "));
        }
        text.push('\n');
    }
    text
}

fn time(runs: &[&Run], n: f64, rng: &mut Stream) -> String {
    let expected = expected_time(runs.iter().copied());
    if !expected.is_finite() {
        return "-".into();
    }
    let mut samples: Vec<f64> = (0..SAMPLES)
        .map(|_| expected_time((0..runs.len()).map(|_| runs[index(rng, runs.len())])))
        .collect();
    samples.sort_by(f64::total_cmp);
    let shown =
        |time: f64| if time.is_finite() { format!("{:.0}", time / n) } else { "∞".into() };
    let (low, high) = (samples[SAMPLES / 20], samples[SAMPLES * 19 / 20]);
    format!("{} ({} .. {})", shown(expected), shown(low), shown(high))
}
