//! `detect`: a chessboard's corners, or the targets of a coded field, as approximate positions.

use std::path::PathBuf;

use calibench_cameras::read_kalibr_target;
use calibench_photographs::coded::coded_of;
use calibench_photographs::{Finder, board_of};
use calibench_recognise::{Classifier, Recogniser};
use calibench_scenario::Subject;
use pyo3::prelude::*;

use crate::error::{doubt, input};
use crate::grey::Grey;
use crate::rendering::{Targets, starts};
use crate::session::{scenario_of, with_project};
use crate::stopped::interruptible;

/// Finds a board, or the targets of the coded field that a scenario describes; None where it is not seen. As `calibench detect` does.
#[pyfunction]
#[pyo3(signature = (image, board = None, *, testfield = None, classifier = "modern", root = None))]
pub fn detect(
    py: Python<'_>,
    image: &Bound<'_, PyAny>,
    board: Option<&str>,
    testfield: Option<&str>,
    classifier: &str,
    root: Option<PathBuf>,
) -> PyResult<Option<Targets>> {
    let grey = Grey::of(image)?;
    let image = grey.image()?;
    with_project(root, |here| match (board, testfield) {
        (Some(board), None) => {
            // A chessboard with or without the side of a square.
            let with_side = if board.contains(':') || board.contains('.') { board.to_owned() } else { format!("{board}:1") };
            let finder = Finder::new(board_of(&with_side, read_kalibr_target).map_err(input)?).map_err(input)?;
            let found = interruptible(py, || finder.find(&image, "image"))?;
            found.doubts.iter().try_for_each(|what| doubt(py, what))?;
            let targets = starts(py, found.rows.iter().map(|row| (row.target.as_str(), row.start)))?;
            Ok(if found.rows.is_empty() { None } else { Some(targets) })
        }
        (None, Some(name)) => {
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
            match interruptible(py, || coded_of(&subject.field, &recogniser, &image, "image"))? {
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
        _ => Err(input("expected either a board, as in 9x6, or testfield=SCENARIO")),
    })
}
