//! All readings of what the paper leaves open.

use aep_core::trials::Summary;
use aep_core::{
    Aep, Border, CommonRate, Division, LearningRate, MetaEp, Method, RunError, Spread, UpdateOrder,
};
use serde::Serialize;

use super::{Claim, Figure, Setting};

/// One reading, measured on one line of a figure.
#[derive(Clone, Debug, Serialize)]
pub struct Reading {
    /// The reading in words.
    pub reading: String,
    /// Whether it is the default.
    pub default: bool,
    /// What comes out.
    pub summary: Summary,
    /// Its first printed statement held against it.
    pub claim: Claim,
}

impl Figure {
    /// Every reading on every line, `trials` times each. Borders that let individuals leave the
    /// domain are left out where the function has no minimum outside it (f3).
    ///
    /// # Errors
    /// As [`Figure::measure`].
    pub fn readings(&self, trials: usize, seed: u64) -> Result<Vec<Reading>, RunError> {
        let mut all = Vec::new();
        for line in self.lines {
            let Some(printed) = line.printed.first() else { continue };
            for (reading, method, default) in line.method.readings() {
                if self.name == "fig4" && reading.contains("allow") {
                    continue;
                }
                let trials = self.run(&*method, trials, seed)?;
                let summary = trials.summary(self.target);
                let claim = printed.judge(line.label, &trials, self.target);
                all.push(Reading { reading, default, summary, claim });
            }
        }
        Ok(all)
    }
}

type Variant = (String, Box<dyn Method>, bool);

impl Setting {
    pub(super) fn aep(self) -> Aep {
        match self {
            Self::Aep(beta1, beta2) => Aep::paper().with_beta(beta1, beta2),
            _ => Aep::paper(),
        }
    }

    pub(super) fn meta_ep(self) -> MetaEp {
        match self {
            Self::MetaEpByPopulation(sigma) => {
                MetaEp::paper().with_sigma(sigma).with_learning_rate(LearningRate::Population)
            }
            Self::MetaEp(sigma) => MetaEp::paper().with_sigma(sigma),
            Self::Aep(..) => MetaEp::paper(),
        }
    }

    /// Every reading of this method: in words, as a method, and whether it is the default.
    fn readings(self) -> Vec<Variant> {
        match self {
            Self::Aep(..) => aep_readings(&self.aep()),
            _ => meta_ep_readings(&self.meta_ep()),
        }
    }
}

fn aep_readings(base: &Aep) -> Vec<Variant> {
    let mut all: Vec<Variant> = Vec::new();
    for spread in [Spread::Variance, Spread::StandardDeviation] {
        for division in [Division::PerComponent, Division::Whole] {
            for border in Border::ALL {
                let s = match division {
                    Division::Whole => "beta f",
                    Division::PerComponent => "beta f / n",
                };
                let kind = match spread {
                    Spread::Variance => "variance",
                    Spread::StandardDeviation => "standard deviation",
                };
                let method = base.clone().with_spread(spread, division).with_border(border);
                let default = method == *base;
                all.push((format!("{kind} {s}, {}", word(border)), Box::new(method), default));
            }
        }
    }
    all
}

fn meta_ep_readings(base: &MetaEp) -> Vec<Variant> {
    let mut all: Vec<Variant> = Vec::new();
    for order in [UpdateOrder::PositionFirst, UpdateOrder::SigmaFirst] {
        for common in [CommonRate::Tau, CommonRate::TauPrime] {
            for border in Border::ALL {
                let first = match order {
                    UpdateOrder::PositionFirst => "position first",
                    UpdateOrder::SigmaFirst => "sigma first",
                };
                let rate = match common {
                    CommonRate::Tau => "tau common",
                    CommonRate::TauPrime => "tau' common",
                };
                let method =
                    base.clone().with_order(order).with_common_rate(common).with_border(border);
                let default = method == *base;
                all.push((format!("{first}, {rate}, {}", word(border)), Box::new(method), default));
            }
        }
    }
    all
}

fn word(border: Border) -> &'static str {
    match border {
        Border::Clamp => "clamp",
        Border::Reflect => "reflect",
        Border::Resample => "resample",
        Border::KeepComponent => "keep component",
        Border::Allow => "allow outside",
    }
}
