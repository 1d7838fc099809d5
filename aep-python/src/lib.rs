//! The compiled part of the Python package `aep`: the engine's numbers, kinds and sentences as Python objects. What a user
//! calls, with its documentation, is in `python/aep`; this module is private to it.

#![expect(clippy::needless_pass_by_value, reason = "arguments come from Python by value")]

mod costs;
mod discover;
mod drive;
mod failure;
mod formula;
mod found;
mod minimize;
mod optimizer;
mod own_family;
mod reading;
mod search;
mod space;
mod steady;
mod task;
mod trials;
mod watched;

use pyo3::prelude::*;

#[pymodule]
mod _aep {
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    use super::discover::discover;
    #[pymodule_export]
    use super::drive::{challenge, compare, effects, experiment, extend, simulate, suggest};
    #[pymodule_export]
    use super::formula::evaluate;
    #[pymodule_export]
    use super::found::Found;
    #[pymodule_export]
    use super::minimize::{methods, minimize};
    #[pymodule_export]
    use super::optimizer::Optimizer;
    #[pymodule_export]
    use super::own_family::{OwnFound, discover_own};
    #[pymodule_export]
    use super::reading::Data;
    #[pymodule_export]
    use super::space::Space;
    #[pymodule_export]
    use super::steady::{Steady, stop_message};
    #[pymodule_export]
    use super::task::{Task, tasks};
    #[pymodule_export]
    use super::trials::{rank_test, trials};
}
