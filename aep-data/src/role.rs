//! The quantities a recording can hold, and the names under which files carry them.

use crate::unit::Dimension;

/// A quantity that the analysis knows how to use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnRole {
    /// Time of the sample.
    Time,
    /// Force or torque of the drive.
    Force,
    /// Position or angle of the axis.
    Position,
    /// Measured velocity.
    Velocity,
    /// Position that was asked for.
    Reference,
    /// Number of the piece the sample belongs to.
    Segment,
    /// Temperature.
    Temperature,
    /// 0 where the drive is switched off.
    Enabled,
    /// Force or torque that another model gives for the same samples.
    ModelForce,
}

/// What is known of a role.
#[derive(Debug)]
pub struct Facts {
    /// The role.
    pub role: ColumnRole,
    /// Name of the channel, of the flag (`--force`) and of the field of `DATA.toml`.
    pub name: &'static str,
    /// The header of a linear axis, e.g. `force_N`.
    pub header: &'static str,
    /// The header of a rotary axis.
    pub rotary_header: &'static str,
    /// Dimension on a linear axis.
    pub linear: Dimension,
    /// Dimension on a rotary axis.
    pub rotary: Dimension,
    /// Names without unit under which it is recognised, lower case, best first.
    pub aliases: &'static [&'static str],
    /// Aliases that only a rotary axis uses.
    pub rotary_aliases: &'static [&'static str],
}

/// Every role, time first.
pub const ALL: &[Facts] = &[
    Facts {
        role: ColumnRole::Time,
        name: "time",
        header: "time_s",
        rotary_header: "time_s",
        linear: Dimension::Time,
        rotary: Dimension::Time,
        aliases: &["time", "t", "timestamp", "zeit"],
        rotary_aliases: &[],
    },
    Facts {
        role: ColumnRole::Force,
        name: "force",
        header: "force_N",
        rotary_header: "torque_Nm",
        linear: Dimension::Force,
        rotary: Dimension::Torque,
        aliases: &["force", "f", "torque", "tau", "motor_force", "motor_torque", "effort"],
        rotary_aliases: &["torque", "tau", "motor_torque"],
    },
    Facts {
        role: ColumnRole::Position,
        name: "position",
        header: "position_m",
        rotary_header: "angle_rad",
        linear: Dimension::Length,
        rotary: Dimension::Angle,
        aliases: &["position", "pos", "angle", "x", "q", "theta", "phi", "displacement"],
        rotary_aliases: &["angle", "theta", "phi"],
    },
    Facts {
        role: ColumnRole::Velocity,
        name: "velocity",
        header: "velocity_m_s",
        rotary_header: "angular_velocity_rad_s",
        linear: Dimension::Speed,
        rotary: Dimension::AngularSpeed,
        aliases: &["velocity", "vel", "angular_velocity", "speed", "v", "qd", "dq", "omega"],
        rotary_aliases: &["angular_velocity", "omega"],
    },
    Facts {
        role: ColumnRole::Reference,
        name: "reference",
        header: "reference_m",
        rotary_header: "reference_rad",
        linear: Dimension::Length,
        rotary: Dimension::Angle,
        aliases: &[
            "reference",
            "ref",
            "q_ref",
            "x_ref",
            "position_ref",
            "setpoint",
            "q_goal",
            "qg",
        ],
        rotary_aliases: &[],
    },
    Facts {
        role: ColumnRole::Segment,
        name: "segment",
        header: "segment",
        rotary_header: "segment",
        linear: Dimension::Number,
        rotary: Dimension::Number,
        aliases: &["segment", "run", "block"],
        rotary_aliases: &[],
    },
    Facts {
        role: ColumnRole::Temperature,
        name: "temperature",
        header: "temperature_C",
        rotary_header: "temperature_C",
        linear: Dimension::Temperature,
        rotary: Dimension::Temperature,
        aliases: &["temperature", "temp"],
        rotary_aliases: &[],
    },
    Facts {
        role: ColumnRole::Enabled,
        name: "enabled",
        header: "enabled",
        rotary_header: "enabled",
        linear: Dimension::Number,
        rotary: Dimension::Number,
        aliases: &["enabled", "torque_enable", "torque_enabled", "drive_enabled"],
        rotary_aliases: &[],
    },
    Facts {
        role: ColumnRole::ModelForce,
        name: "model_force",
        header: "model_force_N",
        rotary_header: "model_torque_Nm",
        linear: Dimension::Force,
        rotary: Dimension::Torque,
        // Never taken unasked: with it a discovery answers another question.
        aliases: &[],
        rotary_aliases: &[],
    },
];

impl ColumnRole {
    /// What is known of it.
    pub fn facts(self) -> &'static Facts {
        // The table is in the order of the variants; a test holds it to that.
        &ALL[self as usize]
    }

    /// Whether no recording is possible without it.
    pub fn is_required(self) -> bool {
        matches!(self, Self::Time | Self::Force | Self::Position)
    }

    /// The quantities its unit may measure.
    pub fn accepts(self, quantity: Dimension) -> bool {
        quantity == self.facts().linear || quantity == self.facts().rotary
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_variants() {
        for (index, facts) in ALL.iter().enumerate() {
            assert_eq!(facts.role as usize, index, "{}", facts.name);
        }
    }

    #[test]
    fn no_alias_means_two_things() {
        let mut seen = std::collections::BTreeSet::new();
        for alias in ALL.iter().flat_map(|facts| facts.aliases) {
            assert!(seen.insert(alias), "{alias}");
            assert_eq!(*alias, alias.to_lowercase());
        }
    }
}
