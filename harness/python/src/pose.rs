//! `Pose`: where a camera stands.

use calibench_model::Pose as Exterior;
use nalgebra::{DMatrix, Matrix3, Point3};
use numpy::{PyArray1, PyArray2};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::arrays::of_matrix;
use crate::pickled::{Pickled, Reduced, reduced};

/// Exterior orientation: see `calibench.Pose`.
#[pyclass(frozen, module = "calibench", name = "Pose")]
pub struct Pose(pub Exterior);

impl Pose {
    /// From object to the camera's axes as Python has them: x right, y down, z forward.
    fn matrix(&self) -> Matrix3<f64> {
        Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, -1.0, -1.0)) * self.0.rotation
    }
}

#[pymethods]
impl Pose {
    /// (3, 3): from object axes to the camera's, x right, y down, z forward.
    #[getter(R)]
    fn rotation(&self, py: Python<'_>) -> PyResult<Py<PyArray2<f64>>> {
        of_matrix(py, &DMatrix::from_iterator(3, 3, self.matrix().iter().copied()))
    }

    /// (3,): `X_camera = R X + t`, object units.
    #[getter]
    fn t(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        let t = -(self.matrix() * self.0.centre.coords);
        PyArray1::from_slice(py, t.as_slice()).unbind()
    }

    /// (3,): the projection centre, object units.
    #[getter]
    fn centre(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        PyArray1::from_slice(py, self.0.centre.coords.as_slice()).unbind()
    }

    /// omega, phi, kappa, degrees: of the photogrammetric camera, which looks along its -z.
    #[getter]
    fn angles(&self) -> (f64, f64, f64) {
        let [omega, phi, kappa] = self.0.angles().map(f64::to_degrees);
        (omega, phi, kappa)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        let (c, (omega, phi, kappa)) = (self.0.centre, self.angles());
        format!("Pose(centre=({}, {}, {}), omega={omega:.6}, phi={phi:.6}, kappa={kappa:.6} degrees)", c.x, c.y, c.z)
    }
}

/// Nine numbers of the rotation, column by column, and the projection centre.
type State = ([f64; 9], [f64; 3]);

impl Pickled for Pose {
    const CLASS: &'static str = "Pose";

    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Exterior { rotation, centre } = &self.0;
        let state: State = (std::array::from_fn(|i| rotation[i]), centre.coords.into());
        state.into_bound_py_any(py)
    }

    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (rotation, centre): State = state.extract()?;
        Ok(Self(Exterior { rotation: Matrix3::from_column_slice(&rotation), centre: Point3::from(centre) }))
    }
}
