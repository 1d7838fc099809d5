//! From the columns of a file to a checked recording in SI.

use std::collections::BTreeSet;
use std::path::Path;

use missing_physics::{Channel, Recording, RecordingError};

use crate::enabled::switched_on;
use crate::error::{DataError, Problem};
use crate::expression::Expression;
use crate::kept::{Kept, LeftOut, MOST, repeated};
use crate::layouts::Layout;
use crate::mapping::{Mapping, column_channel, regressor_channel};
use crate::pick::{Pick, Said};
use crate::role::{self, ColumnRole};
use crate::table::Table;

/// Largest value in SI that any channel may have.
const LARGEST: f64 = 1e12;
/// Smallest range in SI of a channel that changes at all.
const SMALLEST: f64 = 1e-12;
/// Shortest and longest sampling interval, s.
const SHORTEST: f64 = 1e-8;
const LONGEST: f64 = 10.0;

/// A recording and how it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The measurement, in SI.
    pub recording: Recording,
    /// Where each quantity came from.
    pub origins: Vec<Origin>,
    /// The published data set whose names were recognised.
    pub layout: Option<&'static str>,
    /// Columns that nothing was read from.
    pub unused: Vec<String>,
    /// Samples left out because the drive was switched off.
    pub switched_off: usize,
    /// Rows left out because they have no number, or the time of the row before.
    pub left_out: LeftOut,
}

/// Where a quantity came from.
#[derive(Clone, Debug, PartialEq)]
pub struct Origin {
    /// Name of the channel, or `time`.
    pub channel: &'static str,
    /// Column or product in the file.
    pub column: String,
    /// SI unit that it has now.
    pub unit: &'static str,
}

/// Reads the quantities that `mapping` names, or that the names of the columns tell.
pub(crate) fn assemble(
    path: &Path,
    table: &dyn Table,
    mapping: &Mapping,
) -> Result<Loaded, DataError> {
    let names = table.names();
    let layout = Layout::of(&names);
    let mapping = layout.map_or_else(|| mapping.clone(), |known| mapping.or(&known.mapping()));
    let mut picks = picks(path, table, &mapping)?;
    drop_sparse(&mut picks, table, &mapping)?;
    let rotary = is_rotary(&picks).map_err(|problem| DataError::new(path, problem))?;
    same_effort(&picks).map_err(|problem| DataError::new(path, problem))?;
    let extras = extras(path, table, &mapping)?;
    let (kept, left_out) = kept(path, table, &picks, &extras)?;
    let (recording, switched_off) = recording(path, &kept, &mapping, (&picks, &extras), rotary)?;
    let origins = picks.iter().map(|pick| origin(pick, &picks, rotary)).collect();
    let used = |name: &String| {
        let beside = extras.iter().flat_map(|(_, expression)| expression.columns());
        picks.iter().flat_map(Pick::columns).chain(beside).any(|used| used == name)
    };
    let unused = names.iter().filter(|name| !used(name)).cloned().collect();
    Ok(Loaded {
        recording,
        origins,
        layout: layout.map(|known| known.name),
        unused,
        switched_off,
        left_out,
    })
}

/// Leaves out what nobody asked for where it has no number in many rows: a temperature that is read once a second.
fn drop_sparse(
    picks: &mut Vec<Pick>,
    table: &dyn Table,
    mapping: &Mapping,
) -> Result<(), DataError> {
    let mut sparse = Vec::new();
    for (k, pick) in picks.iter().enumerate() {
        if pick.role.is_required() || mapping.source(pick.role).column.is_some() {
            continue;
        }
        for name in pick.columns() {
            let values = table.column(name)?.values;
            let missing = values.iter().filter(|value| !value.is_finite()).count();
            if missing as f64 > MOST * values.len() as f64 {
                sparse.push(k);
                break;
            }
        }
    }
    sparse.iter().rev().for_each(|k| drop(picks.remove(*k)));
    Ok(())
}

/// The rows that have all numbers and a time of their own.
fn kept<'a>(
    path: &Path,
    table: &'a dyn Table,
    picks: &[Pick],
    extras: &[(String, Expression)],
) -> Result<(Kept<'a>, LeftOut), DataError> {
    let beside = extras.iter().flat_map(|(_, expression)| expression.columns());
    let columns: BTreeSet<&str> = picks.iter().flat_map(Pick::columns).chain(beside).collect();
    let kept = Kept::of(table, &columns, path)?;
    let missing = kept.left_out();
    let of = |role: ColumnRole| picks.iter().find(|pick| pick.role == role);
    let Some(time) = of(ColumnRole::Time) else {
        return Ok((kept, LeftOut { missing, repeated: 0 }));
    };
    let values = time.values(&kept, path)?;
    let segment = of(ColumnRole::Segment).map(|pick| pick.values(&kept, path)).transpose()?;
    if values.len() != kept.len() {
        return Ok((kept, LeftOut { missing, repeated: 0 }));
    }
    let again = repeated(&values, segment.as_deref());
    let (rows, repeated) = (kept.len(), again.len());
    if repeated as f64 > MOST * rows as f64 {
        let error = DataError::new(path, Problem::TooManyRepeated { repeated, rows });
        let first = again[0];
        return Err(error.at_sample(first, kept.line(first)).in_column(&time.expression.text));
    }
    Ok((kept.without(&again), LeftOut { missing, repeated }))
}

/// Channels beside those of roles: regressors, and columns for laws that read them.
fn extras(
    path: &Path,
    table: &dyn Table,
    mapping: &Mapping,
) -> Result<Vec<(String, Expression)>, DataError> {
    let names = table.names();
    let regressors = mapping.regressors.iter().map(|(name, formula)| {
        let role = format!("regressor '{name}'");
        Expression::find(&role, formula, table).map(|found| (regressor_channel(name), found))
    });
    let mut columns: Vec<&String> = mapping.columns.iter().collect();
    columns.sort_unstable();
    columns.dedup();
    let columns = columns.into_iter().map(|name| {
        // The name of a column, not a formula: a formula names the columns that it reads.
        if !names.contains(name) {
            return Err(table.missing("effect", Some(name)));
        }
        Expression::find("effect", name, table).map(|found| (column_channel(name), found))
    });
    let all: Result<Vec<_>, Problem> = regressors.chain(columns).collect();
    all.map_err(|problem| DataError::new(path, problem))
}

fn picks(path: &Path, table: &dyn Table, mapping: &Mapping) -> Result<Vec<Pick>, DataError> {
    let mut picks = Vec::new();
    for facts in role::ALL {
        let counted = facts.role == ColumnRole::Time
            && mapping.interval_s.is_some()
            && mapping.time.column.is_none();
        if !counted {
            picks.extend(Pick::find(facts.role, mapping.source(facts.role), table, path)?);
        }
    }
    Ok(picks)
}

/// Unit of a channel: that of the axis, or V or A where the force is one.
fn unit_of(pick: &Pick, picks: &[Pick], rotary: bool) -> &'static str {
    let force = picks.iter().find(|other| other.role == ColumnRole::Force);
    let electrical = match pick.role {
        ColumnRole::Force => pick.electrical(),
        // What says no unit of its own is in that of the force.
        ColumnRole::ModelForce => force.and_then(Pick::electrical),
        _ => None,
    };
    electrical.unwrap_or_else(|| unit(pick.role, rotary))
}

/// Refuses a model's force in another kind of unit than the force's.
fn same_effort(picks: &[Pick]) -> Result<(), Problem> {
    let of = |role: ColumnRole| picks.iter().find(|pick| pick.role == role);
    let (Some(force), Some(model)) = (of(ColumnRole::Force), of(ColumnRole::ModelForce)) else {
        return Ok(());
    };
    let (there, here) = (force.electrical(), model.electrical());
    let says_nothing = matches!(model.said, Said::Nothing | Said::Rotary) && here.is_none();
    if there == here || (there.is_some() && says_nothing) {
        return Ok(());
    }
    let name = |unit: Option<&'static str>| unit.unwrap_or("N or Nm");
    let unit = name(here).to_owned();
    Err(Problem::WrongUnit { role: "model_force", unit, known: vec![name(there)] })
}

fn unit(role: ColumnRole, rotary: bool) -> &'static str {
    let facts = role.facts();
    if rotary { facts.rotary.si() } else { facts.linear.si() }
}

fn origin(pick: &Pick, picks: &[Pick], rotary: bool) -> Origin {
    let unit = unit_of(pick, picks, rotary);
    Origin { channel: pick.role.facts().name, column: pick.expression.text.clone(), unit }
}

/// Whether the axis turns. Where no unit says so, it is linear.
fn is_rotary(picks: &[Pick]) -> Result<bool, Problem> {
    let first = |wanted: bool| picks.iter().find(|pick| pick.is_rotary() == Some(wanted));
    let described =
        |pick: &Pick, rotary| format!("'{}' in {}", pick.expression.text, unit(pick.role, rotary));
    match (first(false), first(true)) {
        (Some(linear), Some(rotary)) => Err(Problem::MixedAxis {
            linear: described(linear, false),
            rotary: described(rotary, true),
        }),
        (_, rotary) => Ok(rotary.is_some()),
    }
}

fn recording(
    path: &Path,
    table: &dyn Table,
    mapping: &Mapping,
    (picks, extras): (&[Pick], &[(String, Expression)]),
    rotary: bool,
) -> Result<(Recording, usize), DataError> {
    let mut time = None;
    let mut enabled = None;
    let mut segment = None;
    let mut channels = Vec::new();
    for pick in picks {
        let values = pick.values(table, path)?;
        match pick.role {
            ColumnRole::Time => time = Some(values),
            ColumnRole::Segment => segment = Some(whole(&values, pick, table, path)?),
            ColumnRole::Enabled => enabled = Some(values),
            role => {
                let unit = unit_of(pick, picks, rotary);
                check_size(&values, unit, pick, table, path)?;
                channels.push(Channel::new(role.facts().name, unit, values));
            }
        }
    }
    let samples = channels.iter().map(|channel| channel.values.len()).max().unwrap_or(0);
    for (channel, expression) in extras {
        let mut values = expression.values(table, path)?;
        if values.len() == 1 {
            values = vec![values[0]; samples];
        }
        if values.len() != samples {
            let (name, values) = (expression.text.clone(), values.len());
            return Err(DataError::new(path, Problem::Length { name, values, samples }));
        }
        if channel.starts_with("regressor ") && values.iter().all(|value| *value == 0.0) {
            let formula = expression.text.clone();
            return Err(DataError::new(path, Problem::Nothing { formula }));
        }
        if let Some(sample) = values.iter().position(|value| value.abs() > LARGEST) {
            let value = values[sample];
            let problem = Problem::Implausible { role: "column", value, unit: "" };
            let error = DataError::new(path, problem).at_sample(sample, table.line(sample));
            return Err(error.in_column(&expression.text));
        }
        channels.push(Channel::new(channel, "", values));
    }
    let time = times(time, mapping.interval_s, samples).map_err(|p| DataError::new(path, p))?;
    let segment = segment.unwrap_or_else(|| vec![0; time.len()]);
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let recording = Recording::with_segments(name, time, channels, segment)
        .map_err(|error| located(error, picks, table, path))?;
    check_interval(recording.interval()).map_err(|problem| DataError::new(path, problem))?;
    let recording = match mapping.hold {
        Some(hold) => recording.with_hold(hold),
        None => recording,
    };
    let Some(enabled) = enabled.filter(|enabled| enabled.contains(&0.0)) else {
        return Ok((recording, 0));
    };
    let (samples, values) = (recording.len(), enabled.len());
    if samples != values {
        let problem = Problem::Length { name: "enabled".to_owned(), values, samples };
        return Err(DataError::new(path, problem));
    }
    let left = switched_on(&recording, &enabled)
        .map_err(|error| DataError::new(path, Problem::Recording(error)))?;
    let switched_off = samples - left.len();
    Ok((left, switched_off))
}

/// Refuses values so large, or changes so small, that no machine has them and that squares of them are no numbers.
fn check_size(
    values: &[f64],
    unit: &'static str,
    pick: &Pick,
    table: &dyn Table,
    path: &Path,
) -> Result<(), DataError> {
    let role = pick.role.facts().name;
    let Some(sample) = values.iter().position(|value| value.abs() > LARGEST) else {
        let (low, high) =
            values.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(*x), h.max(*x)));
        if high > low && high - low < SMALLEST {
            let problem = Problem::Tiny { role, range: high - low, unit };
            return Err(DataError::new(path, problem).in_column(&pick.expression.text));
        }
        return Ok(());
    };
    let value = values[sample];
    let error = DataError::new(path, Problem::Implausible { role, value, unit });
    Err(error.at_sample(sample, table.line(sample)).in_column(&pick.expression.text))
}

/// Refuses intervals that come of a wrong unit; one sample a segment has none.
fn check_interval(interval: f64) -> Result<(), Problem> {
    if interval == 0.0 || (SHORTEST..=LONGEST).contains(&interval) {
        return Ok(());
    }
    Err(Problem::Interval { interval })
}

/// The times: as recorded, or counted from an interval.
fn times(
    recorded: Option<Vec<f64>>,
    interval: Option<f64>,
    samples: usize,
) -> Result<Vec<f64>, Problem> {
    let interval = match recorded {
        Some(time) if time.len() != 1 || samples == 1 => return Ok(time),
        // A single value is the sampling interval, as many MATLAB files keep it.
        Some(time) => time.first().copied(),
        None => interval,
    };
    let interval = interval.unwrap_or(0.0);
    if !(interval > 0.0 && interval.is_finite()) {
        let what = "the sampling interval".to_owned();
        return Err(Problem::BadNumber { what, value: interval, must: "a time in s above 0" });
    }
    Ok((0..samples).map(|sample| sample as f64 * interval).collect())
}

fn whole(
    values: &[f64],
    pick: &Pick,
    table: &dyn Table,
    path: &Path,
) -> Result<Vec<i64>, DataError> {
    let broken = values.iter().position(|value| value.fract() != 0.0 || value.abs() > 1e15);
    if let Some(sample) = broken {
        let error = DataError::new(path, Problem::Segment { value: values[sample] });
        return Err(error.at_sample(sample, table.line(sample)).in_column(&pick.expression.text));
    }
    Ok(values.iter().map(|&value| value as i64).collect())
}

/// The recording counts samples; the user's file has lines and columns.
fn located(error: RecordingError, picks: &[Pick], table: &dyn Table, path: &Path) -> DataError {
    let column = |channel: &str| {
        let pick = picks.iter().find(|pick| pick.role.facts().name == channel);
        pick.map_or(channel, |pick| &pick.expression.text).to_owned()
    };
    match error {
        RecordingError::TimeNotIncreasing { index, before, after } => {
            DataError::new(path, Problem::TimeBackwards { before, after })
                .at_sample(index, table.line(index))
                .in_column(column("time"))
        }
        RecordingError::NotFinite { channel, index, value } => {
            DataError::new(path, Problem::NotANumber { value: value.to_string() })
                .at_sample(index, table.line(index))
                .in_column(column(&channel))
        }
        RecordingError::Length { channel, values, samples } => {
            DataError::new(path, Problem::Length { name: column(&channel), values, samples })
        }
        other => DataError::new(path, Problem::Recording(other)),
    }
}
