//! Files to take away. They lie in `exports/` of the project, each written as a command writes it.

use friction_ident::family::Decides;
use missing_physics::report::Combinations;
use missing_physics::{Fitted, Thresholds, diagnosis, fit};

use super::Studio;
use super::session::Session;
use super::task::Form;
use crate::app;
use crate::args::OutputArgs;
use crate::failure::Failure;
use crate::report::{Kind, Report};
use crate::series;

/// Seed of the placebos behind the p-values of a report, as that of the commands.
const SEED: u64 = 1;

/// Writes it.
pub fn write(
    studio: &Studio,
    session: &Session,
    id: u32,
    form: Form,
    is_over: &dyn Fn() -> bool,
) -> Result<(), Failure> {
    let place = |name: String| studio.project().place("exports", &name);
    let by_command = |to: &str, name: String| {
        let model = studio.project().model_path(id);
        let words = ["export", "--quiet", "--to", to, "--model"].map(std::ffi::OsString::from);
        let paths = [model.into_os_string(), place(name)?.into_os_string()];
        app::as_typed(words.into_iter().chain(paths))
    };
    match form {
        Form::Report => report(studio, session, id, is_over),
        Form::Series => {
            let (names, models) = path(studio, session, id)?;
            let named: Vec<(String, Fitted)> = names.into_iter().zip(models).collect();
            let place = place(format!("series-{id}.csv"))?;
            series::save(&place, &session.family, &named, Decides::Prediction).map(drop)
        }
        Form::C => by_command("c", format!("c-{id}")),
        Form::Fmu => by_command("fmu", format!("model_{id}.fmu")),
        Form::Modelica => by_command("modelica", format!("model_{id}.mo")),
        Form::Mjcf => by_command("mjcf", format!("model-{id}.xml")),
        Form::Urdf => by_command("urdf", format!("model-{id}.urdf")),
    }
}

/// The models from the base to this one, with a name for each.
pub fn path(
    studio: &Studio,
    session: &Session,
    id: u32,
) -> Result<(Vec<String>, Vec<Fitted>), Failure> {
    let project = studio.project();
    let path = project.state.tree.path(id);
    let names = path.iter().enumerate().map(|(k, entry)| match &entry.rung.added[..] {
        [] if k > 0 => format!("{k}_model_{}", entry.id),
        _ => entry.rung.label(k),
    });
    let names = names.collect();
    let models = path.iter().map(|entry| Ok(session.family.fitted(&project.model(entry.id)?)?));
    let models = models.collect::<Result<_, Failure>>()?;
    Ok((names, models))
}

fn report(
    studio: &Studio,
    session: &Session,
    id: u32,
    is_over: &dyn Fn() -> bool,
) -> Result<(), Failure> {
    let family = &*session.family;
    let (_, models) = path(studio, session, id)?;
    let rungs = {
        let project = studio.project();
        project.state.tree.path(id).into_iter().map(|entry| entry.rung.clone()).collect()
    };
    let place = studio.project().place("exports", &format!("report-{id}.html"))?;
    let args = OutputArgs { json: None, html: Some(place) };
    let (Some(first), Some(last)) = (models.first(), models.last()) else {
        return Err(Failure::bad_input(format!("there is no model {id}")));
    };
    let (first, last) = (fit::as_given(family, first.clone()), fit::as_given(family, last.clone()));
    let discovery = diagnosis::comparison(family, (&first, &last), rungs, SEED, is_over);
    let report = Report {
        kind: Kind::Comparison,
        discovery: &discovery,
        loaded: &session.loaded,
        check: &session.check,
        thresholds: Thresholds::default(),
        together: Combinations::default(),
        samples: args.samples(family, &models, Decides::Prediction),
        more: Vec::new(),
    };
    report.save(&args).map(drop)
}
