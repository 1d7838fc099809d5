//! What can be wrong with a file, where, and how to mend it.

use std::fmt::{self, Write};
use std::path::{Path, PathBuf};

/// Why a file is no recording. Says what; [`place`](DataError::place) says where and
/// [`hint`](DataError::hint) how to mend it.
#[derive(Clone, Debug, PartialEq)]
pub struct DataError {
    /// The file.
    pub path: PathBuf,
    /// Line in the file, from 1, where there is one.
    pub line: Option<u64>,
    /// Sample, from 0, in files without lines.
    pub sample: Option<usize>,
    /// Column or variable.
    pub column: Option<String>,
    /// What is wrong.
    pub problem: Box<Problem>,
}

impl DataError {
    pub(crate) fn new(path: &Path, problem: Problem) -> Self {
        Self {
            path: path.to_owned(),
            line: None,
            sample: None,
            column: None,
            problem: Box::new(problem),
        }
    }

    pub(crate) fn at_line(mut self, line: Option<u64>) -> Self {
        self.line = line;
        self
    }

    pub(crate) fn at_sample(mut self, sample: usize, line: Option<u64>) -> Self {
        self.line = line;
        self.sample = line.is_none().then_some(sample);
        self
    }

    pub(crate) fn in_column(mut self, column: impl Into<String>) -> Self {
        self.column = Some(column.into());
        self
    }

    /// Where it is, e.g. `run.csv, line 12, column 'force_N'`.
    pub fn place(&self) -> String {
        // Writing to a string cannot fail.
        let mut place = self.path.display().to_string();
        if let Some(line) = self.line {
            let _ = write!(place, ", line {line}");
        }
        if let Some(column) = &self.column {
            let mat =
                self.path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mat"));
            let kind = if mat { "variable" } else { "column" };
            let _ = write!(place, ", {kind} '{column}'");
        }
        if let Some(sample) = self.sample {
            let _ = write!(place, ", sample {}", sample + 1);
        }
        place
    }

    /// How to mend it.
    pub fn hint(&self) -> Option<String> {
        self.problem.hint(&self.path, self.column.as_deref())
    }
}

impl fmt::Display for DataError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.problem, self.place())
    }
}

impl std::error::Error for DataError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&*self.problem)
    }
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// No such file.
    #[error("there is no such file")]
    Absent,
    /// A directory where a file is wanted.
    #[error("this is a directory, not a file")]
    Directory {
        /// The data files in it.
        files: Vec<String>,
    },
    /// The system refuses.
    #[error("cannot be read: {message}")]
    Unreadable {
        /// What the system says.
        message: String,
    },
    /// Not a byte in it.
    #[error("the file is empty")]
    Empty,
    /// A header and nothing below it.
    #[error("the file has a header, but no data below it")]
    HeaderOnly,
    /// A formula that cannot be read.
    #[error("the formula of {role}: {}", .error.what)]
    Formula {
        /// What is read from it.
        role: String,
        /// What is wrong, and where.
        error: aep_formula::FormulaError,
    },
    /// A formula that has no value at a sample.
    #[error("the formula '{formula}' is {value} here: {with}")]
    NotFinite {
        /// The formula.
        formula: String,
        /// Its value.
        value: f64,
        /// The columns at that sample.
        with: String,
    },
    /// A file of a known format that cannot be read.
    #[error("the {format} cannot be read: {what}")]
    Damaged {
        /// The format.
        format: &'static str,
        /// What its reader says.
        what: String,
    },
    /// A topic of an MCAP file that cannot be chosen.
    #[error("{}", topics(.wanted.as_deref(), .present))]
    Topic {
        /// The topic that was asked for.
        wanted: Option<String>,
        /// Topics with joints.
        present: Vec<String>,
    },
    /// A topic was asked for in a file that has none.
    #[error("this file has no topics; MCAP files do")]
    NoTopics,
    /// A regressor that is nothing.
    #[error("the regressor '{formula}' is 0 at every sample: no factor makes a force of it")]
    Nothing {
        /// Its formula.
        formula: String,
    },
    /// Numbers from the first line on.
    #[error("the file has no header: its first line holds only numbers")]
    NoHeader {
        /// Columns in the first line.
        columns: usize,
    },
    /// Bytes that no text holds.
    #[error("this is neither text nor a MATLAB file: {what}")]
    NotText {
        /// What was seen.
        what: &'static str,
    },
    /// Two columns with one name.
    #[error("the header names the column '{name}' twice")]
    DuplicateColumn {
        /// The name.
        name: String,
    },
    /// A row with more or fewer fields than the header.
    #[error("the row has {fields} fields, but the header has {columns}")]
    RaggedRow {
        /// Fields in the row.
        fields: u64,
        /// Columns in the header.
        columns: u64,
    },
    /// Text or NaN where a number is wanted.
    #[error("{} is not a number", shown(.value))]
    NotANumber {
        /// What stands there.
        value: String,
    },
    /// So many rows without a number that the rest is no recording.
    #[error(
        "{missing} of {rows} rows have no number in a column that is used, the first one here; up to a quarter are left out"
    )]
    TooManyMissing {
        /// Rows without a number.
        missing: usize,
        /// All rows.
        rows: usize,
    },
    /// So many rows with the time of the row before that the times say nothing.
    #[error(
        "{repeated} of {rows} rows have the time of the row before; up to a quarter are left out"
    )]
    TooManyRepeated {
        /// Rows with the time of the row before.
        repeated: usize,
        /// All rows.
        rows: usize,
    },
    /// A velocity, but no position.
    #[error(
        "there is a velocity ('{column}'), but no position: models are judged by the positions that they predict"
    )]
    VelocityOnly {
        /// The column of the velocity.
        column: String,
    },
    /// A column that is needed is not there.
    #[error("no column for the {role}{}; the file has: {}", wanted(.column.as_deref()), listed(.present))]
    MissingColumn {
        /// What it is needed for.
        role: String,
        /// The name asked for, where one was.
        column: Option<String>,
        /// The names there are.
        present: Vec<String>,
        /// The one that was probably meant.
        nearest: Option<String>,
    },
    /// No groups of columns that could be axes.
    #[error("no axes found: no force and position of the same number or joint name; the file has: {}", listed(.present))]
    NoAxes {
        /// The names there are.
        present: Vec<String>,
    },
    /// An axis that is not there.
    #[error("there is no axis '{name}'; there are: {}", .present.join(", "))]
    NoAxis {
        /// The name asked for.
        name: String,
        /// The names there are.
        present: Vec<String>,
    },
    /// A variable that is needed is not in the `.mat` file.
    #[error("no variable for the {role}{}; the file has: {}", wanted(.column.as_deref()), listed(.present))]
    MissingVariable {
        /// What it is needed for.
        role: String,
        /// The name asked for, where one was.
        column: Option<String>,
        /// The variables there are, with class and size.
        present: Vec<String>,
        /// The one that was probably meant.
        nearest: Option<String>,
    },
    /// A structure, cell array or text where a numeric array is wanted.
    #[error("'{name}' is a {class}, not a numeric array")]
    NotNumeric {
        /// Name of the variable.
        name: String,
        /// Its MATLAB class.
        class: &'static str,
        /// A field of it that is one, where it is a structure with such.
        field: Option<String>,
    },
    /// A matrix where a vector is wanted.
    #[error("'{name}' is {rows} x {columns}, not a vector")]
    NotAVector {
        /// Name of the variable.
        name: String,
        /// Rows.
        rows: usize,
        /// All other dimensions together.
        columns: usize,
    },
    /// Vectors of different lengths.
    #[error("'{name}' has {values} values, but there are {samples} samples")]
    Length {
        /// Name of the column or variable.
        name: String,
        /// Values in it.
        values: usize,
        /// Samples of the others.
        samples: usize,
    },
    /// Ends in `.mat`, is none.
    #[error("this is not a MATLAB v5 file")]
    NotMat,
    /// A `.mat` that ends in the middle or holds nonsense.
    #[error("the MATLAB file is damaged: {what}")]
    DamagedMat {
        /// What was seen.
        what: String,
    },
    /// A unit nobody knows.
    #[error("the unit '{unit}' of the {role} is not known")]
    UnknownUnit {
        /// What the unit is of.
        role: &'static str,
        /// The unit.
        unit: String,
        /// The one that was probably meant.
        nearest: Option<&'static str>,
        /// Units that would do.
        known: Vec<&'static str>,
    },
    /// A known unit of something else.
    #[error("the unit '{unit}' is no unit of a {role}")]
    WrongUnit {
        /// What it should be a unit of.
        role: &'static str,
        /// The unit.
        unit: String,
        /// Units that would do.
        known: Vec<&'static str>,
    },
    /// Volts or counts without the factor that makes a force of them.
    #[error("the column is in {unit}, which is no {role} without a gain")]
    NeedsGain {
        /// What it is to become.
        role: &'static str,
        /// Its unit.
        unit: String,
    },
    /// A linear and a rotary quantity in one recording.
    #[error("{linear} is linear, but {rotary} is rotary")]
    MixedAxis {
        /// Name and unit of the linear one.
        linear: String,
        /// Name and unit of the rotary one.
        rotary: String,
    },
    /// Time stands still or runs backwards.
    #[error("time goes from {before} s to {after} s: it must increase")]
    TimeBackwards {
        /// Time of the sample before, s.
        before: f64,
        /// Time of this sample, s.
        after: f64,
    },
    /// A value that no drive has.
    #[error("a {role} of {value:.2e} {unit} is out of all reason")]
    Implausible {
        /// What it is.
        role: &'static str,
        /// The value in SI.
        value: f64,
        /// SI unit.
        unit: &'static str,
    },
    /// Changes that no sensor sees.
    #[error("the {role} changes by {range:.2e} {unit} in all: no sensor sees that")]
    Tiny {
        /// What it is.
        role: &'static str,
        /// Largest less smallest value in SI.
        range: f64,
        /// SI unit.
        unit: &'static str,
    },
    /// A sampling interval that no recording of a drive has.
    #[error("one sample every {interval:.2e} s is no recording of a drive")]
    Interval {
        /// The interval, s.
        interval: f64,
    },
    /// Segment numbers that are no whole numbers.
    #[error("segment {value} is not a whole number")]
    Segment {
        /// What stands there.
        value: f64,
    },
    /// `DATA.toml` cannot be understood.
    #[error("{message}")]
    Toml {
        /// What the reader of the format says.
        message: String,
    },
    /// A gain or an interval that makes no sense.
    #[error("{what} is {value}: it must be {must}")]
    BadNumber {
        /// Which setting.
        what: String,
        /// Its value.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// A file that does not belong to those before it.
    #[error("its {what} is {here}, but that of the files before it is {there}")]
    Differs {
        /// What differs.
        what: &'static str,
        /// In this file.
        here: String,
        /// In the files before.
        there: String,
    },
    /// Whatever else a recording does not allow.
    #[error("{0}")]
    Recording(#[from] missing_physics::RecordingError),
}

fn shown(value: &str) -> String {
    match value.trim() {
        "" => "an empty field".to_owned(),
        text => format!("'{}'", shortened(text)),
    }
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= 40 {
        return text.to_owned();
    }
    text.chars().take(37).chain("...".chars()).collect()
}

fn wanted(column: Option<&str>) -> String {
    column.map(|name| format!(" called '{name}'")).unwrap_or_default()
}

fn topics(wanted: Option<&str>, present: &[String]) -> String {
    match (wanted, present) {
        (_, []) => "the file has no topic of sensor_msgs/JointState".to_owned(),
        (Some(wanted), _) => {
            format!("there is no topic '{wanted}' with joints; there are: {}", listed(present))
        }
        (None, _) => format!("several topics have joints: {}", listed(present)),
    }
}

fn listed(names: &[String]) -> String {
    const SHOWN: usize = 20;
    match names.len() {
        0 => "nothing".to_owned(),
        n if n <= SHOWN => names.join(", "),
        n => format!("{}, and {} more", names[..SHOWN].join(", "), n - SHOWN),
    }
}

impl Problem {
    fn hint(&self, path: &Path, column: Option<&str>) -> Option<String> {
        let toml = path.with_extension("toml");
        let toml = toml.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Some(match self {
            Self::Absent => "check the name; the path is relative to where you are".to_owned(),
            Self::Directory { files } if files.is_empty() => {
                "give a .csv or .mat file; this directory has none".to_owned()
            }
            Self::Directory { files } => format!("give one of its files: {}", listed(files)),
            Self::Unreadable { .. } => "check the permissions of the file".to_owned(),
            Self::Formula { error, .. } => {
                let text = error.to_string();
                let shown = text.split_once('\n').map_or("", |(_, shown)| shown);
                format!("mend it at the mark; 'aep effects --formula' lists all functions\n{shown}")
            }
            Self::Damaged { .. } => "write it once more, or as CSV with time_s,force_N,position_m".to_owned(),
            Self::Topic { present, .. } if present.is_empty() => {
                "record a topic of sensor_msgs/JointState, or write the signals as CSV with time_s,force_N,position_m".to_owned()
            }
            Self::Topic { present, .. } => format!("choose one of them: --topic {}", present[0]),
            Self::NoTopics => "leave --topic out".to_owned(),
            Self::TooManyMissing { .. } => {
                "fill the column, cut the file (--from, --to), or leave the column out".to_owned()
            }
            Self::TooManyRepeated { .. } => {
                "write the time with more digits, or say the sampling interval: --interval 0.001".to_owned()
            }
            Self::VelocityOnly { .. } => {
                "record the position, too: the integral of a measured velocity drifts by far more than an encoder errs, which \
                 would be taken for missing physics"
                    .to_owned()
            }
            Self::NoAxes { .. } => format!(
                "looked for names such as torque_1 and position_1, tau_0 and q_0, elbow_torque and elbow_angle; say others \
                 with {{}} in place of the axis: --force 'u_{{}}' --position 'enc_{{}}', or with [axes.NAME] in {toml}"
            ),
            Self::NoAxis { .. } => "choose some of these, or --axes all".to_owned(),
            Self::Nothing { .. } => "check the formula, or leave it out".to_owned(),
            Self::NotFinite { .. } => {
                "keep it within its domain, e.g. sqrt(max(0, x)) or log(max(1e-9, x)), or leave the row out".to_owned()
            }
            Self::Empty | Self::HeaderOnly => {
                "a recording is a header such as time_s,force_N,position_m and one line a sample"
                    .to_owned()
            }
            Self::NoHeader { columns } => format!(
                "put a line with {columns} names on top, e.g. time_s,force_N,position_m"
            ),
            Self::NotText { .. } => "export the data as CSV (UTF-8) or as a MATLAB file".to_owned(),
            Self::DuplicateColumn { .. } => "rename one of the two columns".to_owned(),
            Self::RaggedRow { .. } => {
                "complete or delete the row; decimal commas need ';' between the columns".to_owned()
            }
            Self::NotANumber { .. } => {
                "delete the row or repair the value; a long gap is better cut into two segments \
                 (column 'segment')"
                    .to_owned()
            }
            Self::MissingColumn { role, nearest, .. } | Self::MissingVariable { role, nearest, .. } => {
                missing_hint(role, nearest.as_deref(), &toml)
            }
            Self::NotNumeric { field: Some(field), .. } => format!("name a field of it, such as '{field}'"),
            Self::NotNumeric { .. } => {
                "in MATLAB, save the fields as plain vectors: t = s.t; save('data.mat', 't', '-v7')"
                    .to_owned()
            }
            Self::NotAVector { .. } => "save one column of it as a variable of its own".to_owned(),
            Self::Length { .. } => "all vectors must have one value a sample".to_owned(),
            Self::NotMat | Self::DamagedMat { .. } => {
                "in MATLAB: load it, then save('data.mat', '-v7'); or write a CSV with \
                 time_s,force_N,position_m"
                    .to_owned()
            }
            Self::UnknownUnit { role, nearest: Some(unit), .. } => {
                format!("did you mean {unit}? {}", unit_hint(role, column, unit, &toml))
            }
            Self::UnknownUnit { role, known, .. } | Self::WrongUnit { role, known, .. } => format!(
                "units of a {role}: {}; {}",
                known.join(", "),
                unit_hint(role, column, "UNIT", &toml)
            ),
            Self::NeedsGain { role, unit } => format!(
                "say how much {role} one {unit} makes: --{role}-gain G, or in {toml}: {role} = {{ gain = G }}"
            ),
            Self::MixedAxis { .. } => {
                "give both as linear (N, m) or both as rotary (Nm, rad), with a gain where needed: \
                 --force-gain G --force-unit Nm"
                    .to_owned()
            }
            Self::TimeBackwards { .. } => {
                "sort the rows by time; where a new run begins, number the runs in a column 'segment'"
                    .to_owned()
            }
            Self::Implausible { role, .. } | Self::Tiny { role, .. } => {
                format!("check unit and gain: --{role}-unit UNIT, --{role}-gain G, or in {toml}")
            }
            Self::Interval { .. } => {
                "say the unit of the time: --time-unit ms, or the interval: --interval S".to_owned()
            }
            Self::Segment { .. } => "number the segments 0, 1, 2, ...".to_owned(),
            Self::Toml { .. } => {
                "an example: hold = \"zero-order\" and force = { column = \"u_V\", gain = 35.15 }"
                    .to_owned()
            }
            Self::Differs { .. } => {
                "files given together must be recordings of one axis, made in one way".to_owned()
            }
            Self::BadNumber { .. } | Self::Recording(_) => return None,
        })
    }
}

fn unit_hint(role: &str, column: Option<&str>, unit: &str, toml: &str) -> String {
    let column = column.unwrap_or("NAME");
    let flag = role.replace('_', "-");
    format!(
        "say it with --{flag} {column} --{flag}-unit {unit}, or in {toml}: \
         {role} = {{ column = \"{column}\", unit = \"{unit}\" }}"
    )
}

fn missing_hint(role: &str, nearest: Option<&str>, toml: &str) -> String {
    let name = nearest.unwrap_or("NAME");
    let question = nearest.map(|name| format!("did you mean '{name}'? ")).unwrap_or_default();
    if role == "effect" || role.contains(' ') {
        return format!(
            "{question}a formula names columns of the file; 'aep effects --formula' says how"
        );
    }
    let flag = role.replace('_', "-");
    format!("{question}name it with --{flag} {name}, or in {toml}: {role} = \"{name}\"")
}
