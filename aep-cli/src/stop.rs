//! Ctrl-C: the first one asks for an end after the present step, the second one ends at once.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::INTERRUPTED;

static STOP: AtomicBool = AtomicBool::new(false);

/// The flag, watched from now on.
pub fn flag() -> &'static AtomicBool {
    // A second call fails because the first one has done it already.
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
        eprintln!("\nstopping after this step; what was found is kept (Ctrl-C again ends at once)");
    });
    &STOP
}
