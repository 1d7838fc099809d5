//! The seam between the engine and a subject: what a model is made of, what it predicts, and how the data look
//! one sample ahead.

mod ahead;
mod columns;
mod coordinate;
mod fitted;
mod fn_family;
mod full_rate;
mod generic;
mod model_family;
mod of_family;
mod other_reading;
mod own;
mod series;
pub mod shapes;
mod sizes;
mod term;
mod trials;

pub use ahead::{Ahead, Columns, Rival, Trial};
pub use columns::columns;
pub use coordinate::{ComparedQuantity, Coordinate, Regime};
pub use fitted::Fitted;
pub use fn_family::{FnFamily, Given};
pub use full_rate::FullRate;
pub use generic::Generic;
pub use model_family::ModelFamily;
pub(crate) use model_family::on_view;
pub use other_reading::OtherReading;
pub use own::Own;
pub use series::Series;
pub(crate) use sizes::detection_limit;
pub use sizes::sizes;
pub use term::{Role, Term, TermParameter};
pub use trials::trials;
