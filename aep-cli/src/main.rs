//! The command line `aep`: arguments, progress, tables. No physics and no numerics of its own.

mod app;
mod args;
mod commands;
mod compensation;
mod curve_plot;
mod example;
mod experiment;
mod failure;
mod output;
mod outputs;
mod progress;
mod report;
mod series;
mod steps;
mod stop;
mod studio;

fn main() -> std::process::ExitCode {
    app::main()
}
