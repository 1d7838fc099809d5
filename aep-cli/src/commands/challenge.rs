//! `aep challenge`: a recording with a hidden effect.

use std::path::PathBuf;

use clap::ValueEnum;
use friction_ident::challenge::{ChallengeError, Hide, Level, generate};

use crate::app::Global;
use crate::example;
use crate::failure::Failure;
use crate::output::{self, written};

/// Make a recording with a hidden effect, to see whether it is found
///
/// Simulates a ball-screw table under a controller. Writes recording.csv and recording.toml, which
/// discovery reads, and truth.json, which it never does.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The example that `aep discover` runs on without data, with its truth
    #[arg(long, conflicts_with_all = ["hide", "size", "seed"])]
    example: bool,
    /// The effect to hide, `random` or `nothing`
    #[arg(long, value_name = "EFFECT", default_value = "random")]
    hide: String,
    /// How large it is against the noise
    #[arg(long, value_enum, default_value_t = Size::Clear)]
    size: Size,
    /// Seed of the table, the effect and the noise
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Folder to write to; made if it is not there
    #[arg(long, short = 'o', value_name = "DIR")]
    output: PathBuf,
}

const EXAMPLES: &str = "\
Examples:
  aep challenge --hide random --seed 7 -o challenge && aep discover challenge/recording.csv
  aep challenge --hide stribeck --size faint --seed 3 -o faint
  aep challenge --hide nothing --seed 4 -o control
  aep challenge --example -o example";

/// Digits of a recorded number: far below noise and counts.
const DIGITS: usize = 8;

/// Size of the hidden effect against the noise.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Size {
    /// 1 to 3 times the noise
    Faint,
    /// 3 to 10 times
    Moderate,
    /// 10 to 20 times
    Clear,
}

impl From<Size> for Level {
    fn from(size: Size) -> Self {
        match size {
            Size::Faint => Self::Faint,
            Size::Moderate => Self::Moderate,
            Size::Clear => Self::Clear,
        }
    }
}

impl From<ChallengeError> for Failure {
    fn from(error: ChallengeError) -> Self {
        match error {
            ChallengeError::Run(error) => Self::failed(format!("the simulation failed: {error}")),
            other => Self::from_lines(&other.to_string()),
        }
    }
}

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let folder = &args.output;
    let [data, mapping, truth] =
        ["recording.csv", "recording.toml", "truth.json"].map(|name| folder.join(name));
    if args.example {
        output::make_folder(folder)?;
        for (name, content) in example::files() {
            output::save(&folder.join(name), content)?;
        }
    } else {
        let hide = Hide::parse(&args.hide.to_lowercase());
        let challenge = generate(&hide, args.seed, args.size.into())?;
        output::make_folder(folder)?;
        output::save(&data, &aep_data::to_csv_rounded(&challenge.recording, DIGITS))?;
        output::save(&mapping, &aep_data::to_toml(&challenge.recording))?;
        output::save_json(&truth, &challenge.truth)?;
    }
    if global.quiet {
        return Ok(());
    }
    let next = format!("Find out what is hidden: aep discover {}\n", data.display());
    output::print(&(written("recording", &data) + &written("truth", &truth) + &next))
}
