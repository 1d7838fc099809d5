//! Errors of building and stepping an optimizer.

/// A configuration that cannot work. The message names the setting and its valid range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// A domain without components.
    #[error("the domain has no components\n  give at least one lower and one upper limit")]
    EmptyDomain,
    /// Vectors of different length.
    #[error("{what}: {found} entries for {expected} components\n  give one entry per component")]
    Length {
        /// Which vector.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// Limits that enclose nothing or are not finite.
    #[error(
        "component {component}: limits [{lower}, {upper}] enclose nothing\n  \
         lower and upper must be finite and lower < upper"
    )]
    Limits {
        /// Index of the component.
        component: usize,
        /// Its lower limit.
        lower: f64,
        /// Its upper limit.
        upper: f64,
    },
    /// A logarithmic component that reaches zero or below.
    #[error(
        "component {component}: a logarithmic scale needs a positive lower limit, found {lower}\n  \
         raise the limit or use a linear scale"
    )]
    LogLimit {
        /// Index of the component.
        component: usize,
        /// Its lower limit.
        lower: f64,
    },
    /// A setting outside its range.
    #[error("{algorithm}: {setting} = {value}\n  {hint}")]
    Setting {
        /// Which algorithm.
        algorithm: &'static str,
        /// Which setting.
        setting: &'static str,
        /// The value given.
        value: f64,
        /// The valid range.
        hint: &'static str,
    },
    /// More numbers than one block of a run may hold.
    #[error(
        "{what}: {rows} x {columns} numbers do not fit\n  at most {most} are held at once, 1 GiB in double precision"
    )]
    TooLarge {
        /// What they are.
        what: &'static str,
        /// Number of rows.
        rows: usize,
        /// Numbers of a row.
        columns: usize,
        /// Most numbers.
        most: usize,
    },
    /// An initial point that lies outside the domain or is not finite.
    #[error(
        "initial point {point}: component {component} = {value} is outside the domain\n  \
         move it inside the limits"
    )]
    InitialPoint {
        /// Index of the point.
        point: usize,
        /// Index of the component.
        component: usize,
        /// Its value.
        value: f64,
    },
}

/// Most numbers that one block of a run may hold. What is far beyond any memory would end the program, not the run.
const MOST_NUMBERS: usize = 1 << 27;

impl ConfigError {
    /// Refuses a block of more than [`MOST_NUMBERS`] numbers.
    pub(crate) fn require_fits(
        what: &'static str,
        rows: usize,
        columns: usize,
    ) -> Result<(), Self> {
        let fits = rows.checked_mul(columns).is_some_and(|numbers| numbers <= MOST_NUMBERS);
        if fits { Ok(()) } else { Err(Self::TooLarge { what, rows, columns, most: MOST_NUMBERS }) }
    }

    /// Refuses `value` unless `valid`; NaN makes every comparison false and is thus refused too.
    pub(crate) fn require(
        valid: bool,
        algorithm: &'static str,
        setting: &'static str,
        value: f64,
        hint: &'static str,
    ) -> Result<(), Self> {
        if valid { Ok(()) } else { Err(Self::Setting { algorithm, setting, value, hint }) }
    }
}

/// Costs that do not answer the last `ask`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TellError {
    /// `tell` without a preceding `ask`.
    #[error("tell without ask\n  call ask, evaluate its points, then tell their costs once")]
    NotAsked,
    /// Not one cost per point.
    #[error("{found} costs for {expected} points\n  tell one cost per point of the last ask")]
    Count {
        /// Number of costs given.
        found: usize,
        /// Number of points asked.
        expected: usize,
    },
    /// Not one row of residuals per cost.
    #[error(
        "{found} rows of residuals for {expected} costs\n  tell one row per point, an empty one where there is none"
    )]
    Residuals {
        /// Number of rows given.
        found: usize,
        /// Number of costs told.
        expected: usize,
    },
}
