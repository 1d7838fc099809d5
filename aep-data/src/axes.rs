//! Several axes in one file: which columns belong to which joint.
//!
//! | columns | axes |
//! |---|---|
//! | `tau_0, tau_1, q_0, q_1`, also as `q` of N x 2 in `.npz` or lists in Parquet | 0, 1 |
//! | `position_1_rad, joint2_position, torque_1, joint2_torque` | 1, 2 |
//! | `elbow_angle, elbow_torque_Nm`, `position.elbow` | elbow |
//! | any, by `--force 'u_{}' --position 'enc_{}'` | what stands at `{}` in the names of columns |
//! | any, by `[axes.NAME]` in `DATA.toml` | those |

use std::path::{Path, PathBuf};

use crate::assemble::{Loaded, assemble};
use crate::error::{DataError, Problem};
use crate::header::Header;
use crate::mapping::{Mapping, Source};
use crate::role::ColumnRole;
use crate::{open, several, unit};

/// What stands for the name of an axis in a flag.
pub const PLACE: &str = "{}";
/// Most words of a name that name a joint: `left_upper_arm`.
const MOST_WORDS: usize = 3;
/// Roles that each axis has columns of its own for.
const ROLES: [ColumnRole; 6] = [
    ColumnRole::Force,
    ColumnRole::Position,
    ColumnRole::Velocity,
    ColumnRole::Reference,
    ColumnRole::Temperature,
    ColumnRole::Enabled,
];

/// Which axes are wanted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Axes {
    /// All that are found.
    All,
    /// These, by number or name.
    Named(Vec<String>),
}

/// The recordings of the axes of a file.
#[derive(Clone, Debug)]
pub struct LoadedAxes {
    /// Names with recordings, in the order of the file, or as they were asked for.
    pub axes: Vec<(String, Loaded)>,
    /// Joints that have a position, but no force.
    pub without_force: Vec<String>,
}

/// The columns of an axis.
#[derive(Clone, Debug, PartialEq)]
struct Found {
    name: String,
    mapping: Mapping,
}

/// The axes in `paths`, the pieces of one measurement, each as a recording of its own.
///
/// # Errors
/// Like [`read_all`](crate::read_all); and where no axis, or none of a name, is there.
pub fn read_axes(
    paths: &[PathBuf],
    mapping: &Mapping,
    wanted: &Axes,
) -> Result<LoadedAxes, DataError> {
    let Some((first, others)) = paths.split_first() else {
        return Err(DataError::new(Path::new(""), Problem::Absent));
    };
    let (table, beside) = open(first, mapping)?;
    let names = table.names();
    let (all, without_force) = axes(&names, &beside);
    if all.is_empty() {
        let problem = Problem::NoAxes { present: names };
        return Err(DataError::new(first, problem));
    }
    let chosen = chosen(all, wanted).map_err(|problem| DataError::new(first, problem))?;
    let mut pieces: Vec<Vec<Loaded>> = Vec::new();
    for axis in &chosen {
        pieces.push(vec![assemble(first, &*table, &axis.mapping)?]);
    }
    drop(table);
    for path in others {
        let (table, beside) = open(path, mapping)?;
        let (all, _) = axes(&table.names(), &beside);
        for (axis, pieces) in chosen.iter().zip(&mut pieces) {
            let here = all.iter().find(|other| other.name == axis.name);
            let mapping = here.map_or(&axis.mapping, |here| &here.mapping);
            pieces.push(assemble(path, &*table, mapping)?);
        }
    }
    let whole = chosen.into_iter().zip(pieces).map(|(axis, pieces)| {
        several::join(paths.iter().zip(pieces).map(|(path, piece)| Ok((path, piece))))
            .map(|loaded| (axis.name, loaded))
    });
    Ok(LoadedAxes { axes: whole.collect::<Result<_, _>>()?, without_force })
}

fn chosen(all: Vec<Found>, wanted: &Axes) -> Result<Vec<Found>, Problem> {
    let Axes::Named(names) = wanted else { return Ok(all) };
    let mut chosen: Vec<Found> = Vec::new();
    for name in names {
        let found = all.iter().find(|axis| axis.name.eq_ignore_ascii_case(plain(name)));
        let Some(found) = found else {
            let present = all.into_iter().map(|axis| axis.name).collect();
            return Err(Problem::NoAxis { name: name.clone(), present });
        };
        if !chosen.contains(found) {
            chosen.push(found.clone());
        }
    }
    Ok(chosen)
}

/// The axes that columns called `names` make, and joints with a position but no force.
fn axes(names: &[String], mapping: &Mapping) -> (Vec<Found>, Vec<String>) {
    if !mapping.axes.is_empty() {
        let shared = Mapping { axes: std::collections::BTreeMap::new(), ..mapping.clone() };
        let each = mapping.axes.iter().map(|(name, own)| Found {
            name: name.clone(),
            mapping: filled(&own.or(&shared), name),
        });
        return (each.collect(), Vec::new());
    }
    let mut keys: Vec<String> = Vec::new();
    let own: Vec<(ColumnRole, String, &String)> = ROLES
        .iter()
        .filter(|role| mapping.source(**role).column.is_none())
        .flat_map(|role| {
            names.iter().filter_map(|name| key(*role, name).map(|key| (*role, key, name)))
        })
        .collect();
    let patterns = ROLES.iter().filter_map(|role| mapping.source(*role).column.as_deref());
    for key in patterns.flat_map(|pattern| matched(pattern, names)) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    for (_, key, _) in &own {
        if !keys.contains(key) {
            keys.push(key.clone());
        }
    }
    // Numbers by size, then names in the order of the file.
    keys.sort_by_key(|key| key.parse::<u64>().unwrap_or(u64::MAX));
    let (mut found, mut without_force) = (Vec::new(), Vec::new());
    for key in keys {
        let mut all = filled(mapping, &key);
        for (role, _, name) in own.iter().filter(|(_, other, _)| *other == key) {
            let source = source_of(&mut all, *role);
            if source.column.is_none() {
                source.column = Some((*name).clone());
            }
        }
        let has = |role: ColumnRole| {
            let column = all.source(role).column.as_deref();
            // A name of a column that is not there; what a formula lacks is told when it is read.
            column.is_some_and(|column| {
                column.contains(['(', '*', '+', '/', '-', '`'])
                    || names.iter().any(|name| name == column)
            })
        };
        match (has(ColumnRole::Force), has(ColumnRole::Position) || has(ColumnRole::Velocity)) {
            (true, true) => found.push(Found { name: key, mapping: all }),
            (false, true) => without_force.push(key),
            _ => {}
        }
    }
    (found, without_force)
}

fn source_of(mapping: &mut Mapping, role: ColumnRole) -> &mut Source {
    match role {
        ColumnRole::Time => &mut mapping.time,
        ColumnRole::Force => &mut mapping.force,
        ColumnRole::Position => &mut mapping.position,
        ColumnRole::Velocity => &mut mapping.velocity,
        ColumnRole::Reference => &mut mapping.reference,
        ColumnRole::Segment => &mut mapping.segment,
        ColumnRole::Temperature => &mut mapping.temperature,
        ColumnRole::Enabled => &mut mapping.enabled,
        ColumnRole::ModelForce => &mut mapping.model_force,
    }
}

/// A mapping with the name of an axis at every place for it.
fn filled(mapping: &Mapping, name: &str) -> Mapping {
    let mut filled = mapping.clone();
    for role in crate::role::ALL {
        let source = source_of(&mut filled, role.role);
        source.column = source.column.as_ref().map(|column| column.replace(PLACE, name));
    }
    for formula in filled.regressors.values_mut() {
        *formula = formula.replace(PLACE, name);
    }
    filled
}

/// What stands at the place for an axis in names that are otherwise `pattern`.
fn matched(pattern: &str, names: &[String]) -> Vec<String> {
    let Some((before, after)) = pattern.split_once(PLACE) else { return Vec::new() };
    let within = |name: &String| {
        let key = name.strip_prefix(before)?.strip_suffix(after)?;
        (!key.is_empty()).then(|| key.to_owned())
    };
    names.iter().filter_map(within).collect()
}

/// The joint that a column of `role` belongs to: what is left of its name beside a name of the role and a unit.
fn key(role: ColumnRole, name: &str) -> Option<String> {
    let is = |header: &Header<'_>| {
        role.facts().aliases.contains(&header.base.as_str())
            && header.unit.is_none_or(|unit| role.accepts(unit.quantity))
    };
    let (words, unit) = words(name);
    // The name of a single axis.
    if is(&Header::parse(name)) {
        return None;
    }
    (1..=MOST_WORDS).find_map(|count| {
        // A number names a joint rather than a word does.
        // Something must be left beside it.
        let last = words.len().checked_sub(count).filter(|last| *last > 0)?;
        let mut starts: Vec<usize> = (0..=last).collect();
        starts.sort_by_key(|start| !is_number(words[*start]));
        starts.into_iter().find_map(|start| {
            let key = &words[start..start + count];
            let rest = [&words[..start], &words[start + count..]].concat().join("_") + &unit;
            let is_unit = key.iter().any(|word| !is_number(word) && unit::find(word).is_some());
            (!is_unit && is(&Header::parse(&rest))).then(|| plain(&key.join("_")).to_owned())
        })
    })
}

fn is_number(word: &str) -> bool {
    word.bytes().all(|byte| byte.is_ascii_digit())
}

/// `1` for `joint1`, `joint_1`, `axis_1`, `j1`.
fn plain(key: &str) -> &str {
    let start = key.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_');
    let is_joint = ["joint", "axis", "j"].iter().any(|word| start.eq_ignore_ascii_case(word));
    match key[start.len()..].trim_start_matches('_') {
        number if is_joint && !number.is_empty() => number,
        _ => key,
    }
}

/// The words of a name, digits at the end of one as a word of their own, and a unit in brackets behind them.
fn words(name: &str) -> (Vec<&str>, String) {
    let (name, unit) = match Header::parse(name).bracketed {
        Some(text) => {
            let cut = name.rfind(['[', '(']).unwrap_or(name.len());
            (&name[..cut], format!(" [{text}]"))
        }
        None => (name, String::new()),
    };
    let parts = name.split(['_', '.', '-', '/', ' ', '[', ']', '(', ')']);
    let words = parts.filter(|part| !part.is_empty()).flat_map(|part| {
        let (letters, digits) =
            part.split_at(part.trim_end_matches(|c: char| c.is_ascii_digit()).len());
        [letters, digits].into_iter().filter(|word| !word.is_empty())
    });
    (words.collect(), unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(names: &str, mapping: &Mapping) -> (Vec<String>, Vec<String>) {
        let names: Vec<String> = names.split(',').map(str::to_owned).collect();
        let (all, without) = axes(&names, mapping);
        let column = |source: &Source| source.column.clone().unwrap_or_default();
        let told = |axis: Found| {
            let m = &axis.mapping;
            format!("{}: {} {}", axis.name, column(&m.force), column(&m.position))
        };
        (all.into_iter().map(told).collect(), without)
    }

    #[test]
    fn columns_of_a_joint_are_told_by_its_number_or_its_name() {
        let none = Mapping::default();
        for (names, told) in [
            ("t,tau_0,tau_1,q_0,q_1,dq_0", ["0: tau_0 q_0", "1: tau_1 q_1"]),
            ("t,q1,q2,tau1_Nm,tau2_Nm", ["1: tau1_Nm q1", "2: tau2_Nm q2"]),
            (
                "time_s,position_1_rad,position_2_rad,torque_Nm_1,torque_Nm_2,model_1",
                ["1: torque_Nm_1 position_1_rad", "2: torque_Nm_2 position_2_rad"],
            ),
            (
                "t,joint1_position,joint_2_position,joint1.torque,joint2.torque",
                ["1: joint1.torque joint1_position", "2: joint2.torque joint_2_position"],
            ),
            (
                "t,left_arm_angle,elbow_angle [deg],left_arm_torque,torque.elbow",
                [
                    "left_arm: left_arm_torque left_arm_angle",
                    "elbow: torque.elbow elbow_angle [deg]",
                ],
            ),
            ("t,position[0],position[1],f[0],f[1]", ["0: f[0] position[0]", "1: f[1] position[1]"]),
        ] {
            let (mut here, mut told) = (found(names, &none).0, told.map(str::to_owned).to_vec());
            here.sort();
            told.sort();
            assert_eq!(here, told, "{names}");
        }
    }

    #[test]
    fn a_single_axis_is_no_group_and_a_joint_without_force_is_told() {
        let none = Mapping::default();
        assert_eq!(found("time_s,force_N,position_m,velocity_m_s", &none).0, [""; 0]);
        assert_eq!(found("t,duty,v_in_V,q", &none).0, [""; 0]);
        let (all, without) = found("t,q_1,q_2,tau_1", &none);
        assert_eq!((all.len(), without), (1, vec!["2".to_owned()]));
    }

    #[test]
    fn other_names_are_told_by_a_place_for_the_axis_or_by_tables() {
        let flags = Mapping {
            force: Source::column("u_{}"),
            position: Source::column("0.5*enc{}"),
            ..Mapping::default()
        };
        let all = found("t,u_a,u_b,enca,encb", &flags).0;
        assert_eq!(all, ["a: u_a 0.5*enca", "b: u_b 0.5*encb"]);
        let text = "time = \"t_ms\"\n[axes.x]\nforce = \"f1\"\nposition = \"p1\"\n[axes.y]\nforce = \"f2\"\n";
        let tables = Mapping::parse(text, Path::new("run.toml")).unwrap();
        assert_eq!(found("t_ms,f1,f2", &tables).0, ["x: f1 p1", "y: f2 "]);
        let time = axes(&[], &tables).0[1].mapping.time.clone();
        assert_eq!(time, Source::column("t_ms"));
    }

    #[test]
    fn numbers_are_in_order_and_asked_for_by_any_name() {
        let names: Vec<String> =
            (1..=12).rev().flat_map(|k| [format!("q_{k}"), format!("tau_{k}")]).collect();
        let (all, _) = axes(&names, &Mapping::default());
        let order: Vec<&str> = all.iter().map(|axis| axis.name.as_str()).collect();
        assert_eq!((order[0], order[1], order[11]), ("1", "2", "12"));
        let some = Axes::Named(vec!["joint3".to_owned(), "1".to_owned()]);
        let picked = chosen(all.clone(), &some).unwrap();
        assert_eq!([&picked[0].name, &picked[1].name], ["3", "1"]);
        let none = chosen(all, &Axes::Named(vec!["13".to_owned()]));
        assert!(matches!(none, Err(Problem::NoAxis { .. })));
    }
}
