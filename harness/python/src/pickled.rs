//! Results taken apart: for `pickle`, `copy`, and the processes of a pool.

use pyo3::PyClass;
use pyo3::prelude::*;

/// A class of the package whose objects are all that their state says, to the last bit.
pub trait Pickled: PyClass + Into<PyClassInitializer<Self>> {
    /// What it is called in Python.
    const CLASS: &'static str;

    /// All of an object, of Python's own types, arrays and other classes that are pickled.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>>;

    /// The object.
    ///
    /// # Errors
    /// Another state than [`Self::state`] makes.
    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self>;
}

/// What `__reduce__` answers: the function that puts an object together, and what it is given.
pub type Reduced<'py> = (Bound<'py, PyAny>, (&'static str, &'static str, Bound<'py, PyAny>));

/// The version by which states are written and read.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// `__reduce__` of an object.
pub fn reduced<'py, T: Pickled>(py: Python<'py>, object: &T) -> PyResult<Reduced<'py>> {
    Ok((py.import("calibench._calibench")?.getattr("restored")?, (T::CLASS, VERSION, object.state(py)?)))
}
