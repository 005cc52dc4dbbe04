//! Long work that Ctrl-C ends.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use calibench_model::stop::is_end;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use rayon::ThreadPool;

use crate::pool::{all_threads, heeding, released, threads_of_main};

/// How often Python is asked whether it was interrupted.
const ASKED: Duration = Duration::from_millis(50);

/// Threads for long work, and the flag at which it ends.
pub struct Stoppable {
    pool: Arc<ThreadPool>,
    stop: Arc<AtomicBool>,
}

impl Stoppable {
    /// `threads` of them, all cores where none are given. Work on them ends at its next [`point`](calibench_model::stop::point) once the flag is up.
    ///
    /// # Errors
    /// A system that starts no threads.
    pub fn on(py: Python<'_>, threads: Option<usize>) -> PyResult<Self> {
        if let Some(threads) = threads {
            let stop = Arc::<AtomicBool>::default();
            return Ok(Self { pool: Arc::new(heeding(threads, &stop)?), stop });
        }
        if !is_main_thread(py)? {
            return Ok(Self { pool: all_threads()?, stop: Arc::default() });
        }
        let (pool, stop) = threads_of_main()?;
        stop.store(false, Ordering::Relaxed);
        Ok(Self { pool, stop: stop.clone() })
    }

    /// The flag, for work that can also end in good order.
    pub fn flag(&self) -> &AtomicBool {
        &self.stop
    }

    /// Does `work` while Python looks out for signals.
    ///
    /// # Errors
    /// What `work` refuses; the interruption, once `work` has ended.
    pub fn run<T: Send>(&self, py: Python<'_>, work: impl FnOnce() -> PyResult<T> + Send) -> PyResult<T> {
        watched(py, &self.pool, &self.stop, work)
    }
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
    Stoppable::on(py, None)?.run(py, || Ok(work()))
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
