//! Why a model has no error in some view.

use missing_physics::RecordingError;
use thiserror::Error;

use crate::closed_loop::ClosedLoopError;
use crate::simulator::SimulationError;
use crate::windows::WindowError;

/// Why there is no such view of a model.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NoView {
    /// What is simulated needs a force that depends on the motion.
    #[error(
        "the model's force is given over time: its motion cannot be simulated, so that there are no windows and no free run"
    )]
    ForceGiven,
    /// Windows of this length cannot be simulated.
    #[error("windows of {length} s: {source}")]
    Windows {
        /// s.
        length: f64,
        /// What is wrong with them.
        source: WindowError,
    },
    /// No window lies on fitted or on held-out data, or the model runs away in all.
    #[error(
        "windows of {length} s: there are none on fitted or on held-out data, or the model runs away"
    )]
    NoWindows {
        /// s.
        length: f64,
    },
    /// The model cannot be simulated from the first sample.
    #[error("free run: {0}")]
    FreeRun(#[from] SimulationError),
    /// A channel is missing.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// Nothing says where the drive was to go.
    #[error("closed loop: the recording has no channel 'reference'")]
    NoReference,
    /// A loop is followed from one start only.
    #[error("closed loop: the recording has several segments")]
    SeveralSegments,
    /// A controller has one sample time.
    #[error("closed loop: the recording is not sampled uniformly")]
    NotUniform,
    /// The force does not show the controller.
    #[error(
        "closed loop: only {:.0} % of the force follows from reference and position, so that the controller is not known",
        100.0 * .described
    )]
    UnknownController {
        /// Share of the variance of the force that a linear law describes, 0..1.
        described: f64,
    },
    /// The loop cannot be simulated.
    #[error("closed loop: {0}")]
    ClosedLoop(#[from] ClosedLoopError),
}
