//! Long work that Ctrl-C ends.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use calibench_model::stop::is_end;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::input;
use crate::pool::{all_threads, released, threads_of_main};

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
    watched(py, &pool, stop, work)
}

/// Does `work` on all threads; called by Python's main thread it ends at its next [`point`](calibench_model::stop::point) once Python was interrupted, and leaves
/// nothing.
///
/// # Errors
/// The interruption, once `work` has ended.
pub fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    if !is_main_thread(py)? {
        return released(py, work);
    }
    let (pool, stop) = threads_of_main()?;
    stop.store(false, Ordering::Relaxed);
    watched(py, &pool, stop, || Ok(work()))
}

/// Signals are told to the main thread alone.
fn is_main_thread(py: Python<'_>) -> PyResult<bool> {
    let threading = py.import("threading")?;
    Ok(threading.call_method0("current_thread")?.is(&threading.call_method0("main_thread")?))
}

fn watched<T: Send>(py: Python<'_>, pool: &ThreadPool, stop: &AtomicBool, work: impl FnOnce() -> PyResult<T> + Send) -> PyResult<T> {
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
        // A handler of signals that measured itself was interrupted.
        (None, Err(end)) if is_end(&*end) => Err(PyKeyboardInterrupt::new_err(())),
        (None, Err(_)) => Err(PyRuntimeError::new_err("calibench failed unexpectedly: this is a mistake of its own; please report it")),
    }
}
