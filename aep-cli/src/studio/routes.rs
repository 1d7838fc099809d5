//! Requests and their answers; docs/studio.md lists them. A request waits for no task: it begins one.

use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, Bytes, HttpBody, to_bytes};
use axum::extract::{Query, State};
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::http::{HeaderValue, StatusCode};
use axum::middleware::from_fn_with_state;
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{Html, IntoResponse, Json, Response};
use axum::routing::{get, post};
use friction_ident::challenge::Level;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio_stream::StreamExt;
use tokio_stream::wrappers::BroadcastStream;

use super::pictures::Pictured;
use super::{Studio, data, guard, jobs, law, pictures, riddles, view};
use crate::failure::{BAD_INPUT, Failure};

/// Largest recording, bytes.
const LARGEST_FILE: usize = 256 << 20;
/// Largest other request, bytes.
const LARGEST: usize = 64 << 10;
/// Longest time in which a recording, and any other request, must have come.
const FILE_WITHIN: Duration = Duration::from_mins(2);
const WITHIN: Duration = Duration::from_secs(10);
/// Requests that compute at the same time, and pages that listen.
const AT_ONCE: usize = 4;
const LISTENERS: usize = 64;

/// What handlers share.
#[derive(Clone)]
struct Shared {
    studio: Arc<Studio>,
    working: Arc<Semaphore>,
    listening: Arc<Semaphore>,
}

/// Why a request is refused.
pub struct Refused(StatusCode, Value);

impl Refused {
    /// For a reason in words.
    pub fn because(status: StatusCode, why: &str) -> Self {
        Self(status, json!({"what": why}))
    }
}

impl From<Failure> for Refused {
    fn from(failure: Failure) -> Self {
        let bad = failure.code == BAD_INPUT;
        let status = if bad { StatusCode::BAD_REQUEST } else { StatusCode::INTERNAL_SERVER_ERROR };
        Self(status, view::failure(&failure))
    }
}

impl IntoResponse for Refused {
    fn into_response(self) -> Response {
        (self.0, Json(json!({"error": self.1}))).into_response()
    }
}

type Answer<T = Json<Value>> = Result<T, Refused>;

/// Everything that is answered.
pub fn router(studio: Arc<Studio>) -> Router {
    let shared = Shared {
        studio: studio.clone(),
        working: Arc::new(Semaphore::new(AT_ONCE)),
        listening: Arc::new(Semaphore::new(LISTENERS)),
    };
    Router::new()
        .route("/", get(page))
        .route(
            "/studio.js",
            get(|| async { typed("text/javascript", aep_studio::studio::script()) }),
        )
        .route("/studio.css", get(|| async { typed("text/css", aep_studio::studio::style()) }))
        .route("/api/state", get(state))
        .route("/api/events", get(events))
        .route("/api/effects", get(|| async { Json(view::effects()) }))
        .route("/api/preview", get(preview))
        .route("/api/data", get(checked_data))
        .route("/api/course", get(course))
        .route("/api/remains", get(remains))
        .route("/api/control", get(control))
        .route("/api/file", get(file))
        .route("/api/upload", post(upload))
        .route("/api/example", post(example))
        .route("/api/check", post(check))
        .route("/api/take", post(take))
        .route("/api/leave", post(leave))
        .route("/api/task", post(task))
        .route("/api/cancel", post(cancel))
        .route("/api/discard", post(discard))
        .route("/api/choose", post(choose))
        .route("/api/law", post(draw_law))
        .route("/api/effect", post(add_law))
        .route("/api/riddle", post(make_riddle))
        .route("/api/guess", post(guess))
        .with_state(shared)
        .layer(from_fn_with_state(studio, guard::guarded))
}

fn typed(kind: &'static str, text: String) -> Response {
    let kind = HeaderValue::from_str(&format!("{kind}; charset=utf-8"));
    let mut answer = text.into_response();
    if let Ok(kind) = kind {
        answer.headers_mut().insert(CONTENT_TYPE, kind);
    }
    answer
}

impl Shared {
    /// Runs what computes or reads files beside the threads that answer.
    async fn work<T: Send + 'static>(
        &self,
        work: impl FnOnce(&Arc<Studio>) -> Result<T, Failure> + Send + 'static,
    ) -> Answer<T> {
        let closed = || Refused::because(StatusCode::SERVICE_UNAVAILABLE, "the studio is ending");
        let permit = self.working.clone().acquire_owned().await.map_err(|_| closed())?;
        let studio = self.studio.clone();
        let done = tokio::task::spawn_blocking(move || {
            let _permit: OwnedSemaphorePermit = permit;
            work(&studio)
        });
        let done = done.await.map_err(|_| {
            Refused::because(StatusCode::INTERNAL_SERVER_ERROR, "the request failed inside")
        })?;
        Ok(done?)
    }

    /// The same for what changes something: every page hears of it.
    async fn change(
        &self,
        work: impl FnOnce(&Arc<Studio>) -> Result<(), Failure> + Send + 'static,
    ) -> Answer {
        self.work(work).await?;
        self.studio.changed();
        Ok(Json(json!({})))
    }
}

/// A body of limited size that must come in limited time.
async fn body(body: Body, largest: usize, within: Duration) -> Answer<Bytes> {
    let large = || {
        let why = format!("the request is larger than {} KiB", largest >> 10);
        Refused::because(StatusCode::PAYLOAD_TOO_LARGE, &why)
    };
    if body.size_hint().lower() > largest as u64 {
        return Err(large());
    }
    let read = tokio::time::timeout(within, to_bytes(body, largest)).await;
    let late =
        || Refused::because(StatusCode::REQUEST_TIMEOUT, "the request took too long to come");
    read.map_err(|_| late())?.map_err(|_| large())
}

async fn asked<T: DeserializeOwned>(from: Body) -> Answer<T> {
    let bytes = body(from, LARGEST, WITHIN).await?;
    serde_json::from_slice(&bytes).map_err(|error| {
        Refused::because(StatusCode::BAD_REQUEST, &format!("the request cannot be read: {error}"))
    })
}

async fn page(State(shared): State<Shared>) -> Html<String> {
    Html(aep_studio::studio::page(shared.studio.guard.token()))
}

async fn state(State(shared): State<Shared>) -> Answer {
    shared.work(|studio| Ok(Json(view::state(studio)))).await
}

async fn events(State(shared): State<Shared>) -> Answer<impl IntoResponse> {
    let permit = shared.listening.clone().try_acquire_owned().map_err(|_| {
        Refused::because(
            StatusCode::SERVICE_UNAVAILABLE,
            "too many pages of the studio are open: close some",
        )
    })?;
    let told = BroadcastStream::new(shared.studio.told.subscribe());
    let events = told.map(move |told| {
        let _permit = &permit;
        // What was missed is asked for anew.
        let message = told.unwrap_or_else(|_| json!({"changed": true}).to_string());
        Ok::<_, Infallible>(Event::default().data(message))
    });
    Ok(Sse::new(events).keep_alive(KeepAlive::default()))
}

async fn preview(State(shared): State<Shared>) -> Answer {
    shared.work(|studio| data::look(studio).map(Json)).await
}

async fn checked_data(State(shared): State<Shared>) -> Answer {
    shared.work(|studio| data::check_of_models(studio).map(Json)).await
}

async fn course(State(shared): State<Shared>, Query(asked): Query<Pictured>) -> Answer {
    shared.work(move |studio| pictures::course(studio, &asked).map(Json)).await
}

async fn remains(State(shared): State<Shared>, Query(asked): Query<Pictured>) -> Answer {
    shared.work(move |studio| pictures::remains(studio, &asked).map(Json)).await
}

/// The compensator that was simulated last.
async fn control(State(shared): State<Shared>) -> Json<Value> {
    let project = shared.studio.project();
    Json(json!({"html": project.beside.control.as_ref().map(|(_, card)| card)}))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Path {
    path: String,
}

async fn file(State(shared): State<Shared>, Query(asked): Query<Path>) -> Answer<Response> {
    let (name, content) = shared
        .work(move |studio| {
            let path = studio.project().file(&asked.path)?;
            let content = std::fs::read(&path).map_err(|error| {
                Failure::failed(format!("cannot read the file: {error}")).in_file(&path)
            })?;
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            Ok((name, content))
        })
        .await?;
    let plain: String =
        name.chars().filter(|c| c.is_ascii_alphanumeric() || "._-+".contains(*c)).collect();
    let mut answer = content.into_response();
    // A page of the user's own making is none of the studio.
    for (header, value) in [
        (CONTENT_TYPE, "application/octet-stream".to_owned()),
        (CONTENT_DISPOSITION, format!("attachment; filename=\"{plain}\"")),
    ] {
        if let Ok(value) = HeaderValue::from_str(&value) {
            answer.headers_mut().insert(header, value);
        }
    }
    Ok(answer)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Name {
    name: String,
}

async fn upload(State(shared): State<Shared>, Query(asked): Query<Name>, from: Body) -> Answer {
    let content = body(from, LARGEST_FILE, FILE_WITHIN).await?;
    shared.change(move |studio| data::keep(studio, &asked.name, &content, None)).await
}

async fn example(State(shared): State<Shared>) -> Answer {
    shared.change(|studio| data::bring_example(studio)).await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Taken {
    mapping: Value,
    #[serde(default)]
    effects: Option<Vec<String>>,
}

async fn check(State(shared): State<Shared>, from: Body) -> Answer {
    let asked: Taken = asked(from).await?;
    shared.work(move |studio| data::checked(studio, &data::mapping(asked.mapping)?).map(Json)).await
}

async fn take(State(shared): State<Shared>, from: Body) -> Answer {
    let asked: Taken = asked(from).await?;
    shared
        .change(move |studio| data::take(studio, &data::mapping(asked.mapping)?, asked.effects))
        .await
}

async fn leave(State(shared): State<Shared>) -> Answer {
    shared.change(|studio| data::leave(studio)).await
}

async fn task(State(shared): State<Shared>, from: Body) -> Answer {
    let task = asked(from).await?;
    shared.change(move |studio| jobs::start(studio, task)).await
}

/// Waits for nothing that computes.
async fn cancel(State(shared): State<Shared>) -> Answer {
    shared.studio.jobs.cancel(&shared.studio);
    Ok(Json(json!({})))
}

/// What a killed server left is not wanted any more.
async fn discard(State(shared): State<Shared>) -> Answer {
    shared
        .change(|studio| {
            if studio.jobs.view().is_none() {
                studio.project().end();
            }
            Ok(())
        })
        .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Chosen {
    model: u32,
}

async fn choose(State(shared): State<Shared>, from: Body) -> Answer {
    let Chosen { model } = asked(from).await?;
    shared
        .change(move |studio| {
            let mut project = studio.project();
            if project.state.tree.get(model).is_none() {
                return Err(Failure::bad_input(format!("there is no model {model}")));
            }
            project.state.tree.chosen = Some(model);
            project.save()
        })
        .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OfLaw {
    law: law::Law,
    from: u32,
}

async fn draw_law(State(shared): State<Shared>, from: Body) -> Answer {
    let OfLaw { law, from } = asked(from).await?;
    shared.work(move |studio| law::curve(studio, &law, from).map(Json)).await
}

async fn add_law(State(shared): State<Shared>, from: Body) -> Answer {
    let OfLaw { law, from } = asked(from).await?;
    shared.change(move |studio| law::add(studio, &law, from)).await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Hidden {
    #[serde(default)]
    size: Level,
}

async fn make_riddle(State(shared): State<Shared>, from: Body) -> Answer {
    let Hidden { size } = asked(from).await?;
    shared.change(move |studio| riddles::make(studio, size)).await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Guess {
    effect: Option<String>,
}

async fn guess(State(shared): State<Shared>, from: Body) -> Answer {
    let Guess { effect } = asked(from).await?;
    shared.change(move |studio| riddles::guess(studio, effect.as_deref())).await
}
