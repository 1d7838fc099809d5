//! A task, done: the engine's calls, and what of their results is kept.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use aep_studio::report::plain;
use friction_ident::Model;
use friction_ident::family::{Decides, FrictionFamily};
use missing_physics::ahead::ByHand;
use missing_physics::ahead::node::Node;
use missing_physics::report::Combinations;
use missing_physics::{
    Discovery, Event, Fitted, ModelFamily, Observer, Settings, Thresholds, discover, suggest, terms,
};
use serde_json::{Value, json};

use super::export;
use super::project::Said;
use super::session::Session;
use super::task::Task;
use super::tree::{By, Entry};
use super::{Studio, view};
use crate::args::{LoopArgs, MappingArgs, OutputArgs, ReferenceArgs, known, library};
use crate::compensation::{self, Case};
use crate::failure::Failure;
use crate::report::{Kind, Report};
use crate::{experiment, output, progress, steps};

/// Seed of every random choice, as that of the commands.
const SEED: u64 = 1;
/// Time of a search, as that of the commands.
const LIMIT: Duration = Duration::from_mins(1);

/// How far a task has come.
#[derive(Clone, Debug, Default)]
pub struct Step {
    /// In words.
    pub message: Option<String>,
    /// The model in progress: its effects.
    pub effects: Vec<String>,
    /// Its prediction error over what the sensors make.
    pub times: Option<f64>,
}

/// What a task brought.
pub enum Done {
    /// Models, each below the one before it, the first one below `parent`, and what a search said of the last one.
    Models {
        /// The model that the first one comes from.
        parent: Option<u32>,
        /// Entry, model, and prediction errors where they are at hand.
        made: Vec<(Entry, Model, Option<Node>)>,
        /// What was said.
        said: Option<Said>,
    },
    /// Which effect a model lacks.
    Suggested(u32, Value),
    /// The motion to run next.
    Motion(Value),
    /// The compensator was simulated: what the page is told, and its card.
    Control(Value, String),
    /// Files were written.
    Written,
}

impl Done {
    /// Keeps it.
    pub fn take(self, studio: &Studio) -> Result<(), Failure> {
        let mut kept = Vec::new();
        {
            let mut project = studio.project();
            match self {
                Self::Models { parent, made, said } => {
                    let mut parent = parent;
                    for (entry, model, node) in made {
                        let next = project.state.tree.next;
                        let path = project.place("models", &format!("{next}.json"))?;
                        output::save(&path, &(model.to_json()? + "\n"))?;
                        parent = Some(project.state.tree.add(Entry { parent, ..entry }));
                        kept.extend(node.map(|node| (next, node)));
                    }
                    if let (Some(said), Some(id)) = (said, project.state.tree.chosen) {
                        project.state.said = Some(Said { id, ..said });
                    }
                    project.save()?;
                }
                Self::Suggested(id, view) => drop(project.beside.suggestions.insert(id, view)),
                Self::Motion(view) => project.beside.motion = Some(view),
                Self::Control(said, card) => project.beside.control = Some((said, card)),
                Self::Written => {}
            }
        }
        if !kept.is_empty() {
            let session = studio.session()?;
            for (id, node) in kept {
                session.keep(id, Arc::new(node));
            }
        }
        Ok(())
    }
}

/// What is heard on the way.
type Tell<'a> = &'a (dyn Fn(Step) + Sync);

/// Does a task.
pub fn done(
    studio: &Studio,
    task: &Task,
    stop: &AtomicBool,
    tell: Tell<'_>,
) -> Result<Done, Failure> {
    let say = |text: &str| tell(Step { message: Some(text.to_owned()), ..Step::default() });
    say("preparing the motion");
    let session = studio.session()?;
    say(&task.said());
    let run = (stop, tell);
    let from = |id: &u32| From::of(studio, &session, *id);
    match task {
        Task::Base { effects } => base(&session, effects.as_deref(), run),
        Task::Add { from: id, effect } => add(&session, &from(id)?, effect, run),
        Task::Remove { from: id, effect } => remove(&from(id)?, effect, run),
        Task::Fix { from: id, parameter, value } => {
            fix(&session, &from(id)?, parameter, *value, run)
        }
        Task::Suggest { from: id } => suggestions(&from(id)?, run),
        Task::Discover { from: id } => discovery(studio, &session, &from(id)?, run),
        Task::Experiment { from: id, effects } => motion(studio, &from(id)?, effects),
        Task::Control { from, plant, reference } => {
            control(studio, (*from, plant.unwrap_or(*from)), reference.as_deref())
        }
        Task::Export { from: id, form } => {
            let is_over = || stop.load(Ordering::Relaxed);
            export::write(studio, &session, from(id)?.entry.id, *form, &is_over)?;
            Ok(Done::Written)
        }
    }
}

/// The model that a task begins with.
struct From {
    /// Its entry.
    entry: Entry,
    /// As a plant.
    model: Model,
    /// The recording with its fixed parameters.
    family: Arc<FrictionFamily>,
}

impl From {
    fn of(studio: &Studio, session: &Session, id: u32) -> Result<Self, Failure> {
        let project = studio.project();
        let model = project.model(id)?;
        let entry = project.state.tree.get(id).cloned();
        drop(project);
        let entry = entry.ok_or_else(|| Failure::bad_input(format!("there is no model {id}")))?;
        let family = session.family(&entry.fixed)?;
        family.belongs(&model)?;
        Ok(Self { entry, model, family })
    }

    fn fitted(&self) -> Result<Fitted, Failure> {
        Ok(self.family.fitted(&self.model)?)
    }
}

/// Hears of fits: of each the model in progress and its error.
fn heard(event: &Event<'_>) -> Step {
    match event {
        Event::Fitted { effects, times } => {
            Step { message: None, effects: effects.to_vec(), times: Some(*times) }
        }
        event => Step { message: progress::said(event), ..Step::default() },
    }
}

struct Heard<'a>(Tell<'a>);

impl Observer for Heard<'_> {
    fn event(&mut self, event: &Event<'_>) {
        (self.0)(heard(event));
    }
}

type Run<'a> = (&'a AtomicBool, Tell<'a>);

/// Fits models of `family` by hand.
fn by_hand<T>(
    family: &FrictionFamily,
    (stop, tell): Run<'_>,
    fit: impl FnOnce(&ByHand<'_>) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let over = || stop.load(Ordering::Relaxed);
    let told = |event: &Event<'_>| tell(heard(event));
    let hand = ByHand::new(family, &over, &told).ok_or_else(|| {
        Failure::bad_input("the recording is too short to predict it sample by sample")
            .with_hint("record some hundred samples at least")
    })?;
    fit(&hand)
}

fn base(session: &Session, effects: Option<&[String]>, run: Run<'_>) -> Result<Done, Failure> {
    let family = &session.family;
    let names = match effects {
        Some(names) => names.iter().map(|name| known(name)).collect::<Result<Vec<_>, _>>()?,
        None => MappingArgs::default().base(None, &session.loaded)?,
    };
    by_hand(family, run, |hand| {
        let node = hand.identified(&terms(&**family, &names)?, SEED);
        let rung = hand.rung(None, &node, &[]);
        let (by, name, fixed) = (By::Base, "base model".to_owned(), BTreeMap::new());
        let entry = Entry { id: 0, parent: None, by, name, rung, fixed };
        let model = family.model(&node.model)?;
        Ok(Done::Models { parent: None, made: vec![(entry, model, Some(node))], said: None })
    })
}

fn add(session: &Session, from: &From, effect: &str, run: Run<'_>) -> Result<Done, Failure> {
    let effect = known(effect)?;
    let family = &*from.family;
    // Says which effect stands in the way, where one does.
    from.model.clone().with_effect(library().find(&effect)?)?;
    let term = terms(family, std::slice::from_ref(&effect))?.pop();
    let fitted = from.fitted()?;
    by_hand(family, run, |hand| {
        let below = session.node(from.entry.id, (family, &from.model), hand)?;
        let node = term.and_then(|term| hand.with(&fitted, term)).ok_or_else(|| {
            Failure::bad_input(format!("'{effect}' cannot be fitted beside {}", from.entry.rung.effects.join(" + ")))
                .with_hint("this recording does not show it (a law along a column, a period longer than the stroke)")
        })?;
        let added = [effect.clone()];
        let rung = hand.rung(Some(&below), &node, &added);
        let name = format!("+ {effect}");
        let entry = Entry { by: By::Added, name, rung, ..from.entry.clone() };
        let model = family.model(&node.model)?.with_known(family.known().clone());
        Ok(Done::Models {
            parent: Some(from.entry.id),
            made: vec![(entry, model, Some(node))],
            said: None,
        })
    })
}

fn remove(from: &From, effect: &str, run: Run<'_>) -> Result<Done, Failure> {
    let model = from.model.clone().without(effect);
    if model.effects().len() == from.model.effects().len() {
        return Err(Failure::bad_input(format!("the model has no '{effect}'")));
    }
    again(from, &from.family, &model, (By::Removed, format!("without {effect}")), run)
}

/// A model fitted again near its values, in `family`.
fn again(
    from: &From,
    family: &FrictionFamily,
    near: &Model,
    (by, name): (By, String),
    run: Run<'_>,
) -> Result<Done, Failure> {
    by_hand(family, run, |hand| {
        let node = hand.refitted(family.fitted(near)?);
        let rung = hand.rung(None, &node, &[]);
        let fixed = family.known().fixed.clone();
        let entry = Entry { by, name, rung, fixed, ..from.entry.clone() };
        let model = family.model(&node.model)?.with_known(family.known().clone());
        Ok(Done::Models {
            parent: Some(from.entry.id),
            made: vec![(entry, model, Some(node))],
            said: None,
        })
    })
}

fn fix(
    session: &Session,
    from: &From,
    parameter: &str,
    value: Option<f64>,
    run: Run<'_>,
) -> Result<Done, Failure> {
    let mut near = from.model.clone();
    let mut fixed = from.entry.fixed.clone();
    let name = match value {
        Some(value) => {
            near.set(parameter, value)?;
            fixed.insert(parameter.to_owned(), value);
            let unit = near.unit(parameter)?;
            format!(
                "{parameter} = {}",
                missing_physics::measurement::quantity::quantity(value, unit)
            )
        }
        None if fixed.remove(parameter).is_some() => format!("{parameter} free"),
        None => return Err(Failure::bad_input(format!("'{parameter}' is not fixed"))),
    };
    let family = session.family(&fixed)?;
    again(from, &family, &near, (By::Fixed, name), run)
}

fn settings<'a>(from: &From, stop: &'a AtomicBool) -> Result<Settings<'a>, Failure> {
    Ok(Settings {
        base: from.entry.rung.effects.clone(),
        start: Some(from.fitted()?),
        seed: SEED,
        stop: Some(stop),
        time_limit: Some(LIMIT),
        ..Settings::default()
    })
}

fn suggestions(from: &From, (stop, tell): Run<'_>) -> Result<Done, Failure> {
    let start = by_hand(&from.family, (stop, tell), |hand| Ok(hand.at_its_best(from.fitted()?)))?;
    let settings = Settings { start: Some(start), ..settings(from, stop)? };
    let in_part = from.family.ahead_in_part().is_some();
    let discovery = suggest(&*from.family, &settings, &mut Heard(tell))?;
    Ok(Done::Suggested(from.entry.id, view::suggestions(&discovery, &settings, in_part)))
}

fn discovery(
    studio: &Studio,
    session: &Session,
    from: &From,
    (stop, tell): Run<'_>,
) -> Result<Done, Failure> {
    let family = &*from.family;
    let found = discover(family, &settings(from, stop)?, &mut Heard(tell))?;
    if stop.load(Ordering::Relaxed) {
        return Ok(Done::Written);
    }
    write_report(studio, session, from, &found)?;
    let made = found.ladder.iter().skip(1).map(|rung| {
        let name = format!("+ {}", rung.added.join(" + "));
        let entry = Entry { by: By::Discovered, name, rung: rung.clone(), ..from.entry.clone() };
        Ok((entry, family.plant(rung)?, None))
    });
    let made = made.collect::<Result<Vec<_>, Failure>>()?;
    let said = Said {
        id: from.entry.id,
        complete: found.budget.is_some_and(|budget| budget.complete),
        verdict: aep_studio::words::verdict(&found).to_owned(),
        summary: aep_studio::words::summary(&found),
        notes: aep_studio::words::notes(&found),
    };
    Ok(Done::Models { parent: Some(from.entry.id), made, said: Some(said) })
}

/// The report and the JSON of a search, as `aep discover` writes them.
fn write_report(
    studio: &Studio,
    session: &Session,
    from: &From,
    found: &Discovery,
) -> Result<(), Failure> {
    let family = &*from.family;
    let place = |ending: &str| {
        studio.project().place("exports", &format!("discovery-{}.{ending}", from.entry.id))
    };
    let args = OutputArgs { json: Some(place("json")?), html: Some(place("html")?) };
    let ladder = steps::ladder(family, found)?;
    let together = match ladder.last() {
        Some(last) => family.friction(last, Decides::Prediction),
        None => Combinations::default(),
    };
    let report = Report {
        kind: Kind::Discovery,
        discovery: found,
        loaded: &session.loaded,
        check: &session.check,
        thresholds: Thresholds::default(),
        together,
        samples: args.samples(family, &ladder, Decides::Prediction),
        more: Vec::new(),
    };
    report.save(&args).map(drop)
}

/// PD control of `plant` without and with the compensator of `model`.
fn control(
    studio: &Studio,
    (model, plant): (u32, u32),
    reference: Option<&str>,
) -> Result<Done, Failure> {
    let (names, path) = {
        let project = studio.project();
        let [of_model, of_plant] = [model, plant].map(|id| {
            let entry = project.state.tree.get(id);
            let entry =
                entry.ok_or_else(|| Failure::bad_input(format!("there is no model {id}")))?;
            Ok::<_, Failure>((entry.name.clone(), project.model_path(id)))
        });
        let (of_model, of_plant) = (of_model?, of_plant?);
        let place = project.place("exports", &format!("control-{model}-{plant}.html"))?;
        ([of_model, of_plant], place)
    };
    let [model, plant] = [&names[0].1, &names[1].1].map(|path| compensation::read(path));
    let (model, plant) = (model?, plant?);
    let (servo, settings) = LoopArgs::default().build(&model, None)?;
    let reference = ReferenceArgs::of_shape(reference, model.axis(), settings.sample_time)?;
    let case = Case { model, plant, servo, settings, reference };
    let both = case.run()?;
    let part = case.part(&both);
    let of = format!("Compensator of {}, plant {}. ", names[0].0, names[1].0);
    let said = of + &both.said().unwrap_or_default();
    let parts = std::slice::from_ref(&part);
    output::save(&path, &plain::page("Friction compensation, simulated", &said, parts, ""))?;
    Ok(Done::Control(json!({"said": said}), plain::part(&part)))
}

fn motion(studio: &Studio, from: &From, effects: &[String]) -> Result<Done, Failure> {
    steps::needs_plant(&from.family)?;
    let path = studio.project().place("exports", &format!("motion-{}.csv", effects.join("-")))?;
    let below = &from.entry.rung.effects;
    let found = experiment::find(&from.family, below, effects, SEED)?;
    experiment::write(&found, &path)?;
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    Ok(Done::Motion(json!({
        "effects": found.effects,
        "motion": found.motion,
        "about": found.about,
        "said": experiment::said(&found),
        "worth": found.is_worth_running(),
        "step": found.reference.sample_time,
        "unit": found.position_unit,
        "position": found.reference.position,
        "file": format!("exports/{}", name.unwrap_or_default()),
    })))
}
