//! What the benchmarks share.

pub mod discovery;
