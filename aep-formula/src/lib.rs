//! Formulas as users write them: parsed with the place of every mistake, bounded in size, evaluated fast.
//!
//! ```text
//! comparison  a < b  a <= b  a > b  a >= b  a == b  a != b      1 where it holds, else 0
//! sum         a + b  a - b
//! product     a * b  a / b  a % b                               % is the remainder, with the sign of a
//! power       a ^ b  a ** b                                     from the right: 2^3^2 is 2^9
//! functions   see [`FUNCTIONS`]
//! names       letters, digits, _ and . ; any other name stands in backticks: `Motor force [N]`
//! ```
//!
//! `-x^2` is refused, as it is read one way here and the other way there: write `-(x^2)` or `(-x)^2`.

mod error;
mod functions;
mod parse;
mod program;

pub use error::FormulaError;
pub use functions::{FUNCTIONS, Function, constant};
pub use program::Formula;

/// Most bytes of a formula.
pub const MOST_LENGTH: usize = 4096;
/// Most brackets, signs and powers inside one another.
pub const MOST_DEPTH: usize = 64;

/// The example of the README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
