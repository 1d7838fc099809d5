//! Which column holds what: from flags, from `DATA.toml` beside the data, or by the names alone.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use missing_physics::Hold;
use serde::Deserialize;
use serde::de::{self, Deserializer, MapAccess, Visitor};

use crate::error::{DataError, Problem};
use crate::role::{ALL, ColumnRole};

/// Where the values of one quantity come from. `column * unit * gain` is the value in SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Source {
    /// Column or variable, or a product such as `vir*gtau` or `0.5*u_V`.
    pub column: Option<String>,
    /// Unit of the column times the gain; without it, the ending of the name says it.
    pub unit: Option<String>,
    /// Factor on every value.
    pub gain: Option<f64>,
}

impl Source {
    /// The column called `column`, its unit to be read from the name.
    pub fn column(column: impl Into<String>) -> Self {
        Self { column: Some(column.into()), ..Self::default() }
    }

    fn table(&self) -> toml::Table {
        let column = self.column.clone().map(|column| ("column".to_owned(), column.into()));
        let unit = self.unit.clone().map(|unit| ("unit".to_owned(), unit.into()));
        let gain = self.gain.map(|gain| ("gain".to_owned(), gain.into()));
        column.into_iter().chain(unit).chain(gain).collect()
    }

    /// This, with what it leaves open taken from `other`.
    #[must_use]
    pub fn or(&self, other: &Self) -> Self {
        Self {
            column: self.column.clone().or_else(|| other.column.clone()),
            unit: self.unit.clone().or_else(|| other.unit.clone()),
            gain: self.gain.or(other.gain),
        }
    }
}

/// How to read a file. What is left open is recognised by the names of the columns.
///
/// As `DATA.toml` beside `DATA.csv` or `DATA.mat`:
/// ```toml
/// hold = "zero-order"                        # the force is a command held between samples; else "sampled"
/// time = "t_ms"                              # a column; its unit is the ending of its name
/// force = { column = "u_V", gain = 35.15 }   # N per V
/// position = { column = "enc", gain = 1e-6 }
/// model_force = "0.9*tau_model"             # what your own model gives; any column may be a formula
/// [regressors]
/// joint2 = "a2*cos(q1)"                      # known up to a factor
/// [axes.elbow]                               # several axes in one file: a table for each
/// force = "i_3_A"
/// position = "enc_3"
/// ```
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Mapping {
    /// Time.
    pub time: Source,
    /// Force or torque.
    pub force: Source,
    /// Position or angle.
    pub position: Source,
    /// Velocity.
    pub velocity: Source,
    /// Position that was asked for.
    pub reference: Source,
    /// Number of the piece.
    pub segment: Source,
    /// Temperature.
    pub temperature: Source,
    /// 0 where the drive is switched off: such samples are left out.
    pub enabled: Source,
    /// Force or torque that another model gives for the same samples: what that model lacks is looked for.
    pub model_force: Source,
    /// Known regressors: a name, and a formula over columns. Each becomes a channel [`regressor_channel`].
    pub regressors: BTreeMap<String, String>,
    /// Axes of a file with several, by name: what is read differently for each (`[axes.elbow]`).
    pub axes: BTreeMap<String, Mapping>,
    /// Columns that are kept as they are, for laws that read them. Each becomes a channel [`column_channel`].
    #[serde(skip)]
    pub columns: Vec<String>,
    /// Sampling interval in seconds, for files without a time.
    pub interval_s: Option<f64>,
    /// Topic of an MCAP file, where several have joints.
    pub topic: Option<String>,
    /// How the input acts between samples: `zero-order` or `sampled`.
    #[serde(deserialize_with = "hold")]
    pub hold: Option<Hold>,
}

impl Mapping {
    /// The source of a role.
    pub fn source(&self, role: ColumnRole) -> &Source {
        match role {
            ColumnRole::Time => &self.time,
            ColumnRole::Force => &self.force,
            ColumnRole::Position => &self.position,
            ColumnRole::Velocity => &self.velocity,
            ColumnRole::Reference => &self.reference,
            ColumnRole::Segment => &self.segment,
            ColumnRole::Temperature => &self.temperature,
            ColumnRole::Enabled => &self.enabled,
            ColumnRole::ModelForce => &self.model_force,
        }
    }

    /// This, with what it leaves open taken from `other`: flags come before the file's own mapping.
    #[must_use]
    pub fn or(&self, other: &Self) -> Self {
        Self {
            time: self.time.or(&other.time),
            force: self.force.or(&other.force),
            position: self.position.or(&other.position),
            velocity: self.velocity.or(&other.velocity),
            reference: self.reference.or(&other.reference),
            segment: self.segment.or(&other.segment),
            temperature: self.temperature.or(&other.temperature),
            enabled: self.enabled.or(&other.enabled),
            model_force: self.model_force.or(&other.model_force),
            regressors: joined(&self.regressors, &other.regressors),
            axes: if self.axes.is_empty() { other.axes.clone() } else { self.axes.clone() },
            columns: self.columns.iter().chain(&other.columns).cloned().collect(),
            interval_s: self.interval_s.or(other.interval_s),
            topic: self.topic.clone().or_else(|| other.topic.clone()),
            hold: self.hold.or(other.hold),
        }
    }

    /// The mapping written in `text`, the content of the file `path`.
    ///
    /// # Errors
    /// What the format's reader says, with the line.
    pub fn parse(text: &str, path: &Path) -> Result<Self, DataError> {
        toml::from_str(text).map_err(|error| {
            let line = error.span().map(|span| 1 + text[..span.start].matches('\n').count() as u64);
            let message = error.message().trim().to_owned();
            DataError::new(path, Problem::Toml { message }).at_line(line)
        })
    }

    /// The text that [`parse`](Self::parse) reads back; columns for laws are no part of it.
    pub fn to_toml(&self) -> String {
        self.table().to_string()
    }

    fn table(&self) -> toml::Table {
        let sources = ALL.iter().filter_map(|facts| {
            let source = self.source(facts.role).table();
            (!source.is_empty()).then(|| (facts.name.to_owned(), source.into()))
        });
        let mut table: toml::Table = sources.collect();
        let regressors = self.regressors.iter();
        let regressors: toml::Table =
            regressors.map(|(name, formula)| (name.clone(), formula.clone().into())).collect();
        let axes = self.axes.iter();
        let axes: toml::Table =
            axes.map(|(name, axis)| (name.clone(), axis.table().into())).collect();
        for (name, part) in [("regressors", regressors), ("axes", axes)] {
            if !part.is_empty() {
                table.insert(name.to_owned(), part.into());
            }
        }
        table.extend(self.interval_s.map(|interval| ("interval_s".to_owned(), interval.into())));
        table.extend(self.topic.clone().map(|topic| ("topic".to_owned(), topic.into())));
        table.extend(self.hold.map(|hold| ("hold".to_owned(), hold_name(hold).into())));
        table
    }

    /// The mapping in `DATA.toml` beside `data`, or the one that leaves all open where there is none.
    ///
    /// # Errors
    /// A file that is there but cannot be read or understood.
    pub fn beside(data: &Path) -> Result<Self, DataError> {
        let path = data.with_extension("toml");
        if path == data || !path.is_file() {
            return Ok(Self::default());
        }
        let text = std::fs::read_to_string(&path).map_err(|error| {
            DataError::new(&path, Problem::Unreadable { message: error.to_string() })
        })?;
        Self::parse(&text, &path)
    }
}

/// The channel of a recording that holds a known regressor.
pub fn regressor_channel(name: &str) -> String {
    format!("regressor {name}")
}

/// The channel of a recording that holds a column as it stands in the file.
pub fn column_channel(name: &str) -> String {
    format!("column {name}")
}

/// All regressors of both, those of the first one where both have a name.
fn joined(
    first: &BTreeMap<String, String>,
    second: &BTreeMap<String, String>,
) -> BTreeMap<String, String> {
    let mut all = second.clone();
    all.extend(first.iter().map(|(name, formula)| (name.clone(), formula.clone())));
    all
}

/// Reads `zero-order` or `sampled`.
///
/// # Errors
/// Anything else, with the two names.
pub fn parse_hold(text: &str) -> Result<Hold, String> {
    match text {
        "zero-order" => Ok(Hold::ZeroOrder),
        "sampled" => Ok(Hold::Sampled),
        other => Err(format!("unknown hold '{other}': it is \"zero-order\" or \"sampled\"")),
    }
}

/// The name under which [`parse_hold`] reads it back.
pub fn hold_name(hold: Hold) -> &'static str {
    match hold {
        Hold::ZeroOrder => "zero-order",
        Hold::Sampled => "sampled",
    }
}

fn hold<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Hold>, D::Error> {
    let text = String::deserialize(deserializer)?;
    parse_hold(&text).map(Some).map_err(de::Error::custom)
}

/// `force = "u_V"` or `force = { column = "u_V", gain = 35.15 }`.
impl<'de> Deserialize<'de> for Source {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(SourceVisitor)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SourceTable {
    column: Option<String>,
    unit: Option<String>,
    gain: Option<f64>,
}

struct SourceVisitor;

impl<'de> Visitor<'de> for SourceVisitor {
    type Value = Source;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a column, or { column = \"NAME\", unit = \"UNIT\", gain = G }")
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<Source, E> {
        Ok(Source::column(name))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Source, A::Error> {
        let table = SourceTable::deserialize(de::value::MapAccessDeserializer::new(map))?;
        Ok(Source { column: table.column, unit: table.unit, gain: table.gain })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Mapping, DataError> {
        Mapping::parse(text, Path::new("run.toml"))
    }

    #[test]
    fn a_source_is_a_name_or_a_table() {
        let mapping = parse(
            "hold = \"zero-order\"\ntime = \"t_ms\"\n[force]\ncolumn = \"u_V\"\ngain = 35.15\n",
        )
        .unwrap();
        assert_eq!(mapping.hold, Some(Hold::ZeroOrder));
        assert_eq!(mapping.time, Source::column("t_ms"));
        assert_eq!(mapping.force.gain, Some(35.15));
        assert_eq!(mapping.position, Source::default());
    }

    #[test]
    fn what_is_written_reads_back_whatever_the_names_are() {
        let mut mapping = parse(
            "hold = \"sampled\"\ninterval_s = 1e-3\ntopic = \"/a\"\ntime = \"t_ms\"\n[regressors]\na = \"b*c\"\n[axes.elbow]\nforce = \"i\"\n",
        )
        .unwrap();
        mapping.force = Source {
            column: Some("a \"b\"]\n[time]".into()),
            unit: Some("N".into()),
            gain: Some(-35.15),
        };
        assert_eq!(parse(&mapping.to_toml()).unwrap(), mapping);
        assert_eq!(parse(&Mapping::default().to_toml()).unwrap(), Mapping::default());
    }

    #[test]
    fn a_misspelt_field_names_line_and_fields() {
        let error = parse("hold = \"sampled\"\nfroce = \"u\"\n").unwrap_err();
        assert_eq!(error.line, Some(2));
        assert!(error.to_string().contains("froce") && error.to_string().contains("force"));
        let error = parse("hold = \"first-order\"\n").unwrap_err();
        assert!(error.to_string().contains("zero-order"), "{error}");
    }

    #[test]
    fn flags_come_before_the_file() {
        let file = parse("force = { column = \"u\", gain = 2.0 }").unwrap();
        let flags = Mapping {
            force: Source { gain: Some(3.0), ..Source::default() },
            ..Mapping::default()
        };
        let both = flags.or(&file);
        assert_eq!(both.force.gain, Some(3.0));
        assert_eq!(both.force.column.as_deref(), Some("u"));
    }
}
