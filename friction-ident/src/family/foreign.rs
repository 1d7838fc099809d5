//! Whether a model and a recording, or two recordings, are of one kind of drive.

use missing_physics::fit::{Fit, as_given};
use missing_physics::report::Rung;
use missing_physics::{DiscoverError, model_of};

use super::{FrictionFamily, PreparationError};
use crate::axis::{Axis, Effort, Quantity};
use crate::model::{Model, ModelError};

/// Why a model and data do not belong together.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ForeignModel {
    /// Linear and rotary.
    #[error("one of model and data is of a linear axis, the other of a rotary one")]
    Axis,
    /// Forces in different units.
    #[error("the model is in {model}, but the force of the data is in {data}")]
    Effort {
        /// Unit of the model.
        model: &'static str,
        /// Unit of the data.
        data: &'static str,
    },
    /// The model has a mass, but the data have a force that another model gives.
    #[error(
        "the model has a mass of its own, but the data are read with a force that another model gives"
    )]
    WithMass,
    /// The model stands beside a given force, which the data do not have.
    #[error(
        "the model stands beside a force that another model gives, but the data are read without it"
    )]
    Beside,
    /// A law of the user that has no value somewhere on these data.
    #[error(transparent)]
    Law(#[from] PreparationError),
    /// An effect that the terms of these data do not have.
    #[error(transparent)]
    Term(#[from] DiscoverError),
    /// An effect that these data cannot have.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl Model {
    /// Whether this model is of such an axis, in this unit of force.
    ///
    /// # Errors
    /// It is of another one.
    pub fn is_of(&self, axis: Axis, effort: Effort) -> Result<(), ForeignModel> {
        if self.axis() != axis {
            return Err(ForeignModel::Axis);
        }
        if self.effort() != effort {
            let unit = |effort: Effort| effort.unit(axis, Quantity::Force);
            return Err(ForeignModel::Effort { model: unit(self.effort()), data: unit(effort) });
        }
        Ok(())
    }
}

impl FrictionFamily {
    /// Whether `model` is of this kind of drive (linear or rotary, the unit of its force, a mass of its own or none) and
    /// requires a force everywhere here.
    ///
    /// # Errors
    /// It is of another kind, or its law has no value somewhere.
    pub fn belongs(&self, model: &Model) -> Result<(), ForeignModel> {
        model.is_of(self.axis, self.effort)?;
        match (model.timing().is_some(), self.is_beside()) {
            (false, true) => Err(ForeignModel::WithMass),
            (true, false) => Err(ForeignModel::Beside),
            _ => Ok(self.check(model)?),
        }
    }

    /// A given model on this recording, nothing fitted.
    ///
    /// # Errors
    /// As [`Self::belongs`].
    pub fn as_given(&self, model: &Model) -> Result<Fit, ForeignModel> {
        self.belongs(model)?;
        Ok(as_given(self, self.fitted(model)?))
    }

    /// The plant that a rung describes, with what is known of it.
    ///
    /// # Errors
    /// An effect of the rung is not among this family's.
    pub fn plant(&self, rung: &Rung) -> Result<Model, ForeignModel> {
        Ok(self.model(&model_of(self, rung)?)?.with_known(self.known.clone()))
    }
}

#[cfg(test)]
mod tests {
    use missing_physics::Recording;

    use super::*;
    use crate::challenge::{Hide, Level, generate};
    use crate::effects::beside::MODEL_FORCE;
    use crate::family::Options;
    use crate::model::Timing;

    fn recording() -> Recording {
        generate(&Hide::Nothing, 1, Level::Clear).unwrap().recording
    }

    /// The same with a force that another model gives.
    fn beside(recording: &Recording) -> Recording {
        let mut given = recording.channel("force").unwrap().clone();
        given.name = MODEL_FORCE.to_owned();
        let channels = recording.channels().iter().cloned().chain([given]).collect();
        Recording::new("beside", recording.time().to_vec(), channels).unwrap()
    }

    #[test]
    fn a_model_of_another_kind_of_drive_is_refused_with_what_differs() {
        let recording = recording();
        let family = FrictionFamily::new(&recording, &Options::default()).unwrap();
        let linear = Model::new(Axis::Linear, 30.0).unwrap();
        assert_eq!(family.belongs(&linear), Ok(()));
        let rotary = Model::new(Axis::Rotary, 30.0).unwrap();
        assert_eq!(family.belongs(&rotary), Err(ForeignModel::Axis));
        let volts = linear.clone().with_effort(Effort::Volt);
        assert_eq!(family.belongs(&volts), Err(ForeignModel::Effort { model: "V", data: "N" }));
        let besides = Model::beside(Axis::Linear, Timing::default()).unwrap();
        assert_eq!(family.belongs(&besides), Err(ForeignModel::Beside));
        let given = FrictionFamily::new(&beside(&recording), &Options::default()).unwrap();
        assert_eq!(given.belongs(&besides), Ok(()));
        assert_eq!(given.belongs(&linear), Err(ForeignModel::WithMass));
    }
}
