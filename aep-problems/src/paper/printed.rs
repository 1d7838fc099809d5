//! What the paper prints, and when our runs agree with it.

use aep_core::trials::{Trials, quantile};

use super::{Claim, POPULATION};

/// A statement of the paper about one line of a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Printed {
    /// Every trial ends at 0. Agrees when the mean of our trials is below 1e-16, the resolution of
    /// double precision.
    Zero,
    /// The result of a single run. Agrees when it lies between our best and our worst trial.
    Single(f64),
    /// A mean over the trials. Agrees when ours is within a factor of ten.
    Mean(f64),
    /// Found after about this many generations. Agrees when it lies between our fastest and our
    /// slowest trial.
    Generations(f64),
    /// The slowest trial needed this many generations. Agrees within a factor of two.
    Slowest(f64),
    /// Found in every trial.
    AlwaysFound,
    /// Not found: agrees when more than half of our trials fail.
    Fails,
    /// Not found in this many of 50 trials. Agrees within five, which is about two standard
    /// deviations of the difference of two such counts.
    FailsIn(usize),
}

impl Printed {
    /// This statement held against `trials`.
    pub fn judge(&self, about: &str, trials: &Trials, target: f64) -> Claim {
        let (ours, agrees) = self.compare(trials, target);
        Claim::new(about, self.text(), ours, agrees)
    }

    fn text(self) -> String {
        match self {
            Self::Zero => "reaches 0".into(),
            Self::Single(value) => format!("{value:.2e} in one run"),
            Self::Mean(value) => format!("mean {value:.2e}"),
            Self::Generations(count) => format!("0 after about {count} generations"),
            Self::Slowest(count) => format!("{count} generations in 1 of 50 trials"),
            Self::AlwaysFound => "found in every trial".into(),
            Self::Fails => "not found".into(),
            Self::FailsIn(count) => format!("fails in {count} of 50"),
        }
    }

    fn compare(self, trials: &Trials, target: f64) -> (String, bool) {
        let summary = trials.summary(target);
        let (mean, median, (best, worst)) = (summary.mean, summary.median, summary.range);
        let count = summary.trials;
        let failed = count - summary.successes;
        let generations = generations_to(trials, target);
        let [fastest, middle, slowest] = [0.0, 0.5, 1.0].map(|p| quantile(&generations, p));
        match self {
            Self::Zero => (format!("mean {mean:.0e}"), mean < 1e-16),
            Self::Single(value) => (
                format!("median {median:.1e}, {best:.0e} .. {worst:.0e}"),
                best <= value && value <= worst,
            ),
            Self::Mean(value) => {
                let ratio = mean / value;
                (format!("mean {mean:.2e}, median {median:.1e}"), (0.1..=10.0).contains(&ratio))
            }
            Self::Generations(value) => (
                format!("median {middle}, {fastest} .. {slowest}, {failed} of {count} fail"),
                fastest <= value && value <= slowest && failed == 0,
            ),
            Self::Slowest(value) => {
                let ratio = slowest / value;
                (format!("slowest {slowest}"), (0.5..=2.0).contains(&ratio))
            }
            Self::AlwaysFound => (format!("found in {} of {count}", count - failed), failed == 0),
            Self::Fails => (format!("fails in {failed} of {count}"), 2 * failed > count),
            Self::FailsIn(value) => {
                let expected = value as f64 * count as f64 / 50.0;
                let agrees = (failed as f64 - expected).abs() <= 5.0 * count as f64 / 50.0;
                (format!("fails in {failed} of {count}"), agrees)
            }
        }
    }
}

/// Generations of the trials that found the target, ascending.
fn generations_to(trials: &Trials, target: f64) -> Vec<f64> {
    let reached = trials.trials.iter().filter_map(|trial| trial.evaluations_to(target));
    let mut generations: Vec<f64> = reached.map(|used| (used / POPULATION) as f64 - 1.0).collect();
    generations.sort_by(f64::total_cmp);
    generations
}
