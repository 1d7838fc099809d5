//! `aep man`: manual pages.

use std::path::PathBuf;

use clap_mangen::Man;

use crate::app::{self, Global};
use crate::failure::Failure;
use crate::output::{self, written};

/// Print the manual page, or write those of all commands
#[derive(clap::Args)]
#[command(after_help = "Examples:
  aep man > aep.1 && man ./aep.1
  aep man --dir ~/.local/share/man/man1    aep.1, aep-discover.1, ...; then: man aep-discover")]
pub struct Args {
    /// Folder to write one page per command to; made if it is not there
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let mut command = app::command().disable_help_subcommand(true);
    // Hands the global flags and the names `aep-discover`, ... down to the commands.
    command.build();
    let Some(dir) = &args.dir else { return output::print(&page(command)?) };
    output::make_folder(dir)?;
    let commands: Vec<clap::Command> = command.get_subcommands().cloned().collect();
    for command in std::iter::once(command).chain(commands) {
        let name = command.get_display_name().unwrap_or(command.get_name()).to_owned();
        output::save(&dir.join(format!("{name}.1")), &page(command)?)?;
    }
    if global.quiet { Ok(()) } else { output::print(&written("manual pages", dir)) }
}

fn page(command: clap::Command) -> Result<String, Failure> {
    let mut roff = Vec::new();
    let made = Man::new(command).render(&mut roff);
    made.map_err(|error| Failure::failed(format!("cannot make the page: {error}")))?;
    Ok(String::from_utf8_lossy(&roff).into_owned())
}
