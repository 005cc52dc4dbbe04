//! `calibrate`: a camera from measured points.

use std::collections::HashMap;
use std::path::PathBuf;

use calibench_adjust::Use;
use calibench_calibrate::{
    BoardShape, Calibration as Solved, CalibrationError as Unsolved, Doubt, MOST_TRIED, Optics, Settings, StatedBoard, Suspected,
    calibrate as solve, prepare, suspected,
};
use calibench_model::NamedCamera;
use calibench_model::Pose as Exterior;
use calibench_report::calibration::{summary, warnings};
use nalgebra::DMatrix;
use numpy::PyArray2;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{matrix, of_matrix, rows, table};
use crate::asking::{gross, lens_and_board};
use crate::boards::{Board, save};
use crate::camera::Camera;
use crate::error::{CalibrationError, doubt, in_python, input};
use crate::image_size::size_of;
use crate::pickled::{Pickled, Reduced, reduced};
use crate::points::{image_names, points};
use crate::pose::Pose;
use crate::reframing::of_images;
use crate::stopped::interruptible;

/// A calibrated camera and its quality: see `calibench.Calibration`.
#[pyclass(frozen, module = "calibench", name = "Calibration")]
pub struct Calibration {
    done: Done,
    camera: Py<Camera>,
}

/// What is kept of a solution.
struct Done {
    /// The parameters that were solved for.
    solved: Vec<String>,
    covariance: DMatrix<f64>,
    images: Vec<String>,
    poses: Vec<Exterior>,
    /// By image given: v of x and y in the order of the board, px; NaN where there is none.
    residuals: Vec<Vec<[f64; 2]>>,
    /// Of the same points: whether they took part.
    used: Vec<Vec<bool>>,
    sigma0: Option<f64>,
    rms_px: f64,
    doubts: Vec<Doubted>,
    /// Word, what it may be, px RMS then.
    suspected: Vec<Suspect>,
    warnings: Vec<String>,
    summary: String,
    /// Image, number, value, standard deviation.
    per_image: Vec<(String, String, f64, f64)>,
}

/// Subject, probability of chance, by how many standard deviations the camera moves, in words.
type Doubted = (String, Option<f64>, Option<f64>, String);

type Suspect = (String, String, Option<f64>);

#[pymethods]
impl Calibration {
    /// The camera, with its covariance.
    #[getter]
    fn camera(&self, py: Python<'_>) -> Py<Camera> {
        self.camera.clone_ref(py)
    }

    /// Standard deviations of the parameters that were solved for, in their units.
    #[getter]
    fn sigma<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        let sigma = |i: usize| self.done.covariance[(i, i)].sqrt();
        self.done.solved.iter().enumerate().try_for_each(|(i, name)| all.set_item(name, sigma(i)))?;
        Ok(all)
    }

    /// Names of the parameters that were solved for: rows and columns of `covariance`.
    #[getter]
    fn solved(&self) -> Vec<String> {
        self.done.solved.clone()
    }

    /// Covariance of these parameters, in their units.
    #[getter]
    fn covariance(&self, py: Python<'_>) -> PyResult<Py<PyArray2<f64>>> {
        of_matrix(py, &self.done.covariance)
    }

    /// A (n, 2) array for each image given: adjusted less observed, px; NaN where there is no point.
    #[getter]
    fn residuals(&self, py: Python<'_>) -> PyResult<Vec<Py<PyArray2<f64>>>> {
        self.done.residuals.iter().map(|image| table(py, image)).collect()
    }

    /// For each image given whether each point took part.
    #[getter]
    fn used(&self) -> Vec<Vec<bool>> {
        self.done.used.clone()
    }

    /// Poses by the names of images; an image without a pose is not there.
    #[getter]
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        self.done.images.iter().zip(&self.done.poses).try_for_each(|(name, pose)| all.set_item(name, Py::new(py, Pose(*pose))?))?;
        Ok(all)
    }

    /// What each image has for itself beside the camera of all: by image and number, its value and its standard deviation.
    #[getter]
    fn per_image<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (image, name, value, sigma) in &self.done.per_image {
            if !all.contains(image)? {
                all.set_item(image, PyDict::new(py))?;
            }
            all.as_any().get_item(image)?.set_item(name, (value, sigma))?;
        }
        Ok(all)
    }

    /// sigma0: the standard deviation of an image coordinate over the a-priori one; None without redundancy.
    #[getter]
    fn sigma0(&self) -> Option<f64> {
        self.done.sigma0
    }

    /// Root mean square of the residuals in use, 2D, px.
    #[getter]
    fn rms_px(&self) -> f64 {
        self.done.rms_px
    }

    /// What is doubtful, in words; with any the command line ends with exit code 3.
    #[getter]
    fn doubts(&self) -> Vec<String> {
        self.done.doubts.iter().map(|(.., words)| words.clone()).collect()
    }

    /// The same for programs: dicts of `subject` (a word), `p`, `moves` and `words`; None where a number is not known.
    #[getter]
    fn doubted<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let one = |(subject, p, moves, words): &Doubted| {
            let found = PyDict::new(py);
            found.set_item("subject", subject)?;
            found.set_item("p", p)?;
            found.set_item("moves", moves)?;
            found.set_item("words", words)?;
            Ok(found)
        };
        self.done.doubts.iter().map(one).collect()
    }

    /// What the input may be in truth where the result is in doubt, first what explains it best: dicts of `kind`, `what` and `rms_px`, or None there.
    #[getter]
    fn suspected<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let one = |(kind, what, rms_px): &Suspect| {
            let found = PyDict::new(py);
            found.set_item("kind", kind)?;
            found.set_item("what", what)?;
            found.set_item("rms_px", rms_px)?;
            Ok(found)
        };
        self.done.suspected.iter().map(one).collect()
    }

    /// What is to be known and is no doubt: what the summary calls warnings.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.done.warnings.clone()
    }

    /// What the command line prints.
    #[getter]
    fn summary(&self) -> &str {
        &self.done.summary
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        let doubts = self.done.doubts.len();
        format!(
            "Calibration({} images, {:.4} px RMS{})",
            self.done.images.len(),
            self.done.rms_px,
            if doubts == 0 { String::new() } else { format!(", {doubts} doubts") }
        )
    }
}

/// Calibrates a camera from measured points: as `calibench calibrate --points --control` does.
#[pyfunction]
#[pyo3(signature = (xy, board, *, size, images = None, model = None, pitch = None, solve = None, priors = None, per_image = None, start = None, datum = "control",
    board_shape = "tested", sigma = None, covariances = false, huber = None, snoop = None, compare = None, limit = None,
    board_file = None, save_board = None, board_scale = None, print_noise = None))]
#[expect(clippy::too_many_arguments, reason = "each is a keyword of Python's")]
pub fn calibrate(
    py: Python<'_>,
    xy: Vec<Bound<'_, PyAny>>,
    board: &Bound<'_, PyAny>,
    size: &Bound<'_, PyAny>,
    images: Option<Vec<String>>,
    model: Option<String>,
    pitch: Option<f64>,
    solve: Option<Vec<String>>,
    priors: Option<Vec<String>>,
    per_image: Option<Vec<String>>,
    start: Option<&Camera>,
    datum: &str,
    board_shape: &str,
    sigma: Option<f64>,
    covariances: bool,
    huber: Option<f64>,
    snoop: Option<bool>,
    compare: Option<Vec<Vec<String>>>,
    limit: Option<f64>,
    board_file: Option<PathBuf>,
    save_board: Option<PathBuf>,
    board_scale: Option<(f64, f64)>,
    print_noise: Option<f64>,
) -> PyResult<Calibration> {
    if board_file.is_some() && save_board.is_some() {
        return Err(input("board_file and save_board: one or the other"));
    }
    let board = Board::of(board)?.with_file(board_file)?;
    let names = image_names(images, xy.len())?;
    let points = points(&xy, &names, &board)?;
    let (model, bent) = lens_and_board(model);
    let size = size_of(size)?;
    let optics = Optics {
        pitch_um: positive(pitch, "pitch")?,
        model,
        solve,
        priors: priors.unwrap_or_default().iter().map(|text| text.parse()).collect::<Result<_, _>>().map_err(input)?,
        per_image: per_image.unwrap_or_default().iter().map(|text| text.parse()).collect::<Result<_, _>>().map_err(input)?,
        start: start.map(|camera| Ok::<_, PyErr>(of_images(&camera.named, size, "start: the camera")?.camera)).transpose()?,
        ..Optics::new(size)
    };
    let settings = Settings {
        datum: datum.parse().map_err(input)?,
        board: StatedBoard {
            scale: board_scale.map(|(value, sigma)| format!("{value}:{sigma}").parse()).transpose().map_err(input)?,
            noise: positive(print_noise, "print_noise")?,
            is_measured: save_board.is_some(),
        },
        shape: if bent && board_shape == "tested" { BoardShape::Bent } else { board_shape.parse().map_err(input)? },
        gross: gross(positive(huber, "huber")?, snoop)?,
        sigma_px: positive(sigma, "sigma")?,
        limit_px: positive(limit, "limit")?,
        covariances,
        ..Settings::new(vec![optics])
    };
    let given = (points.len() <= MOST_TRIED).then(|| points.clone());
    let suspects = |found: Result<&Solved<'_>, &Unsolved>| {
        given.as_ref().map_or_else(Vec::new, |points| suspected(points, &board.control, &settings, found))
    };
    let done = interruptible(py, || {
        let explained = |error: Unsolved| {
            let lines: String = suspects(Err(&error)).iter().map(|found| format!("\nsuspected: {}", found.words())).collect();
            format!("{error}{lines}")
        };
        let prepared = prepare(points, &board.control, &settings).map_err(explained)?;
        let solved = self::solve(&prepared, &compare.unwrap_or_default(), |calibration| {
            let suspects = if calibration.doubts().is_empty() { Vec::new() } else { suspects(Ok(calibration)) };
            save_board.as_deref().map_or(Ok(()), |path| save(path, calibration, &board))?;
            done(calibration, suspects, &names, &board)
        });
        solved.map_err(explained)
    })?;
    let (named, done) = done.map_err(|error| CalibrationError::new_err(in_python(&error)))?.map_err(input)?;
    let suspicions = done.suspected.iter().map(|(_, what, _)| format!("suspected: {what}"));
    for text in done.doubts.iter().map(|(.., words)| words.clone()).chain(suspicions) {
        doubt(py, &text)?;
    }
    Ok(Calibration { camera: Py::new(py, Camera::new(named))?, done })
}

/// A positive number, if there is one; `what` is its name in errors.
///
/// # Errors
/// Zero, a negative number, one that is not finite.
pub fn positive(value: Option<f64>, what: &str) -> PyResult<Option<f64>> {
    match value {
        Some(number) if !(number.is_finite() && number > 0.0) => Err(input(format!("{what}: {number}; expected a positive number"))),
        value => Ok(value),
    }
}

fn done(calibration: &Solved<'_>, suspects: Vec<Suspected>, names: &[String], board: &Board) -> Result<(NamedCamera, Done), String> {
    let (prepared, solution) = (calibration.prepared, &calibration.solution);
    let image_of: HashMap<&str, usize> = names.iter().enumerate().map(|(index, name)| (name.as_str(), index)).collect();
    let point_of: HashMap<&str, usize> = board.names().enumerate().map(|(index, name)| (name, index)).collect();
    let mut residuals = vec![vec![[f64::NAN; 2]; board.control.len()]; names.len()];
    let mut used = vec![vec![false; board.control.len()]; names.len()];
    for residual in solution.each_residual() {
        let sight = prepared.survey.sight(prepared.sights[residual.observation] as usize);
        let image = image_of.get(prepared.survey.images[sight.image].as_str());
        let (Some(&image), Some(&point)) = (image, point_of.get(prepared.survey.target(sight.target))) else { continue };
        residuals[image][point] = residual.v.unwrap_or([f64::NAN; 2]);
        used[image][point] = residual.used != Use::LeftOut;
    }
    let (solved, covariance) = calibration.covariances.of_camera(0);
    let done = Done {
        solved: solved.into_iter().map(str::to_owned).collect(),
        covariance,
        images: prepared.survey.images.clone(),
        poses: solution.poses().to_vec(),
        residuals,
        used,
        sigma0: solution.sigma0(),
        rms_px: calibration.rms_px(),
        doubts: calibration.doubts().iter().map(doubted).collect(),
        suspected: suspects.into_iter().map(|found| (found.kind.to_owned(), in_python(&found.what), found.rms_px)).collect(),
        per_image: calibration.own_numbers().into_iter().map(|own| (own.image, own.name, own.value, own.sigma)).collect(),
        warnings: warnings(calibration).iter().map(|words| in_python(words)).collect(),
        summary: summary(calibration),
    };
    Ok((calibration.named_camera(0)?, done))
}

fn doubted(doubt: &Doubt) -> Doubted {
    let finding = doubt.finding;
    (doubt.subject.name().to_owned(), finding.map(|found| found.p), finding.and_then(|found| found.moves), in_python(&doubt.words))
}

/// The camera and all fields of [`Done`], in their order.
type State<'py> = (
    Py<Camera>,
    Vec<String>,
    Bound<'py, PyAny>,
    Vec<String>,
    Vec<Py<Pose>>,
    Vec<Bound<'py, PyAny>>,
    Vec<Vec<bool>>,
    Option<f64>,
    f64,
    (Vec<Doubted>, Vec<Suspect>, Vec<String>),
    (String, Vec<(String, String, f64, f64)>),
);

impl Pickled for Calibration {
    const CLASS: &'static str = "Calibration";

    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Done { solved, covariance, images, poses, used, sigma0, rms_px, doubts, suspected, warnings, summary, per_image, .. } =
            &self.done;
        let poses = poses.iter().map(|pose| Py::new(py, Pose(*pose))).collect::<PyResult<Vec<_>>>()?;
        let (covariance, residuals) = (of_matrix(py, covariance)?, self.residuals(py)?);
        (
            &self.camera,
            solved,
            covariance,
            images,
            poses,
            residuals,
            used,
            *sigma0,
            *rms_px,
            (doubts, suspected, warnings),
            (summary, per_image),
        )
            .into_bound_py_any(py)
    }

    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (
            camera,
            solved,
            covariance,
            images,
            poses,
            residuals,
            used,
            sigma0,
            rms_px,
            (doubts, suspected, warnings),
            (summary, per_image),
        ): State<'_> = state.extract()?;
        let covariance = matrix(&covariance)?;
        let residuals = residuals.iter().map(|image| rows(image, "residuals")).collect::<PyResult<_>>()?;
        let poses = poses.iter().map(|pose| pose.get().0).collect();
        let done =
            Done { solved, covariance, images, poses, residuals, used, sigma0, rms_px, doubts, suspected, warnings, summary, per_image };
        Ok(Self { done, camera })
    }
}
