//! What a discovery found, as data: numbers, units and names, no computing. The bottom of the crate.

/// The published schema of a [`Discovery`] in JSON (draft 2020-12), as `aep discover --json` writes it.
pub const SCHEMA: &str = include_str!("../../schema/discovery.schema.json");

mod candidate;
mod combination;
mod confirmation;
mod course;
mod decision;
mod diagnosis;
mod discovery;
mod explained;
mod metrics;
mod missing_force;
mod place;
mod plot;
mod refusal;
mod remains;
mod remark;
mod residual_map;
mod rung;
mod samples;
mod surrogates;
mod verdict;
mod view;

pub use candidate::{Candidate, DetectionLimit, NamedValue};
pub use combination::{Combination, Combinations};
pub use confirmation::{Confirmation, Confirmed};
pub use course::Course;
pub use decision::{Decision, Outcome, Reason};
pub use diagnosis::{Diagnosis, Independence, Line, LineOf, Relation, Whiteness};
pub use discovery::Discovery;
pub use explained::Explained;
pub use metrics::{Metrics, SplitMetrics};
pub use missing_force::MissingForce;
pub use place::{Pattern, RegimeShare, Where};
pub use plot::{Curve, Plot};
pub use refusal::Refusal;
pub use remains::{Astray, Fault, NoCause, Remains};
pub use remark::{Lacking, Remark};
pub use residual_map::{MapBin, ResidualMap};
pub use rung::{Estimate, NamedError, Rung, SplitError, floor_key, relative_key};
pub use samples::{Compared, Law, LawBin, Samples, Track};
pub use surrogates::Surrogates;
pub use verdict::{Ambiguity, Budget, Verdict};
pub use view::{Caveat, Compares, Disagreement, View};
