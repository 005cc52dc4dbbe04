//! `task`: what something costs that a camera is to measure.

use std::path::PathBuf;

use calibench_files::bounded;
use calibench_model::{ControlRow, NamedCamera};
use calibench_project::ProjectError;
use calibench_report::calibration::{CAMERAS_FILE, CalibratedCamera, CalibratedCameras};
use calibench_report::json::TaskAnswer;
use calibench_report::task::doubts;
use calibench_task::{Budget, KnownCamera, map, parse};
use pyo3::prelude::*;

use crate::answered::as_dict;
use crate::arrays::rows;
use crate::camera::Camera;
use crate::error::{doubt, input, project};
use crate::pool::released;

/// A camera, what halves show of it, and what is in doubt of its calibration.
type Known = (NamedCamera, Option<f64>, Vec<String>);

/// What a task costs: as `calibench task` does.
#[pyfunction]
#[pyo3(signature = (task, camera = None, *, calibration = None, camera_name = None, halves = None, control = None, slices = None))]
#[expect(clippy::too_many_arguments, reason = "those of Python's function")]
pub fn task<'py>(
    py: Python<'py>,
    task: &str,
    camera: Option<&Camera>,
    calibration: Option<PathBuf>,
    camera_name: Option<&str>,
    halves: Option<f64>,
    control: Option<&Bound<'py, PyAny>>,
    slices: Option<Vec<f64>>,
) -> PyResult<Bound<'py, PyAny>> {
    let parsed = parse("task", task).map_err(|problems| project(ProjectError::Problems(problems)))?;
    if halves.is_some_and(|times| !(times.is_finite() && times > 0.0)) {
        return Err(input("halves: expected a number above 0"));
    }
    let slices = slices.unwrap_or_default();
    if slices.iter().any(|offset| !offset.is_finite()) {
        return Err(input("slices: expected finite numbers"));
    }
    let (named, by_images, before) = match (camera, calibration) {
        (Some(camera), None) => match camera.named.doubt() {
            Some(doubt) => return Err(input(doubt)),
            None => (camera.named.clone(), None, Vec::new()),
        },
        (None, Some(folder)) => of_calibration(folder, camera_name)?,
        _ => return Err(input("expected either a camera, or calibration=FOLDER")),
    };
    let control = control.map(control_rows).transpose()?;
    let known = KnownCamera { halves: halves.or(by_images), ..KnownCamera::of(&named) };
    let (budget, maps) = released(py, || {
        let budget = Budget::of(&parsed, &known, control.as_deref())?;
        let maps = slices.iter().map(|offset| map(&parsed, &known, control.as_deref(), *offset)).collect::<Result<Vec<_>, _>>()?;
        Ok::<_, calibench_task::TaskError>((budget, maps))
    })?
    .map_err(input)?;
    let doubts = doubts(&budget, known.covariance.is_some(), &before);
    doubts.iter().try_for_each(|words| doubt(py, words))?;
    as_dict(py, &TaskAnswer::new(&parsed, &budget, doubts, known.halves, &maps))
}

fn of_calibration(folder: PathBuf, name: Option<&str>) -> PyResult<Known> {
    let file = folder.join(CAMERAS_FILE);
    let refused = |why: String| input(format!("{}: {why}", file.display()));
    let text = bounded::text(&file).map_err(|error| refused(error.to_string()))?;
    let found = CalibratedCameras::parse(&text).map_err(|error| refused(error.to_string()))?;
    let chosen: &CalibratedCamera = found.choose(name).map_err(refused)?;
    Ok((chosen.named.clone(), chosen.halves(), found.doubts.clone()))
}

/// Control of (n, 3), or of (n, 6) with standard deviations.
fn control_rows(control: &Bound<'_, PyAny>) -> PyResult<Vec<ControlRow>> {
    let named = |place: usize, at: [f64; 3], sigmas| ControlRow { sigmas, ..ControlRow::new(place.to_string(), at) };
    let found: Vec<ControlRow> = match rows::<6>(control, "control") {
        Ok(rows) => {
            let rows = rows.into_iter().enumerate();
            rows.map(|(place, [x, y, z, sx, sy, sz])| named(place, [x, y, z], Some([sx, sy, sz]))).collect()
        }
        Err(_) => rows::<3>(control, "control")?.into_iter().enumerate().map(|(place, at)| named(place, at, None)).collect(),
    };
    let is_right = |row: &ControlRow| {
        let sigmas = row.sigmas.unwrap_or_default();
        row.position.iter().chain(&sigmas).all(|number| number.is_finite()) && sigmas.iter().all(|sigma| *sigma >= 0.0)
    };
    if let Some(place) = found.iter().position(|row| !is_right(row)) {
        return Err(input(format!("control: row {place}: expected finite X, Y, Z, and standard deviations of at least 0")));
    }
    Ok(found)
}
