//! What several crates do together.

mod c_export;
mod hidden_effect;
mod model_file;
mod own_effect;
mod same_bits;
mod schema;
mod table;
