//! An effect as a fit left it.

/// What an effect needs to know of a fit to say whether it still is that effect.
#[derive(Clone, Copy, Debug)]
pub struct AsFound<'a> {
    /// Its fitted parameters in the order of its [`super::About`], SI.
    pub values: &'a [f64],
    /// Where the search for each of them ended below.
    pub least: &'a [f64],
    /// Where it ended above.
    pub most: &'a [f64],
    /// Mass or inertia of the model.
    pub mass: f64,
    /// Root mean square of the recorded force.
    pub force: f64,
    /// One count of the position, m or rad: that of the encoder, or of one whose counts are as large as the noise.
    pub count: f64,
    /// How far the model's contact gives before it slides, m or rad; 0 without one.
    pub give: f64,
}

/// What a fit left within this factor of an end of its search is there.
pub const AT_END: f64 = 1.001;

impl AsFound<'_> {
    /// Why an effect is none whose parameter at place `k`, of this name, ended within a `factor` of where its search begins.
    pub fn at_least(
        &self,
        (k, name): (usize, &'static str),
        factor: f64,
        meaning: &'static str,
    ) -> Option<Refused> {
        self.within((k, name), factor * self.least[k], meaning)
    }

    /// The same of one that is no larger than a `limit`.
    pub fn within(
        &self,
        (k, name): (usize, &'static str),
        limit: f64,
        meaning: &'static str,
    ) -> Option<Refused> {
        let value = self.values[k];
        (value <= limit).then_some(Refused { name, value, limit, unit_of: name, meaning })
    }
}

/// Why a fitted effect no longer is that effect: a value at which it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refused {
    /// The parameter, or what several of them make.
    pub name: &'static str,
    /// Its value, SI.
    pub value: f64,
    /// What it was held against, SI.
    pub limit: f64,
    /// Parameter of the table whose unit both have.
    pub unit_of: &'static str,
    /// What it means, in a few words.
    pub meaning: &'static str,
}
