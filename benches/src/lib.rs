//! What the benchmarks share.

pub mod axes;
pub mod discovery;
pub mod peers;
pub mod python;
