//! What an effect is mistaken for.

/// Effects that look alike in ordinary motion, and what tells them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Apart {
    /// Names of the others.
    pub from: &'static [&'static str],
    /// The experiment, without a full stop at its end.
    pub experiment: &'static str,
}
