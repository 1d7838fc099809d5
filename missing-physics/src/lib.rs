//! Tells what a model lacks.
//!
//! A measurement is compared with a model; the residual shows *where* the model fails, a screening of
//! candidate terms shows *which* one is missing, and a ladder of refits shows what each of them gains
//! on held-out data. The engine knows nothing of friction or any other subject: it works for every
//! [`ModelFamily`](family::ModelFamily).

pub mod data_check;
pub mod quantity;
pub mod recording;
pub mod report;

pub use recording::{Channel, Hold, Recording, RecordingError};
pub use report::Discovery;
