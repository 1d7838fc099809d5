//! Recordings of axes that share nothing with the library's simulator: other laws, another integrator, other
//! motions and controllers; and what a discovery says of them.
//!
//! A *case* hides one thing in one *machine*; a *recording* follows from case, level and seed alone.

pub mod case;
pub mod contact;
pub mod drive;
pub mod fault;
pub mod hidden;
pub mod integrator;
pub mod judge;
pub mod level;
pub mod machine;
pub mod motion;
pub mod plant;
pub mod random;
pub mod record;
pub mod score;
pub mod select;
pub mod sweep;
pub mod visibility;
pub mod write;
