//! Several axes of one file: each is searched by itself, side by side within the threads that there are.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use aep_data::{Axes, Loaded, PLACE};
use aep_studio::report::AxisPage;
use aep_studio::words::{self, AXES_HEADINGS, AxisResult, axis_row};
use friction_ident::family::{Decides, explained};
use missing_physics::measurement::check::{DataCheck, Severity, check};
use missing_physics::report::{Combinations, Samples};
use missing_physics::{Discovery, discover};
use serde_json::{Value, json};

use super::{Args, friction, save_model, save_series};
use crate::app::Global;
use crate::args::{axis_path, library};
use crate::failure::Failure;
use crate::output::{self, Align, Table, dim, heading, written};
use crate::progress::Progress;
use crate::report::{Kind, Report, command, source};
use crate::stop::Watch;
use crate::{outputs, steps};

/// `all`, or numbers and names.
pub fn wanted(text: &str) -> Result<Axes, String> {
    if text.trim().eq_ignore_ascii_case("all") {
        return Ok(Axes::All);
    }
    let names = text.split(',').map(str::trim).filter(|name| !name.is_empty());
    let names: Vec<String> = names.map(str::to_owned).collect();
    if names.is_empty() {
        return Err("say 'all', or numbers or names: 1,3".to_owned());
    }
    Ok(Axes::Named(names))
}

/// An axis that was searched.
struct Searched {
    discovery: Discovery,
    friction: Combinations,
    samples: Samples,
    json: Value,
    files: String,
}

/// An axis and what became of it; nothing where it was not begun.
struct Axis {
    name: String,
    loaded: Loaded,
    check: DataCheck,
    found: Option<Result<Searched, Failure>>,
}

impl Axis {
    fn result(&self) -> AxisResult<'_> {
        match &self.found {
            None => AxisResult::NotBegun,
            Some(Err(failure)) => AxisResult::Refused(&failure.what),
            Some(Ok(searched)) => AxisResult::Found(&searched.discovery),
        }
    }
}

/// Runs the command for these axes.
pub fn run(args: &Args, wanted: &Axes, global: Global) -> Result<(), Failure> {
    refuse(args)?;
    let read = args.mapping.read_axes(&args.data, wanted)?;
    let mut axes: Vec<Axis> = read
        .axes
        .into_iter()
        .map(|(name, loaded)| Axis { name, check: check(&loaded.recording), loaded, found: None })
        .collect();
    check_files(args, &axes)?;
    let watch = Watch::new(None);
    let quiet = global.quiet || args.results.own_stdout();
    if !quiet {
        output::print(&read_from(&axes, &read.without_force))?;
    }
    search_all(args, &mut axes, watch, quiet)?;
    // Where no axis could be searched, the first reason is the reason.
    if axes.iter().all(|axis| matches!(axis.found, Some(Err(_)))) {
        let first = axes.swap_remove(0);
        if let Some(Err(failure)) = first.found {
            return Err(failure);
        }
    }
    let mut files = String::new();
    if let Some(path) = &args.results.json {
        output::save_json(path, &in_json(&axes, watch))?;
        files += &written("results", path);
    }
    if let Some(path) = &args.results.html {
        output::save(path, &page(args, &axes))?;
        files += &written("report", path);
    }
    for axis in &axes {
        if let Some(Ok(searched)) = &axis.found {
            files += &searched.files;
        }
    }
    if !quiet {
        let files = if files.is_empty() { files } else { format!("\n{files}") };
        output::print(&(table(&axes) + &files + &next(args, &axes)))?;
    }
    watch.end()
}

/// What makes no sense for several axes at once.
fn refuse(args: &Args) -> Result<(), Failure> {
    if args.data.is_empty() {
        return Err(Failure::bad_input("--axes needs a file with several axes")
            .with_hint("aep discover FILE --axes all"));
    }
    let alone = [
        ("--validate", !args.validate.is_empty()),
        ("--surrogates", args.surrogates.is_some()),
        ("--experiment", args.experiment.is_some()),
        ("--explain", args.run.explain),
    ];
    if let Some((flag, _)) = alone.iter().find(|(_, given)| *given) {
        let hint = "leave --axes out and say the columns of one: --force tau_1 --position q_1";
        return Err(Failure::bad_input(format!("{flag} is for one axis")).with_hint(hint));
    }
    for (flag, path) in [("-o", args.output.as_deref()), ("--series", args.series.path())] {
        if let Some(path) = path.filter(|path| !path.to_string_lossy().contains(PLACE)) {
            let what = format!("{flag} is one file, but there are several axes");
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let ending = path.extension().unwrap_or_default().to_string_lossy();
            return Err(Failure::bad_input(what)
                .in_file(path)
                .with_hint(format!("let the axis be in its name: '{stem}_{PLACE}.{ending}'")));
        }
    }
    Ok(())
}

fn check_files(args: &Args, axes: &[Axis]) -> Result<(), Failure> {
    let own = |path: Option<&Path>| -> Vec<PathBuf> {
        path.map_or_else(Vec::new, |path| {
            axes.iter().map(|axis| axis_path(path, &axis.name)).collect()
        })
    };
    let (models, points) = (own(args.output.as_deref()), own(args.series.path()));
    let mut files =
        vec![("--json", args.results.json.as_deref()), ("--html", args.results.html.as_deref())];
    files.extend(models.iter().map(|path| ("--output", Some(path.as_path()))));
    files.extend(points.iter().map(|path| ("--series", Some(path.as_path()))));
    outputs::check(&args.data, &files)
}

/// Searches every axis. As many at once as there are threads, each with its share of them: a search shares its work among
/// threads of its own only, so that none waits for another axis while its time runs.
fn search_all(args: &Args, axes: &mut [Axis], watch: Watch, quiet: bool) -> Result<(), Failure> {
    let threads = rayon::current_num_threads().max(1);
    let workers = threads.min(axes.len());
    let next = AtomicUsize::new(0);
    let progress = Progress::new(quiet);
    let running: Mutex<Vec<String>> = Mutex::default();
    let tell = |name: &str, begins: bool| {
        let mut running = running.lock().unwrap_or_else(PoisonError::into_inner);
        if begins {
            running.push(name.to_owned());
        } else {
            running.retain(|other| other != name);
            progress.one_more();
        }
        progress.say(format!("searching axis {}", running.join(", ")));
    };
    progress.count_to(axes.len() as u64);
    let pools: Result<Vec<_>, _> = (0..workers)
        .map(|k| threads / workers + usize::from(k < threads % workers))
        .map(|share| rayon::ThreadPoolBuilder::new().num_threads(share).build())
        .collect();
    let pools = pools.map_err(|error| Failure::failed(format!("cannot start threads: {error}")))?;
    let found: Vec<Mutex<Option<Result<Searched, Failure>>>> =
        axes.iter().map(|_| Mutex::default()).collect();
    let shared: &[Axis] = axes;
    std::thread::scope(|scope| {
        for pool in &pools {
            scope.spawn(|| {
                while !watch.is_interrupted() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(axis) = shared.get(index) else { break };
                    tell(&axis.name, true);
                    let result = pool.install(|| search(args, axis));
                    *found[index].lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
                    tell(&axis.name, false);
                }
            });
        }
    });
    for (axis, found) in axes.iter_mut().zip(found) {
        axis.found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    }
    Ok(())
}

fn search(args: &Args, axis: &Axis) -> Result<Searched, Failure> {
    let recording = &axis.loaded.recording;
    let base = args.mapping.base(args.base.as_ref(), &axis.loaded)?;
    let settings = args.run.settings(base)?;
    let family = steps::family(recording, args.bandwidth, &args.known.known()?)?;
    let discovery = discover(&family, &settings, &mut ())?;
    let friction = friction(&family, &discovery)?;
    let report = Report {
        kind: Kind::Discovery,
        discovery: &discovery,
        loaded: &axis.loaded,
        check: &axis.check,
        thresholds: settings.thresholds,
        together: friction.clone(),
        samples: Samples::default(),
        more: Vec::new(),
    };
    let json = report.json()?;
    let models = steps::ladder(&family, &discovery)?;
    let samples = args.results.samples(&family, &models, Decides::Prediction);
    let mut files = String::new();
    if let Some(path) = &args.output {
        files += &save_model(&family, &discovery, &axis_path(path, &axis.name))?;
    }
    if let Some(path) = args.series.of_axis(&axis.name) {
        files += &save_series(&path, &family, &discovery)?;
    }
    Ok(Searched { discovery, friction, samples, json, files })
}

/// Which columns were taken for which axis.
fn read_from(axes: &[Axis], without_force: &[String]) -> String {
    let columns = ["axis", "force", "position", "samples", "doubts about the data"];
    let mut table = Table::new(&columns.map(|name| (name, Align::Left)));
    for axis in axes {
        let column = |channel: &str| {
            let origin = axis.loaded.origins.iter().find(|origin| origin.channel == channel);
            origin.map_or_else(String::new, |o| format!("{} ({})", o.column, o.unit))
        };
        let doubts = axis.check.findings.iter();
        let doubts = doubts.filter(|finding| finding.severity() != Severity::Info);
        let doubts: Vec<String> = doubts.map(words::finding).collect();
        table.row([
            axis.name.clone(),
            column("force"),
            column("position"),
            axis.loaded.recording.len().to_string(),
            doubts.join("\n"),
        ]);
    }
    let name = axes.first().map_or("", |axis| axis.loaded.recording.name());
    let mut text = heading(&format!("The axes: {name}")) + &table.text();
    if !without_force.is_empty() {
        text += &output::note(&format!(
            "a position but no force was found for axis {}: left out",
            without_force.join(", ")
        ));
    }
    text
}

fn table(axes: &[Axis]) -> String {
    let columns = AXES_HEADINGS.map(|name| match name.strip_prefix('#') {
        Some(number) => (number.replace(" (", "\n("), Align::Right),
        None => (name.to_owned(), Align::Left),
    });
    let headings: Vec<(&str, Align)> =
        columns.iter().map(|(name, align)| (name.as_str(), *align)).collect();
    let mut table = Table::new(&headings);
    for axis in axes {
        table.row(axis_row(&axis.name, axis.result()));
    }
    heading("What each axis lacks") + &table.text()
}

fn in_json(axes: &[Axis], watch: Watch) -> Value {
    let each = axes.iter().map(|axis| {
        let columns = axis.loaded.origins.iter().map(
            |o| json!({ "channel": o.channel, "column": o.column, "unit": o.unit }),
        );
        json!({
            "axis": axis.name,
            "columns": columns.collect::<Vec<Value>>(),
            "discovery": match &axis.found {
                Some(Ok(searched)) => searched.json.clone(),
                _ => Value::Null,
            },
            "failure": match &axis.found {
                Some(Err(failure)) => Some(&failure.what),
                _ => None,
            },
        })
    });
    json!({ "axes": each.collect::<Vec<Value>>(), "interrupted": watch.is_interrupted() })
}

fn page(args: &Args, axes: &[Axis]) -> String {
    let settings = args.run.settings(Vec::new());
    let library = explained(&library());
    let sources: Vec<aep_studio::Source> = axes
        .iter()
        .map(|axis| {
            let mut source = source(&axis.loaded);
            source.name = format!("{}, axis {}", source.name, axis.name);
            if let Some(Ok(searched)) = &axis.found {
                source.together = searched.friction.clone();
                source.samples = searched.samples.clone();
                // All others would stand there once for each axis.
                let last = searched.discovery.ladder.last();
                let named = |name: &String| last.is_some_and(|rung| rung.effects.contains(name));
                source.effects =
                    library.iter().filter(|effect| named(&effect.name)).cloned().collect();
            }
            if let Ok(settings) = &settings {
                source.thresholds = settings.thresholds;
            }
            source
        })
        .collect();
    let pages: Vec<AxisPage<'_>> = (axes.iter().zip(&sources))
        .map(|(axis, source)| AxisPage {
            name: &axis.name,
            result: axis.result(),
            source,
            check: &axis.check,
        })
        .collect();
    let file = axes.first().map_or("", |axis| axis.loaded.recording.name());
    aep_studio::report::axes(file, &pages, &command())
}

/// How to see more of the axis that lacks most.
fn next(args: &Args, axes: &[Axis]) -> String {
    if args.results.html.is_some() {
        return String::new();
    }
    let Some(axis) = axes.iter().find(|axis| matches!(&axis.found, Some(Ok(s)) if !s.discovery.added.is_empty()))
    else {
        return String::new();
    };
    let flag = crate::args::flag("axes", Some(&axis.name));
    let command = format!("aep discover {}{flag} --html report.html", args.words());
    format!("\n{}\n", dim(&format!("An axis with plots: {command}")))
}
