//! Units a file may use, and what one of each is in SI.

/// What a unit measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Seconds.
    Time,
    /// Newtons.
    Force,
    /// Newton metres.
    Torque,
    /// Metres.
    Length,
    /// Radians.
    Angle,
    /// Metres per second.
    Speed,
    /// Radians per second.
    AngularSpeed,
    /// Degrees Celsius.
    Temperature,
    /// A plain number: segments.
    Number,
    /// Something electrical or raw that a gain has to turn into a quantity of the axis.
    Raw,
}

impl Dimension {
    /// The SI unit the recording carries.
    pub fn si(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Force => "N",
            Self::Torque => "Nm",
            Self::Length => "m",
            Self::Angle => "rad",
            Self::Speed => "m/s",
            Self::AngularSpeed => "rad/s",
            Self::Temperature => "C",
            Self::Number | Self::Raw => "",
        }
    }
}

/// A unit: `value * factor + shift` is the value in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// How it is written in a header or in `DATA.toml`.
    pub name: &'static str,
    /// What it measures.
    pub quantity: Dimension,
    /// One of it in SI.
    pub factor: f64,
    /// Its zero in SI (only temperatures have one).
    pub shift: f64,
}

const fn unit(name: &'static str, quantity: Dimension, factor: f64) -> Unit {
    Unit { name, quantity, factor, shift: 0.0 }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;
const TURN: f64 = std::f64::consts::TAU;
const KILOGRAM_FORCE: f64 = 9.806_65;
const POUND_FORCE: f64 = 4.448_221_615_260_5;

/// Every unit that is understood. Case matters: `mN` is not `MN`.
pub const UNITS: &[Unit] = &[
    unit("s", Dimension::Time, 1.0),
    unit("ms", Dimension::Time, 1e-3),
    unit("us", Dimension::Time, 1e-6),
    unit("ns", Dimension::Time, 1e-9),
    unit("min", Dimension::Time, 60.0),
    unit("N", Dimension::Force, 1.0),
    unit("mN", Dimension::Force, 1e-3),
    unit("kN", Dimension::Force, 1e3),
    unit("kgf", Dimension::Force, KILOGRAM_FORCE),
    unit("gf", Dimension::Force, KILOGRAM_FORCE * 1e-3),
    unit("lbf", Dimension::Force, POUND_FORCE),
    unit("Nm", Dimension::Torque, 1.0),
    unit("mNm", Dimension::Torque, 1e-3),
    unit("Ncm", Dimension::Torque, 1e-2),
    unit("Nmm", Dimension::Torque, 1e-3),
    unit("kNm", Dimension::Torque, 1e3),
    unit("m", Dimension::Length, 1.0),
    unit("cm", Dimension::Length, 1e-2),
    unit("mm", Dimension::Length, 1e-3),
    unit("um", Dimension::Length, 1e-6),
    unit("nm", Dimension::Length, 1e-9),
    unit("in", Dimension::Length, 0.0254),
    unit("rad", Dimension::Angle, 1.0),
    unit("mrad", Dimension::Angle, 1e-3),
    unit("urad", Dimension::Angle, 1e-6),
    unit("deg", Dimension::Angle, DEGREE),
    unit("rev", Dimension::Angle, TURN),
    unit("m/s", Dimension::Speed, 1.0),
    unit("cm/s", Dimension::Speed, 1e-2),
    unit("mm/s", Dimension::Speed, 1e-3),
    unit("um/s", Dimension::Speed, 1e-6),
    unit("m/min", Dimension::Speed, 1.0 / 60.0),
    unit("mm/min", Dimension::Speed, 1e-3 / 60.0),
    unit("rad/s", Dimension::AngularSpeed, 1.0),
    unit("mrad/s", Dimension::AngularSpeed, 1e-3),
    unit("deg/s", Dimension::AngularSpeed, DEGREE),
    unit("rev/s", Dimension::AngularSpeed, TURN),
    unit("rpm", Dimension::AngularSpeed, TURN / 60.0),
    unit("C", Dimension::Temperature, 1.0),
    Unit { name: "K", quantity: Dimension::Temperature, factor: 1.0, shift: -273.15 },
    unit("V", Dimension::Raw, 1.0),
    unit("mV", Dimension::Raw, 1e-3),
    unit("A", Dimension::Raw, 1.0),
    unit("mA", Dimension::Raw, 1e-3),
    unit("counts", Dimension::Raw, 1.0),
    unit("bar", Dimension::Raw, 1.0),
];

/// Other ways to write a unit, after blanks, dots and underscores are gone.
const SPELLINGS: &[(&str, &str)] = &[
    ("sec", "s"),
    ("seconds", "s"),
    ("msec", "ms"),
    ("\u{b5}s", "us"),
    ("\u{3bc}s", "us"),
    ("\u{b5}m", "um"),
    ("\u{3bc}m", "um"),
    ("\u{b5}m/s", "um/s"),
    ("\u{3bc}m/s", "um/s"),
    ("micron", "um"),
    ("inch", "in"),
    ("\u{b0}", "deg"),
    ("\u{b0}/s", "deg/s"),
    ("\u{b0}C", "C"),
    ("degC", "C"),
    ("1/min", "rpm"),
    ("turn", "rev"),
    ("count", "counts"),
    ("ticks", "counts"),
];

/// The unit written `text`, as `mm`, `mm/s`, `mm_s` (the form of a CSV header), `N*m`, `µm`, ...
pub fn find(text: &str) -> Option<&'static Unit> {
    let plain: String =
        text.trim().chars().filter(|c| !matches!(c, ' ' | '*' | '\u{b7}' | '.')).collect();
    let slashed = plain.replace('_', "/");
    let name = SPELLINGS.iter().find(|(other, _)| *other == slashed).map_or(&*slashed, |s| s.1);
    UNITS.iter().find(|unit| unit.name == name)
}

/// The unit of force or torque that `text` is in lower case. No two of them differ in their case alone.
pub(crate) fn find_lower(text: &str) -> Option<&'static Unit> {
    let is_force = |unit: &&Unit| matches!(unit.quantity, Dimension::Force | Dimension::Torque);
    let mut forces = UNITS.iter().filter(is_force);
    forces.find(|unit| unit.name.to_lowercase() == text)
}

/// `V` or `A`, where a unit is of a voltage or a current.
pub fn electrical(unit: &Unit) -> Option<&'static str> {
    match unit.name {
        "V" | "mV" => Some("V"),
        "A" | "mA" => Some("A"),
        _ => None,
    }
}

/// The unit that was probably meant by `text`.
pub fn nearest(text: &str) -> Option<&'static str> {
    let same_letters = UNITS.iter().find(|unit| unit.name.eq_ignore_ascii_case(text.trim()));
    same_letters.map(|unit| unit.name)
}

/// The names of all units of `quantity`.
pub fn names(quantity: Dimension) -> Vec<&'static str> {
    UNITS.iter().filter(|unit| unit.quantity == quantity).map(|unit| unit.name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_unit_has_many_spellings() {
        for text in ["mm/s", "mm_s", " mm / s "] {
            assert_eq!(find(text).map(|unit| unit.name), Some("mm/s"), "{text}");
        }
        assert_eq!(find("\u{b5}m").map(|unit| unit.factor), Some(1e-6));
        assert_eq!(find("N*m").map(|unit| unit.quantity), Some(Dimension::Torque));
        assert_eq!(find("N\u{b7}m").map(|unit| unit.quantity), Some(Dimension::Torque));
    }

    #[test]
    fn case_matters_but_a_slip_is_guessed() {
        assert_eq!(find("MN"), None);
        assert_eq!(find("Mm"), None);
        assert_eq!(nearest("KN"), Some("kN"));
    }

    #[test]
    fn no_unit_is_listed_twice() {
        for (index, unit) in UNITS.iter().enumerate() {
            assert!(UNITS[..index].iter().all(|other| other.name != unit.name), "{}", unit.name);
        }
        let force = |unit: &&Unit| matches!(unit.quantity, Dimension::Force | Dimension::Torque);
        let mut lower: Vec<_> = UNITS.iter().filter(force).map(|u| u.name.to_lowercase()).collect();
        lower.sort();
        assert!(lower.windows(2).all(|pair| pair[0] != pair[1]), "{lower:?}");
    }

    #[test]
    fn turns_degrees_and_kelvin_convert() {
        let to_si = |value: f64, name| {
            let unit = find(name).unwrap();
            value * unit.factor + unit.shift
        };
        assert!((to_si(60.0, "rpm") - TURN).abs() < 1e-12);
        assert!((to_si(180.0, "deg") - std::f64::consts::PI).abs() < 1e-12);
        assert!((to_si(293.15, "K") - 20.0).abs() < 1e-9);
    }
}
