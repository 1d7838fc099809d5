//! Where fits of a second body begin: their valleys are narrow.

/// A second body with friction of its own: mass `m_L`, Coulomb friction `F_L`, viscous friction `d_L`. It takes over parts of
/// the model's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondBody {
    /// The parameter whose valley is narrow, and what it is tried at.
    pub along: Along,
    /// Damping ratio, `zeta`, that it begins with.
    pub damping: f64,
    /// Shares of the model's friction that it is tried with.
    pub shares: &'static [f64],
    /// Factors on that parameter at which other valleys are looked for beside a fit.
    pub factors: &'static [f64],
    /// The second body, by name, that it is hard to tell from: a fit of the one begins from that of the other, too.
    pub related: Option<&'static str>,
}

/// A parameter and the line that it is tried along, evenly on a logarithmic scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// The frequency `f`.
    Frequency {
        /// Trials.
        count: usize,
        /// The lowest, Hz.
        low: f64,
        /// The highest as a share of the sampling frequency.
        share: f64,
    },
    /// The width `b` of a gap.
    Gap {
        /// Trials.
        count: usize,
        /// The smallest in standard deviations of the measured position.
        deviations: f64,
        /// The largest as a share of the stroke.
        share: f64,
    },
}

impl Along {
    /// Name of the parameter.
    pub fn parameter(self) -> &'static str {
        match self {
            Self::Frequency { .. } => "f",
            Self::Gap { .. } => "b",
        }
    }
}
