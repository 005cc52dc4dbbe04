//! Results taken apart and put together again: for `pickle`, `copy`, and the processes of a pool.

use pyo3::PyClass;
use pyo3::prelude::*;

use crate::calibrating::Calibration;
use crate::camera::Camera;
use crate::difference::Difference;
use crate::error::{Error, input};
use crate::judging::Judgement;
use crate::measuring::Measured;
use crate::pose::Pose;
use crate::rendering::{Shot, Targets};
use crate::running::Records;

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
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// `__reduce__` of an object.
pub fn reduced<'py, T: Pickled>(py: Python<'py>, object: &T) -> PyResult<Reduced<'py>> {
    Ok((py.import("calibench._calibench")?.getattr("restored")?, (T::CLASS, VERSION, object.state(py)?)))
}

/// The object of `class` that was pickled as `state`: `pickle` calls it.
#[pyfunction]
#[pyo3(signature = (class_, version, state))]
pub fn restored(py: Python<'_>, class_: &str, version: &str, state: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
    if version != VERSION {
        return Err(input(format!("pickled by calibench {version}, and this is {VERSION}; make it anew, or pickle its arrays")));
    }
    match class_ {
        Calibration::CLASS => object::<Calibration>(py, state),
        Camera::CLASS => object::<Camera>(py, state),
        Difference::CLASS => object::<Difference>(py, state),
        Judgement::CLASS => object::<Judgement>(py, state),
        Measured::CLASS => object::<Measured>(py, state),
        Pose::CLASS => object::<Pose>(py, state),
        Records::CLASS => object::<Records>(py, state),
        Shot::CLASS => object::<Shot>(py, state),
        Targets::CLASS => object::<Targets>(py, state),
        other => Err(input(format!("`{other}` is no class of calibench that is pickled"))),
    }
}

fn object<T: Pickled>(py: Python<'_>, state: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
    let wrong = |error| input(format!("{}: its state is not what calibench pickles: {error}", T::CLASS));
    let object = T::of(state).map_err(|error| if error.is_instance_of::<Error>(py) { error } else { wrong(error) })?;
    Ok(Py::new(py, object)?.into_any())
}
