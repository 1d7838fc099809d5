//! What the page is told: numbers as words, so that page, report and terminal say the same.

use aep_studio::{studio, words};
use friction_ident::Effect;
use missing_physics::measurement::quantity::{number, quantity};
use missing_physics::report::Rung;
use missing_physics::{Discovery, Settings, likely};
use serde_json::{Value, json};

use super::Studio;
use super::project::Project;
use super::riddle::Riddle;
use super::tree::Entry;
use crate::args::library;
use crate::failure::Failure;

/// Everything but curves and candidates' pictures.
pub fn state(studio: &Studio) -> Value {
    let job = studio.jobs.view();
    let project = studio.project();
    let state = &project.state;
    let entries: Vec<Value> = state.tree.entries.iter().map(entry).collect();
    let chosen = state.tree.chosen;
    let interrupted = if job.is_some() { None } else { project.interrupted() };
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "folder": project.folder().display().to_string(),
        "data": state.data,
        "brought": state.brought,
        "hold": state.hold,
        "models": entries,
        "chosen": chosen,
        "suggestions": chosen.and_then(|id| project.beside.suggestions.get(&id)),
        "said": state.said,
        "motion": project.beside.motion,
        "control": project.beside.control.as_ref().map(|(said, _)| said),
        "failed": project.beside.failed,
        "riddle": state.riddle.as_ref().map(Riddle::view),
        "points": state.points,
        "files": files(&project),
        "interrupted": interrupted.map(|task| json!({"said": task.said(), "task": task})),
        "job": job,
    })
}

fn entry(entry: &Entry) -> Value {
    let rung = &entry.rung;
    json!({
        "id": entry.id,
        "parent": entry.parent,
        "by": entry.by,
        "name": entry.name,
        "effects": rung.effects,
        "times": rung.budget,
        "times_said": rung.budget.map(words::times),
        "gain": rung.likelihood_gain.map(words::nats),
        "p": rung.p_value.map(words::chance),
        "said": studio::said(rung),
        "parameters": parameters(rung, entry),
    })
}

fn parameters(rung: &Rung, entry: &Entry) -> Vec<Value> {
    let fitted = rung.parameters.iter().map(|(name, estimate)| {
        json!({
            "name": name,
            "number": estimate.value,
            "unit": estimate.unit,
            "value": words::value(estimate),
            "interval": words::interval(estimate),
            "identifiable": estimate.identifiable,
        })
    });
    let fixed = entry.fixed.iter().map(|(name, value)| {
        json!({"name": name, "number": value, "value": number(*value), "fixed": true})
    });
    fitted.chain(fixed).collect()
}

/// Files that were written, with their sizes in bytes.
fn files(project: &Project) -> Vec<Value> {
    let mut found = Vec::new();
    let mut rooms = vec![(project.folder().join("exports"), "exports".to_owned())];
    while let Some((folder, name)) = rooms.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
            let inside = format!("{name}/{}", entry.file_name().to_string_lossy());
            match entry.metadata() {
                Ok(about) if about.is_dir() => rooms.push((entry.path(), inside)),
                Ok(about) if about.is_file() => found.push((inside, about.len())),
                _ => {}
            }
        }
    }
    found.sort();
    found.into_iter().map(|(path, bytes)| json!({"path": path, "bytes": bytes})).collect()
}

/// Every effect that can be asked for.
pub fn effects() -> Value {
    let library = library();
    let all = library.effects().iter().flat_map(|effect| {
        std::iter::once(effect.about()).chain(effect.forms().iter().map(|form| form.about()))
    });
    let each = all.map(|about| {
        json!({
            "name": about.name, "title": about.title, "equation": about.equation, "shows": about.shows,
            "reference": about.reference,
        })
    });
    each.collect()
}

/// What is to be known of gains that were found on a part of a long recording.
const IN_PART: &str = "Gains are estimated on a part of this long recording; adding an effect tells what it gains on all of it.";

/// Which effect a model lacks: every candidate with what it gains, `in_part` where that was looked for on a part.
pub fn suggestions(discovery: &Discovery, settings: &Settings<'_>, in_part: bool) -> Value {
    let library = library();
    let is_likely: Vec<&str> = likely(discovery, settings).map(|c| c.effect.as_str()).collect();
    let rows = discovery.ranking.first().into_iter().flatten().map(|candidate| {
        let about = library.find(&candidate.effect).ok().map(Effect::about);
        json!({
            "effect": candidate.effect,
            "title": about.map(|about| about.title),
            "equation": about.map(|about| about.equation),
            "shows": about.map(|about| about.shows),
            "gain": candidate.nats.map(words::nats),
            "nats": candidate.nats,
            "p": words::chance(candidate.p_value),
            "size": words::size(&candidate.size),
            "likely": is_likely.contains(&candidate.effect.as_str()),
        })
    });
    let rows: Vec<Value> = rows.collect();
    let places = discovery.where_it_fails.iter().filter(|place| place.is_structure());
    let places: Vec<String> =
        places.map(|place| format!("{}: {}", place.coordinate, words::pattern(place))).collect();
    let missing = discovery.missing_force.as_ref().map(|missing| {
        format!(
            "{} rms of {}, known to ±{}",
            quantity(missing.rms, &missing.unit),
            quantity(missing.recorded, &missing.unit),
            quantity(missing.band, &missing.unit)
        )
    });
    let mut notes = words::notes(discovery);
    notes.extend(in_part.then(|| IN_PART.to_owned()));
    json!({
        "rows": rows,
        "places": places,
        "missing": missing,
        "summary": summary(discovery, settings),
        "notes": notes,
    })
}

/// What the candidates say together. Of the model itself nothing is said here: only a search does that.
fn summary(discovery: &Discovery, settings: &Settings<'_>) -> String {
    if let Some(best) = &discovery.most_likely {
        return format!("Most likely missing: {best}. Nothing was added.");
    }
    if words::is_cut(discovery) {
        return "No effect was found before the search was stopped.".to_owned();
    }
    format!(
        "No effect of the library gains the {} nats that are needed, and more than chance, beside this model.",
        settings.thresholds.better
    )
}

/// What went wrong: what, where, how to mend it.
pub fn failure(failure: &Failure) -> Value {
    json!({"what": failure.what, "place": failure.place, "hint": failure.hint})
}
