//! Optimizers of other crates.

use benches::peers::{cmaes_bipop, fcmaes_cma};
use fcmaes_core::{CmaesParams, De, DeParams, Fitness};

use crate::Result;
use crate::case::{Case, Tally};

/// First step, in widths of the domain: that of our CMA-ES.
const SIGMA: f64 = 0.3;

/// A method of another crate, with its defaults.
#[derive(Clone, Copy)]
pub enum Peer {
    FcmaesDe,
    FcmaesCma,
    CmaesBipop,
}

impl Peer {
    pub const ALL: [Self; 3] = [Self::FcmaesDe, Self::FcmaesCma, Self::CmaesBipop];

    pub fn name(self) -> &'static str {
        match self {
            Self::FcmaesDe => "fcmaes-core DE",
            Self::FcmaesCma => "fcmaes-core CMA-ES",
            Self::CmaesBipop => "cmaes BIPOP",
        }
    }

    /// One run, until it is over or the method gives up.
    pub fn run(self, case: &Case, seed: u64, tally: &Tally<'_>) -> Result<()> {
        let n = case.domain().dimension();
        let cost = |u: &[f64]| tally.cost_in_cube(u);
        let (lower, upper) = (vec![0.0; n], vec![1.0; n]);
        match self {
            Self::FcmaesDe => {
                let settings =
                    DeParams { max_evaluations: tally.left(), seed, ..DeParams::default() };
                let fitness = Fitness::bounded(n, 1, &lower, &upper);
                De::new(fitness, &[], &[], None, &settings).optimize(&cost);
            }
            Self::FcmaesCma => {
                let settings =
                    CmaesParams { max_evaluations: tally.left(), seed, ..CmaesParams::default() };
                let start = case.population(seed, 1)?.remove(0);
                fcmaes_cma((&lower, &upper), &start, SIGMA, &settings).optimize(&cost, 1);
            }
            Self::CmaesBipop => cmaes_bipop((n, 0.0..=1.0), tally.left(), None, seed, cost)?,
        }
        Ok(())
    }
}
