//! `aep discover`: the main job.

mod axes;

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use aep_data::{Axes, Loaded};
use aep_studio::words;
use friction_ident::Known;
use friction_ident::family::{Decides, FrictionFamily};
use missing_physics::{Discovery, Fitted, Settings, Thresholds, discover, model_of};
use missing_physics::measurement::check::check;
use missing_physics::report::{Combinations, Confirmed, Rung, Verdict};

use crate::steps;
use crate::app::Global;
use crate::args::{self, EffectNames, KnownArgs, MappingArgs, OutputArgs, RunArgs, SeriesArgs};
use crate::experiment::{Proposal, propose};
use crate::failure::Failure;
use crate::output::{self, Columns, heading, written};
use crate::progress::Progress;
use crate::report::{Kind, Report};
use crate::stop::{self, Watch};
use crate::{outputs, series};

/// Find out which physical effect a model of the drive lacks
///
/// Fits the base model, shows where it fails, and searches the sets of effects by how well a model with them
/// predicts each sample from those before it: the set stands that gains clearly on what was held out, and
/// the verdict says whether the model then errs more than the sensors make it. Errors of the force, of
/// windows and of simulations are shown and decide nothing.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The measurement: CSV with `time_s,force_N,position_m` (rotary: `torque_Nm,angle_rad`), MATLAB (v5 to v7.3), Parquet,
    /// .npz, .xlsx, or `-` for standard input; without it, the example that comes with the program. Names, units and gains may also
    /// stand in DATA.toml beside it. Several files are pieces of one measurement
    #[arg(value_name = "DATA")]
    data: Vec<PathBuf>,
    /// Effects of the model to begin with: coulomb,viscous,offset, or none beside --model-force
    #[arg(long, value_name = "EFFECTS")]
    base: Option<EffectNames>,
    /// Write the last model
    #[arg(long, short = 'o', value_name = "MODEL.json")]
    output: Option<PathBuf>,
    /// Bandwidth in Hz below which forces are shown; by default 5 % of the sampling frequency, less
    /// where the position is noisy. Beside --model-force it decides, too
    #[arg(long, value_name = "HZ", value_parser = super::positive)]
    bandwidth: Option<f64>,
    /// Other recordings of the same drive: does what was found hold there? Nothing is fitted to them but what belongs
    /// to a recording: where homing put the position's zero, how hard the lubricant shears
    #[arg(long, value_name = "DATA", num_args = 1..)]
    validate: Vec<PathBuf>,
    /// False alarms on this very axis: search N surrogates of the recording (what the last model would have made, its own
    /// errors in another order), which hold nothing to find. Each takes as long as
    /// the search for a first effect
    #[arg(long, value_name = "N")]
    surrogates: Option<NonZeroUsize>,
    /// Where the data cannot tell effects apart: write a motion that would (time and position)
    #[arg(long, value_name = "FILE.csv")]
    experiment: Option<PathBuf>,
    /// The file has several axes: search `all`, or those of these numbers or names (`1,3` or `elbow`). Columns of an axis
    /// are told by its number or name (`tau_1` and `q_1`, `elbow_torque` and `elbow_angle`); others with `{}` in its place:
    /// --force 'u_{}' --position 'enc_{}'. The time limit holds for each axis; -o and --series need a `{}`, too
    #[arg(long, value_name = "AXES", value_parser = axes::wanted)]
    axes: Option<Axes>,
    #[command(flatten)]
    results: OutputArgs,
    #[command(flatten)]
    series: SeriesArgs,
    #[command(flatten)]
    run: RunArgs,
    #[command(flatten)]
    mapping: MappingArgs,
    #[command(flatten)]
    known: KnownArgs,
}

impl Args {
    /// All files that are read.
    fn inputs(&self) -> Vec<PathBuf> {
        self.data.iter().chain(&self.validate).cloned().collect()
    }

    /// The data, how they are read and what the base is, as they stand in a command.
    fn words(&self) -> String {
        let base = self.base.as_ref().map(|base| base.0.join(","));
        args::words(&self.data)
            + &self.mapping.words()
            + &args::flag("base", base)
            + &args::flag("bandwidth", self.bandwidth)
            + &self.known.words()
    }
}

const EXAMPLES: &str = "\
Examples:
  aep discover                                           the example, with an effect hidden in it
  aep discover run.csv --html report.html                a report with plots
  aep discover run.csv --base coulomb,viscous --json -   for scripts
  aep discover run.csv --force u_V --force-gain 35.15 --position-unit mm
  aep discover DATA_EMPS.mat -o model.json               MATLAB; writes the model it found
  aep discover run.csv --model-force tau_model           what your own model lacks
  aep discover arm.csv --axes all --html arm.html        six joints in one file, one table
  aep discover run.csv --explain                         everything that was compared, and why
  aep discover run.csv --series points.parquet           prediction and residual of every model, sample by sample
  aep discover run.csv --surrogates 20                   how often it would name what is not there
  aep discover run.csv --experiment next.csv             where it is ambiguous: what to run next
  aep discover a.csv b.csv --validate c.csv d.csv        two runs as one measurement, two to confirm";

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    if let Some(wanted) = &args.axes {
        return axes::run(args, wanted, global);
    }
    let begun = Instant::now();
    outputs::check(
        &args.inputs(),
        &[
            ("--output", args.output.as_deref()),
            ("--json", args.results.json.as_deref()),
            ("--html", args.results.html.as_deref()),
            ("--series", args.series.path()),
            ("--experiment", args.experiment.as_deref()),
        ],
    )?;
    stop::at_once();
    let loaded = match args.data.as_slice() {
        [] if !args.mapping.words().is_empty() => {
            let words = args.mapping.words();
            let what = format!("there is no recording to read with{words}");
            return Err(Failure::bad_input(what)
                .with_hint("name the file: aep discover DATA ...; without one and without these flags the example is searched"));
        }
        [] => crate::example::load()?,
        paths => args.mapping.read_all(paths)?,
    };
    let others = match args.validate.as_slice() {
        [] => None,
        paths => Some(args.mapping.read_all(paths)?),
    };
    let base = args.mapping.base(args.base.as_ref(), &loaded)?;
    let settings = args.run.settings(base)?;
    let watch = Watch::new(None);
    let quiet = global.quiet || args.results.own_stdout();
    let data = check(&loaded.recording);
    if !quiet {
        output::print(&output::data_check(&loaded, &data))?;
    }
    let mut progress = Progress::new(quiet);
    progress.say("preparing the motion");
    let read = Instant::now();
    let known = args.known.known()?;
    let family = Arc::new(steps::searched(&loaded.recording, args.bandwidth, &known)?);
    progress.say("fitting the base model");
    let settings = args.run.with_time_left(settings, begun, read);
    progress.within(settings.time_limit);
    let mut discovery = discover(&*family, &settings, &mut progress)?;
    let mut more = Vec::new();
    let mut confirmed = String::new();
    // Who has asked for an end wants no more than what there is.
    let go_on = !watch.is_interrupted();
    if let Some(others) = others.filter(|_| go_on) {
        progress.say("confirming it on the other recordings");
        let (family, settings) = (Arc::clone(&family), settings.clone());
        let (ladder, how) = (discovery.ladder.clone(), (args.bandwidth, known.clone()));
        let work = move || self::confirmed(&family, &ladder, &others, &how, &settings);
        if let Some(found) = stop::unless_interrupted(work) {
            let found = found?;
            let title = format!("On other recordings: {}", found.recording);
            confirmed = output::confirmation(&discovery, &found, &title);
            discovery.confirmation = Some(found);
        }
    }
    let mut alarms = String::new();
    if args.surrogates.is_some() || args.experiment.is_some() {
        steps::needs_plant(&family)?;
    }
    if let Some(count) = args.surrogates.filter(|_| go_on)
        && let Some(last) = discovery.ladder.last()
    {
        let model = family.plant(last)?;
        let options = steps::options(args.bandwidth, &known);
        let count = count.get();
        let found = family.false_alarms(&model, (&settings, &options), count, |k| {
            progress.say(format!("surrogate {} of {count}", k + 1));
            !watch.is_interrupted()
        })?;
        alarms = output::surrogates(&found);
        discovery.surrogates = Some(found);
    }
    let mut proposal = Proposal::default();
    if let Some(path) = args.experiment.as_ref().filter(|_| go_on) {
        progress.say("looking for an experiment that tells them apart");
        let rivals = discovery.ambiguous.first().map_or_else(Vec::new, |set| set.effects.clone());
        let last = discovery.ladder.last().map_or_else(Vec::new, |rung| rung.effects.clone());
        proposal = propose(&family, (last, rivals), path, args.run.seed)?;
        more.append(&mut proposal.more);
    }
    let friction = friction(&family, &discovery)?;
    let mut points = String::new();
    if let Some(path) = args.series.path() {
        progress.say("predicting every sample");
        points = save_series(path, &family, &discovery)?;
    }
    if args.results.html.is_some() {
        progress.say("drawing the report");
    }
    let models = steps::ladder(&family, &discovery)?;
    let samples = args.results.samples(family.on_view(), &models, Decides::Prediction);
    drop(progress);
    let report = Report {
        kind: Kind::Discovery,
        discovery: &discovery,
        loaded: &loaded,
        check: &data,
        thresholds: settings.thresholds,
        together: friction.clone(),
        samples,
        more,
    };
    let mut files = report.save(&args.results)?;
    files += &points;
    if let Some(path) = &args.output {
        files += &save_model(&family, &discovery, path)?;
    }
    if quiet {
        return watch.end();
    }
    let next = if args.data.is_empty() { crate::example::next() } else { next(args, &discovery) };
    let files = if files.is_empty() { files } else { format!("\n{files}") };
    let story = story(&discovery, &settings.thresholds, &friction, args.run.explain);
    output::print(&(story + &confirmed + &alarms + &proposal.text + &files + &next))?;
    watch.end()
}

/// What other recordings, prepared with this bandwidth and what is known of parameters, say of a ladder.
fn confirmed(
    family: &FrictionFamily,
    ladder: &[Rung],
    others: &Loaded,
    (bandwidth, known): &(Option<f64>, Known),
    settings: &Settings<'_>,
) -> Result<Confirmed, Failure> {
    let other = steps::searched(&others.recording, *bandwidth, known)?.with_stroke_of(family);
    steps::same_axes(family, &other)?;
    let rungs = missing_physics::confirm(&other, ladder, settings)?;
    Ok(Confirmed { recording: others.recording.name().to_owned(), rungs })
}

fn save_model(
    family: &FrictionFamily,
    discovery: &Discovery,
    path: &Path,
) -> Result<String, Failure> {
    let Some(last) = discovery.ladder.last() else {
        return Ok(String::new());
    };
    let model = family.plant(last)?;
    output::save(path, &(model.to_json()? + "\n"))?;
    Ok(written("model", path))
}

/// What parameters of the last model make together.
fn friction(family: &FrictionFamily, discovery: &Discovery) -> Result<Combinations, Failure> {
    let Some(last) = discovery.ladder.last() else { return Ok(Combinations::default()) };
    Ok(family.on_view().friction(&model_of(family, last)?, Decides::Prediction))
}

/// Writes every rung point by point; returns what to tell the user.
fn save_series(
    path: &Path,
    family: &FrictionFamily,
    discovery: &Discovery,
) -> Result<String, Failure> {
    let names = discovery.ladder.iter().enumerate().map(|(k, rung)| rung.label(k));
    let rungs: Vec<(String, Fitted)> = names.zip(steps::ladder(family, discovery)?).collect();
    series::save(path, family.on_view(), &rungs, Decides::Prediction)
}

/// The loop as it went: where the base model failed, what was tried, what was gained.
fn story(
    discovery: &Discovery,
    thresholds: &Thresholds,
    friction: &Combinations,
    explain: bool,
) -> String {
    let mut text = String::new();
    if let Some(base) = discovery.ladder.first() {
        text += &heading(&format!("Where the base model fails: {}", base.effects.join(" + ")));
        let of = words::shared_out(discovery, discovery.missing_force_base.as_ref());
        text += &output::regimes(&discovery.regimes_base, &of);
        text += "\n";
        text += &output::where_it_fails(&discovery.where_base);
    }
    for (rung, candidates) in discovery.ranking.iter().enumerate() {
        let outcome = match discovery.ladder.get(rung + 1).map_or(&[][..], |next| &next.added) {
            [] => "nothing is added".to_owned(),
            effects => format!("{} is added", effects.join(" + ")),
        };
        text += &heading(&format!("Which effect is missing, step {}: {outcome}", rung + 1));
        if let Some(why) = words::why_nothing(discovery, rung, thresholds) {
            text += &output::why(&why);
        }
        text += &output::ranking(candidates, Columns::Best);
    }
    if explain && !discovery.decisions.is_empty() {
        text += &heading("What was compared");
        text += &output::compared(discovery, thresholds);
    }
    if discovery.ladder.len() > 1 {
        text += &heading("Where the last model fails");
        let of = words::shared_out(discovery, discovery.missing_force.as_ref());
        text += &output::regimes(&discovery.regimes, &of);
    }
    if let Some(diagnosis) = &discovery.diagnosis {
        text += &heading("Is what remains noise?");
        text += &output::tests(diagnosis);
        let lines = output::lines(discovery, diagnosis);
        text += if lines.is_empty() { "" } else { "\n" };
        text += &lines;
    }
    if let Some(last) = discovery.ladder.last() {
        text += &heading("Parameters of the last model");
        text += &output::parameters(last);
        text += &output::together(friction);
    }
    text += &heading("The ladder");
    text += &output::ladder(discovery, "base model");
    text += &output::verdict(discovery);
    text + &if explain { String::new() } else { output::comparisons(discovery) }
}

fn next(given: &Args, discovery: &Discovery) -> String {
    if discovery.verdict == Verdict::Ambiguous && given.experiment.is_none() {
        let command = format!("aep discover {} --experiment next.csv", given.words());
        return format!("\n{}\n", output::dim(&format!("What to run next: {command}")));
    }
    if given.results.html.is_some() {
        return String::new();
    }
    let command = format!("aep discover {} --html report.html", given.words());
    format!("\n{}\n", output::dim(&format!("All this with plots: {command}")))
}
