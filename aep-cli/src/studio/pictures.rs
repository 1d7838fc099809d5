//! What is drawn of models on the recording.

use std::sync::Arc;

use friction_ident::family::Decides;
use missing_physics::report::Rung;
use missing_physics::statistics::residual_tests::whiteness;
use missing_physics::{Fitted, ModelFamily, fit};
use serde::Deserialize;
use serde_json::{Value, json};

use super::session::Session;
use super::{Studio, export};
use crate::failure::Failure;

/// What is asked for.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pictured {
    /// The model.
    of: u32,
    /// Another one to stand beside it, in place of those before it.
    with: Option<u32>,
}

/// The recording with a model and all before it, or with two models.
pub fn course(studio: &Arc<Studio>, asked: &Pictured) -> Result<Value, Failure> {
    let session = studio.session()?;
    let (ladder, models) = models(studio, &session, asked)?;
    let samples = session.family.samples(&models, Decides::Prediction);
    let ladder: Vec<(String, &Rung)> =
        ladder.iter().map(|(name, rung)| (name.clone(), rung)).collect();
    Ok(aep_studio::studio::course(&ladder, &samples))
}

/// Whether what the model leaves resembles itself, beside that of the first one, as HTML.
pub fn remains(studio: &Arc<Studio>, asked: &Pictured) -> Result<Value, Failure> {
    let session = studio.session()?;
    let (_, models) = models(studio, &session, asked)?;
    let family = &*session.family;
    let test = |model: &Fitted| {
        let residual = fit::as_given(family, model.clone()).residual;
        whiteness(&residual, family.time(), &family.colour(), 0)
    };
    let first = models.first().filter(|_| models.len() > 1).and_then(test);
    let last = models.last().and_then(test);
    let html = last
        .map(|last| aep_studio::studio::whiteness(&family.quantity().name, first.as_ref(), &last));
    Ok(json!({ "html": html.unwrap_or_default() }))
}

/// A model's name and errors.
type Named = (String, Rung);

/// All that are drawn.
fn models(
    studio: &Studio,
    session: &Session,
    asked: &Pictured,
) -> Result<(Vec<Named>, Vec<Fitted>), Failure> {
    let Some(with) = asked.with else {
        let (_, models) = export::path(studio, session, asked.of)?;
        let project = studio.project();
        let path = project.state.tree.path(asked.of);
        if path.is_empty() {
            return Err(Failure::bad_input(format!("there is no model {}", asked.of)));
        }
        let named = path.iter().map(|entry| (entry.name.clone(), entry.rung.clone()));
        return Ok((named.collect(), models));
    };
    let project = studio.project();
    let two = [with, asked.of].map(|id| {
        let entry = project.state.tree.get(id);
        let entry = entry.ok_or_else(|| Failure::bad_input(format!("there is no model {id}")))?;
        let model = session.family.fitted(&project.model(id)?)?;
        Ok(((format!("model {id}: {}", entry.name), entry.rung.clone()), model))
    });
    Ok(two.into_iter().collect::<Result<Vec<_>, Failure>>()?.into_iter().unzip())
}
