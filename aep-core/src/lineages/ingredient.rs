//! What the method is made of.

use serde::{Deserialize, Serialize};

/// A part of [`super::Lineages`] that can be left out, to see what it is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Ingredient {
    /// AEP's direction: C is stretched along the path of the parent; in a population, children of
    /// age 1 go where the last success went.
    Direction,
    /// AEP's age: it ends a lineage that no longer becomes better; in a population it sets the step
    /// and lets old individuals adopt a better parent.
    Age,
    /// AEP's contest of child and parent: a lineage is given up that cannot become better than the
    /// best one; in a population a child takes its own parent's place only (without: the better
    /// half of all parents and children stays).
    Contest,
    /// The best position of a lineage that no longer becomes better is evaluated once more. Where its cost is another one,
    /// age is told by the median of a generation, and there is no contest of lineages: the lowest cost is chance's.
    Reevaluation,
    /// Negative weights: C shrinks along the steps of bad children.
    NegativeWeights,
    /// The quadratic model that takes the place of evaluations.
    Model,
    /// The search along components where the cost is a sum over them.
    Components,
    /// Descents on the residuals, where the problem tells them.
    Descents,
    /// Lineages of few children and short first steps.
    SmallLineages,
    /// Lineages of more and more children.
    LargeLineages,
    /// Populations of individuals by AEP's rules.
    Populations,
}

impl Ingredient {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Direction,
        Self::Age,
        Self::Contest,
        Self::Reevaluation,
        Self::NegativeWeights,
        Self::Model,
        Self::Components,
        Self::Descents,
        Self::SmallLineages,
        Self::LargeLineages,
        Self::Populations,
    ];
    /// Its name, for tables and command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Direction => "direction",
            Self::Age => "age",
            Self::Contest => "contest",
            Self::Reevaluation => "re-evaluation",
            Self::NegativeWeights => "negative-weights",
            Self::Model => "model",
            Self::Components => "components",
            Self::Descents => "descents",
            Self::SmallLineages => "small-lineages",
            Self::LargeLineages => "large-lineages",
            Self::Populations => "populations",
        }
    }
}
