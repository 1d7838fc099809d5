//! Arguments that several commands share.

mod control;
mod data;
mod effects;
mod horizon;
mod known;
mod run;
mod series;
mod shell;

pub use control::{LoopArgs, ReferenceArgs};
pub use data::{DataArgs, MappingArgs, words};
pub use effects::{EffectNames, add_files, add_regressors, known, library};
pub use horizon::{Compared, TimeArgs};
pub use known::KnownArgs;
pub use run::{LimitArgs, OutputArgs, RunArgs};
pub use series::{SeriesArgs, axis_path};
pub use shell::{flag, quoted};
