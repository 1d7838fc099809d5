//! The task: what is asked of a discovery, and who watches it.

mod event;
mod names;
mod settings;
mod thresholds;

pub use event::{Event, Observer};
pub use names::{DiscoverError, model_of, terms, terms_of_model};
pub use settings::Settings;
pub use thresholds::Thresholds;
