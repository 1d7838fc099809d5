//! `aep completions`: what a shell needs to complete commands and flags.

use clap_complete::Shell;

use crate::app::{self, Global};
use crate::failure::Failure;
use crate::output;

/// Print completions for a shell
///
/// They complete commands, flags and the values that flags can have.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  aep completions bash > ~/.local/share/bash-completion/completions/aep
  aep completions zsh > ~/.zfunc/_aep
  aep completions fish > ~/.config/fish/completions/aep.fish")]
pub struct Args {
    /// Which shell
    #[arg(value_enum, value_name = "SHELL")]
    shell: Shell,
}

/// Runs the command. Quiet or not, they are what was asked for.
pub fn run(args: &Args, _: Global) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut app::command(), "aep", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}
