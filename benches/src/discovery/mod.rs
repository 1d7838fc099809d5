//! How well discovery names a hidden effect: recordings made without the library's laws, cells of a
//! matrix, and what counts as a hit.

pub mod cell;
pub mod hidden;
pub mod motion;
pub mod size;
pub mod table;
