//! The commands. Each is a file with its arguments and a function that runs them; the list below is
//! all there is to registering one.

use crate::app::Global;
use crate::failure::Failure;

mod optimize_run;
mod reproduce_control;
mod reproduce_figure;
mod reproduce_optimizers;
mod reproduce_plant;
mod reproduce_record;
mod reproduce_table;

/// Makes the commands of `name(module)` pairs: `module::Args` and `module::run`.
macro_rules! commands {
    ($($name:ident($module:ident)),+ $(,)?) => {
        $(mod $module;)+

        /// A command with its arguments.
        #[derive(clap::Subcommand)]
        pub enum Command {
            $(
                #[doc(hidden)]
                $name(Box<$module::Args>),
            )+
        }

        impl Command {
            /// Runs it.
            pub fn run(self, global: Global) -> Result<(), Failure> {
                match self {
                    $(Self::$name(args) => $module::run(&args, global),)+
                }
            }
        }
    };
}

commands! {
    Discover(discover),
    Identify(identify),
    Compare(compare),
    Suggest(suggest),
    Extend(extend),
    Simulate(simulate),
    Control(control),
    Export(export),
    Challenge(challenge),
    Effects(effects),
    Optimize(optimize),
    Problems(problems),
    Reproduce(reproduce),
    Studio(studio),
    Completions(completions),
    Man(man),
}

/// A number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        _ => Err("it must be a number above 0".to_owned()),
    }
}

/// A number of at least 0.
pub fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value >= 0.0 && f64::is_finite(value) => Ok(value),
        _ => Err("it must be a number of at least 0".to_owned()),
    }
}
