//! A recording and how it is read: brought, looked at, taken.

use std::path::Path;
use std::sync::Arc;

use aep_data::{Mapping, ROLES, hold_name, parse, preview};
use missing_physics::measurement::check::check;
use serde_json::{Map, Value, json};

use super::project::safe_name;
use super::task::Task;
use super::{Studio, jobs};
use crate::failure::Failure;
use crate::{example, output, report};

/// Copies a recording from this machine into the project, with what lies beside it.
pub fn bring(studio: &Studio, path: &Path) -> Result<(), Failure> {
    let bytes = |path: &Path| {
        std::fs::read(path).map_err(|error| {
            Failure::bad_input(format!("cannot read the file: {error}")).in_file(path)
        })
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let beside = path.with_extension("toml");
    let content = bytes(path)?;
    // Started again with the file that its models are of, a project goes on.
    let known = studio.project().recording().ok();
    if known.and_then(|known| std::fs::read(known).ok()).is_some_and(|known| known == content) {
        return Ok(());
    }
    let mapping = if beside.is_file() && beside != path { Some(bytes(&beside)?) } else { None };
    keep(studio, &name, &content, mapping.as_deref())
}

/// Keeps a file that the page sent.
pub fn keep(
    studio: &Studio,
    name: &str,
    content: &[u8],
    mapping: Option<&[u8]>,
) -> Result<(), Failure> {
    if content.is_empty() {
        return Err(Failure::bad_input("the file is empty"));
    }
    let mut project = studio.project();
    let name = safe_name(name);
    if name.to_lowercase().ends_with(".toml") {
        return Err(Failure::bad_input(
            "a .toml says how a recording is read; choose the recording",
        ));
    }
    // The recording of the models stays as it is until another one takes its place; so does the file beside it, which one
    // of the same name with another ending would share.
    let stem = |name: &str| Path::new(name).with_extension("");
    let name = if project.state.data.as_deref().map(stem) == Some(stem(&name)) {
        format!("{}-{name}", project.state.tree.next)
    } else {
        name
    };
    let path = project.place("data", &name)?;
    aep_data::save(&path, content)?;
    let beside = path.with_extension("toml");
    match mapping {
        Some(mapping) => aep_data::save(&beside, mapping)?,
        None => drop(std::fs::remove_file(&beside)),
    }
    project.state.brought = Some(name);
    project.save()
}

/// The example that comes with the program.
pub fn bring_example(studio: &Studio) -> Result<(), Failure> {
    let [(name, recording), (_, mapping), _] = example::files();
    keep(studio, name, recording.as_bytes(), Some(mapping.as_bytes()))
}

/// Goes back to the models from what was brought and not taken.
pub fn leave(studio: &Studio) -> Result<(), Failure> {
    let mut project = studio.project();
    project.state.brought = None;
    project.save()
}

/// The recording that is looked at: the one brought last.
fn looked_at(studio: &Studio) -> Result<std::path::PathBuf, Failure> {
    let project = studio.project();
    let name = project.state.brought.clone().or_else(|| project.state.data.clone());
    let name = name.ok_or_else(|| Failure::bad_input("choose a file first"))?;
    project.place("data", &name)
}

/// What is in it, and how it would be read.
pub fn look(studio: &Studio) -> Result<Value, Failure> {
    let path = looked_at(studio)?;
    let mapping = Mapping::beside(&path)?;
    let seen = preview(&path, &mapping)?;
    let columns = seen.columns.iter().map(|column| {
        json!({"name": column.name, "unit": column.unit, "first": column.first, "len": column.len})
    });
    let columns: Vec<Value> = columns.collect();
    let guesses: Map<String, Value> = seen
        .guesses
        .iter()
        .map(|(role, column)| (role.facts().name.to_owned(), json!(column)))
        .collect();
    let roles = ROLES.iter().map(|facts| {
        let mut units = aep_data::unit::names(facts.linear);
        if facts.rotary != facts.linear {
            units.extend(aep_data::unit::names(facts.rotary));
        }
        json!({"name": facts.name, "units": units, "required": facts.role.is_required()})
    });
    let roles: Vec<Value> = roles.collect();
    Ok(json!({
        "file": path.file_name().map(|name| name.to_string_lossy()),
        "columns": columns,
        "more": seen.more,
        "guesses": guesses,
        "layout": seen.layout,
        "roles": roles,
        "mapping": in_json(&mapping),
    }))
}

fn in_json(mapping: &Mapping) -> Value {
    let mut json = Map::new();
    for facts in ROLES {
        let source = mapping.source(facts.role);
        if source != &aep_data::Source::default() {
            let told = json!({"column": source.column, "unit": source.unit, "gain": source.gain});
            json.insert(facts.name.to_owned(), told);
        }
    }
    json.insert("hold".to_owned(), json!(mapping.hold.map(hold_name)));
    json.insert("interval_s".to_owned(), json!(mapping.interval_s));
    json.insert("regressors".to_owned(), json!(mapping.regressors));
    json.insert("topic".to_owned(), json!(mapping.topic));
    Value::Object(json)
}

/// A mapping as the page sends it: as `DATA.toml`, in JSON, where null says nothing.
pub fn mapping(json: Value) -> Result<Mapping, Failure> {
    fn without_nulls(json: Value) -> Value {
        match json {
            Value::Object(map) => {
                let kept = map.into_iter().filter(|(_, value)| !value.is_null());
                Value::Object(kept.map(|(key, value)| (key, without_nulls(value))).collect())
            }
            other => other,
        }
    }
    serde_json::from_value(without_nulls(json))
        .map_err(|error| Failure::bad_input(format!("this is no mapping: {error}")))
}

/// The check of the data, read by `mapping` alone.
pub fn checked(studio: &Studio, mapping: &Mapping) -> Result<Value, Failure> {
    let path = looked_at(studio)?;
    let bytes = std::fs::read(&path).map_err(|error| {
        Failure::bad_input(format!("cannot read the file: {error}")).in_file(&path)
    })?;
    let loaded = parse(&path, bytes, mapping)?;
    let seen = check(&loaded.recording);
    let source = report::source(&loaded);
    Ok(json!({"html": aep_studio::studio::data(&seen, &source), "unused": loaded.unused}))
}

/// The check of the recording that the models are of.
pub fn check_of_models(studio: &Studio) -> Result<Value, Failure> {
    let session = studio.session()?;
    let source = report::source(&session.loaded);
    Ok(json!({"html": aep_studio::studio::data(&session.check, &source)}))
}

/// Takes the recording that was brought, read by `mapping`, and begins its models.
pub fn take(
    studio: &Arc<Studio>,
    mapping: &Mapping,
    effects: Option<Vec<String>>,
) -> Result<(), Failure> {
    checked(studio, mapping)?;
    let path = looked_at(studio)?;
    output::save(&path.with_extension("toml"), &mapping.to_toml())?;
    begin(studio, &path)?;
    jobs::start(studio, Task::Base { effects })
}

/// Begins a tree of models for a recording in the project. Where there was one before it is kept beside.
pub fn begin(studio: &Studio, path: &Path) -> Result<(), Failure> {
    studio.jobs.cancel(studio);
    {
        let mut project = studio.project();
        if !project.state.tree.entries.is_empty() {
            let before = format!("studio-before-{}.json", project.state.tree.next);
            output::save_json(&project.folder().join(before), &project.state)?;
        }
        let tree = project.state.tree.after();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        let points = project.state.points;
        project.state = super::project::State { data: name, tree, points, ..Default::default() };
        project.beside = super::project::Beside::default();
        project.save()?;
    }
    studio.forget();
    Ok(())
}
