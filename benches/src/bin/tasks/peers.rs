//! Optimizers of other crates.

use cmaes::DVector;
use cmaes::restart::{BIPOP, RestartOptions, RestartStrategy};
use fcmaes_core::{Cmaes, CmaesParams, De, DeParams, Fitness};

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
        let fitness = || Fitness::bounded(n, 1, &vec![0.0; n], &vec![1.0; n]);
        let start = case.population(seed, 1)?.remove(0);
        match self {
            Self::FcmaesDe => {
                let settings =
                    DeParams { max_evaluations: tally.left(), seed, ..DeParams::default() };
                De::new(fitness(), &[], &[], None, &settings).optimize(&cost);
            }
            Self::FcmaesCma => {
                let settings =
                    CmaesParams { max_evaluations: tally.left(), seed, ..CmaesParams::default() };
                Cmaes::new(fitness(), &start, &[SIGMA], &settings).optimize(&cost, 1);
            }
            // Its restarts choose their places themselves, from the seed.
            Self::CmaesBipop => {
                let strategy = RestartStrategy::BIPOP(BIPOP::default());
                let left = usize::try_from(tally.left())?;
                let options =
                    RestartOptions::new(n, 0.0..=1.0, strategy).max_function_evals(left).seed(seed);
                let restarts = options.build().map_err(|error| format!("{error:?}"))?;
                restarts.run(|| |u: &DVector<f64>| tally.cost_in_cube(u.as_slice()));
            }
        }
        Ok(())
    }
}
