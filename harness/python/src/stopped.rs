//! Long work that Ctrl-C ends.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;

use crate::error::input;
use crate::pool::all_threads;

/// How often Python is asked whether it was interrupted.
const ASKED: Duration = Duration::from_millis(50);

/// Does `work` on `threads` threads (all cores where none are given) while Python looks out for signals; `work` is told by the flag that it is to end.
///
/// # Errors
/// What `work` refuses; the interruption, once `work` has ended.
pub fn stoppable<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    stop: &AtomicBool,
    work: impl FnOnce() -> PyResult<T> + Send,
) -> PyResult<T> {
    let pool = match threads {
        Some(threads) => Arc::new(ThreadPoolBuilder::new().num_threads(threads).build().map_err(input)?),
        None => all_threads()?,
    };
    let (caller, mut interrupted) = (thread::current(), None);
    let result = thread::scope(|scope| {
        let worker = scope.spawn(move || {
            let result = pool.install(work);
            caller.unpark();
            result
        });
        while interrupted.is_none() && !worker.is_finished() {
            py.detach(|| thread::park_timeout(ASKED));
            if let Err(signal) = py.check_signals() {
                stop.store(true, Ordering::Relaxed);
                interrupted = Some(signal);
            }
        }
        py.detach(|| worker.join())
    });
    match (interrupted, result) {
        (Some(signal), _) => Err(signal),
        (None, Ok(result)) => result,
        (None, Err(_)) => Err(PyRuntimeError::new_err("calibench failed unexpectedly: this is a mistake of its own; please report it")),
    }
}
