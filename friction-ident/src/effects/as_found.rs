//! An effect as a fit left it.

/// What an effect needs to know of a fit to say whether it still is that effect.
#[derive(Clone, Copy, Debug)]
pub struct AsFound<'a> {
    /// Its fitted parameters in the order of its [`super::About`], SI.
    pub values: &'a [f64],
    /// Where the search for each of them ended below.
    pub least: &'a [f64],
    /// Mass or inertia of the model.
    pub mass: f64,
    /// Root mean square of the recorded force.
    pub force: f64,
}
