//! `Camera`: read, written, converted, and projected with.

use std::path::PathBuf;

use calibench_cameras::conversion::{Converted, converted};
use calibench_cameras::fit::losses;
use calibench_cameras::for_file::for_file;
use calibench_cameras::open_points::OpenPoints;
use calibench_cameras::target::{Given, goal};
use calibench_cameras::{CameraFormat, ReadOptions, format_named, read_camera_with, write_camera};
use calibench_files::OutputFile;
use calibench_images::st_map::{Overscan, Undistorted};
use calibench_model::camera::{CameraModel, Ray, Verification, fold};
use calibench_model::convert::{ConvertOptions, Method, Region, Verdict};
use calibench_model::{NamedCamera, PixelPoint};
use numpy::PyArray2;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::{NOWHERE, of_matrix, of_positions, positions, rows, table};
use crate::error::{camera as refused, doubt, input, lost};
use crate::image_size::size_of;
use crate::pickled::{Pickled, Reduced, reduced};
use crate::pool::released;
use crate::reframing::reframing;

/// A camera: see `calibench.Camera`.
#[pyclass(frozen, module = "calibench", name = "Camera")]
pub struct Camera {
    pub named: NamedCamera,
    /// The format that it was read from or converted to.
    format: Option<&'static CameraFormat>,
    /// RMS and largest residual of the fit that made it, px; `None` if none did.
    fit: Option<(f64, f64)>,
}

/// Points that a thread takes at a time.
const SHARE: usize = 4096;

/// `work` of each point, on all threads where there are many: to wake them takes longer than a few points do.
fn each<P: Sync, R: Send>(py: Python<'_>, points: &[P], work: impl Fn(&P) -> R + Send + Sync) -> PyResult<Vec<R>> {
    if points.len() <= SHARE {
        return Ok(py.detach(|| points.iter().map(work).collect()));
    }
    released(py, || points.par_iter().with_min_len(SHARE).map(work).collect())
}

impl Camera {
    /// One that no file held.
    pub fn new(named: NamedCamera) -> Self {
        Self { named, format: None, fit: None }
    }

    /// What of its convention no numbers of its tool confirm, as a warning.
    fn unverified(&self, py: Python<'_>) -> PyResult<()> {
        let Verification::Unverified(open) = self.named.camera.convention().verification else { return Ok(()) };
        doubt(py, &format!("unverified: {}: {open}", self.named.camera.convention().name))
    }
}

#[pymethods]
impl Camera {
    /// The camera of a file of any known format, found by content.
    #[staticmethod]
    #[pyo3(signature = (path, *, size = None, camera = None, format = None, fisheye = None))]
    fn read(
        py: Python<'_>,
        path: PathBuf,
        size: Option<&Bound<'_, PyAny>>,
        camera: Option<&str>,
        format: Option<&str>,
        fisheye: Option<bool>,
    ) -> PyResult<Self> {
        let all = Self::read_all(py, path.clone(), size, format, fisheye)?;
        let (count, shown) = (all.len(), path.display());
        let Some(name) = camera else {
            let first = all.into_iter().next().ok_or_else(|| refused(format!("{shown}: holds no camera")))?;
            if count > 1 {
                doubt(py, &format!("{shown}: the first of {count} cameras, `{}`; choose with camera=NAME", first.named.name))?;
            }
            return Ok(first);
        };
        let place = name.parse::<usize>().ok().and_then(|place| place.checked_sub(1));
        let by_name = all.iter().position(|one| one.named.name == name).or(place.filter(|place| *place < count));
        let found = by_name.and_then(|place| all.into_iter().nth(place));
        found.ok_or_else(|| refused(format!("{shown}: no camera is called {name}")))
    }

    /// All cameras of a file.
    #[staticmethod]
    #[pyo3(signature = (path, *, size = None, format = None, fisheye = None))]
    fn read_all(
        py: Python<'_>,
        path: PathBuf,
        size: Option<&Bound<'_, PyAny>>,
        format: Option<&str>,
        fisheye: Option<bool>,
    ) -> PyResult<Vec<Self>> {
        let from = format.map(|name| {
            format_named(name).ok_or_else(|| input(format!("format: no such format as `{name}`; `calibench list formats` lists them")))
        });
        let options = ReadOptions { size: size.map(size_of).transpose()?, fisheye, from: from.transpose()?, ..ReadOptions::default() };
        let file = released(py, || read_camera_with(&path, &options))?.map_err(refused)?;
        let format = file.format;
        let cameras = OpenPoints::default().read(file);
        let all: Vec<Self> = cameras.into_iter().map(|named| Self { named, format: Some(format), fit: None }).collect();
        if let Some(first) = all.first() {
            first.unverified(py)?;
        }
        let mut said: Vec<&String> = Vec::new();
        for note in all.iter().flat_map(|camera| &camera.named.notes) {
            if !said.contains(&note) {
                lost(py, &format!("{}: {note}", path.display()))?;
                said.push(note);
            }
        }
        Ok(all)
    }

    /// The same camera in another convention, or for another tool.
    #[pyo3(signature = (to, *, model = None, pitch = None, base = None, radius = None, rotation = false, accept = false))]
    #[expect(clippy::too_many_arguments, reason = "each is a keyword of Python's")]
    fn convert(
        &self,
        py: Python<'_>,
        to: &str,
        model: Option<&str>,
        pitch: Option<f64>,
        base: Option<f64>,
        radius: Option<f64>,
        rotation: bool,
        accept: bool,
    ) -> PyResult<Self> {
        let order = OpenPoints::default().order();
        let given = Given { source: &self.named, pitch_um: pitch, base_mm: base, order, output: None };
        let goal = goal(to, &given).map_err(refused)?;
        let region = radius.map_or(Region::Frame, |px| Region::Radius { px });
        let options = ConvertOptions { region, rotation, accept, ..ConvertOptions::default() };
        let found = released(py, || converted(&self.named, &goal, model, pitch, &options))?.map_err(refused)?;
        let Converted { camera: named, conversion, .. } = found;
        let (rms, most) = (conversion.residual.rms_px, conversion.residual.max_px);
        if conversion.method != Method::Exact && conversion.verdict != Verdict::Good {
            doubt(py, &format!("{to}: fitted with residuals of {rms:.3} px RMS, {most:.3} px at most"))?;
        }
        if let Some(fold) = fold(&conversion.camera).filter(|_| conversion.region == Region::Frame) {
            let (radius, share) = (fold.radius_px, 100.0 * fold.share);
            doubt(py, &format!("the camera folds over {radius:.1} px from the image of the axis: {share:.2} % of the frame have no ray"))?;
        }
        let mut all = [named];
        OpenPoints::default().written(goal.format, &mut all);
        let [named] = all;
        for what in losses(goal.format, &named) {
            lost(py, &format!("{to}: lost: {what}"))?;
        }
        let fit = (conversion.method != Method::Exact).then_some((rms, most));
        let made = Self { named, format: Some(goal.format), fit };
        if made.named.camera.convention() != self.named.camera.convention() {
            made.unverified(py)?;
        }
        Ok(made)
    }

    /// The same camera in other images: of a part of them, in another size, turned.
    #[pyo3(signature = (*, crop = None, size = None, scale = None, binned = None, turn = None))]
    fn reframe(
        &self,
        py: Python<'_>,
        crop: Option<[i64; 4]>,
        size: Option<&Bound<'_, PyAny>>,
        scale: Option<f64>,
        binned: Option<u32>,
        turn: Option<u16>,
    ) -> PyResult<Self> {
        let by = reframing(self.named.camera.size(), crop, size, (scale, binned), turn)?;
        let (named, dropped) = by.named(&self.named).map_err(refused)?;
        for what in dropped {
            lost(py, &format!("lost: {what}"))?;
        }
        Ok(Self { named, format: self.format, fit: None })
    }

    /// Writes a camera file: as it was converted, or in the convention `to`, or in the one that the file's ending asks for.
    #[pyo3(signature = (path, *, to = None))]
    fn write(&self, py: Python<'_>, path: PathBuf, to: Option<&str>) -> PyResult<()> {
        OutputFile::open(&path).map_err(refused)?;
        if let (Some(format), None) = (self.format, to) {
            return write_camera(&path, format, std::slice::from_ref(&self.named)).map_err(refused);
        }
        let file = for_file(&path, &self.named, to).map_err(refused)?;
        if let Some(why) = &file.instead {
            doubt(py, &format!("{}: {why}; it is written as it is, in the format of {}", path.display(), file.format.tool))?;
        }
        if let Some((to, conversion)) = &file.fitted {
            let (rms, most) = (conversion.residual.rms_px, conversion.residual.max_px);
            doubt(py, &format!("{}: converted to {to} by a fit: residuals {rms:.3} px RMS, {most:.3} px at most", path.display()))?;
        }
        for what in losses(file.format, &file.camera) {
            lost(py, &format!("{}: lost: {what}", path.display()))?;
        }
        write_camera(&path, file.format, &[file.camera]).map_err(refused)
    }

    /// Points of (n, 3) in the camera's axes (x right, y down, z forward) to pixels of (n, 2); NaN for what is not pictured.
    fn project(&self, py: Python<'_>, points: &Bound<'_, PyAny>) -> PyResult<Py<PyArray2<f64>>> {
        let points = rows::<3>(points, "points")?;
        let one = |[x, y, z]: &[f64; 3]| self.named.camera.project(Ray { x: *x, y: -y, z: -z }).unwrap_or(NOWHERE);
        of_positions(py, each(py, &points, one)?)
    }

    /// Pixels of (n, 2) to rays of (n, 3) of length 1 in the camera's axes; NaN for what no ray comes to.
    fn unproject(&self, py: Python<'_>, px: &Bound<'_, PyAny>) -> PyResult<Py<PyArray2<f64>>> {
        let places = positions(px, "px")?;
        let one = |at: &PixelPoint| {
            let Ok(Ray { x, y, z }) = self.named.camera.unproject(*at) else { return [f64::NAN; 3] };
            let length = (x * x + y * y + z * z).sqrt();
            [x / length, -y / length, -z / length]
        };
        table(py, &each(py, &places, one)?)
    }

    /// Pixels of (n, 2) to where they would be without distortion, px, with the same focal lengths and principal point; NaN for what has no place there.
    fn undistort(&self, py: Python<'_>, px: &Bound<'_, PyAny>) -> PyResult<Py<PyArray2<f64>>> {
        let places = positions(px, "px")?;
        let plain = Undistorted::of(&self.named.camera, Overscan::Percent(0.0)).map_err(refused)?;
        let one = |at: &PixelPoint| self.named.camera.unproject(*at).ok().and_then(|ray| plain.image(ray)).unwrap_or(NOWHERE);
        of_positions(py, each(py, &places, one)?)
    }

    /// Columns and rows, px.
    #[getter]
    fn size(&self) -> (u32, u32) {
        let size = self.named.camera.size();
        (size.width, size.height)
    }

    /// The name of its convention.
    #[getter]
    fn model(&self) -> &'static str {
        self.named.camera.convention().name
    }

    /// Its name in the file; empty where the format has none.
    #[getter]
    fn name(&self) -> &str {
        &self.named.name
    }

    /// Pixel pitch, um, if known.
    #[getter]
    fn pitch(&self) -> Option<f64> {
        self.named.pitch_um
    }

    /// The parameters by their names, in the convention's units.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, pyo3::types::PyDict>> {
        let all = pyo3::types::PyDict::new(py);
        self.named.camera.parameters().iter().try_for_each(|parameter| all.set_item(parameter.name, parameter.value))?;
        Ok(all)
    }

    /// The units of the parameters; empty for numbers.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, pyo3::types::PyDict>> {
        let all = pyo3::types::PyDict::new(py);
        self.named.camera.parameters().iter().try_for_each(|parameter| all.set_item(parameter.name, parameter.unit))?;
        Ok(all)
    }

    /// The covariance of all parameters in their order, zero for those that were held; None where none is stated.
    #[getter]
    fn covariance(&self, py: Python<'_>) -> PyResult<Option<Py<PyArray2<f64>>>> {
        let Some(stated) = &self.named.covariance else { return Ok(None) };
        let whole = stated.whole(&self.named.camera).map_err(refused)?;
        of_matrix(py, &whole).map(Some)
    }

    /// RMS and largest residual of the fit that made it, px; None if it is as it was read, or exact.
    #[getter]
    fn fit(&self) -> Option<(f64, f64)> {
        self.fit
    }

    /// What is to be known of how it was read.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.named.notes.clone()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        let (size, parameters) = (self.named.camera.size(), self.named.camera.parameters());
        let parameters: Vec<String> = parameters.iter().map(|p| format!("{}={}", p.name, p.value)).collect();
        format!("Camera({}, {} x {} px, {})", self.model(), size.width, size.height, parameters.join(", "))
    }
}

/// What its file or its calibration said of it, its format, the residuals of its fit.
type State = (String, Option<String>, Option<(f64, f64)>);

impl Pickled for Camera {
    const CLASS: &'static str = "Camera";

    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let named = serde_json::to_string(&self.named).map_err(refused)?;
        let state: State = (named, self.format.map(|format| format.name.to_owned()), self.fit);
        state.into_bound_py_any(py)
    }

    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (named, format, fit): State = state.extract()?;
        let format = format.map(|name| format_named(&name).ok_or_else(|| refused(format!("format: no such format as `{name}`"))));
        Ok(Self { named: serde_json::from_str(&named).map_err(refused)?, format: format.transpose()?, fit })
    }
}
