//! What is known of a test function.

/// A test function: equation, domain, optimum, reference.
#[derive(Clone, Copy, Debug)]
pub struct Definition {
    /// Short name, as used on the command line.
    pub name: &'static str,
    /// The equation in plain text.
    pub equation: &'static str,
    /// What makes it easy or hard.
    pub character: &'static str,
    /// Where it was defined.
    pub reference: &'static str,
    /// Numbers of components it is defined for.
    pub dimension: Dimension,
    /// Limits of every component.
    pub limits: (f64, f64),
    /// The cost.
    pub cost: fn(&[f64]) -> f64,
    /// A position with the smallest cost, for a given number of components.
    pub optimum: fn(usize) -> Vec<f64>,
    /// How far above the smallest cost a run counts as successful.
    pub tolerance: f64,
    /// How the optimum is moved.
    pub shift: Shift,
}

/// Numbers of components a function is defined for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Only this one.
    Fixed(usize),
    /// Any from `least` on.
    Any {
        /// The smallest one.
        least: usize,
        /// The one used when none is asked for.
        usual: usize,
    },
}

/// How a function's optimum is moved to another place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shift {
    /// The function is translated; used where the optimum lies inside and costs rise beyond the
    /// domain too.
    Translate,
    /// The function is translated and what leaves the domain comes in on the other side; used
    /// where the optimum lies at the border or lower costs lie outside.
    Wrap,
}

impl Dimension {
    /// The number of components when none is asked for.
    pub fn usual(self) -> usize {
        match self {
            Self::Fixed(n) | Self::Any { usual: n, .. } => n,
        }
    }

    /// Whether the function is defined for `n` components.
    pub fn admits(self, n: usize) -> bool {
        match self {
            Self::Fixed(fixed) => n == fixed,
            Self::Any { least, .. } => n >= least,
        }
    }
}

impl std::fmt::Display for Dimension {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Fixed(n) => write!(f, "{n}"),
            Self::Any { least, usual } => write!(f, "{least}.. (usually {usual})"),
        }
    }
}
