//! What a residual may depend on, and what is compared.

/// What is compared: the predicted quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ComparedQuantity {
    /// Name, e.g. `force`.
    pub name: String,
    /// SI unit, e.g. `N`.
    pub unit: String,
}

/// Something that the residual may depend on.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// Name, e.g. `position`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// One value per grid point.
    pub values: Vec<f64>,
    /// Where given, the residual is multiplied by it before it is looked at: +1 and -1 for the
    /// direction of motion show what opposes motion.
    pub parity: Option<Vec<f64>>,
    /// True where it is part of the state that the physics depends on (a position, a velocity; not
    /// the time): the noise floor compares instants of nearly the same state.
    pub state: bool,
}

impl Coordinate {
    /// Part of the state that the physics depends on; one value per grid point.
    pub fn of_state(name: &str, unit: &str, values: Vec<f64>) -> Self {
        let (name, unit) = (name.to_owned(), unit.to_owned());
        Self { name, unit, values, parity: None, state: true }
    }
}

/// A regime of the experiment. The regimes of a family do not overlap and cover every grid point.
#[derive(Clone, Debug, PartialEq)]
pub struct Regime {
    /// Name, e.g. `reversal`.
    pub name: String,
    /// Whether a grid point belongs to it.
    pub member: Vec<bool>,
}
