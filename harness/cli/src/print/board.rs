//! A board on one sheet of paper, without a scenario.

use calibench_model::Testfield;
use calibench_model::boards::Board;
use calibench_prints::Paper;
use calibench_random::Key;
use calibench_synth::testfield::{BoardSheet, Levels};

use crate::failure::Failure;

/// Nobody prints a board that is smaller than this, mm: its lengths are in another unit.
const SMALLEST: f64 = 20.0;
/// So much of a point's distance to the next stays blank around a board, if the paper has room.
const USUAL_MARGIN: f64 = 1.0;
/// What a sheet may lack by rounding, mm.
const ROUNDING: f64 = 1e-6;

/// The board's name in files and footers: letters, digits and `-`.
pub fn name(board: &Board) -> String {
    board.to_string().chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect()
}

/// The board, with as much blank paper around it as `paper` leaves on one sheet; `mm` is the length of an object unit.
///
/// # Errors
/// A board that cannot be, that is too small to be one in mm, or that does not fit on one sheet.
pub fn field(board: Board, mm: f64, paper: (&Paper, &str)) -> Result<Testfield, Failure> {
    let layout = board.layout().map_err(|error| Failure::input(format!("--board {board}: {error}")))?;
    let [low, high] = layout.printed;
    let size = [(high[0] - low[0]) * mm, (high[1] - low[1]) * mm];
    if size[0].max(size[1]) < SMALLEST {
        return Err(Failure::input(format!(
            "--board {board}: is {} x {} mm; where its lengths are in metres, --unit m says so",
            length(size[0]),
            length(size[1])
        )));
    }
    let margin = margin(board, mm, size, paper)?;
    let sheet = BoardSheet { board, margin: margin / mm, bend: None, print_noise: 0.0, levels: Levels::default(), background: 0.0 };
    let key = Key { seed: 0, of: "", trial: 0, view: "", target: "" };
    sheet.generate(key).map_err(|error| Failure::input(format!("--board {board}: {error}")))
}

/// Blank paper around a board of this size, mm.
fn margin(board: Board, mm: f64, size: [f64; 2], (paper, name): (&Paper, &str)) -> Result<f64, Failure> {
    let usual = USUAL_MARGIN * board.step() * mm;
    let Some(room) = paper.room() else { return Ok(usual) };
    let left = |room: [f64; 2]| (0.5 * (room[0] - size[0])).min(0.5 * (room[1] - size[1]));
    let most = room.map(left).into_iter().fold(f64::NEG_INFINITY, f64::max);
    if most >= -ROUNDING {
        return Ok(usual.min(most).max(0.0));
    }
    let scale = |room: [f64; 2]| (room[0] / size[0]).min(room[1] / size[1]);
    let scale = room.map(scale).into_iter().fold(0.0, f64::max);
    Err(Failure::input(format!(
        "--board {board}: is {} x {} mm, and {name} has room for {} x {} mm or, across, {} x {}; expected lengths of {} % of these, fewer points, \
         larger paper, or --paper whole, which makes a page as large as the board",
        length(size[0]),
        length(size[1]),
        length(room[0][0]),
        length(room[0][1]),
        length(room[1][0]),
        length(room[1][1]),
        (100.0 * scale).floor()
    )))
}

/// mm, to a tenth.
fn length(mm: f64) -> String {
    format!("{}", (mm * 10.0).round() / 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(board: &str, mm: f64, paper: Paper) -> Result<[f64; 2], String> {
        let made = field(board.parse().unwrap(), mm, (&paper, "A4"));
        let field = made.map_err(|failure| match failure {
            Failure::Input(text) | Failure::Picture(text) => text,
            Failure::Gate | Failure::Doubt => String::new(),
        })?;
        let [low, high] = field.plates[0].corners;
        Ok([(high[0] - low[0]) * mm, (high[1] - low[1]) * mm])
    }

    #[test]
    fn a_board_stands_on_one_sheet_or_the_paper_is_too_small() {
        // 10 x 7 squares of 25 mm; across, A4 has 277 x 176 mm.
        let [width, height] = sheet("chessboard:9x6:25", 1.0, Paper::A4).unwrap();
        assert!((width - 251.0).abs() < 1e-9 && (height - 176.0).abs() < 1e-9, "{width} {height}");
        assert_eq!(sheet("chessboard:9x6:25", 1.0, Paper::Whole), Ok([300.0, 225.0]));
        assert_eq!(sheet("chessboard:9x6:0.025", 1000.0, Paper::Whole).unwrap().map(f64::round), [300.0, 225.0]);
        // Upright.
        let [width, height] = sheet("chessboard:6x9:25", 1.0, Paper::A4).unwrap();
        assert!(width <= 190.0 && height <= 263.0, "{width} {height}");
        let large = sheet("chessboard:9x6:30", 1.0, Paper::A4).unwrap_err();
        assert!(
            large.contains("is 300 x 210 mm, and A4 has room for 190 x 263 mm or, across, 277 x 176; expected lengths of 83 %"),
            "{large}"
        );
        let metres = sheet("aprilgrid:6x6:0.088:0.3", 1.0, Paper::A4).unwrap_err();
        assert!(metres.ends_with("--unit m says so"), "{metres}");
        assert!(sheet("aprilgrid:6x6:0.088:0.3", 1000.0, Paper::A3).unwrap_err().contains("expected lengths of"));
        assert_eq!(name(&"chessboard:9x6:2.5".parse().unwrap()), "chessboard-9x6-2.5");
    }
}
