//! What can hide in a machine.

/// A law that the base model does not have, or a fault of the recording. Its size is a number in the unit
/// said here; 0 is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hidden {
    /// Nothing.
    Nothing,
    /// A hump of the level at low speed, `exp(-|v/v_s|)`; of the Coulomb level.
    StribeckExponential,
    /// `exp(-(v/v_s)^2)`; of the Coulomb level.
    StribeckGaussian,
    /// `1 - tanh |v/v_s|`; of the Coulomb level.
    StribeckTanh,
    /// A damped bristle; deflection, in short lengths of the machine.
    LuGre,
    /// Eight elements that slip one after the other; deflection, in short lengths.
    Maxwell,
    /// A level that heals at rest and wears off within a few micrometres; of the Coulomb level.
    Healing,
    /// A part of the mass on a spring, friction on either side; that part.
    Flexible,
    /// A part of mass and friction behind a gap; the gap, in short lengths.
    Backlash,
    /// A force periodic in the position, two harmonics; amplitude, of the Coulomb level.
    Ripple,
    /// A smooth random profile of the level; root mean square, of the Coulomb level.
    Profile,
    /// A level in proportion to the force of the drive; share.
    Load,
    /// A level in proportion to the force that accelerates; share.
    InertialLoad,
    /// Level and viscosity fall to their values exponentially; what they have too much at the start.
    Drift,
    /// A lag of the force of first order; in sampling intervals.
    Lag,
    /// Two equal lags in a row; in sampling intervals.
    SecondOrderLag,
    /// A delay; in sampling intervals.
    Delay,
    /// The largest force; what it cuts off the largest one needed, as a share.
    Saturation,
    /// The drive gives more to one side than to the other; half difference of the gains, of their mean.
    GainBySide,
    /// The drive gives less of a large command, by its square; share lost of the largest one needed.
    GainByCurrent,
    /// The drive's gain has a sine along the stroke, 1.6 to 8 periods; amplitude, of the mean gain.
    GainAlongStroke,
    /// Drag with the square of the speed; at full speed, of the Coulomb level.
    Drag,
    /// A spring; at the end of the stroke, of the Coulomb level.
    Spring,
    /// Level and viscosity by direction; relative difference to the mean.
    Asymmetry,
    /// Viscosity by direction alone; relative difference to the mean.
    ViscosityByDirection,
    /// A constant force, where the base model has none; of the Coulomb level.
    Offset,
    /// A force periodic in time; amplitude, of the Coulomb level.
    Periodic,
    /// The level changes at a moment; by this part.
    FrictionStep,
    /// Soft stops at the ends of the stroke; force at the very end, of the Coulomb level.
    SoftEnds,
    /// A level raised by acceleration in the past; of the Coulomb level.
    PastAcceleration,
    /// Positions not taken when the time stamps say; standard deviation, in sampling intervals.
    Jitter,
    /// Runs of samples that repeat an old position; share of the samples.
    Dropped,
    /// A block whose time stamps run too slowly; by this part.
    WrongStamps,
}

impl Hidden {
    /// Start, least and largest size of a search for one that shows as much as wanted. Beyond the largest
    /// the effect is the machine.
    pub fn limits(self) -> (f64, f64, f64) {
        match self {
            // Below two counts nobody could see it, however quiet the machine.
            Self::LuGre | Self::Maxwell => (1.0, 0.1, 20.0),
            Self::Backlash => (1.0, 0.01, 15.0),
            Self::Flexible => (0.2, 0.005, 0.7),
            Self::InertialLoad | Self::Load => (0.1, 5e-4, 0.7),
            Self::Lag | Self::SecondOrderLag => (0.3, 0.01, 2.0),
            Self::Delay => (0.4, 0.01, 1.6),
            Self::Saturation => (0.15, 0.005, 0.7),
            Self::Asymmetry | Self::ViscosityByDirection => (0.2, 0.002, 0.9),
            Self::GainBySide | Self::GainByCurrent | Self::GainAlongStroke => (0.1, 1e-3, 0.6),
            Self::Jitter => (0.1, 0.002, 0.4),
            Self::Dropped => (0.03, 1e-3, 0.3),
            Self::WrongStamps => (0.05, 1e-3, 0.8),
            Self::Drift | Self::FrictionStep | Self::Healing => (0.3, 2e-3, 2.0),
            _ => (0.3, 2e-3, 3.0),
        }
    }

    /// Whether it lies between command and force, so that a measured force does not show it.
    pub fn needs_command(self) -> bool {
        matches!(
            self,
            Self::Lag
                | Self::SecondOrderLag
                | Self::Delay
                | Self::Saturation
                | Self::GainBySide
                | Self::GainByCurrent
                | Self::GainAlongStroke
        )
    }
}
