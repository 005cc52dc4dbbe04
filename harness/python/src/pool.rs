//! The threads of this process.

use std::process;
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::input;

/// The threads, and the process whose they are.
static THREADS: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// A process that was forked has none of its parent's threads: it gets its own.
///
/// # Errors
/// A system that starts no threads.
pub fn all_threads() -> PyResult<Arc<ThreadPool>> {
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    let own = process::id();
    if let Some((_, pool)) = threads.as_ref().filter(|(of, _)| *of == own) {
        return Ok(pool.clone());
    }
    let pool = Arc::new(ThreadPoolBuilder::new().build().map_err(input)?);
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
