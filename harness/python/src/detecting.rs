//! `detect`: a board's points, or the targets of a coded field, as approximate positions; and what board there is.

use std::path::PathBuf;

use calibench_cameras::read_kalibr_target;
use calibench_model::Image;
use calibench_photographs::coded::coded_of;
use calibench_photographs::{self as photographs, Finder, UNKNOWN, board_of, unknown};
use calibench_project::Project;
use calibench_recognise::{Classifier, Recogniser};
use calibench_scenario::Subject;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::error::{doubt, input};
use crate::grey::Grey;
use crate::pickled::{Pickled, Reduced, reduced};
use crate::rendering::{Targets, starts};
use crate::session::{scenario_of, with_project};
use crate::stopped::interruptible;

/// What is seen: of one board or field, or of each of several boards.
#[derive(IntoPyObject)]
pub enum Seen {
    One(Option<Targets>),
    Each(Vec<Targets>),
}

/// Finds a board, or the targets of the coded field that a scenario describes; None where it is not seen. With `all` each of several such boards, from the left. As `calibench detect` does.
#[pyfunction]
#[pyo3(signature = (image, board = None, *, all = false, testfield = None, classifier = "modern", root = None))]
pub fn detect(
    py: Python<'_>,
    image: &Bound<'_, PyAny>,
    board: Option<&str>,
    all: bool,
    testfield: Option<&str>,
    classifier: &str,
    root: Option<PathBuf>,
) -> PyResult<Seen> {
    let grey = Grey::of(image)?;
    let image = grey.image()?;
    with_project(root, |here| match (board, testfield) {
        (Some(board), None) => of_board(py, &image, board, all),
        (None, Some(_)) if all => Err(input("all=True: expected a board, of which there may be several, and no testfield")),
        (None, Some(name)) => Ok(Seen::One(of_field(py, &image, (here, name), classifier)?)),
        _ => Err(input("expected either a board, as in 9x6, or testfield=SCENARIO")),
    })
}

fn of_board(py: Python<'_>, image: &Image<'_>, board: &str, all: bool) -> PyResult<Seen> {
    if board == UNKNOWN {
        return Err(input("board: `unknown`: identify(image) names the board that is there; expected a board"));
    }
    // A chessboard with or without the side of a square.
    let with_side = if board.contains(':') || board.contains('.') { board.to_owned() } else { format!("{board}:1") };
    let finder = Finder::new(board_of(&with_side, read_kalibr_target).map_err(input)?).map_err(input)?.of_each(all);
    let found = interruptible(py, || finder.find(image, "image"))?;
    let several = !all && !found.boards.is_empty();
    found.why.iter().filter(|_| several).chain(&found.doubts).try_for_each(|what| doubt(py, what))?;
    if several {
        doubt(py, "several boards are seen in one image: all=True takes each of them")?;
    }
    let views = found.rows.chunk_by(|one, next| one.image == next.image);
    let mut each = views.map(|rows| starts(py, rows.iter().map(|row| (row.target.as_str(), row.start)))).collect::<PyResult<Vec<_>>>()?;
    Ok(if all { Seen::Each(each) } else { Seen::One(each.pop()) })
}

fn of_field(py: Python<'_>, image: &Image<'_>, (here, name): (&Project<'_>, &str), classifier: &str) -> PyResult<Option<Targets>> {
    let scenario = scenario_of(py, here, name)?;
    let Subject::Views(subject) = &scenario.subject else {
        return Err(input(format!("testfield: `{name}` has no testfield; expected a scenario with [testfield] kind = \"coded\"")));
    };
    let classifier = match classifier {
        "modern" => Classifier::Modern,
        "contours" => Classifier::Contours,
        other => return Err(input(format!("classifier: `{other}`; expected modern or contours"))),
    };
    let recogniser = Recogniser::new(&subject.field, classifier)
        .map_err(|error| input(format!("testfield: {name}: {error}; its [testfield] must have kind = \"coded\"")))?;
    match interruptible(py, || coded_of(&subject.field, &recogniser, image, "image"))? {
        Ok(coded) => {
            if !coded.lost.is_empty() {
                doubt(py, &format!("{} targets of {} whole squares recognised, {}", coded.rows.len(), coded.squares, coded.lost))?;
            }
            Ok(Some(starts(py, coded.rows.iter().map(|row| (row.target.as_str(), row.start)))?))
        }
        Err(why) => {
            doubt(py, &format!("not recognised ({}): {why}", why.name()))?;
            Ok(None)
        }
    }
}

/// What board is in an image of which nothing is known: see `calibench.Identified`.
#[pyclass(frozen, get_all, module = "calibench", name = "Identified")]
pub struct Identified {
    /// The words by which the board is found in this image, its lengths in sides of a square or a marker, or in distances of circles; None of markers by themselves.
    board: Option<String>,
    /// Kind, counts, dictionary and pattern.
    words: String,
    /// How many of its points are seen.
    points: usize,
    /// The ids of its markers, ascending; of boards without markers none.
    markers: Vec<u32>,
}

#[pymethods]
impl Identified {
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        let board = self.board.as_ref().map_or_else(String::new, |board| format!(", {board}, {} points", self.points));
        format!("Identified({}{board})", self.words)
    }
}

/// What board is in an image of which nothing is known; None where none is that is known. As `calibench detect --board unknown` does.
#[pyfunction]
pub fn identify(py: Python<'_>, image: &Bound<'_, PyAny>) -> PyResult<Option<Identified>> {
    let grey = Grey::of(image)?;
    let image = grey.image()?;
    let found = interruptible(py, || unknown::identify(&image))?;
    Ok(found.map(|found| {
        let words = found.words();
        match found {
            photographs::Identified::Board { board, points, markers } => {
                Identified { board: Some(board.to_string()), words, points, markers }
            }
            photographs::Identified::Markers { ids, .. } => Identified { board: None, words, points: 0, markers: ids },
        }
    }))
}

/// All fields, in their order.
type State = (Option<String>, String, usize, Vec<u32>);

impl Pickled for Identified {
    const CLASS: &'static str = "Identified";

    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Self { board, words, points, markers } = self;
        (board, words, points, markers).into_bound_py_any(py)
    }

    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (board, words, points, markers): State = state.extract()?;
        Ok(Self { board, words, points, markers })
    }
}
