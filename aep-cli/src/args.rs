//! Arguments that several commands share.

mod data;
mod effects;
mod horizon;
mod run;

pub use data::{DataArgs, MappingArgs, words};
pub use effects::{EffectNames, add_files, known, library};
pub use horizon::{Compared, TimeArgs, TimeTask};
pub use run::{OutputArgs, RunArgs};
