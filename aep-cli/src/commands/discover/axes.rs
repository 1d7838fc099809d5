//! Several axes of one file: each is searched by itself, side by side within the threads that there are.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use aep_data::{Axes, Loaded, PLACE};
use aep_studio::report::AxisPage;
use aep_studio::words::{self, AXES_HEADINGS, AxisResult, axis_row};
use friction_ident::family::{Decides, explained};
use missing_physics::measurement::check::{DataCheck, Severity, check};
use missing_physics::report::{Combinations, Samples};
use missing_physics::{Discovery, Thresholds, discover};
use serde_json::{Value, json};

use super::{Args, confirmed, friction, save_model, save_series};
use crate::app::{self, Global};
use crate::args::{axis_path, library};
use crate::failure::Failure;
use crate::output::{self, Align, Table, dim, heading, written};
use crate::progress::Progress;
use crate::report::{Kind, Report, command, source};
use crate::stop::{self, Watch};
use crate::{outputs, steps};

/// How often it is looked whether all axes are done.
const LOOKS: Duration = Duration::from_millis(20);
/// How long an axis that is searched may take to end after Ctrl-C.
const PATIENCE: Duration = Duration::from_millis(500);

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
    thresholds: Thresholds,
    friction: Combinations,
    samples: Samples,
    json: Value,
    files: String,
}

/// An axis and what became of it; nothing where it is not done.
struct Axis {
    name: String,
    loaded: Loaded,
    /// Other recordings of it, which are to confirm what is found.
    others: Option<Loaded>,
    check: DataCheck,
    found: OnceLock<Result<Searched, Failure>>,
}

impl Axis {
    fn result(&self) -> AxisResult<'_> {
        match self.found.get() {
            None => AxisResult::NotDone,
            Some(Err(failure)) => AxisResult::Refused(&failure.what),
            Some(Ok(searched)) => AxisResult::Found(&searched.discovery),
        }
    }
}

/// Runs the command for these axes.
pub fn run(args: &Args, wanted: &Axes, global: Global) -> Result<(), Failure> {
    refuse(args)?;
    stop::at_once();
    let read = args.mapping.read_axes(&args.data, wanted)?;
    let mut others = others(args, &read.axes)?.into_iter();
    let axis = |(name, loaded): (String, Loaded)| {
        let check = check(&loaded.recording);
        Axis { name, loaded, others: others.next(), check, found: OnceLock::new() }
    };
    let axes: Vec<Axis> = read.axes.into_iter().map(axis).collect();
    check_files(args, &axes)?;
    let watch = Watch::new(None);
    let quiet = global.quiet || args.results.own_stdout();
    if !quiet {
        output::print(&read_from(&axes, &read.without_force))?;
    }
    stop::keeping();
    search_all(args, &axes, watch, quiet)?;
    tell(args, &axes, watch, quiet)
}

/// The same axes in the recordings that are to confirm what is found; none where there are no such recordings.
fn others(args: &Args, axes: &[(String, Loaded)]) -> Result<Vec<Loaded>, Failure> {
    if args.validate.is_empty() {
        return Ok(Vec::new());
    }
    let names = Axes::Named(axes.iter().map(|(name, _)| name.clone()).collect());
    let read = args.mapping.read_axes(&args.validate, &names)?;
    Ok(read.axes.into_iter().map(|(_, loaded)| loaded).collect())
}

/// Tells of the axes that are done, and writes the files.
fn tell(args: &Args, axes: &[Axis], watch: Watch, quiet: bool) -> Result<(), Failure> {
    let failures = axes.iter().map(|axis| axis.found.get().and_then(|found| found.as_ref().err()));
    // Where no axis could be searched, the first reason is the reason.
    if let Some(failures) = failures.collect::<Option<Vec<&Failure>>>()
        && let Some(first) = failures.first()
    {
        return Err((*first).clone());
    }
    let mut files = String::new();
    if let Some(path) = &args.results.json {
        output::save_json(path, &in_json(axes, watch))?;
        files += &written("results", path);
    }
    if let Some(path) = &args.results.html {
        output::save(path, &page(args, axes))?;
        files += &written("report", path);
    }
    for axis in axes {
        if let Some(Ok(searched)) = axis.found.get() {
            files += &searched.files;
        }
    }
    if !quiet {
        let files = if files.is_empty() { files } else { format!("\n{files}") };
        output::print(&(more(args, axes) + &table(axes) + &files + &next(args, axes)))?;
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
        ("--surrogates", args.surrogates.is_some()),
        ("--experiment", args.experiment.is_some()),
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
    outputs::check(&args.inputs(), &files)
}

/// Searches every axis. As many at once as there are threads, each with its share of them: a search shares its work among
/// threads of its own only, so that none waits for another axis while its time runs. After Ctrl-C those that are done are
/// told at once, and the program ends.
fn search_all(args: &Args, axes: &[Axis], watch: Watch, quiet: bool) -> Result<(), Failure> {
    let threads = rayon::current_num_threads().max(1);
    let workers = threads.min(axes.len());
    let next = AtomicUsize::new(0);
    let progress = Progress::new(quiet);
    let running: Mutex<Vec<String>> = Mutex::default();
    let said = |name: &str, begins: bool| {
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
    let working = AtomicUsize::new(workers);
    std::thread::scope(|scope| {
        for pool in &pools {
            scope.spawn(|| {
                while !watch.is_interrupted() {
                    let Some(axis) = axes.get(next.fetch_add(1, Ordering::Relaxed)) else { break };
                    said(&axis.name, true);
                    // Nobody else has set it.
                    let _ = axis.found.set(pool.install(|| search(args, axis, watch)));
                    said(&axis.name, false);
                }
                working.fetch_sub(1, Ordering::Relaxed);
            });
        }
        while working.load(Ordering::Relaxed) > 0 {
            std::thread::sleep(LOOKS);
            if watch.is_interrupted() {
                // A search that knows when to end does so now; what takes longer is left.
                let until = Instant::now() + PATIENCE;
                while working.load(Ordering::Relaxed) > 0 && Instant::now() < until {
                    std::thread::sleep(LOOKS);
                }
                progress.hide();
                app::end(tell(args, axes, watch, quiet));
            }
        }
    });
    Ok(())
}

fn search(args: &Args, axis: &Axis, watch: Watch) -> Result<Searched, Failure> {
    let recording = &axis.loaded.recording;
    let base = args.mapping.base(args.base.as_ref(), &axis.loaded)?;
    let settings = args.run.settings(base)?;
    let begun = Instant::now();
    let how = (args.bandwidth, args.known.known()?);
    let family = steps::searched(recording, how.0, &how.1)?;
    let settings = args.run.with_time_left(settings, begun, begun);
    let mut discovery = discover(&family, &settings, &mut ())?;
    if let Some(others) = axis.others.as_ref().filter(|_| !watch.is_interrupted()) {
        let found = confirmed(&family, &discovery.ladder, others, &how, &settings)?;
        discovery.confirmation = Some(found);
    }
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
    let samples = args.results.samples(family.on_view(), &models, Decides::Prediction);
    let mut files = String::new();
    if let Some(path) = &args.output {
        files += &save_model(&family, &discovery, &axis_path(path, &axis.name))?;
    }
    if let Some(path) = args.series.of_axis(&axis.name) {
        files += &save_series(&path, &family, &discovery)?;
    }
    let thresholds = settings.thresholds;
    Ok(Searched { discovery, thresholds, friction, samples, json, files })
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

/// What was compared, where that is asked, and what other recordings say, axis by axis.
fn more(args: &Args, axes: &[Axis]) -> String {
    let mut text = String::new();
    for axis in axes {
        let Some(Ok(Searched { discovery, thresholds, .. })) = axis.found.get() else { continue };
        if args.run.explain && !discovery.decisions.is_empty() {
            text += &heading(&format!("What was compared: axis {}", axis.name));
            text += &output::compared(discovery, thresholds);
        }
        if let Some(found) = &discovery.confirmation {
            let on = format!("axis {}, on other recordings: {}", axis.name, found.recording);
            text += &output::confirmation(discovery, found, &on);
        }
    }
    text
}

fn in_json(axes: &[Axis], watch: Watch) -> Value {
    let each = axes.iter().map(|axis| {
        let columns = axis.loaded.origins.iter().map(
            |o| json!({ "channel": o.channel, "column": o.column, "unit": o.unit }),
        );
        json!({
            "axis": axis.name,
            "columns": columns.collect::<Vec<Value>>(),
            "discovery": match axis.found.get() {
                Some(Ok(searched)) => searched.json.clone(),
                _ => Value::Null,
            },
            "failure": match axis.found.get() {
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
            if let Some(Ok(searched)) = axis.found.get() {
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
    let Some(axis) = axes.iter().find(|axis| matches!(axis.found.get(), Some(Ok(s)) if !s.discovery.added.is_empty()))
    else {
        return String::new();
    };
    let flag = crate::args::flag("axes", Some(&axis.name));
    let command = format!("aep discover {}{flag} --html report.html", args.words());
    format!("\n{}\n", dim(&format!("An axis with plots: {command}")))
}
