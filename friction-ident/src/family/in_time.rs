//! Identification by simulation that begins where the comparison of forces ends.

use aep_core::{Aep, Budget, Method};
use missing_physics::fit::Until;
use missing_physics::{ModelFamily, Recording, identify};

use super::FrictionFamily;
use crate::Identification;
use crate::effects::Effect;
use crate::identify::{self as by_simulation, Horizon, IdentifyError, Searched, all_free};
use crate::model::{Model, ModelError};

impl FrictionFamily {
    /// Identifies a model of `effects` by simulating it over `recording`, that of this family, from the values that the
    /// comparison of forces gives; once `until` is over with what there is.
    ///
    /// # Errors
    /// Unknown effects, effects that do not fit together, or channels that the horizon needs.
    pub fn identify_in_time(
        &self,
        recording: &Recording,
        effects: &[String],
        horizon: Horizon,
        (method, budget, seed): (&dyn Method, &Budget, u64),
        until: Until<'_>,
    ) -> Result<Searched, IdentifyError> {
        let first = self.first_guess(recording, effects, seed, until)?;
        let problem = Identification::new(&first, recording, &all_free(&first), horizon)?;
        problem.until(until).from_several_starts(method, budget, seed)
    }

    /// Values from the comparison of forces; typical ones for effects that it cannot show.
    fn first_guess(
        &self,
        recording: &Recording,
        effects: &[String],
        seed: u64,
        until: Until<'_>,
    ) -> Result<Model, IdentifyError> {
        let is_shown = |name: &&String| self.terms().iter().any(|term| &term.name == *name);
        let shown: Vec<String> = effects.iter().filter(is_shown).cloned().collect();
        let found = identify(self, &shown, (&Aep::practical(), seed), until)?;
        let values = self.model(&found.fit.model)?;
        let effects = effects.iter().map(|name| Ok(self.library.find(name)?));
        let effects: Vec<&dyn Effect> = effects.collect::<Result<_, ModelError>>()?;
        Ok(by_simulation::first_guess(&values, &effects, recording)?)
    }
}
