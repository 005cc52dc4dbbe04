//! `render`: images whose truth is known.

use std::path::PathBuf;

use calibench_model::{NamedCamera, Start};
use calibench_run::shots::{Shot as Rendered, TrueTarget, shots};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::arrays::{NOWHERE, of_axes, of_positions, table};
use crate::camera::Camera;
use crate::error::input;
use crate::pickled::{Pickled, Reduced, reduced};
use crate::pool::released;
use crate::pose::Pose;
use crate::session::{scenario_of, with_project};

/// An image and all that is known of it: see `calibench.Shot`.
#[pyclass(frozen, get_all, module = "calibench", name = "Shot")]
pub struct Shot {
    /// The station's name.
    name: String,
    /// (rows, columns), fractions of full scale.
    image: Py<PyArray2<f32>>,
    /// The truth about every target.
    truth: Py<Targets>,
    /// Where measuring starts.
    starts: Py<Targets>,
    /// The camera; None in a flat scene.
    camera: Option<Py<Camera>>,
    /// Where it stood; None in a flat scene.
    pose: Option<Py<Pose>>,
}

#[pymethods]
impl Shot {
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!("Shot({}, {} targets)", self.name, self.truth.get().target.len())
    }
}

/// Targets in an image: see `calibench.Targets`.
#[pyclass(frozen, get_all, module = "calibench", name = "Targets")]
pub struct Targets {
    /// Names.
    pub target: Vec<String>,
    /// Kinds; None where not known.
    pub kind: Vec<Option<String>>,
    /// Positions, px; NaN where there is none.
    pub xy: Py<PyArray2<f64>>,
    /// (n, 2, 2): columns are the target's own axes in the image, px; NaN where not known.
    pub axes: Py<PyArray3<f64>>,
    /// Object coordinates; NaN in a flat scene and where not known.
    pub object: Py<PyArray2<f64>>,
    /// `visible`, `clipped`, `hidden` or `outside`; of starts all are visible.
    pub visibility: Vec<String>,
}

#[pymethods]
impl Targets {
    fn __len__(&self) -> usize {
        self.target.len()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!("Targets({})", self.target.len())
    }
}

fn truth(py: Python<'_>, targets: &[TrueTarget]) -> PyResult<Targets> {
    Ok(Targets {
        target: targets.iter().map(|target| target.id.clone()).collect(),
        kind: targets.iter().map(|target| Some(target.kind.name().to_owned())).collect(),
        xy: of_positions(py, targets.iter().map(|target| target.at.unwrap_or(NOWHERE)))?,
        axes: of_axes(py, targets.iter().map(|target| target.affine))?,
        object: table(py, &targets.iter().map(|target| target.object.map_or([f64::NAN; 3], |p| [p.x, p.y, p.z])).collect::<Vec<_>>())?,
        visibility: targets.iter().map(|target| target.visibility.name().to_owned()).collect(),
    })
}

/// Starts as targets.
pub fn starts<'s>(py: Python<'_>, all: impl Iterator<Item = (&'s str, Start)>) -> PyResult<Targets> {
    let all: Vec<_> = all.collect();
    Ok(Targets {
        target: all.iter().map(|(name, _)| (*name).to_owned()).collect(),
        kind: all.iter().map(|(_, start)| start.kind.map(|kind| kind.name().to_owned())).collect(),
        xy: of_positions(py, all.iter().map(|(_, start)| start.position))?,
        axes: of_axes(py, all.iter().map(|(_, start)| start.affine))?,
        object: table(py, &vec![[f64::NAN; 3]; all.len()])?,
        visibility: vec!["visible".to_owned(); all.len()],
    })
}

fn shot(py: Python<'_>, rendered: Rendered) -> PyResult<Shot> {
    let Rendered { name, image, targets, starts: begin, camera } = rendered;
    let shape = [image.height(), image.width()];
    let (camera, pose) = camera.unzip();
    Ok(Shot {
        name,
        image: PyArray1::from_vec(py, image.into_grey()).reshape(shape)?.unbind(),
        truth: Py::new(py, truth(py, &targets)?)?,
        starts: Py::new(py, starts(py, begin.iter().map(|(name, start)| (name.as_str(), *start)))?)?,
        camera: camera.map(|camera| Py::new(py, Camera::new(NamedCamera::new("", camera)))).transpose()?,
        pose: pose.map(|pose| Py::new(py, Pose(pose))).transpose()?,
    })
}

/// The images of one trial of a scenario, with their truth: what `calibench render` writes.
#[pyfunction]
#[pyo3(signature = (scenario, *, trial = 0, seed = None, stations = None, root = None))]
pub fn render(
    py: Python<'_>,
    scenario: &str,
    trial: u64,
    seed: Option<u64>,
    stations: Option<Vec<String>>,
    root: Option<PathBuf>,
) -> PyResult<Vec<Shot>> {
    with_project(root, |here| {
        let scenario = scenario_of(py, here, scenario)?;
        let rendered =
            released(py, || shots(&scenario, seed.unwrap_or(scenario.seed), trial, &stations.unwrap_or_default()))?.map_err(input)?;
        rendered.into_iter().map(|rendered| shot(py, rendered)).collect()
    })
}

/// All fields of a shot, in their order.
type ShotState<'py> = (String, Bound<'py, PyArray2<f32>>, Py<Targets>, Py<Targets>, Option<Py<Camera>>, Option<Py<Pose>>);

impl Pickled for Shot {
    const CLASS: &'static str = "Shot";

    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Self { name, image, truth, starts, camera, pose } = self;
        (name, image.bind(py), truth, starts, camera, pose).into_bound_py_any(py)
    }

    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (name, image, truth, starts, camera, pose): ShotState<'_> = state.extract()?;
        Ok(Self { name, image: image.unbind(), truth, starts, camera, pose })
    }
}

/// All fields of targets, in their order.
type TargetsState<'py> =
    (Vec<String>, Vec<Option<String>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray3<f64>>, Bound<'py, PyArray2<f64>>, Vec<String>);

impl Pickled for Targets {
    const CLASS: &'static str = "Targets";

    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Self { target, kind, xy, axes, object, visibility } = self;
        (target, kind, xy.bind(py), axes.bind(py), object.bind(py), visibility).into_bound_py_any(py)
    }

    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (target, kind, xy, axes, object, visibility): TargetsState<'_> = state.extract()?;
        Ok(Self { target, kind, xy: xy.unbind(), axes: axes.unbind(), object: object.unbind(), visibility })
    }
}
