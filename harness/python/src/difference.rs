//! `diff`: how far two cameras differ.

use calibench_model::camera::CameraModel;
use calibench_model::convert::{DifferenceOptions, Region, difference, difference_at};
use numpy::PyArray2;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::arrays::{positions, table};
use crate::camera::Camera;
use crate::error::{camera as refused, input};
use crate::pickled::{Pickled, Reduced, reduced};
use crate::pool::released;
use crate::reframing::of_images;

/// How far two cameras differ over the frame: see `calibench.Difference`.
#[pyclass(frozen, get_all, module = "calibench", name = "Difference")]
pub struct Difference {
    /// RMS over the frame, px.
    rms_px: f64,
    /// The largest, px.
    max_px: f64,
    /// Where that is, px.
    max_at: (f64, f64),
    /// The best rotation, which was taken out, degrees.
    rotation_deg: f64,
    /// RMS that remains after the best change of principal distance and point, px; None where that was not asked for.
    compensated_rms_px: Option<f64>,
    /// Share of the region that one of the cameras does not picture.
    not_comparable: f64,
    /// The differences on a grid over the frame: x, y, dx, dy, px.
    vectors: Py<PyArray2<f64>>,
}

#[pymethods]
impl Difference {
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "Difference({:.6} px RMS, {:.6} px at most, after a rotation of {:.6} degrees)",
            self.rms_px, self.max_px, self.rotation_deg
        )
    }
}

/// How far two cameras differ, after the best rotation: as `calibench diff` says.
#[pyfunction]
#[pyo3(signature = (first, second, *, rotation = true, radius = None, points = None))]
pub fn diff(
    py: Python<'_>,
    first: &Camera,
    second: &Camera,
    rotation: bool,
    radius: Option<f64>,
    points: Option<&Bound<'_, PyAny>>,
) -> PyResult<Difference> {
    let (a, b) = (&first.named.camera, &second.named.camera);
    for named in [&first.named, &second.named] {
        if let Some(doubt) = named.doubt() {
            return Err(refused(doubt));
        }
    }
    of_images(&second.named, a.size(), "the images of the two cameras differ in size: the second")?;
    if points.is_some() && !rotation {
        return Err(input("points: the rotation is the best at these; with rotation=False there is none"));
    }
    let region = radius.map_or(Region::Frame, |px| Region::Radius { px });
    let options =
        DifferenceOptions { region, rotation, compensation: true, finer: DifferenceOptions::FINE, ..DifferenceOptions::default() };
    let places = points.map(|points| positions(points, "points")).transpose()?;
    let found = released(py, || match &places {
        Some(places) => difference_at(a, b, places, &options),
        None => difference(a, b, &options),
    })?;
    let found = found.map_err(refused)?;
    Ok(Difference {
        rms_px: found.spread.rms_px,
        max_px: found.spread.max_px,
        max_at: (found.spread.at.x, found.spread.at.y),
        rotation_deg: found.rotation.angle().to_degrees(),
        compensated_rms_px: found.compensated.as_ref().map(|compensated| compensated.spread.rms_px),
        not_comparable: found.not_comparable,
        vectors: table(py, &found.vectors.iter().map(|v| [v.at.x, v.at.y, v.dx, v.dy]).collect::<Vec<_>>())?,
    })
}

/// All fields, in their order.
type State<'py> = (f64, f64, (f64, f64), f64, Option<f64>, f64, Bound<'py, PyArray2<f64>>);

impl Pickled for Difference {
    const CLASS: &'static str = "Difference";

    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Self { rms_px, max_px, max_at, rotation_deg, compensated_rms_px, not_comparable, vectors } = self;
        (rms_px, max_px, *max_at, rotation_deg, *compensated_rms_px, not_comparable, vectors.bind(py)).into_bound_py_any(py)
    }

    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (rms_px, max_px, max_at, rotation_deg, compensated_rms_px, not_comparable, vectors): State<'_> = state.extract()?;
        Ok(Self { rms_px, max_px, max_at, rotation_deg, compensated_rms_px, not_comparable, vectors: vectors.unbind() })
    }
}
