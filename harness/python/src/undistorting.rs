//! `undistort`: pictures and points as another camera would have them.

use calibench_model::{NamedCamera, PixelPoint};
use calibench_undistort::{Frame, Kernel, Level, Map, Picture, Target, View, framed, resample};
use numpy::{Element, IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyList, PySequence, PyTuple};

use crate::arrays::{of_positions, positions};
use crate::camera::Camera;
use crate::error::input;
use crate::pool::released;

/// What a picture may be.
const EXPECTED: &str =
    "expected an array (rows, columns) or (rows, columns, channels) of uint8, uint16 or float32, with 1 to 4 channels; or a list of such";

/// The views of what is given and of what is made.
fn views(camera: &Camera, to: &Bound<'_, PyAny>, frame: &str, scale: f64, redistort: bool) -> PyResult<(View, View)> {
    let own = View::of(&camera.named);
    let new = if let Ok(other) = to.cast::<Camera>() {
        if frame != "keep" || scale != 1.0 {
            return Err(input("to: a camera has its own frame; expected frame=\"keep\" and scale=1"));
        }
        View::of(&other.get().named)
    } else {
        let target = match to.extract::<String>().as_deref() {
            Ok("pinhole") => Target::Pinhole,
            Ok("equirectangular") => Target::Equirectangular,
            _ => return Err(input(format!("to: found {to}; expected \"pinhole\", \"equirectangular\" or a Camera"))),
        };
        let frame = match frame {
            "keep" => Frame::Keep,
            "all" => Frame::All,
            "crop" => Frame::Crop,
            other => return Err(input(format!("frame: found {other:?}; expected \"keep\", \"all\" or \"crop\""))),
        };
        if !(scale.is_finite() && scale > 0.0) {
            return Err(input(format!("scale: found {scale}; expected a positive number")));
        }
        framed(&own, target, frame, scale).map_err(input)?
    };
    Ok(if redistort { (new, own) } else { (own, new) })
}

/// Pictures as another camera would have taken them: as `calibench undistort` makes them.
#[pyfunction]
#[pyo3(signature = (picture, camera, *, to = None, frame = "keep", scale = 1.0, kernel = "cubic", redistort = false))]
#[expect(clippy::too_many_arguments, reason = "those of Python's function")]
pub fn undistort<'py>(
    py: Python<'py>,
    picture: &Bound<'py, PyAny>,
    camera: &Camera,
    to: Option<Bound<'py, PyAny>>,
    frame: &str,
    scale: f64,
    kernel: &str,
    redistort: bool,
) -> PyResult<Bound<'py, PyTuple>> {
    let kernel: Kernel = kernel.parse().map_err(|error| input(format!("kernel: {error}")))?;
    let to = to.map_or_else(|| "pinhole".into_bound_py_any(py), Ok)?;
    let (from, made) = views(camera, &to, frame, scale, redistort)?;
    // What is made has the camera of a file, or one of its own.
    let of_file = if redistort { Some(camera.named.clone()) } else { to.cast::<Camera>().ok().map(|other| other.get().named.clone()) };
    let map = released(py, || Map::between(&from, &made))?;
    if map.covered() == 0 {
        return Err(input(calibench_undistort::FrameError::Nothing));
    }
    let is_one = picture.cast::<PyUntypedArray>().is_ok();
    let pictures = if is_one {
        one(py, picture, &map, kernel)?
    } else {
        let Ok(all) = picture.cast::<PySequence>() else {
            return Err(input(format!("picture: found {}; {EXPECTED}", picture.get_type().name()?)));
        };
        let made = (0..all.len()?).map(|i| one(py, &all.get_item(i)?, &map, kernel)).collect::<PyResult<Vec<_>>>()?;
        PyList::new(py, made)?.into_any()
    };
    let (width, height) = (map.size().width as usize, map.size().height as usize);
    let mask: Vec<bool> = released(py, || map.mask(0..height))?.into_iter().map(|level| level > 0).collect();
    let mask = mask.into_pyarray(py).reshape([height, width])?;
    let new = match (made, of_file) {
        (View::Splined(_), Some(named)) => Camera::new(named).into_bound_py_any(py)?,
        (View::Camera(camera), _) => Camera::new(NamedCamera::new("", camera)).into_bound_py_any(py)?,
        (View::Splined(_) | View::Equirectangular(_), _) => py.None().into_bound(py),
    };
    PyTuple::new(py, [pictures, new, mask.into_any()])
}

/// One picture through a map.
fn one<'py>(py: Python<'py>, picture: &Bound<'py, PyAny>, map: &Map, kernel: Kernel) -> PyResult<Bound<'py, PyAny>> {
    if let Ok(levels) = picture.extract::<PyReadonlyArrayDyn<'py, u8>>() {
        return of_levels(py, &levels, map, kernel);
    }
    if let Ok(levels) = picture.extract::<PyReadonlyArrayDyn<'py, u16>>() {
        return of_levels(py, &levels, map, kernel);
    }
    if let Ok(levels) = picture.extract::<PyReadonlyArrayDyn<'py, f32>>() {
        return of_levels(py, &levels, map, kernel);
    }
    let found = match picture.cast::<PyUntypedArray>() {
        Ok(array) => format!("an array of {}", array.dtype()),
        Err(_) => format!("{}", picture.get_type().name()?),
    };
    Err(input(format!("picture: found {found}; {EXPECTED}")))
}

fn of_levels<'py, T: Level + Element>(
    py: Python<'py>,
    levels: &PyReadonlyArrayDyn<'py, T>,
    map: &Map,
    kernel: Kernel,
) -> PyResult<Bound<'py, PyAny>> {
    let shape = levels.shape().to_vec();
    let (height, width, channels) = match shape[..] {
        [height, width] => (height, width, 1),
        [height, width, channels @ 1..=4] => (height, width, channels),
        _ => return Err(input(format!("picture: found an array of shape {shape:?}; {EXPECTED}"))),
    };
    let size = map.source();
    if (width, height) != (size.width as usize, size.height as usize) {
        return Err(input(format!("picture: has {width} x {height} px, expected {} x {} px of the camera", size.width, size.height)));
    }
    let own: Vec<T>;
    let all = match levels.as_slice() {
        Ok(all) => all,
        Err(_) => {
            own = levels.as_array().iter().copied().collect();
            &own
        }
    };
    let (columns, rows) = (map.size().width as usize, map.size().height as usize);
    let mut made = vec![T::default(); columns * rows * channels];
    let picture = Picture::new(size, channels, 0, all).map_err(input)?;
    released(py, || resample(map, kernel, &picture, 0..rows, &mut made))?.map_err(input)?;
    let made = made.into_pyarray(py);
    Ok(if shape.len() == 2 { made.reshape([rows, columns])?.into_any() } else { made.reshape([rows, columns, channels])?.into_any() })
}

/// Points of pictures where `undistort` puts them, or back with `redistort`.
#[pyfunction]
#[pyo3(signature = (points, camera, *, to = None, frame = "keep", scale = 1.0, redistort = false))]
pub fn undistort_points(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    camera: &Camera,
    to: Option<Bound<'_, PyAny>>,
    frame: &str,
    scale: f64,
    redistort: bool,
) -> PyResult<Py<PyArray2<f64>>> {
    let to = to.map_or_else(|| "pinhole".into_bound_py_any(py), Ok)?;
    let (from, made) = views(camera, &to, frame, scale, redistort)?;
    let points = positions(points, "points")?;
    let nowhere = PixelPoint::new(f64::NAN, f64::NAN);
    let moved = released(py, || points.iter().map(|at| from.place_in(&made, *at).unwrap_or(nowhere)).collect::<Vec<_>>())?;
    of_positions(py, moved)
}
