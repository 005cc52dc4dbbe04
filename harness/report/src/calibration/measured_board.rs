//! The board as photographs show it, and what of it is taken as exact, in words.

use std::io;

use calibench_calibrate::{BoardTest, Calibration, MeasuredBoard, Part, Repeats};
use calibench_exchange::write_board_corners;
use calibench_files::NewFolder;

use crate::plain;

/// What was stated of the board, what was measured of it, and what is taken as exact, a line each.
pub(super) fn facts(calibration: &Calibration<'_>) -> Vec<String> {
    let stated = &calibration.prepared.settings.board;
    let scale = stated.scale.map(|scale| {
        format!(
            "scale of the board {} \u{b1} {} as stated: {} of every length, and of each station's distance from the object's origin, is in their standard deviations; no \
             parameter of a camera depends on it",
            scale.value,
            scale.sigma,
            plain(scale.share())
        )
    });
    let noise = stated.noise.map(|sigma| format!("corners of the board: X, Y and Z each known to {sigma} object units, as stated"));
    let measured = calibration.measured_board.iter().flat_map(|board| match board {
        Ok(board) => of_board(board),
        Err(why) => vec![format!("board not measured: {why}")],
    });
    let exact = calibration.taken_as_exact();
    let exact = (!exact.is_empty()).then(|| format!("taken as exact: {}", exact.join(", ")));
    scale.into_iter().chain(noise).chain(measured).chain(exact).collect()
}

fn of_board(board: &MeasuredBoard) -> Vec<String> {
    let MeasuredBoard { corners, deviation, sigma, test, beyond_bend, photographs, .. } = board;
    let mut lines = vec![
        format!(
            "board measured: {} corners from {photographs} photographs, in the place and scale of the nominal ones as a whole (inner constraints over all of them); they are {} \
             object units RMS off in the plane (standard deviation {}) and {} across ({}): {}",
            corners.len(),
            plain(deviation.in_plane),
            plain(sigma.in_plane),
            plain(deviation.across),
            plain(sigma.across),
            chance(test)
        ),
        match &board.repeats {
            Ok(repeats) => repeated(repeats),
            Err(why) => format!("whether photographs repeat it was not told: {why}"),
        },
    ];
    lines.extend(board.bend.map(|bend| {
        let beyond = beyond_bend.map_or_else(String::new, |test| format!("; what is beyond a bend: {}", chance(&test)));
        let size = plain(calibench_calibrate::Board::deflection(bend.coefficients));
        if bend.is_significant() {
            format!("of it a bend by {size} object units from its lowest to its highest place{beyond}")
        } else {
            format!("no bend is told from none{beyond}")
        }
    }));
    lines.push(if board.is_told() {
        "this board is told from a perfect one: take the file with --board-file for later photographs of it".into()
    } else {
        "this board is not told from a perfect one: nothing is gained by its file".into()
    });
    lines
}

fn chance(test: &BoardTest) -> String {
    let p = if test.p < 1e-4 { "p < 0.0001".into() } else { format!("p {:.4}", test.p) };
    format!("F {} of {} and {} degrees of freedom, {p} if it were chance", plain(test.f), test.more, test.redundancy)
}

fn repeated(repeats: &Repeats) -> String {
    let part = |part: &Part| {
        format!(
            "{:.2} ({} object units, {:.0} % of the variance of all photographs)",
            part.correlation,
            plain(part.common),
            100.0 * part.of_whole
        )
    };
    let printer = repeats.printer.map_or_else(String::new, |printer| {
        format!(
            "; rows and columns that are off as a whole, as a printer's feed makes them, are {:.0} % of it in the plane, {:.0} % by chance",
            100.0 * printer.share,
            100.0 * printer.by_chance
        )
    });
    let sigmas = if repeats.sigmas > 1.0 {
        format!("; halves differ by {} times what standard deviations said, which are enlarged by as much", plain(repeats.sigmas))
    } else {
        String::new()
    };
    format!(
        "halves of the photographs repeat it: correlation {} in the plane, {} across, over {} splits{printer}{sigmas}",
        part(&repeats.in_plane),
        part(&repeats.across),
        repeats.splits
    )
}

/// Writes `board-corners.csv`: the corners that were measured, where the board was.
pub(super) fn table(calibration: &Calibration<'_>, folder: &NewFolder) -> io::Result<()> {
    let Some(Ok(board)) = &calibration.measured_board else { return Ok(()) };
    let corners = board.measured(&calibration.prepared.settings.board);
    folder.write("board-corners.csv", |file| write_board_corners(file, &corners))
}
