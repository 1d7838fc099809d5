//! The studio: a page on this machine that runs the loop live. It does what the commands do, by the same calls, and keeps
//! all it has in a folder of files that the commands read.
//!
//! | file | what it does |
//! |---|---|
//! | `project` | the folder: where everything lies, and what of it may be read |
//! | `tree` | the models: each with the one that it came from |
//! | `session` | the recording in memory, prepared, and what was computed of it |
//! | `task` | what can be asked for that takes time |
//! | `jobs` | one task at a time on a thread of its own: progress, cancel, what a killed server left |
//! | `work` | a task, done |
//! | `guard` | which requests are heard |
//! | `routes` | requests and their answers |
//! | `data`, `law`, `riddles`, `export` | a file and its mapping; a law while it is typed; challenges; files to take away |
//! | `pictures` | models on the recording, as they are drawn |
//! | `view` | what the page is told |

mod data;
mod export;
mod guard;
mod jobs;
mod law;
mod pictures;
mod project;
mod riddle;
mod riddles;
mod routes;
mod session;
mod task;
mod tree;
mod view;
mod work;

use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::broadcast;

use crate::failure::Failure;
use crate::{output, stop};
use jobs::Jobs;
use project::Project;
use session::Session;

/// Messages that a page which does not listen may miss before it asks for everything anew.
const MESSAGES: usize = 256;
/// How often it is asked whether Ctrl-C was pressed.
const WATCH: Duration = Duration::from_millis(50);

/// What the studio is started with.
pub struct Options {
    /// Where it keeps everything.
    pub folder: PathBuf,
    /// A recording to begin with.
    pub data: Option<PathBuf>,
    /// Port on this machine; 0 for any that is free.
    pub port: u16,
    /// Whether a browser is opened.
    pub open: bool,
}

/// The running studio.
pub struct Studio {
    project: Mutex<Project>,
    session: Mutex<Option<Arc<Session>>>,
    jobs: Jobs,
    /// What pages hear: JSON.
    told: broadcast::Sender<String>,
    guard: guard::Guard,
}

impl Studio {
    fn project(&self) -> MutexGuard<'_, Project> {
        self.project.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The recording in memory; it is read where it was not yet.
    fn session(&self) -> Result<Arc<Session>, Failure> {
        let mut session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(session) = &*session {
            return Ok(session.clone());
        }
        let (path, hold, effects) = {
            let project = self.project();
            (project.recording()?, project.state.hold, project.effect_files()?)
        };
        let made = Arc::new(Session::read(&path, hold, &effects)?);
        {
            let mut project = self.project();
            if project.state.hold != made.hold() {
                project.state.hold = made.hold();
                project.save()?;
            }
        }
        *session = Some(made.clone());
        Ok(made)
    }

    /// Forgets what is in memory: the files have changed.
    fn forget(&self) {
        *self.session.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Tells every page that something has changed.
    fn changed(&self) {
        self.tell(&serde_json::json!({"changed": true}));
    }

    fn tell(&self, message: &serde_json::Value) {
        // Where no page listens nobody is to be told.
        let _ = self.told.send(message.to_string());
    }
}

/// Serves the page until Ctrl-C.
pub fn serve(options: &Options, quiet: bool) -> Result<(), Failure> {
    if let Some(data) = options.data.as_deref().filter(|data| !data.is_file()) {
        return Err(Failure::bad_input("there is no such file").in_file(data));
    }
    let project = Project::open(&options.folder)?;
    let studio = Arc::new(Studio {
        project: Mutex::new(project),
        session: Mutex::new(None),
        jobs: Jobs::default(),
        told: broadcast::channel(MESSAGES).0,
        guard: guard::Guard::new(),
    });
    if let Some(data) = &options.data {
        data::bring(&studio, data)?;
    }
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .map_err(|error| Failure::failed(format!("cannot start the server: {error}")))?;
    let served = runtime.block_on(listen(&studio, options, quiet));
    // A fit in progress is left; it is offered again.
    runtime.shutdown_background();
    served
}

async fn listen(studio: &Arc<Studio>, options: &Options, quiet: bool) -> Result<(), Failure> {
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, options.port));
    let listener = tokio::net::TcpListener::bind(address).await.map_err(|error| {
        Failure::bad_input(format!("cannot listen on port {}: {error}", options.port))
            .with_hint("another program has it: leave --port out, or give another one")
    })?;
    let port = listener.local_addr().map_or(options.port, |address| address.port());
    let url = format!("http://127.0.0.1:{port}/");
    if !quiet {
        let folder = studio.project().folder().display().to_string();
        output::print(&format!(
            "The studio is at {url}\nIts files are in {folder}\nCtrl-C ends it; nothing is lost but a fit in progress.\n"
        ))?;
    }
    if options.open {
        // Where there is no browser the address has been printed.
        let _ = open::that_detached(&url);
    }
    let flag = stop::flag_silent();
    let interrupted = async {
        while !flag.load(Ordering::Relaxed) {
            tokio::time::sleep(WATCH).await;
        }
    };
    tokio::select! {
        served = axum::serve(listener, routes::router(studio.clone())) => {
            served.map_err(|error| Failure::failed(format!("the server stopped: {error}")))
        }
        () = interrupted => Ok(()),
    }
}
