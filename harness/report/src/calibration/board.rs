//! The shape of the board, for the page, the terminal and as CSV.

use std::io;

use calibench_calibrate::{Bend, Board, Calibration, Shape};
use calibench_files::NewFolder;

use super::csv;
use crate::plain;

/// What each coefficient is.
const NAMES: [&str; 3] = ["along u", "along v", "twist"];

/// Coefficients and standard deviations of the bend that was adjusted, object units, and where the board lies; `None` if none was.
pub(super) fn adjusted<'c>(calibration: &'c Calibration<'_>) -> Option<(&'c Board, [f64; 3], [f64; 3])> {
    let Shape::Bent { board, .. } = &calibration.prepared.shape else { return None };
    let covariance = calibration.covariances.surfaces.first()?;
    let sigmas = std::array::from_fn(|i| covariance[(i, i)].max(0.0).sqrt());
    Some((board, calibration.solution.surfaces().next()?, sigmas))
}

/// What is held of the shape, in a line.
pub(super) fn fact(calibration: &Calibration<'_>) -> Option<String> {
    match &calibration.prepared.shape {
        Shape::Untouched => None,
        Shape::Untested(why) => Some(format!("board: taken as its coordinates say; a bend was not tested: {why}")),
        Shape::Flat { bend, .. } => Some(format!(
            "board: flat, as far as these images tell: a bend of {} is not told from none (p {:.3})",
            coefficients(bend.coefficients, bend.sigmas),
            bend.p
        )),
        Shape::Bent { bend, .. } => {
            let (_, values, sigmas) = adjusted(calibration)?;
            let tested = bend.map_or_else(|| "as asked".to_owned(), |bend| significance(&bend));
            Some(format!("board: bent ({tested}) by {} object units, positive towards the camera", coefficients(values, sigmas)))
        }
    }
}

fn significance(bend: &Bend) -> String {
    if bend.p < 1e-4 { "p < 0.0001".into() } else { format!("p {:.4}", bend.p) }
}

fn coefficients(values: [f64; 3], sigmas: [f64; 3]) -> String {
    let one = |k: usize| {
        if sigmas[k] > 0.0 {
            let (value, sigma) = super::digits::rounded(values[k], sigmas[k]);
            format!("{value} \u{b1} {sigma} {}", NAMES[k])
        } else {
            format!("{} {} (fixed)", values[k], NAMES[k])
        }
    };
    [0, 1, 2].map(one).join(", ")
}

/// A bend that was found although nobody asked for it.
pub(super) fn warning(calibration: &Calibration<'_>) -> Option<String> {
    let Shape::Bent { bend: Some(_), .. } = &calibration.prepared.shape else { return None };
    let (_, values, _) = adjusted(calibration)?;
    Some(format!(
        "the board is bent by {} object units from its lowest to its highest place, which the calibration takes into account; its control file says flat \
         (--board-shape flat to keep it so)",
        plain(Board::deflection(values))
    ))
}

/// Writes `board.csv`: the coefficients that were adjusted or tested, and what was made of them. No file where no board was looked at.
pub(super) fn table(calibration: &Calibration<'_>, folder: &NewFolder) -> io::Result<()> {
    let (status, values, sigmas, p) = match (&calibration.prepared.shape, adjusted(calibration)) {
        (Shape::Flat { bend, .. }, _) => ("flat", bend.coefficients, bend.sigmas, Some(bend.p)),
        (Shape::Bent { bend, .. }, Some((_, values, sigmas))) => ("bent", values, sigmas, bend.map(|bend| bend.p)),
        _ => return Ok(()),
    };
    let row = |k: usize| {
        let p = p.map_or(String::new(), |p| p.to_string());
        vec![NAMES[k].to_owned(), values[k].to_string(), sigmas[k].to_string(), p, status.to_owned()]
    };
    csv::table(folder, "board.csv", &["coefficient", "value", "sigma", "p", "status"], (0..3).map(row))
}
