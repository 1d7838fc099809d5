//! Arguments that several commands share.

mod control;
mod data;
mod effects;
mod horizon;
mod run;

pub use control::{LoopArgs, ReferenceArgs};
pub use data::{DataArgs, MappingArgs, words};
pub use effects::{EffectNames, add_files, known, library};
pub use horizon::{Compared, TimeArgs, TimeTask};
pub use run::{LimitArgs, OutputArgs, RunArgs};
