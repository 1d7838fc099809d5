//! The force without its noise.
//!
//! A drive that reports a measured current reports noise, too, which did not act. A lag of the actuator or a delay takes the
//! mean over some samples and predicts better for it, whatever the drive; a filter that delays nothing does so better still.
//! Where the lag is the drive's, it comes late, and the filter does not help.

use std::sync::OnceLock;

use missing_physics::{Channel, Fitted};

use super::filter::LowPass;
use super::{FrictionFamily, Options};

/// Cut-offs of the filter as shares of the sampling frequency.
const CUTOFFS: [f64; 4] = [0.2, 0.1, 0.05, 0.025];

/// The same recording with its force through each filter, made where it is asked for.
pub(super) type Filtered = [OnceLock<Option<Box<FrictionFamily>>>; CUTOFFS.len()];

impl FrictionFamily {
    /// A model without what makes the force late.
    pub(super) fn in_time(&self, model: &Fitted) -> Fitted {
        let late = (0..model.terms.len()).filter(|place| self.lateness(model, *place).is_some());
        late.fold(model.clone(), |left, place| left.without(self, model.terms[place]))
    }

    /// The same recording with its force through one of the filters, each lower than the one before.
    pub(super) fn filtered(&self, which: usize) -> Option<&Self> {
        let given = self.given.is_some() || self.smoothing.is_some();
        let filtered = self.filtered.get(which).filter(|_| !given)?;
        filtered.get_or_init(|| self.below(CUTOFFS[which]).map(Box::new)).as_deref()
    }

    fn below(&self, cutoff: f64) -> Option<Self> {
        let bandwidth = Some(self.prepared.bandwidth);
        let (library, known) = (self.library.clone(), self.known.clone());
        let options = Options { bandwidth, library, known };
        let filter = LowPass::new(cutoff);
        let mut channels: Vec<Channel> = self.recording.channels().to_vec();
        let force = channels.iter_mut().find(|channel| channel.name == "force")?;
        let pieces = self.recording.segments().iter();
        force.values = pieces.flat_map(|piece| filter.run(&force.values[piece.clone()])).collect();
        let recording = self.recording.clone().with_channels(channels).ok()?;
        let family = Self::of_any_length(&recording, &options).ok()?.with_stroke_of(self);
        // What did not act stays in the band of the filter: it is noise of a sensor.
        let noise = self.ahead.as_ref()?.predictor.noise().force_at_most;
        let ahead = family.ahead.as_ref().map(|ahead| ahead.with_force_noise(noise));
        let smoothing = Some(cutoff / self.prepared.interval);
        let family = Self { smoothing, ahead, hold: self.hold, jitter: self.jitter, ..family };
        match &self.on_view {
            Some(shown) => family.shown_below(shown.prepared.bandwidth).ok(),
            None => Some(family),
        }
    }
}

#[cfg(test)]
mod tests {
    use missing_physics::{Hold, ModelFamily};

    use crate::family::HoldChoice;
    use crate::family::testing::{family, model};

    #[test]
    fn a_filter_takes_the_noise_of_a_force_and_nothing_of_a_slow_one() {
        let mut family = family();
        family.hold = Some(HoldChoice { hold: Hold::Sampled, nats: 1.0, by_search: true });
        let (first, last) = (family.filtered(0).unwrap(), family.filtered(3).unwrap());
        assert!(family.filtered(4).is_none() && first.filtered(0).is_none());
        let below = |family: &super::FrictionFamily| family.smoothing.unwrap().round();
        assert_eq!((below(first), below(last)), (200.0, 25.0));
        assert_eq!(last.recording.len(), family.recording.len());
        // What may be the hold may be it here, too.
        assert_eq!(last.hold, family.hold);
        let force = |family: &super::FrictionFamily| -> Vec<f64> {
            family.recording.channel("force").unwrap().values.clone()
        };
        // A sine of 1 Hz and 28 N.
        let off = |(a, b): (&f64, &f64)| (a - b).abs();
        let most = force(&family).iter().zip(&force(last)).map(off).fold(0.0, f64::max);
        assert!(most < 0.05, "{most}");
        // What is left of its noise in the band is that of a sensor.
        let noise =
            |family: &super::FrictionFamily| *family.ahead.as_ref().unwrap().predictor.noise();
        let quick = noise(&family).force_at_most;
        assert!(noise(&family).force < quick);
        assert_eq!((noise(first).force, noise(last).force), (quick, quick));
    }

    #[test]
    fn a_model_in_time_has_no_lag_and_no_delay() {
        let family = family();
        let late = model(&family, &["mass", "coulomb", "actuator-lag", "stribeck"], &[]);
        let in_time = family.without_lateness(&late);
        assert_eq!(in_time, late.without(&family, late.terms[2]));
        assert_eq!(family.without_lateness(&in_time), in_time);
    }
}
