//! Ctrl-C: the first one asks for an end after the present step, the second one ends at once. So does the first one while
//! there is nothing to keep.

use std::io::Write as _;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use missing_physics::fit::Until;

use crate::failure::{Failure, INTERRUPTED};

static STOP: AtomicBool = AtomicBool::new(false);
static AT_ONCE: AtomicBool = AtomicBool::new(false);

/// How often a wait looks whether Ctrl-C came.
const LOOKS: Duration = Duration::from_millis(20);

/// The flag, watched from now on.
pub fn flag() -> &'static AtomicBool {
    watched(Some("stopping after this step; what was found is kept (Ctrl-C again ends at once)"))
}

/// The same for whoever ends at once and says so.
pub fn flag_silent() -> &'static AtomicBool {
    watched(None)
}

fn watched(said: Option<&'static str>) -> &'static AtomicBool {
    // A second call fails because the first one has done it already.
    let _ = ctrlc::set_handler(move || {
        if AT_ONCE.load(Ordering::Relaxed) {
            say("interrupted");
            std::process::exit(i32::from(INTERRUPTED));
        }
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
        if let Some(said) = said {
            say(said);
        }
    });
    &STOP
}

/// Where standard error is closed nobody is left to tell; a panic would end the thread that listens.
fn say(what: &str) {
    let _ = writeln!(std::io::stderr(), "\n{what}");
}

/// From now on Ctrl-C ends at once: nothing was found yet.
pub fn at_once() {
    AT_ONCE.store(true, Ordering::Relaxed);
    flag();
}

/// From now on there is something that is told after Ctrl-C.
pub fn keeping() {
    AT_ONCE.store(false, Ordering::Relaxed);
}

/// What `work` brings, or nothing as soon as Ctrl-C comes: the work is then left to itself until the program ends.
pub fn unless_interrupted<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
) -> Option<T> {
    let (result, done) = mpsc::channel();
    // Nobody listens any more where Ctrl-C came.
    std::thread::spawn(move || result.send(work()).ok());
    loop {
        match done.recv_timeout(LOOKS) {
            Ok(brought) => return Some(brought),
            Err(mpsc::RecvTimeoutError::Timeout) if !STOP.load(Ordering::Relaxed) => {}
            Err(_) => return None,
        }
    }
}

/// What ends a command early: Ctrl-C, or the end of its time.
#[derive(Clone, Copy, Debug)]
pub struct Watch {
    flag: &'static AtomicBool,
    until: Option<Instant>,
}

impl Watch {
    /// Watches Ctrl-C and, where there is one, a limit that begins now.
    pub fn new(limit: Option<Duration>) -> Self {
        Self { flag: flag(), until: limit.and_then(|limit| Instant::now().checked_add(limit)) }
    }

    /// Whether the user asked for an end.
    pub fn is_interrupted(self) -> bool {
        self.flag.load(Ordering::Relaxed)
    }

    /// The same as the libraries know it.
    pub fn until(self) -> Until<'static> {
        Until { stop: Some(self.flag), at: self.until }
    }

    /// Time that is left; none where there is no limit.
    pub fn left(self) -> Option<Duration> {
        self.until.map(|until| until.saturating_duration_since(Instant::now()))
    }

    /// Whether nothing new is to begin.
    pub fn is_over(self) -> bool {
        self.is_interrupted() || self.left().is_some_and(|left| left.is_zero())
    }

    /// The end of a command that has shown and saved what it has: a failure after Ctrl-C, so that
    /// scripts can tell; a limit is no failure.
    pub fn end(self) -> Result<(), Failure> {
        if self.is_interrupted() {
            return Err(Failure::interrupted("what was found so far is what is reported"));
        }
        Ok(())
    }
}
