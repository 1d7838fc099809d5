//! The bandwidth below which people look at a force.
//!
//! A search looks for where to begin below a bandwidth of its own, as wide as the noise of the position leaves it: a ripple
//! that a narrower one hides must not be missed because someone wants to see a smoother curve.

use missing_physics::Recording;

use super::{FrictionFamily, Options};
use crate::family::preparation::PreparationError;

impl FrictionFamily {
    /// The same as people are shown it: itself, but where another bandwidth was asked for.
    pub fn on_view(&self) -> &Self {
        self.on_view.as_deref().unwrap_or(self)
    }

    /// Prepares a recording for a search, as [`FrictionFamily::new`] does: the bandwidth that is chosen is that of what is shown.
    ///
    /// # Errors
    /// A channel is missing or constant, or too little of the recording moves.
    pub fn to_search(recording: &Recording, options: &Options) -> Result<Self, PreparationError> {
        let family = Self::new(recording, &Options { bandwidth: None, ..options.clone() })?;
        match options.bandwidth {
            Some(bandwidth) => family.shown_below(bandwidth),
            None => Ok(family),
        }
    }

    /// The same, with what is shown of a search below `bandwidth`, Hz. Beside a given force, whose errors are forces, a search
    /// compares below it, too.
    ///
    /// # Errors
    /// Below it too little of the recording moves.
    pub(super) fn shown_below(self, bandwidth: f64) -> Result<Self, PreparationError> {
        let (library, known) = (self.library.clone(), self.known.clone());
        let options = Options { bandwidth: Some(bandwidth), library, known };
        let shown = Self::as_recorded(&self.recording, &options)?.with_stroke_of(&self);
        if self.given.is_some() {
            return Ok(shown);
        }
        let other = self.other_hold.map(|other| other.shown_below(bandwidth)).transpose()?;
        Ok(Self { other_hold: other.map(Box::new), on_view: Some(Box::new(shown)), ..self })
    }
}

#[cfg(test)]
mod tests {
    use missing_physics::ModelFamily;

    use crate::family::testing::family;

    #[test]
    fn what_is_shown_has_its_bandwidth_and_what_is_searched_its_own() {
        let own = family().prepared.bandwidth;
        let family = family().shown_below(10.0).unwrap();
        assert_eq!((family.prepared.bandwidth, family.on_view().prepared.bandwidth), (own, 10.0));
        let names = |of: &super::FrictionFamily| -> Vec<String> {
            of.terms().iter().map(|term| term.name.clone()).collect()
        };
        assert_eq!(names(&family), names(family.on_view()));
        assert!(family.on_view().target().len() < family.target().len());
        assert_eq!(family.stroke, family.on_view().stroke);
        // What is read otherwise is shown alike.
        let filtered = family.filtered(0).unwrap();
        assert_eq!(filtered.on_view().prepared.bandwidth, 10.0);
        assert_eq!(filtered.on_view().recording.channels(), filtered.recording.channels());
        if let Some(other) = &family.other_hold {
            assert_eq!(other.on_view().prepared.bandwidth, 10.0);
        }
    }
}
