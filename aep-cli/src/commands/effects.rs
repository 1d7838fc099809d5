//! `aep effects`: what there is to be found.

use std::fmt::Write;

use friction_ident::Axis;
use missing_physics::measurement::quantity::number;

use crate::app::Global;
use crate::args::{known, library};
use crate::failure::Failure;
use crate::output::{self, Align, Table, bold, dim, heading};

/// List the effects a model can have, with equations and parameters
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Say everything about this one
    #[arg(value_name = "EFFECT")]
    effect: Option<String>,
    /// What a formula may hold: variables, operators and functions, for columns and for effects of your own
    #[arg(long)]
    formula: bool,
    /// Units and ranges of a rotary axis
    #[arg(long)]
    rotary: bool,
}

const EXAMPLES: &str = concat!(
    "\
Examples:
  aep effects                                all of them, one line each
  aep effects stribeck                       everything about one
  aep effects --effects-file cogging.toml    with one of your own
  aep effects --formula                      what a formula may hold

A file with an effect of your own, cogging.toml:

",
    include_str!("../../examples/cogging.toml")
);

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let axis = if args.rotary { Axis::Rotary } else { Axis::Linear };
    let text = match &args.effect {
        _ if args.formula => formula(),
        None => list(),
        Some(name) => about(&known(&name.to_lowercase())?, axis)?,
    };
    if global.quiet { Ok(()) } else { output::print(&text) }
}

fn formula() -> String {
    let listed = aep_formula::FUNCTIONS.iter().filter(|function| !function.about.is_empty());
    let functions: Vec<&str> = listed.map(|function| function.about).collect();
    let functions = format!("  {}\n", functions.join("\n  "));
    let about = "\
wherever a column is named:       duty*v_in_V, force_N - 9.81*m, `Motor force [N]`/2
in an effect of your own:         x v a s t F (position, velocity, acceleration, sign of the velocity, time, force of
                                  the drive), its parameters, and every column of the recording
numbers and constants:            1.5e-3, pi, TAU, E; a column or a parameter of that name comes first
operators, loosest first:         < <= > >= == !=   (1 where it holds, else 0)
                                  + -
                                  * / %             (% is the remainder)
                                  ^ or **           (from the right; -x^2 is refused: write -(x^2) or (-x)^2)
functions:
";
    let limits = format!(
        "\nA formula has at most {} characters and {} brackets inside one another; an effect at most {} parameters.\n",
        aep_formula::MOST_LENGTH,
        aep_formula::MOST_DEPTH,
        friction_ident::effects::formula::MOST_PARAMETERS,
    );
    heading("Formulas") + about + &functions + &limits
}

fn list() -> String {
    let mut table =
        Table::new(&[("effect", Align::Left), ("what it is", Align::Left), ("adds to the model", Align::Left)]);
    for effect in library().effects() {
        let about = effect.about();
        table.row([about.name.to_owned(), about.title.to_owned(), about.equation.to_owned()]);
    }
    let hint = dim("v velocity, x position, s = sign of v; 'aep effects NAME' says everything about one");
    format!("{}\n {hint}\n", table.text())
}

fn about(name: &str, axis: Axis) -> Result<String, Failure> {
    let library = library();
    let effect = library.find(name)?;
    let about = effect.about();
    let mut text = heading(&format!("{}: {}", about.name, about.title));
    let slots: Vec<&str> = about.slots.iter().map(|slot| slot.name()).collect();
    let forms: Vec<&str> = effect.forms().iter().map(|form| form.about().name).collect();
    for (title, content) in [
        ("adds to the model", about.equation),
        ("acts on", &slots.join(", ")),
        ("shows in the residual", about.shows),
        ("source", about.reference),
        ("other forms", &forms.join(", ")),
    ] {
        if !content.is_empty() {
            // Writing to a string cannot fail.
            let _ = writeln!(text, " {}: {content}", bold(title));
        }
    }
    let mut table = Table::new(&[
        ("parameter", Align::Left),
        ("meaning", Align::Left),
        ("unit", Align::Left),
        ("typical", Align::Right),
        ("searched between", Align::Left),
    ]);
    for parameter in about.parameters {
        let (low, high) = parameter.range(axis);
        table.row([
            parameter.name.to_owned(),
            parameter.meaning.to_owned(),
            axis.unit(parameter.quantity).to_owned(),
            number(parameter.typical(axis)),
            format!("{} .. {}", number(low), number(high)),
        ]);
    }
    if !about.parameters.is_empty() {
        text.push_str(&table.text());
    }
    Ok(text)
}
