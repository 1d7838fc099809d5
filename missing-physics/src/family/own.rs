//! What belongs to a recording, not to the plant.

/// A number that may differ between recordings of one and the same plant: where homing put the position's zero, how warm
/// the oil was.
#[derive(Clone, Debug, PartialEq)]
pub struct Own {
    /// Name.
    pub name: &'static str,
    /// Unit; empty for a factor.
    pub unit: String,
    /// Where it changes nothing.
    pub neutral: f64,
    /// Values to begin with, in order; the best lies between neighbours of the best of them.
    pub trials: Vec<f64>,
}
