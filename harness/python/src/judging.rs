//! `judge`: which operator and which camera model to trust, without truth.

use std::path::PathBuf;
use std::sync::Arc;

use calibench_calibrate::choice::ModelChoice;
use calibench_calibrate::usual_limit_px;
use calibench_exchange::PointFile;
use calibench_judge::{
    CornerFile, Expected, JudgementError, Material, Options, judge as judged, stated_sigma, usual_methods, usual_models, with_board,
};
use calibench_model::{LostRow, LostRows};
use calibench_photographs::{Finder, MeasuredBoards, Reader, measured_boards, method_info};
use calibench_records::judgement::{InUse, Row, StillHolds, Summary};
use calibench_report::judgement::{in_use, section, verdict};
use numpy::PyArray1;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::boards::Board;
use crate::calibrating::positive;
use crate::camera::Camera;
use crate::error::{doubt, input};
use crate::image_size::size_of;
use crate::measuring::Measured;
use crate::pickled::{Pickled, Reduced, reduced};
use crate::points::{image_names, points};
use crate::reframing::of_images;
use crate::session::{methods_of_boards, with_project};
use crate::stopped::interruptible;

/// A verdict and the figures behind it: see `calibench.Judgement`.
#[pyclass(frozen, module = "calibench", name = "Judgement")]
pub struct Judgement {
    /// The operator to be trusted.
    #[pyo3(get)]
    operator: String,
    /// The camera model to be trusted.
    #[pyo3(get)]
    model: String,
    /// What the command line prints.
    #[pyo3(get)]
    verdict: String,
    /// Why the verdict is in doubt, if so.
    #[pyo3(get)]
    doubt: Option<String>,
    /// Below which the camera's error over the frame is in 95 of 100 cases, px RMS; None where that is not known.
    #[pyo3(get)]
    limit_px: Option<f64>,
    /// Of a camera in use: `holds`, `moved` or `cannot tell`.
    #[pyo3(get)]
    in_use: Option<String>,
    rows: Vec<Row>,
}

#[pymethods]
impl Judgement {
    /// The figures as columns: method, model, measure, place, value, sigma, count, unit, status, reason.
    #[getter]
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        let text = |of: fn(&Row) -> &Arc<str>| self.rows.iter().map(|row| of(row).to_string()).collect::<Vec<_>>();
        let number = |of: fn(&Row) -> Option<f64>| PyArray1::from_iter(py, self.rows.iter().map(|row| of(row).unwrap_or(f64::NAN)));
        all.set_item("method", text(|row| &row.method))?;
        all.set_item("model", text(|row| &row.model))?;
        all.set_item("measure", text(|row| &row.measure))?;
        all.set_item("place", text(|row| &row.place))?;
        all.set_item("value", number(|row| row.value))?;
        all.set_item("sigma", number(|row| row.sigma))?;
        all.set_item("count", number(|row| row.count.map(|count| count as f64)))?;
        all.set_item("unit", text(|row| &row.unit))?;
        all.set_item("status", text(|row| &row.status))?;
        all.set_item("reason", text(|row| &row.reason))?;
        Ok(all)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!("Judgement({} with {})", self.operator, self.model)
    }
}

/// What is asked for besides the material.
struct Asked {
    models: Vec<ModelChoice>,
    pitch_um: Option<f64>,
    splits: u64,
    seed: u64,
    margin: f64,
    /// Whether the board's share is asked for.
    of_board: bool,
}

/// Says which operator, or whose points, and which camera model to trust: as `calibench judge` does.
#[pyfunction]
#[pyo3(signature = (what, board, *, size = None, images = None, methods = None, models = None, pitch = None, splits = 10, seed = 0, camera = None,
    margin = 1.0, board_file = None))]
#[expect(clippy::too_many_arguments, reason = "each is a keyword of Python's")]
pub fn judge(
    py: Python<'_>,
    what: &Bound<'_, PyAny>,
    board: &Bound<'_, PyAny>,
    size: Option<&Bound<'_, PyAny>>,
    images: Option<Vec<String>>,
    methods: Option<Vec<String>>,
    models: Option<Vec<String>>,
    pitch: Option<f64>,
    splits: u64,
    seed: u64,
    camera: Option<&Camera>,
    margin: f64,
    board_file: Option<PathBuf>,
) -> PyResult<Judgement> {
    let board = Board::of(board)?.with_file(board_file)?;
    let texts = models.unwrap_or_else(|| usual_models(board.pictured.is_some()));
    let models = ModelChoice::parse_all(&texts).map_err(|(place, error)| input(format!("models: {}: {error}", texts[place])))?;
    if !(1..=1000).contains(&splits) {
        return Err(input(format!("splits: {splits}; expected 1 to 1000")));
    }
    positive(Some(margin), "margin")?;
    let of_board = board.pictured.is_some() && camera.is_none();
    let asked = Asked { models, pitch_um: positive(pitch, "pitch")?, splits, seed, margin, of_board };
    let material = match what.extract::<Vec<PathBuf>>() {
        Ok(_) if size.is_some() || images.is_some() => return Err(input("size and images are of points; photographs say both themselves")),
        Ok(photos) => of_photographs(py, &photos, &board, methods, camera.is_some())?,
        Err(_) if methods.is_some() => return Err(input("methods: measure photographs; points are measured already")),
        Err(_) => of_points(what, &board, size, images)?,
    };
    verdict_of(py, &material, asked, camera)
}

fn verdict_of(py: Python<'_>, material: &Material, asked: Asked, camera: Option<&Camera>) -> PyResult<Judgement> {
    camera.map(|camera| of_images(&camera.named, material.size, "camera: it")).transpose()?;
    let options = Options {
        models: asked.models,
        pitch_um: asked.pitch_um,
        splits: asked.splits,
        seed: asked.seed,
        name: "judge".into(),
        published: camera.map(|camera| camera.named.camera),
        published_sigma: camera.and_then(|camera| stated_sigma(&camera.named)),
    };
    let rows = interruptible(py, || {
        let rows = judged(material, &options)?;
        Ok::<_, JudgementError>(if asked.of_board { with_board(rows, material, &options) } else { rows })
    });
    let rows = rows?.map_err(input)?;
    let summary = Summary { limit_px: Some(usual_limit_px(material.size)), ..Summary::new(&rows, asked.seed) };
    let Some(trusted) = summary.trusted() else { return Err(input(section(&summary).0)) };
    // Where the two cannot be compared over the frame the photographs cannot tell.
    let found = camera.map(|_| trusted.in_use(asked.margin).unwrap_or(InUse::unknown(asked.margin)));
    let words = found.as_ref().map_or_else(String::new, |found| format!("- {}\n", in_use(found)));
    if let Some(why) = trusted.doubt() {
        doubt(py, &why)?;
    }
    Ok(Judgement {
        operator: trusted.cell.method.to_string(),
        model: trusted.cell.model.to_string(),
        verdict: format!("{words}{}", verdict(&summary, &trusted)),
        doubt: trusted.doubt(),
        limit_px: trusted.limit,
        in_use: found.map(|found| still_holds(found.verdict).to_owned()),
        rows,
    })
}

const fn still_holds(verdict: StillHolds) -> &'static str {
    match verdict {
        StillHolds::Holds => "holds",
        StillHolds::Moved => "moved",
        StillHolds::CannotTell => "cannot tell",
    }
}

/// Operator, model, verdict, doubt, limit, whether a camera in use holds, and the rows.
type State = (String, String, String, Option<String>, Option<f64>, Option<String>, Vec<RowState>);

/// A row: four texts that say what it is of, value, sigma, count, and three texts.
type RowState = ([String; 4], Option<f64>, Option<f64>, Option<usize>, [String; 3]);

impl Pickled for Judgement {
    const CLASS: &'static str = "Judgement";

    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let row = |row: &Row| -> RowState {
            let Row { method, model, measure, place, value, sigma, count, unit, status, reason } = row;
            let texts = |text: &Arc<str>| text.to_string();
            ([method, model, measure, place].map(texts), *value, *sigma, *count, [unit, status, reason].map(texts))
        };
        let rows: Vec<RowState> = self.rows.iter().map(row).collect();
        (&self.operator, &self.model, &self.verdict, &self.doubt, self.limit_px, &self.in_use, rows).into_bound_py_any(py)
    }

    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (operator, model, verdict, doubt, limit_px, in_use, rows): State = state.extract()?;
        let row = |(of, value, sigma, count, how): RowState| {
            let ([method, model, measure, place], [unit, status, reason]) = (of.map(Arc::from), how.map(Arc::from));
            Row { method, model, measure, place, value, sigma, count, unit, status, reason }
        };
        Ok(Self { operator, model, verdict, doubt, limit_px, in_use, rows: rows.into_iter().map(row).collect() })
    }
}

/// Points by operators: a dict of lists of arrays, or one such list.
fn of_points(what: &Bound<'_, PyAny>, board: &Board, size: Option<&Bound<'_, PyAny>>, images: Option<Vec<String>>) -> PyResult<Material> {
    let size = size_of(size.ok_or_else(|| input("size: expected (columns, rows) of the images that the points are of"))?)?;
    let by_operator = match what.cast::<PyDict>() {
        Ok(dict) => dict.clone(),
        Err(_) => {
            let dict = PyDict::new(what.py());
            dict.set_item("points", what)?;
            dict
        }
    };
    let expected = Expected::new(board.field.clone(), size);
    let (mut files, mut read) = (Vec::new(), Vec::new());
    for (name, arrays) in by_operator.iter() {
        let name: String = name.extract()?;
        let arrays: Vec<Bound<'_, PyAny>> =
            arrays.extract().map_err(|_| input(format!("{name}: expected a list of arrays, one for each image")))?;
        let names = image_names(images.clone(), arrays.len())?;
        let points = points(&arrays, &names, board)?;
        points.rows().try_for_each(|row| {
            expected
                .check(&row)
                .map_err(|(column, why)| input(format!("{name}: image {}, point {}, {column}: {why}", row.image, row.target)))
        })?;
        read.push(PointFile { points, lost: lost(&arrays, &names, board) });
        files.push(CornerFile { path: PathBuf::from(&name), name: name.into() });
    }
    Material::of_corner_files(&files, &read, &expected).map_err(input)
}

/// What methods rejected, where they say so.
fn lost(arrays: &[Bound<'_, PyAny>], images: &[String], board: &Board) -> LostRows {
    let measured = images.iter().zip(arrays).filter_map(|(image, array)| Some((image, array.cast::<Measured>().ok()?.get())));
    let of = |(image, found): (&String, &Measured)| {
        let row = |(target, why): (&str, Option<&'static str>)| {
            let (image, target, status) = (image.clone(), target.to_owned(), "rejected".to_owned());
            why.map(|why| LostRow { image, target, status, reason: why.to_owned() })
        };
        board.names().zip(found.reasons().iter().copied()).filter_map(row).collect::<Vec<_>>()
    };
    measured.flat_map(of).collect()
}

/// The corners of photographs in the hands of methods.
fn of_photographs(py: Python<'_>, photos: &[PathBuf], board: &Board, methods: Option<Vec<String>>, in_use: bool) -> PyResult<Material> {
    let pictured = board.pictured.ok_or_else(|| input("board: photographs are of a board; expected it in a word, as 9x6:25"))?;
    with_project(None, |here| {
        let finder = Finder::new(pictured).map_err(input)?;
        let texts = methods.unwrap_or_else(|| usual_methods(finder.kind(), in_use));
        let methods = methods_of_boards(py, here, &texts, finder.kind())?;
        let reader = Reader::of(photos, calibench_photographs::Asked { one_camera: true, ..Default::default() }).map_err(input)?;
        reader.notes().iter().try_for_each(|note| doubt(py, note))?;
        let measured = interruptible(py, || measured_boards(&reader, &finder, &methods, &|| ()))?;
        let MeasuredBoards { trial, size, doubts } = measured.map_err(input)?;
        doubts.iter().try_for_each(|what| doubt(py, what))?;
        for (view, why) in &trial.missed_views {
            doubt(py, &format!("{view}: {why}"))?;
        }
        let infos: Vec<_> = methods.iter().map(method_info).collect();
        Ok(Material::new(&trial, &infos, board.field.clone(), size))
    })
}
