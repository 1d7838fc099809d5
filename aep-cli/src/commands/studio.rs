//! `aep studio`: the loop on a page.

use std::path::{Path, PathBuf};

use crate::app::Global;
use crate::failure::Failure;
use crate::studio::{self, Options};

/// Open a page on this machine that runs the loop live
///
/// Choose a recording, see the data check, fit, see where the model fails and which effect it lacks, add it and watch the
/// error fall; go back, branch, compare; type a law of your own; solve riddles. The page is served on this machine alone and
/// loads nothing from elsewhere. All it has lies in the project's folder, in files that the other commands read.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A recording to begin with; it is copied into the project, with DATA.toml where there is one
    #[arg(value_name = "DATA")]
    data: Option<PathBuf>,
    /// Folder of the project; made where it is not there [default: DATA-studio, or aep-studio]
    #[arg(long, value_name = "FOLDER")]
    project: Option<PathBuf>,
    /// Port on this machine; 0 for any that is free
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    port: u16,
    /// Open a browser (the default)
    #[arg(long, overrides_with = "no_open")]
    open: bool,
    /// Open no browser, only print the address
    #[arg(long)]
    no_open: bool,
}

const EXAMPLES: &str = "\
Examples:
  aep studio                                   choose a file, or the example, on the page
  aep studio run.csv                           in the folder run-studio
  aep studio --project drive --port 8700       go on with a project, at http://127.0.0.1:8700/
  aep compare drive/data/run.csv --model drive/models/0.json --model drive/models/1.json";

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let options = Options {
        folder: args.project.clone().unwrap_or_else(|| folder(args.data.as_deref())),
        data: args.data.clone(),
        port: args.port,
        open: !args.no_open,
    };
    studio::serve(&options, global.quiet)
}

fn folder(data: Option<&Path>) -> PathBuf {
    let stem = data.and_then(Path::file_stem).map(|stem| stem.to_string_lossy().into_owned());
    PathBuf::from(stem.map_or_else(|| "aep-studio".to_owned(), |stem| format!("{stem}-studio")))
}
