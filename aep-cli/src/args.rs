//! Arguments that several commands share.

mod data;
mod effects;
mod run;

pub use data::{DataArgs, MappingArgs, words};
pub use effects::{EffectNames, known};
pub use run::{OutputArgs, RunArgs};
