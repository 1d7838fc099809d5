//! Arguments that several commands share.

mod control;
mod data;
mod effects;
mod run;

pub use control::{LoopArgs, ReferenceArgs};
pub use data::{DataArgs, MappingArgs, words};
pub use effects::{EffectNames, known};
pub use run::{OutputArgs, RunArgs};
