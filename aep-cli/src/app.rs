//! From the arguments to the exit code.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser};

use crate::args;
use crate::commands::Command;
use crate::failure::{BAD_INPUT, Failure};
use crate::output;

/// Tells what a model of a drive lacks: load a measurement, fit the model, see where it fails, learn
/// which physical effect is missing, add it, watch the error fall.
///
/// Start with `aep discover`: it runs on an example with a hidden effect. Then `aep discover
/// YOUR.csv`.
#[derive(Parser)]
#[command(name = "aep", version, max_term_width = 100, after_help = EXAMPLES)]
struct Cli {
    #[command(flatten)]
    global: Global,
    /// An effect of your own as a line of text in a TOML file (`aep effects --help` shows one); it joins the
    /// library. May be given several times
    #[arg(long, global = true, value_name = "FILE")]
    effects_file: Vec<PathBuf>,
    #[command(subcommand)]
    command: Command,
}

/// Most threads for each processor.
const MOST_THREADS: usize = 8;

const EXAMPLES: &str = "\
Examples:
  aep discover                                  the example that comes with the program
  aep discover run.csv --html report.html       columns time_s,force_N,position_m
  aep discover run.csv --force u_V --force-gain 35.15 --position-unit mm
  aep effects                                   what can be found, with equations

Exit codes: 0 done, 1 failed, 2 wrong usage or bad input, 130 ended by Ctrl-C (with what was found).";

/// What every command understands.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct Global {
    /// Threads to use; by default one per processor. Results do not depend on it.
    #[arg(long, global = true, value_name = "N", help_heading = "Running")]
    threads: Option<std::num::NonZeroUsize>,
    /// Print only errors; files are still written.
    #[arg(long, short, global = true, help_heading = "Running")]
    pub quiet: bool,
}

/// All arguments, for whatever is made of them: manual pages, completions.
pub fn command() -> clap::Command {
    Cli::command()
}

/// Runs the program.
pub fn main() -> ExitCode {
    // A reader or an evaluation of others that panics is told as the error that it is.
    aep_core::silence_caught_panics();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(answer) => {
            // Help and version come this way, too. If even that cannot be printed, nobody is there.
            let _ = answer.print();
            return ExitCode::from(if answer.use_stderr() { BAD_INPUT } else { 0 });
        }
    };
    end(run(cli))
}

/// Tells of a failure and ends the program, whatever it is still at.
pub fn end(result: Result<(), Failure>) -> ! {
    let Err(failure) = result else { std::process::exit(0) };
    output::error(&failure);
    std::process::exit(i32::from(failure.code))
}

/// Runs a command by the words that would be typed after `aep`.
pub fn as_typed(words: impl IntoIterator<Item = OsString>) -> Result<(), Failure> {
    let cli = Cli::try_parse_from(std::iter::once(OsString::from("aep")).chain(words))
        .map_err(|error| Failure::failed(error.to_string()))?;
    cli.command.run(cli.global)
}

fn run(cli: Cli) -> Result<(), Failure> {
    if let Some(asked) = cli.global.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads(asked.get()));
        pool.build_global().map_err(|error| Failure::failed(error.to_string()))?;
    }
    args::add_files(&cli.effects_file)?;
    cli.command.run(cli.global)
}

/// Threads to use where so many are asked for: more than a few for each processor take its time and memory and do nothing.
fn threads(asked: usize) -> usize {
    let processors = std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get);
    let most = MOST_THREADS * processors;
    if asked > most {
        output::warn(&format!(
            "{most} threads are used, not {asked}: there are {processors} processors"
        ));
    }
    asked.min(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_contradict_each_other_nowhere() {
        Cli::command().debug_assert();
    }

    #[test]
    fn every_command_has_an_example_and_says_what_it_does() {
        for command in Cli::command().get_subcommands() {
            assert!(command.get_about().is_some(), "{} has no description", command.get_name());
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(help.contains("aep "), "{} has no example", command.get_name());
        }
    }
}
