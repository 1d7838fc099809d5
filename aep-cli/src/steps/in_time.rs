//! Identification by simulation.

use aep_core::{Aep, Budget, MetaEp, Method};
use friction_ident::effects::Effect;
use friction_ident::family::FrictionFamily;
use friction_ident::identify::{self, FoundParameter, Searched, all_free};
use friction_ident::{Identification, Model, Quantity};
use missing_physics::measurement::quantity::{number, quantity};
use missing_physics::statistics::autocorrelation::interval;
use missing_physics::{ModelFamily, Recording, diagnosis};

use super::{method, model};
use crate::args::{TimeTask, library};
use crate::failure::Failure;
use crate::output::{Align, Table, dim};
use crate::stop::Watch;

/// Identifies a model of these effects by simulating it, from the values that the comparison of forces
/// gives; stopped by Ctrl-C or the time limit it keeps what it has.
pub fn identify_in_time(
    recording: &Recording,
    family: &FrictionFamily,
    effects: &[String],
    task: &TimeTask,
    (algorithm, seed): (&str, u64),
    watch: Watch,
) -> Result<Simulated, Failure> {
    let first = first_guess(family, effects, (recording, seed), watch)?;
    let free = all_free(&first);
    let horizon = (task.horizon)(interval(recording.time()));
    let mut problem =
        Identification::new(&first, recording, &free, horizon)?.with_stop_flag(watch.flag());
    if let Some(left) = watch.left() {
        problem = problem.with_time_limit(left);
    }
    let method = sized(algorithm, task.population)?;
    let budget = Budget::generations(task.generations);
    Ok(Simulated { found: problem.from_several_starts(&*method, &budget, seed)? })
}

/// Values from the comparison of forces; typical ones for effects that it cannot show.
fn first_guess(
    family: &FrictionFamily,
    effects: &[String],
    (recording, seed): (&Recording, u64),
    watch: Watch,
) -> Result<Model, Failure> {
    let shown: Vec<String> = effects
        .iter()
        .filter(|name| family.terms().iter().any(|term| &term.name == *name))
        .cloned()
        .collect();
    let (fit, _) = super::identify(family, &shown, (&Aep::practical(), seed), watch)?;
    let values = model(family, &diagnosis::rung(family, &fit, &[]))?;
    let effects: Vec<&dyn Effect> =
        effects.iter().map(|name| library().find(name)).collect::<Result<_, _>>()?;
    Ok(identify::first_guess(&values, &effects, recording)?)
}

/// The optimizer of this name with a population.
fn sized(name: &str, population: usize) -> Result<Box<dyn Method<f64>>, Failure> {
    Ok(match name {
        "aep" => Box::new(Aep::practical().with_population(population)),
        "meta-ep" => Box::new(MetaEp::practical().with_population(population)),
        other => method(other)?,
    })
}

/// What an identification by simulation found, to be told.
pub struct Simulated {
    /// Model, intervals and error.
    pub found: Searched,
}

impl Simulated {
    /// The parameters as a table, and the error.
    pub fn text(&self) -> String {
        let mut table = Table::new(&[
            ("parameter", Align::Left),
            ("value", Align::Right),
            ("unit", Align::Left),
            ("95 % interval", Align::Left),
        ]);
        for FoundParameter { free, value, unit, interval } in self.found.parameters() {
            let interval = match interval {
                None => "stopped before it was known".to_owned(),
                Some(i) if i.identifiable => format!("{} .. {}", number(i.low), number(i.high)),
                Some(i) => {
                    let (low, high) = (number(i.low), number(i.high));
                    let fits = if i.low <= free.low && i.high < free.high {
                        format!("all below {high} fit")
                    } else if i.low > free.low && i.high >= free.high {
                        format!("all above {low} fit")
                    } else {
                        format!("{low} .. {high} fit")
                    };
                    format!("not identifiable from this data ({fits} as well)")
                }
            };
            table.row([free.address.clone(), number(value), unit.to_owned(), interval]);
        }
        let unit = self.found.model.axis().unit(Quantity::Length);
        let end = format!(
            "{} searches, position error {} rms",
            self.found.searches,
            quantity(self.found.rms, unit)
        );
        format!("{}\n {}\n", table.text(), dim(&end))
    }
}
