//! A recording as it is read: what is searched of it, and what its input does between samples.

use super::Ahead;
use super::compare::Comparison;
use super::fit::evaluated;
use super::found::Found;
use super::node::Node;
use super::residuals::Residuals;
use crate::family::{Fitted, ModelFamily};

/// A recording as it is read: how its input acts between samples.
pub struct Reading<'a> {
    pub(super) family: &'a dyn ModelFamily,
    pub(super) whole: Box<dyn Ahead + 'a>,
    pub(super) part: Option<Box<dyn Ahead + 'a>>,
    /// Whether the errors are residuals.
    pub(super) residuals: bool,
}

impl<'a> Reading<'a> {
    /// That of a family that predicts one sample ahead.
    pub fn of(family: &'a dyn ModelFamily) -> Option<Self> {
        let (whole, part) = (family.ahead()?, family.ahead_in_part());
        Some(Self { family, whole, part, residuals: false })
    }

    /// The same, more of it searched.
    pub(super) fn longer(family: &'a dyn ModelFamily) -> Option<Self> {
        let (whole, part) = (family.ahead()?, family.ahead_in_longer_part());
        Some(Self { family, whole, part, residuals: false })
    }

    /// That of a family that only gives residuals, whose noise the residual of `base` shows.
    pub fn of_residuals(family: &'a dyn ModelFamily, base: &Fitted) -> Self {
        Self { family, whole: Box::new(Residuals::new(family, base)), part: None, residuals: true }
    }

    /// What is searched.
    pub(super) fn searched(&self) -> &dyn Ahead {
        self.asked(true)
    }

    /// All of it, or what is searched.
    pub(super) fn asked(&self, on_part: bool) -> &dyn Ahead {
        self.part.as_deref().filter(|_| on_part).unwrap_or(&*self.whole)
    }

    /// The same, its errors judged by what an autoregression leaves of them.
    pub(super) fn coloured(&self) -> Option<Reading<'_>> {
        let part = self.part.as_ref().map(|part| part.coloured());
        let whole = self.whole.coloured()?;
        let part = part.flatten();
        Some(Reading { family: self.family, whole, part, residuals: self.residuals })
    }

    /// Whether residuals as they are fall by what was found in whitened ones: noise of a colour that nobody stated leaves
    /// no model complete, and hides in them what whitened ones show.
    pub(super) fn bears_out(&self, found: &Found) -> bool {
        let Some(top) = found.rungs.last().filter(|_| self.residuals) else { return false };
        let as_it_is = |node: &Node| evaluated(&*self.whole, node.model.clone(), 0);
        let comparison = Comparison::new(self.family, &*self.whole);
        comparison.compare(&as_it_is(&found.base), &as_it_is(top)).nats > 0.0
    }
}

/// The other way to read a recording.
pub(super) struct Other<'a> {
    pub(super) reading: Reading<'a>,
    /// By how many nats the simplest model prefers the first, and whether that decides until effects say otherwise.
    pub(super) nats: f64,
    pub(super) decided: bool,
}

impl Other<'_> {
    pub(super) fn coloured(&self) -> Option<Other<'_>> {
        Some(Other { reading: self.reading.coloured()?, ..*self })
    }

    /// The same, more of it searched.
    pub(super) fn longer(&self) -> Option<Other<'_>> {
        Some(Other { reading: Reading::longer(self.reading.family)?, ..*self })
    }
}
