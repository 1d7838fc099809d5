//! A statement of the paper beside what comes out here.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Whether a statement of the paper holds here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It does.
    Agrees,
    /// It does not.
    Differs,
    /// The paper does not say enough to tell.
    CannotBeKnown,
}

impl From<bool> for Verdict {
    fn from(agrees: bool) -> Self {
        if agrees { Self::Agrees } else { Self::Differs }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Agrees => "agrees",
            Self::Differs => "does not",
            Self::CannotBeKnown => "cannot be known",
        })
    }
}

/// A statement of the paper beside what our runs say.
///
/// ```
/// use aep_problems::paper::{Claim, Verdict};
/// let claim = Claim::new("PD alone", "stick-slip", "7 stick episodes", Verdict::Agrees);
/// let other = Claim::new("K_P", "0.1", "unstable at 5 ms", Verdict::CannotBeKnown)
///     .because("the paper prints no units");
/// assert!(claim.reason.is_none() && other.reason.is_some());
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Claim {
    /// Which line or quantity.
    pub about: String,
    /// What is printed.
    pub paper: String,
    /// What comes out here.
    pub ours: String,
    /// Whether the two agree.
    pub verdict: Verdict,
    /// Why, where the numbers alone do not say.
    pub reason: Option<String>,
}

impl Claim {
    /// A claim whose numbers speak for themselves; `verdict` may be a `bool`.
    pub fn new(
        about: impl Into<String>,
        paper: impl Into<String>,
        ours: impl Into<String>,
        verdict: impl Into<Verdict>,
    ) -> Self {
        let (about, paper, ours) = (about.into(), paper.into(), ours.into());
        Self { about, paper, ours, verdict: verdict.into(), reason: None }
    }

    /// The same with a reason.
    #[must_use]
    pub fn because(self, reason: impl Into<String>) -> Self {
        Self { reason: Some(reason.into()), ..self }
    }

    /// Whether the two agree.
    pub fn agrees(&self) -> bool {
        self.verdict == Verdict::Agrees
    }
}
