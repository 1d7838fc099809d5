//! How often a recording like this one gets a name that is not there.

use missing_physics::ahead::fit;
use missing_physics::report::{Surrogates, Verdict};
use missing_physics::{Channel, DiscoverError, Recording, Settings, discover};

use super::ahead::View;
use super::{FrictionFamily, Options};
use crate::effects::formula::COLUMN;
use crate::effects::regressor::REGRESSOR;
use crate::model::Model;

impl FrictionFamily {
    /// A recording that `model` would have made under the same force, its own errors in another order; nothing where it
    /// cannot predict this one.
    pub fn surrogate(&self, model: &Model, seed: u64) -> Option<Recording> {
        let read = |family: &Self| {
            let ahead = View::new(family, family.ahead.as_ref()?);
            let fitted = family.fitted(model).ok()?;
            let setting = fit::best_setting(&ahead, &fitted);
            let node = fit::evaluated(&ahead, fitted, setting);
            let positions = ahead.ahead.predictor.surrogate(model, setting, seed)?;
            Some((node.scale, positions, family.recording.hold()))
        };
        let readings = std::iter::once(self).chain(self.other_hold.as_deref());
        let (_, positions, hold) = readings.filter_map(read).min_by(|a, b| a.0.total_cmp(&b.0))?;
        let force = self.recording.channel("force")?.clone();
        let position = self.recording.channel("position")?.clone();
        let mut channels = vec![force, Channel { values: positions, ..position }];
        // What laws and regressors read.
        let read = |name: &str| name.starts_with(COLUMN) || name.starts_with(REGRESSOR);
        channels.extend(self.recording.channels().iter().filter(|c| read(&c.name)).cloned());
        let mut piece = vec![0; self.recording.len()];
        for (number, segment) in (0..).zip(self.recording.segments()) {
            piece[segment.clone()].fill(number);
        }
        let time = self.recording.time().to_vec();
        let made = Recording::with_segments(self.recording.name(), time, channels, piece).ok()?;
        Some(made.with_hold(hold))
    }

    /// Searches `count` surrogates of `model` for what it lacks: nothing, so that every name is a false alarm. `begun`
    /// hears of each one before it is looked at and says whether to go on.
    ///
    /// # Errors
    /// [`DiscoverError`] where a surrogate cannot be searched.
    pub fn false_alarms(
        &self,
        model: &Model,
        (settings, options): (&Settings<'_>, &Options),
        count: usize,
        mut begun: impl FnMut(usize) -> bool,
    ) -> Result<Surrogates, DiscoverError> {
        let base = model.terms().iter().map(|term| term.name().to_owned()).collect();
        // One name is an alarm; a second one is no other.
        let start = self.fitted(model).ok();
        let settings = Settings { base, start, most: 1, ..settings.clone() };
        let mut alarms = Surrogates { asked: count, ..Surrogates::default() };
        for k in 0..count {
            if !begun(k) {
                break;
            }
            let Some(made) = self.surrogate(model, settings.seed + k as u64) else { continue };
            let Ok(family) = FrictionFamily::to_search(&made, options) else { continue };
            let found = discover(&family.with_stroke_of(self), &settings, &mut ())?;
            // Cut: silence then says nothing.
            if found.verdict == Verdict::Stopped {
                continue;
            }
            alarms.count += 1;
            if !found.added.is_empty() {
                alarms.named.push(found.added);
            }
        }
        Ok(alarms)
    }
}
