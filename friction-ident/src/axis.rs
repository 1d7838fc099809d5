//! Linear or rotary: what the force, the position and everything made of them are measured in.

use serde::{Deserialize, Serialize};

/// Kind of axis. It changes units and typical sizes, never a law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Force in N, position in m, mass in kg.
    #[default]
    Linear,
    /// Torque in N m, angle in rad, inertia in kg m^2.
    Rotary,
}

/// What a parameter measures; with an [`Axis`] it gives the SI unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A pure number.
    One,
    /// Mass or moment of inertia.
    Mass,
    /// Force or torque.
    Force,
    /// Position or angle.
    Length,
    /// Velocity or angular velocity.
    Velocity,
    /// Time.
    Time,
    /// Frequency.
    Frequency,
    /// Force per velocity.
    Damping,
    /// Force per velocity squared.
    Drag,
    /// Force per length.
    Stiffness,
    /// A share per force.
    PerForce,
    /// Angle or phase.
    Angle,
    /// Temperature difference.
    Temperature,
}

/// What the drive's effort is measured in. A voltage or a current without a gain makes everything that holds a force a
/// voltage or a current, and the mass a voltage per acceleration; no law changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Effort {
    /// N, or N m on a rotary axis.
    #[default]
    #[serde(rename = "SI")]
    Si,
    /// V.
    #[serde(rename = "V")]
    Volt,
    /// A.
    #[serde(rename = "A")]
    Ampere,
}

impl Effort {
    /// The effort that a recorded force in `unit` is.
    pub fn of(unit: &str) -> Self {
        match unit {
            "V" => Self::Volt,
            "A" => Self::Ampere,
            _ => Self::Si,
        }
    }

    /// Whether it is a force or a torque.
    pub fn is_si(self) -> bool {
        self == Self::Si
    }

    /// Unit of `quantity` on an axis with this effort.
    pub fn unit(self, axis: Axis, quantity: Quantity) -> &'static str {
        let (volt, linear) = match self {
            Self::Si => return axis.unit(quantity),
            Self::Volt => (true, axis == Axis::Linear),
            Self::Ampere => (false, axis == Axis::Linear),
        };
        match (quantity, volt, linear) {
            (Quantity::Force, true, _) => "V",
            (Quantity::Force, false, _) => "A",
            (Quantity::Mass, true, true) => "V s^2/m",
            (Quantity::Mass, true, false) => "V s^2/rad",
            (Quantity::Mass, false, true) => "A s^2/m",
            (Quantity::Mass, false, false) => "A s^2/rad",
            (Quantity::Damping, true, true) => "V s/m",
            (Quantity::Damping, true, false) => "V s/rad",
            (Quantity::Damping, false, true) => "A s/m",
            (Quantity::Damping, false, false) => "A s/rad",
            (Quantity::Drag, true, true) => "V s^2/m^2",
            (Quantity::Drag, true, false) => "V s^2/rad^2",
            (Quantity::Drag, false, true) => "A s^2/m^2",
            (Quantity::Drag, false, false) => "A s^2/rad^2",
            (Quantity::Stiffness, true, true) => "V/m",
            (Quantity::Stiffness, true, false) => "V/rad",
            (Quantity::Stiffness, false, true) => "A/m",
            (Quantity::Stiffness, false, false) => "A/rad",
            (Quantity::PerForce, true, _) => "1/V",
            (Quantity::PerForce, false, _) => "1/A",
            _ => axis.unit(quantity),
        }
    }
}

/// Force, length and velocity of a small servo, in units of those of a small ball-screw table.
const ROTARY_FORCE: f64 = 0.02;
const ROTARY_LENGTH: f64 = 10.0;

impl Axis {
    /// SI unit of `quantity` on this axis.
    pub fn unit(self, quantity: Quantity) -> &'static str {
        let (linear, rotary) = match quantity {
            Quantity::One => ("1", "1"),
            Quantity::Mass => ("kg", "kg m^2"),
            Quantity::Force => ("N", "N m"),
            Quantity::Length => ("m", "rad"),
            Quantity::Velocity => ("m/s", "rad/s"),
            Quantity::Time => ("s", "s"),
            Quantity::Frequency => ("Hz", "Hz"),
            Quantity::Damping => ("N s/m", "N m s/rad"),
            Quantity::Drag => ("N s^2/m^2", "N m s^2/rad^2"),
            Quantity::Stiffness => ("N/m", "N m/rad"),
            Quantity::PerForce => ("1/N", "1/(N m)"),
            Quantity::Angle => ("rad", "rad"),
            Quantity::Temperature => ("K", "K"),
        };
        match self {
            Self::Linear => linear,
            Self::Rotary => rotary,
        }
    }

    /// Factor from the bounds and typical sizes of a ball-screw table, in which the effects' tables
    /// are written, to those of this axis.
    pub fn typical(self, quantity: Quantity) -> f64 {
        let (force, length) = match self {
            Self::Linear => (1.0, 1.0),
            Self::Rotary => (ROTARY_FORCE, ROTARY_LENGTH),
        };
        match quantity {
            Quantity::Force => force,
            Quantity::Length | Quantity::Velocity => length,
            Quantity::Mass | Quantity::Damping | Quantity::Stiffness => force / length,
            Quantity::Drag => force / (length * length),
            Quantity::PerForce => 1.0 / force,
            Quantity::One
            | Quantity::Time
            | Quantity::Frequency
            | Quantity::Angle
            | Quantity::Temperature => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_follow_the_axis() {
        assert_eq!(Axis::Linear.unit(Quantity::Damping), "N s/m");
        assert_eq!(Axis::Rotary.unit(Quantity::Damping), "N m s/rad");
        assert_eq!(Axis::Rotary.unit(Quantity::Time), "s");
    }

    #[test]
    fn a_voltage_or_a_current_is_never_called_a_force() {
        for effort in [Effort::Volt, Effort::Ampere] {
            for quantity in [
                Quantity::Mass,
                Quantity::Force,
                Quantity::Damping,
                Quantity::Drag,
                Quantity::Stiffness,
                Quantity::PerForce,
            ] {
                for axis in [Axis::Linear, Axis::Rotary] {
                    let unit = effort.unit(axis, quantity);
                    assert!(!unit.contains('N') && !unit.contains("kg"), "{unit}");
                }
            }
        }
        assert_eq!(Effort::Volt.unit(Axis::Rotary, Quantity::Velocity), "rad/s");
        assert_eq!(Effort::of("Nm"), Effort::Si);
    }

    #[test]
    fn the_sizes_of_a_rotary_axis_are_consistent_among_themselves() {
        let axis = Axis::Rotary;
        let force = axis.typical(Quantity::Damping) * axis.typical(Quantity::Velocity);
        assert!((force - axis.typical(Quantity::Force)).abs() < 1e-15);
        let force = axis.typical(Quantity::Drag) * axis.typical(Quantity::Velocity).powi(2);
        assert!((force - axis.typical(Quantity::Force)).abs() < 1e-15);
    }
}
