//! Identification by simulation.

use aep_core::{Aep, Budget, MetaEp, Method};
use friction_ident::family::FrictionFamily;
use friction_ident::identify::{Interval, Refined, all_free};
use friction_ident::{Free, Identification, Model, Quantity, intervals_over};
use missing_physics::autocorrelation::interval;
use missing_physics::quantity::{number, quantity};
use missing_physics::{ModelFamily, Recording};

use super::{identify, method, model, rung};
use crate::args::{TimeTask, library};
use crate::failure::Failure;
use crate::output::{Align, Table, dim};
use crate::stop::Watch;

/// Searches of an identification by simulation: several valleys may fit as well.
const SEARCHES: u64 = 3;

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
    let mut found: Vec<Refined> = Vec::new();
    for search in 0..SEARCHES {
        if search > 0 && problem.is_stopped() {
            break;
        }
        let method = sized(algorithm, task.population)?;
        let budget = Budget::generations(task.generations);
        let end = problem.run_from(&[problem.start()], &*method, budget, seed + search)?;
        // Nothing was evaluated where there was no time at all.
        let from = if end.position.is_empty() { problem.start() } else { end.position };
        found.push(problem.refine_around(&from));
    }
    found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let best = found.first().ok_or_else(|| Failure::failed("nothing was found".to_owned()))?;
    let model = problem.model(&best.position)?;
    let optima: Vec<Vec<f64>> = found.iter().map(|found| found.position.clone()).collect();
    // Intervals are refits as well; whoever stops wants to go.
    let intervals =
        if problem.is_stopped() { None } else { Some(intervals_over(&problem, &optima)) };
    let errors = problem.errors(&best.position);
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len().max(1) as f64).sqrt();
    Ok(Simulated {
        model,
        free,
        position: best.position.clone(),
        intervals,
        rms,
        searches: found.len(),
    })
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
    let (fit, _) = identify(family, &shown, (&Aep::practical(), seed), watch)?;
    let values = model(family, &rung(family, &fit, None))?;
    let mut model = Model::new(family.axis(), values.mass())?;
    for name in effects {
        let effect = library().find(name)?;
        model = model.with_effect(effect.bound(recording).unwrap_or(effect))?;
        for address in model.addresses() {
            if let Ok(value) = values.get(&address) {
                model.set(&address, value)?;
            }
        }
    }
    Ok(model)
}

/// The optimizer of this name with a population.
fn sized(name: &str, population: usize) -> Result<Box<dyn Method<f64>>, Failure> {
    Ok(match name {
        "aep" => Box::new(Aep::practical().with_population(population)),
        "meta-ep" => Box::new(MetaEp::practical().with_population(population)),
        other => method(other)?,
    })
}

/// What an identification by simulation found.
pub struct Simulated {
    /// The model.
    pub model: Model,
    free: Vec<Free>,
    position: Vec<f64>,
    /// None where it was stopped before.
    intervals: Option<Vec<Interval>>,
    /// Position error, m or rad rms.
    rms: f64,
    searches: usize,
}

impl Simulated {
    fn rows(&self) -> Vec<(&str, f64, &str, Option<&Interval>)> {
        let rows = self.free.iter().zip(&self.position).enumerate();
        rows.map(|(k, (free, value))| {
            let unit = self.model.unit(&free.address).unwrap_or_default();
            let interval = self.intervals.as_ref().and_then(|intervals| intervals.get(k));
            (free.address.as_str(), *value, unit, interval)
        })
        .collect()
    }

    /// The parameters as a table, and the error.
    pub fn text(&self) -> String {
        let mut table = Table::new(&[
            ("parameter", Align::Left),
            ("value", Align::Right),
            ("unit", Align::Left),
            ("95 % interval", Align::Left),
        ]);
        for (address, value, unit, interval) in self.rows() {
            let interval = match interval {
                None => "stopped before it was known".to_owned(),
                Some(i) if i.identifiable => format!("{} .. {}", number(i.low), number(i.high)),
                Some(i) => {
                    let (low, high) = (number(i.low), number(i.high));
                    let free = self.free.iter().find(|free| free.address == address);
                    let fits = match free {
                        Some(free) if i.low <= free.low && i.high < free.high => {
                            format!("all below {high} fit")
                        }
                        Some(free) if i.low > free.low && i.high >= free.high => {
                            format!("all above {low} fit")
                        }
                        _ => format!("{low} .. {high} fit"),
                    };
                    format!("not identifiable from this data ({fits} as well)")
                }
            };
            table.row([address.to_owned(), number(value), unit.to_owned(), interval]);
        }
        let unit = self.model.axis().unit(Quantity::Length);
        let end =
            format!("{} searches, position error {} rms", self.searches, quantity(self.rms, unit));
        format!("{}\n {}\n", table.text(), dim(&end))
    }

    /// The same for scripts.
    pub fn json(&self) -> serde_json::Value {
        let parameters: serde_json::Map<String, serde_json::Value> = self
            .rows()
            .into_iter()
            .map(|(address, value, unit, interval)| {
                let (low, high) = (interval.map(|i| i.low), interval.map(|i| i.high));
                let identifiable = interval.map(|i| i.identifiable);
                let entry = serde_json::json!({
                    "value": value, "low": low, "high": high, "unit": unit, "identifiable": identifiable
                });
                (address.to_owned(), entry)
            })
            .collect();
        serde_json::json!({ "parameters": parameters, "position_rms": self.rms, "searches": self.searches })
    }
}
