//! The compiled part of the Python package `aep`: the engine's numbers, kinds and sentences as Python objects. What a user
//! calls, with its documentation, is in `python/aep`; this module is private to it.

mod costs;
mod failure;
mod minimize;
mod optimizer;
mod space;
mod trials;

use pyo3::prelude::*;

#[pymodule]
mod _aep {
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    use super::minimize::{methods, minimize};
    #[pymodule_export]
    use super::optimizer::Optimizer;
    #[pymodule_export]
    use super::space::Space;
    #[pymodule_export]
    use super::trials::{rank_test, trials};
}
