//! What a model is made of: terms and their parameters.

use aep_core::Scale;

/// What a parameter does to the prediction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The prediction is (nearly) linear in it and the term is absent at 0.
    Amplitude,
    /// Everything else: a characteristic velocity, a period, a time constant.
    Shape,
}

/// One parameter of a term. Its sign is physics: `lower = 0` says that it cannot be negative.
#[derive(Clone, Debug, PartialEq)]
pub struct TermParameter {
    /// Name, e.g. `level`.
    pub name: String,
    /// SI unit, e.g. `N`.
    pub unit: String,
    /// Amplitude or shape.
    pub role: Role,
    /// Lower limit.
    pub lower: f64,
    /// Upper limit.
    pub upper: f64,
    /// Scale on which it is searched.
    pub scale: Scale,
    /// Where a search starts; for what is searched on a linear scale also its typical size. A fit measures its steps by it, or by
    /// the value where that is larger: what has 0 for both stays where it is.
    pub start: f64,
}

/// One term that a model may have.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Identifier used in files and commands.
    pub name: String,
    /// The term in words.
    pub title: String,
    /// Its equation as text.
    pub equation: String,
    /// Its parameters, in the order in which values are given.
    pub parameters: Vec<TermParameter>,
    /// True where every model has it and it is no candidate (an inertia).
    pub always: bool,
}

impl Term {
    /// A term without parameters: its name, what it is, its equation as text.
    pub fn new(name: &str, title: &str, equation: &str) -> Self {
        Self {
            name: name.to_owned(),
            title: title.to_owned(),
            equation: equation.to_owned(),
            parameters: Vec::new(),
            always: false,
        }
    }

    /// With an amplitude within `range`, on a linear scale.
    #[must_use]
    pub fn amplitude(self, name: &str, unit: &str, range: (f64, f64), start: f64) -> Self {
        self.parameter((name, unit), Role::Amplitude, range, Scale::Linear, start)
    }

    /// With a positive shape within `range`, on a logarithmic scale.
    #[must_use]
    pub fn shape(self, name: &str, unit: &str, range: (f64, f64), start: f64) -> Self {
        self.parameter((name, unit), Role::Shape, range, Scale::Log, start)
    }

    fn parameter(
        mut self,
        (name, unit): (&str, &str),
        role: Role,
        (lower, upper): (f64, f64),
        scale: Scale,
        start: f64,
    ) -> Self {
        let (name, unit) = (name.to_owned(), unit.to_owned());
        self.parameters.push(TermParameter { name, unit, role, lower, upper, scale, start });
        self
    }

    /// As part of every model.
    #[must_use]
    pub fn always(mut self) -> Self {
        self.always = true;
        self
    }

    /// The key of a parameter in reports: `term.parameter`, or just the name where both are equal.
    pub fn key(&self, parameter: &TermParameter) -> String {
        if self.name == parameter.name {
            return self.name.clone();
        }
        format!("{}.{}", self.name, parameter.name)
    }
}
