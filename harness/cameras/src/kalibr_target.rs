//! Kalibr's target files: `target.yaml`.

use std::path::Path;

use calibench_model::boards::{AprilGrid, Board, Chessboard, Circles, Dictionary, Marks};

use super::CameraFileError;
use super::formats::yaml;
use super::source::{self, Source};
use super::tree::Entry;

/// The dictionary of Kalibr's tags.
const KALIBRS_TAGS: &str = "DICT_APRILTAG_36h11";

/// The width of their frames, cells.
const KALIBRS_BORDER: usize = 2;

/// Reads a board from a target file of Kalibr's. Lengths are in m.
///
/// # Errors
/// A file that cannot be read or is no such file; a target that Kalibr has and we have not; values out of their range.
pub fn read_kalibr_target(path: &Path) -> Result<Board, CameraFileError> {
    let bytes = source::read(path)?;
    parse(Source::new(&bytes)?.text)
}

fn parse(text: &str) -> Result<Board, CameraFileError> {
    let root = yaml(text)?;
    let kind = root.text_of("target_type")?;
    let board = match kind.trim_matches('\'') {
        "aprilgrid" => aprilgrid(&root)?,
        "checkerboard" => checkerboard(&root)?,
        "circlegrid" => circlegrid(&root)?,
        other => {
            let message = format!("is `{other}`; expected aprilgrid, checkerboard or circlegrid");
            return Err(root.required("target_type")?.wrong(&message).of("target_type"));
        }
    };
    board.layout().map_err(|error| CameraFileError::new(error.to_string()))?;
    Ok(board)
}

fn count(root: &Entry, name: &str) -> Result<usize, CameraFileError> {
    whole(root, name, root.number_of(name)?, 1)
}

/// `value`, which stands under `name`, as a whole number from `least` on.
fn whole(root: &Entry, name: &str, value: f64, least: usize) -> Result<usize, CameraFileError> {
    if value.fract() == 0.0 && (least as f64..=1000.0).contains(&value) {
        return Ok(value as usize);
    }
    Err(root.required(name)?.wrong(&format!("expected a whole number from {least} to 1000")).of(name))
}

fn aprilgrid(root: &Entry) -> Result<Board, CameraFileError> {
    let known = ["target_type", "tagCols", "tagRows", "tagSize", "tagSpacing", "lowId"];
    refuse_unknown(root, &known)?;
    Ok(Board::AprilGrid(AprilGrid {
        columns: count(root, "tagCols")?,
        rows: count(root, "tagRows")?,
        tag: root.number_of("tagSize")?,
        spacing: root.number_of("tagSpacing")?,
        dictionary: Dictionary::named(KALIBRS_TAGS).expect("a dictionary of ours"),
        // A key that forks of Kalibr have.
        first: whole(root, "lowId", root.number_or_zero("lowId")?, 0)? as u32,
        border: KALIBRS_BORDER,
        squares: Some(0.0),
    }))
}

fn checkerboard(root: &Entry) -> Result<Board, CameraFileError> {
    refuse_unknown(root, &["target_type", "targetCols", "targetRows", "rowSpacingMeters", "colSpacingMeters"])?;
    let (square, other) = (root.number_of("colSpacingMeters")?, root.number_of("rowSpacingMeters")?);
    if square != other {
        let message = format!("is {other}, and `colSpacingMeters` is {square}; expected squares");
        return Err(root.required("rowSpacingMeters")?.wrong(&message).of("rowSpacingMeters"));
    }
    Ok(Board::Chessboard(Chessboard { columns: count(root, "targetCols")?, rows: count(root, "targetRows")?, square }))
}

fn circlegrid(root: &Entry) -> Result<Board, CameraFileError> {
    refuse_unknown(root, &["target_type", "targetCols", "targetRows", "spacingMeters", "asymmetricGrid"])?;
    let spacing = root.number_of("spacingMeters")?;
    let asymmetric = root.key("asymmetricGrid")?.map_or(Ok(false), |entry| match entry.text()?.to_lowercase().as_str() {
        "true" => Ok(true),
        "false" => Ok(false),
        _ => Err(entry.wrong("expected True or False").of("asymmetricGrid")),
    })?;
    Ok(Board::Circles(Circles {
        columns: count(root, "targetCols")?,
        rows: count(root, "targetRows")?,
        spacing,
        diameter: 0.5 * spacing,
        hole: None,
        asymmetric,
        marks: Marks::default(),
    }))
}

/// A key that nobody here knows may change what the target is.
fn refuse_unknown(root: &Entry, known: &[&str]) -> Result<(), CameraFileError> {
    match root.entries()?.iter().find(|(name, _)| !known.contains(&name.as_str())) {
        Some((name, entry)) => Err(entry.wrong(&format!("is no key of this target; expected {}", known.join(", "))).of(name)),
        None => Ok(()),
    }
}

/// A board as a target file of Kalibr's; an object unit is `metres` long.
///
/// # Errors
/// Why Kalibr has no word for the board.
pub fn kalibr_target(board: &Board, metres: f64) -> Result<String, &'static str> {
    // Twelve places: 30 mm are 0.03 m.
    let length = |value: f64| (value * metres * 1e12).round() / 1e12;
    match board {
        Board::Chessboard(Chessboard { columns, rows, square }) => {
            let side = length(*square);
            Ok(format!(
                "target_type: 'checkerboard'\ntargetCols: {columns}\ntargetRows: {rows}\nrowSpacingMeters: {side}\ncolSpacingMeters: {side}\n"
            ))
        }
        Board::AprilGrid(grid) => {
            grid_that_kalibr_has(grid)?;
            let AprilGrid { columns, rows, tag, spacing, .. } = grid;
            let side = length(*tag);
            Ok(format!("target_type: 'aprilgrid'\ntagCols: {columns}\ntagRows: {rows}\ntagSize: {side}\ntagSpacing: {spacing}\n"))
        }
        Board::Circles(Circles { hole: Some(_), .. }) => Err("its circles are discs, not rings"),
        Board::Circles(circles) if !circles.marks.is_empty() => Err("its circles are all alike"),
        Board::Circles(Circles { columns, rows, spacing, asymmetric, .. }) => {
            let (spacing, asymmetric) = (length(*spacing), if *asymmetric { "True" } else { "False" });
            Ok(format!(
                "target_type: 'circlegrid'\ntargetCols: {columns}\ntargetRows: {rows}\nspacingMeters: {spacing}\nasymmetricGrid: {asymmetric}\n"
            ))
        }
        Board::Charuco(_) => Err("it knows no ChArUco"),
        Board::GridBoard(_) => Err("it knows no GridBoard"),
        Board::Rings(_) => Err("it knows no ring codes"),
        Board::Puzzle(_) => Err("it knows no PuzzleBoard"),
        Board::Dotted(_) => Err("it knows no dots in a chessboard"),
    }
}

/// Whether Kalibr's detector, whose tags are not in its file, looks for these.
fn grid_that_kalibr_has(grid: &AprilGrid) -> Result<(), &'static str> {
    if grid.dictionary.name != KALIBRS_TAGS {
        Err("its tags are DICT_APRILTAG_36h11")
    } else if grid.border != KALIBRS_BORDER {
        Err("its tags have frames two cells wide")
    } else if grid.first != 0 {
        Err("its first tag is tag 0")
    } else if grid.squares.is_none() {
        Err("it looks for the small squares between the tags")
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As Kalibr's documentation gives it.
    const GRID: &str = "target_type: 'aprilgrid' #gridtype\ntagCols: 6   #number of apriltags\ntagRows: 6\ntagSize: 0.088 #edge to edge [m]\ntagSpacing: 0.3\n";

    #[test]
    fn an_aprilgrid_goes_both_ways() {
        let board = parse(GRID).unwrap();
        assert_eq!(board, "aprilgrid:6x6:0.088:0.3".parse().unwrap());
        let written = kalibr_target(&board, 1.0).unwrap();
        assert_eq!(parse(&written).unwrap(), board, "{written}");
        let in_mm: Board = "aprilgrid:6x6:88:0.3".parse().unwrap();
        assert_eq!(kalibr_target(&in_mm, 1e-3), Ok(written));
    }

    /// What is written is read as the board that it was, and what Kalibr would see as another board is refused.
    #[test]
    fn every_kind_of_board_is_written_or_refused_with_a_reason() {
        for (kind, example) in calibench_model::boards::examples() {
            let board: Board = example.parse().unwrap();
            match kalibr_target(&board, 1.0) {
                Ok(written) => assert_eq!(parse(&written), Ok(board), "{kind}: {written}"),
                Err("its circles are all alike") => assert!(example.contains('@'), "{example}"),
                Err(why) => assert!(["charuco", "gridboard", "rings", "puzzle", "dotted"].contains(&kind), "{kind}: {why}"),
            }
        }
        let refused = |word: &str, why: &str| {
            let error = kalibr_target(&word.parse().unwrap(), 1.0).unwrap_err();
            assert!(error.contains(why), "{word}: {error}, expected {why}");
        };
        refused("aprilgrid:6x6:88:0.3:border1", "two cells");
        refused("aprilgrid:6x6:88:0.3:7", "tag 0");
        refused("aprilgrid:6x6:88:0.3:plain", "small squares");
        refused("charuco:8x5:30:21:DICT_4X4_50", "ChArUco");
        refused("gridboard:5x7:40:10:DICT_6X6_250", "GridBoard");
        refused("rings:12:6x5:50:8", "ring codes");
        refused("puzzle:23x16:30:50,100", "PuzzleBoard");
        refused("dotted:9x6:25", "dots");
        let Board::Circles(discs) = "acircles:4x11:20".parse().unwrap() else { panic!() };
        assert_eq!(parse(&kalibr_target(&Board::Circles(discs), 1.0).unwrap()), Ok(Board::Circles(discs)));
        assert!(kalibr_target(&Board::Circles(Circles { hole: Some(4.0), ..discs }), 1.0).is_err());
    }

    #[test]
    fn other_targets_are_read() {
        let chess = "target_type: 'checkerboard'\ntargetCols: 9\ntargetRows: 6\nrowSpacingMeters: 0.06\ncolSpacingMeters: 0.06\n";
        assert_eq!(parse(chess).unwrap(), "chessboard:9x6:0.06".parse().unwrap());
        assert_eq!(kalibr_target(&parse(chess).unwrap(), 1.0).unwrap(), chess);
        let circles = "target_type: 'circlegrid'\ntargetCols: 6\ntargetRows: 7\nspacingMeters: 0.02\nasymmetricGrid: False\n";
        assert_eq!(parse(circles).unwrap(), "circles:6x7:0.02".parse().unwrap());
    }

    #[test]
    fn mistakes_are_told_with_line_and_key() {
        for (from, to, said) in [
            ("'aprilgrid'", "'apriltag'", "is `apriltag`; expected aprilgrid"),
            ("tagCols: 6", "tagCols: 6.5", "expected a whole number"),
            ("tagSize: 0.088", "tagSize: wide", "tagSize"),
            ("tagSpacing: 0.3", "tagSpcing: 0.3", "tagSpcing"),
            ("tagRows: 6", "tagRows: 6\nlowId: 1.5", "lowId"),
            ("tagRows: 6", "tagRows: 6\nlowId: 552", "`first` is 552: expected at most 587"),
            ("tagRows: 6", "tagRows: 6\nlowId: -1", "expected a whole number from 0 to 1000"),
            ("tagSpacing: 0.3", "tagSpacing: -1", "`spacing` is -1"),
            ("target_type: 'aprilgrid'", "cam0: 3", "target_type"),
        ] {
            let error = parse(&GRID.replace(from, to)).unwrap_err().to_string();
            assert!(error.contains(said), "{error}\nexpected {said}");
        }
    }
}
