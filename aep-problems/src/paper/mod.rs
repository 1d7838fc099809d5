//! Figures 2 to 6 of the AEP paper: the same runs, and what was printed beside what comes out.
//!
//! Conditions: 40 individuals, 50 trials, AEP and meta-EP from the same initial populations, mean of
//! the best cost against generations. The paper leaves open how several of its rules are to be read;
//! [`Figure::readings`] measures all readings, [`aep_core::Aep::paper`] and
//! [`aep_core::MetaEp::paper`] are the one that agrees with most of what is printed.
//!
//! Reference: J.-H. Kim, H.-K. Chae, J.-Y. Jeon, S.-W. Lee, "Identification and Control of Systems
//! with Friction Using Accelerated Evolutionary Programming", IEEE Control Systems Magazine, 1996.

mod claim;
mod figures;
mod printed;
mod readings;

use aep_core::trials::{Plan, RankTest, Trials, rank_test};
use aep_core::{Budget, Method, RunError};

pub use claim::{Claim, Verdict};
pub use figures::FIGURES;
pub use printed::Printed;
pub use readings::Reading;

use crate::Definition;

/// Individuals in every run of the paper.
pub const POPULATION: u64 = 40;

/// One figure: a function, the lines drawn, and what the paper says of them.
#[derive(Clone, Copy)]
pub struct Figure {
    /// `fig2` to `fig6`.
    pub name: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// The function.
    pub function: &'static Definition,
    /// Generations drawn.
    pub generations: u64,
    /// Cost that counts as "found".
    pub target: f64,
    /// The lines; the first is AEP, the second its yardstick.
    pub lines: &'static [Line],
    /// Whether the paper says that AEP is ahead.
    pub aep_ahead: bool,
}

/// One line of a figure.
#[derive(Clone, Copy)]
pub struct Line {
    /// As in the legend.
    pub label: &'static str,
    /// The method with the paper's settings.
    pub method: Setting,
    /// What the paper says of it.
    pub printed: &'static [Printed],
    /// What is known of why ours differs, where it does.
    pub why_not: Option<&'static str>,
}

/// A method of the paper with its parameters.
#[derive(Clone, Copy)]
pub enum Setting {
    /// AEP with beta1 and beta2.
    Aep(f64, f64),
    /// Meta-EP with its first step size.
    MetaEp(f64),
    /// Meta-EP with its first step size and the population size in place of n in its rates.
    MetaEpByPopulation(f64),
}

impl Setting {
    /// The method in the default reading.
    pub fn method(self) -> Box<dyn Method> {
        match self {
            Self::Aep(..) => Box::new(self.aep()),
            Self::MetaEp(_) | Self::MetaEpByPopulation(_) => Box::new(self.meta_ep()),
        }
    }
}

/// A figure's lines, measured.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Trials of each line, in the order of [`Figure::lines`].
    pub lines: Vec<Trials>,
    /// The paper's statements beside ours.
    pub claims: Vec<Claim>,
}

impl Figure {
    /// Runs all lines, `trials` times each.
    ///
    /// # Errors
    /// When a method refuses its settings: never for those of the paper.
    pub fn measure(&self, trials: usize, seed: u64) -> Result<Measured, RunError> {
        let run = |line: &Line| self.run(&*line.method.method(), trials, seed);
        let lines: Vec<Trials> = self.lines.iter().map(run).collect::<Result<_, _>>()?;
        let mut claims = Vec::new();
        for (line, trials) in self.lines.iter().zip(&lines) {
            let judge = |printed: &Printed| {
                let claim = printed.judge(line.label, trials, self.target);
                match line.why_not {
                    Some(why) if !claim.agrees() => claim.because(why),
                    _ => claim,
                }
            };
            claims.extend(line.printed.iter().map(judge));
        }
        if let (true, [aep, other, ..]) = (self.aep_ahead, &lines[..]) {
            let test = rank_test(&aep.merits(self.target), &other.merits(self.target));
            claims.push(ahead(test));
        }
        Ok(Measured { lines, claims })
    }

    /// Runs one method under the figure's conditions.
    ///
    /// # Errors
    /// When a setting of `method` is outside its range.
    pub fn run(&self, method: &dyn Method, trials: usize, seed: u64) -> Result<Trials, RunError> {
        let problem = self.function.usual();
        let plan = Plan::new(trials, Budget::generations(self.generations)).with_seed(seed);
        plan.run(method, |_| &problem)
    }
}

/// The claim that AEP beats meta-EP.
fn ahead(test: RankTest) -> Claim {
    let ours = format!("ahead with probability {:.2}, p = {:.0e}", test.effect, test.p_value);
    let agrees = test.effect > 0.5 && test.p_value < 0.05;
    Claim::new("AEP against EP", "AEP ahead", ours, agrees)
}

/// The figure called `name`.
pub fn find(name: &str) -> Option<&'static Figure> {
    FIGURES.iter().find(|figure| figure.name == name)
}
