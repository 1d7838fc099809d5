//! One task at a time, on a thread of its own.
//!
//! Cancel works at once: the task is told to stop and what it may still bring is not taken. Until its thread has ended it
//! counts as ending, and few may.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use aep_studio::words;
use serde_json::{Value, json};

use super::Studio;
use super::task::Task;
use super::view::failure;
use super::work::{self, Step};
use crate::failure::Failure;

/// Most tasks that were cancelled and have not ended yet.
const ENDING: usize = 2;

/// The task in progress.
#[derive(Default)]
pub struct Jobs {
    running: Mutex<Option<Running>>,
    ending: AtomicUsize,
}

struct Running {
    task: Task,
    stop: Arc<AtomicBool>,
    step: Step,
    began: Instant,
}

impl Running {
    fn view(&self) -> Value {
        json!({
            "task": self.task,
            "said": self.task.said(),
            "message": self.step.message,
            "effects": self.step.effects,
            "times": self.step.times,
            "times_said": self.step.times.map(words::times),
            "seconds": self.began.elapsed().as_secs_f64(),
        })
    }
}

impl Jobs {
    fn running(&self) -> MutexGuard<'_, Option<Running>> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What is being done, as the page is told.
    pub fn view(&self) -> Option<Value> {
        self.running().as_ref().map(Running::view)
    }

    /// Ends the task in progress, if any.
    pub fn cancel(&self, studio: &Studio) {
        if self.drop_running(&mut self.running()) {
            studio.project().end();
            studio.changed();
        }
    }

    fn drop_running(&self, running: &mut Option<Running>) -> bool {
        let Some(job) = running.take() else { return false };
        job.stop.store(true, Ordering::Relaxed);
        self.ending.fetch_add(1, Ordering::Relaxed);
        true
    }
}

/// Begins a task.
///
/// # Errors
/// Another one is in progress.
pub fn start(studio: &Arc<Studio>, task: Task) -> Result<(), Failure> {
    let mut running = studio.jobs.running();
    if let Some(job) = running.as_ref().filter(|job| !job.task.yields()) {
        return Err(Failure::bad_input(format!("the studio is busy: {}", job.task.said()))
            .with_hint("wait until it is done, or cancel it"));
    }
    studio.jobs.drop_running(&mut running);
    if studio.jobs.ending.load(Ordering::Relaxed) > ENDING {
        return Err(Failure::bad_input("what was cancelled has not ended yet")
            .with_hint("try again in a few seconds"));
    }
    {
        let mut project = studio.project();
        project.beside.failed = None;
        project.begin(&task)?;
    }
    let stop = Arc::new(AtomicBool::new(false));
    let step = Step::default();
    *running =
        Some(Running { task: task.clone(), stop: stop.clone(), step, began: Instant::now() });
    drop(running);
    studio.changed();
    let studio = studio.clone();
    std::thread::spawn(move || run(&studio, &task, &stop));
    Ok(())
}

fn run(studio: &Arc<Studio>, task: &Task, stop: &Arc<AtomicBool>) {
    let tell = |step: Step| {
        let mut running = studio.jobs.running();
        if let Some(job) = running.as_mut().filter(|job| Arc::ptr_eq(&job.stop, stop)) {
            let step = Step { message: step.message.or(job.step.message.take()), ..step };
            job.step = step;
            studio.tell(&json!({ "progress": job.view() }));
        }
    };
    let done = catch_unwind(AssertUnwindSafe(|| work::done(studio, task, stop, &tell)));
    let done = done.unwrap_or_else(|_| {
        Err(Failure::failed("the task failed inside; the models are as they were"))
    });
    // Taken in under the lock: what was cancelled meanwhile is not.
    let mut running = studio.jobs.running();
    if !running.as_ref().is_some_and(|job| Arc::ptr_eq(&job.stop, stop)) {
        studio.jobs.ending.fetch_sub(1, Ordering::Relaxed);
        return;
    }
    let taken = done.and_then(|done| done.take(studio));
    {
        let mut project = studio.project();
        project.end();
        project.beside.failed = taken.err().map(|error| failure(&error));
    }
    *running = None;
    drop(running);
    studio.changed();
}
