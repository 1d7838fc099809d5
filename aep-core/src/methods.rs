//! The methods by name, for command lines and comparisons; and [`recommend`], which names one for a task.

mod recommend;

pub use recommend::{Advice, Facts, recommend};

use crate::{Aep, CmaEs, De, Lineages, MetaEp, Method, Restarting};

/// A method that can be asked for by name.
#[derive(Clone, Copy)]
pub struct Named {
    /// Its name.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    /// Builds it for a population size; 0 for its own default.
    pub build: fn(usize) -> Box<dyn Method>,
}

/// All methods.
pub const ALL: &[Named] = &[
    Named {
        name: "aep",
        summary: "accelerated evolutionary programming by the paper's rules (smallest cost must be 0)",
        build: |count| sized(count, Aep::paper(), Aep::with_population),
    },
    Named {
        name: "aep-practical",
        summary: "AEP for real costs: steps from the population's covariance, adoption by age",
        build: |count| sized(count, Aep::practical(), Aep::with_population),
    },
    Named {
        name: "aep-practical-restarts",
        summary: "aep-practical, restarted with twice the population whenever it is stuck",
        build: restarting,
    },
    Named {
        name: "aep-lineages",
        summary: "AEP of lineages: few evaluations, on one minimum or on many",
        build: |count| sized(count, Lineages::default(), Lineages::with_population),
    },
    Named {
        name: "meta-ep",
        summary: "evolutionary programming with log-normal step sizes, the paper's yardstick",
        build: |count| sized(count, MetaEp::paper(), MetaEp::with_population),
    },
    Named {
        name: "meta-ep-practical",
        summary: "meta-ep with first steps in units of the domain",
        build: |count| sized(count, MetaEp::practical(), MetaEp::with_population),
    },
    Named {
        name: "de",
        summary: "differential evolution, rand/1/bin with self-adaptive factors (jDE)",
        build: |count| sized(count, De::default(), De::with_population),
    },
    Named {
        name: "de-fixed",
        summary: "differential evolution, rand/1/bin with F = 0.6, CR = 0.9",
        build: |count| sized(count, De::default().with_fixed(0.6, 0.9), De::with_population),
    },
    Named {
        name: "cma-es",
        summary: "covariance matrix adaptation, population doubled at each restart",
        build: |count| sized(count, CmaEs::default(), CmaEs::with_population),
    },
];

/// The method called `name`.
pub fn find(name: &str) -> Option<&'static Named> {
    ALL.iter().find(|method| method.name == name)
}

/// From `count` individuals on, doubled at each restart.
fn restarting(count: usize) -> Box<dyn Method> {
    let first = if count == 0 { 40 } else { count };
    let resize =
        move |aep: Aep, doubled: usize| aep.with_population((doubled / 40).saturating_mul(first));
    Box::new(Restarting::doubling(Aep::practical(), resize))
}

fn sized<M: Method + 'static>(
    count: usize,
    method: M,
    resize: impl Fn(M, usize) -> M,
) -> Box<dyn Method> {
    Box::new(if count == 0 { method } else { resize(method, count) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_carry_the_name_they_are_found_by() {
        for named in ALL {
            assert_eq!((named.build)(0).name(), named.name);
            assert_eq!((named.build)(60).name(), named.name);
        }
    }
}
