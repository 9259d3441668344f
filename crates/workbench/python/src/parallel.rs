//! Computations on all cores: a pool of threads for each process.
//!
//! A fork copies memory and no threads. The child would wait for ever for the threads of a pool
//! that its parent has made, as rayon's own is. So each process makes its own.

use std::sync::{Arc, Mutex, PoisonError};

use pyo3::exceptions::PyRuntimeError;
use pyo3::marker::Ungil;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The pool, and the process that has made it.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// Computes something in this process's pool, while other threads of Python run.
///
/// # Errors
/// `RuntimeError`: the system has no threads for the pool.
pub fn on_all_cores<T: Send + Ungil>(py: Python, compute: impl FnOnce() -> T + Send + Ungil) -> PyResult<T> {
    let pool = own_pool(py)?;
    Ok(py.detach(|| pool.install(compute)))
}

/// The pool of this process. Python's lock is held, so no thread that a fork leaves behind can hold
/// that of the pool.
fn own_pool(_: Python) -> PyResult<Arc<ThreadPool>> {
    let mut kept = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if let Some((_, pool)) = kept.as_ref().filter(|(owner, _)| *owner == process) {
        return Ok(Arc::clone(pool));
    }
    let pool = ThreadPoolBuilder::new().build();
    let pool = pool.map_err(|reason| PyRuntimeError::new_err(format!("no threads for the computation: {reason}")))?;
    let pool = Arc::new(pool);
    // The parent's pool has locks that its threads may have held: it is never dropped here.
    std::mem::forget(kept.replace((process, Arc::clone(&pool))));
    Ok(pool)
}
