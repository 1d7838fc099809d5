//! Why a simulation stops.

/// Why a simulation stops or cannot start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The state is NaN or infinite.
    #[error(
        "the simulation runs away at {time} s, driven by '{effect}'\n\
         lower its parameters or the longest step"
    )]
    NotFinite {
        /// Time of the step, s.
        time: f64,
        /// The effect with a force that is not finite, or else the one with the largest force.
        effect: String,
    },
    /// A recording that cannot drive a simulation.
    #[error(transparent)]
    Recording(#[from] missing_physics::RecordingError),
    /// Times and forces do not fit together.
    #[error("{samples} times, but {values} values of the input")]
    Length {
        /// Number of times.
        samples: usize,
        /// Number of forces.
        values: usize,
    },
    /// Time does not increase.
    #[error("time goes from {before} s to {after} s at sample {index}: it must increase")]
    Time {
        /// Sample, from 0.
        index: usize,
        /// Time of the sample before, s.
        before: f64,
        /// Time of this sample, s.
        after: f64,
    },
    /// No plant at all.
    #[error("there is no plant to simulate")]
    Empty,
    /// Plants of different effects cannot share a batch.
    #[error("a batch takes plants of the same effects: {first} against {other}")]
    Structure {
        /// Effects of the first plant.
        first: String,
        /// Effects of the plant that does not fit.
        other: String,
    },
    /// A setting that no simulation can use.
    #[error("{name} is {value}; {need}")]
    Setting {
        /// Which setting.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        need: &'static str,
    },
}
