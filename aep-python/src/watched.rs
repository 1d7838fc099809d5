//! Long work beside an interpreter that stays alive: the lock is free, events are heard, Ctrl-C ends the work at its next step.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// How long Ctrl-C may wait.
const PATIENCE: Duration = Duration::from_millis(50);
/// Stack of the thread that works, bytes: that of a main thread.
const STACK: usize = 8 << 20;

/// Does `work` on a thread of its own. What it sends is given to `hear`; what `hear` or Ctrl-C raises sets `stop` and is
/// returned beside the result, for which is waited all the same.
///
/// # Errors
/// The system gives no thread.
pub fn watched<E: Send, R: Send>(
    py: Python<'_>,
    stop: &AtomicBool,
    work: impl FnOnce(Sender<E>) -> R + Send,
    hear: impl Fn(Python<'_>, E) -> PyResult<()> + Sync,
) -> PyResult<(R, Option<PyErr>)> {
    py.detach(|| {
        thread::scope(|scope| {
            let (send, receive) = channel();
            let worker = thread::Builder::new().stack_size(STACK);
            let worker = worker.spawn_scoped(scope, move || {
                // Its end is the end of the work, whatever the work does with its own.
                let alive = send.clone();
                let result = work(send);
                drop(alive);
                result
            })?;
            let mut raised = None;
            loop {
                let event = match receive.recv_timeout(PATIENCE) {
                    Ok(event) => Some(event),
                    Err(RecvTimeoutError::Timeout) => None,
                    Err(RecvTimeoutError::Disconnected) => break,
                };
                let heard = Python::attach(|py| {
                    py.check_signals()?;
                    event.map_or(Ok(()), |event| hear(py, event))
                });
                if let Err(error) = heard {
                    stop.store(true, Ordering::Relaxed);
                    raised.get_or_insert(error);
                }
            }
            let result = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            Ok((result, raised))
        })
    })
}
