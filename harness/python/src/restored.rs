//! What was taken apart is put together again.

use pyo3::prelude::*;

use crate::calibrating::Calibration;
use crate::camera::Camera;
use crate::detecting::Identified;
use crate::difference::Difference;
use crate::error::{Error, input};
use crate::judging::Judgement;
use crate::measuring::Measured;
use crate::pickled::{Pickled, VERSION};
use crate::pose::Pose;
use crate::rendering::{Shot, Targets};
use crate::running::Records;

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
        Identified::CLASS => object::<Identified>(py, state),
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
