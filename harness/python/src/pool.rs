//! The threads of this process.

use std::process;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use calibench_model::stop::heed;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::input;

/// Threads, and the process whose they are.
type Threads = Mutex<Option<(u32, Arc<ThreadPool>)>>;

static THREADS: Threads = Mutex::new(None);

/// Those of Python's main thread, which alone is told of Ctrl-C: what others do on theirs does not end with it.
static OF_MAIN: Threads = Mutex::new(None);

/// Whether what the main thread does is to end.
static STOP: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// A process that was forked has none of its parent's threads: it gets its own.
///
/// # Errors
/// A system that starts no threads.
pub fn all_threads() -> PyResult<Arc<ThreadPool>> {
    own(&THREADS, || ())
}

/// The threads of the main thread, and the flag at which they end what they do.
///
/// # Errors
/// A system that starts no threads.
pub fn threads_of_main() -> PyResult<(Arc<ThreadPool>, &'static Arc<AtomicBool>)> {
    Ok((own(&OF_MAIN, || heed(STOP.clone()))?, &STOP))
}

/// So many threads of their own, which end what they do once `stop` is up.
///
/// # Errors
/// A system that starts no threads.
pub fn heeding(threads: usize, stop: &Arc<AtomicBool>) -> PyResult<ThreadPool> {
    let stop = stop.clone();
    ThreadPoolBuilder::new().num_threads(threads).start_handler(move |_| heed(stop.clone())).build().map_err(input)
}

/// The threads that are kept, if they are this process's, or new ones, each of which begins with `first`.
fn own(threads: &Threads, first: fn()) -> PyResult<Arc<ThreadPool>> {
    let mut threads = threads.lock().unwrap_or_else(PoisonError::into_inner);
    let own = process::id();
    if let Some((_, pool)) = threads.as_ref().filter(|(of, _)| *of == own) {
        return Ok(pool.clone());
    }
    let pool = Arc::new(ThreadPoolBuilder::new().start_handler(move |_| first()).build().map_err(input)?);
    // The parent's are not ended here: they never began.
    if let Some((_, parents)) = threads.replace((own, pool.clone())) {
        std::mem::forget(parents);
    }
    Ok(pool)
}

/// Does `work` on all threads, while others of Python's may run.
///
/// # Errors
/// A system that starts no threads.
pub fn released<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let pool = all_threads()?;
    Ok(py.detach(|| pool.install(work)))
}
