//! What board photographs show of which nothing is known.

use std::path::PathBuf;

use calibench_detect::{Identified, detect};
use calibench_model::boards::{AprilGrid, Board, Charuco, Chessboard, Circles, GridBoard};
use rayon::prelude::*;

pub use calibench_detect::identify;

use crate::names::once;
use crate::{PhotographsError, Reader};

/// So many boards that photographs show are tried in all of them.
const TRIED: usize = 4;
/// Ratios of lengths are told to this.
const TOLD: f64 = 0.02;

/// What photographs show.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// What each of them shows, in their order.
    pub each: Vec<Option<Identified>>,
    /// The board that is found in most of them and, of several, with most points; in how many photographs, and how many points together.
    pub best: Option<(Board, usize, usize)>,
    /// The photographs that show another one, by place: `best` is not found in them.
    pub others: Vec<usize>,
}

/// What photographs show of which nothing is known; `step` is called after each, on any thread.
///
/// # Errors
/// A photograph that cannot be read, or that is given twice.
pub fn shown(reader: &Reader, step: &(dyn Fn() + Sync)) -> Result<Shown, PhotographsError> {
    let photos = reader.photos();
    once(photos)?;
    let one = |path: &PathBuf| {
        let found = identify(&reader.read(path)?);
        step();
        Ok(found)
    };
    let each: Vec<Option<Identified>> = photos.par_iter().map(one).collect::<Result<_, PhotographsError>>()?;
    let of = |found: &Option<Identified>| match found {
        Some(Identified::Board { board, points, .. }) => Some((*board, *points)),
        _ => None,
    };
    let mut boards: Vec<(Board, usize)> = Vec::new();
    for (board, points) in each.iter().filter_map(of) {
        match boards.iter_mut().find(|(known, _)| *known == board) {
            Some((_, all)) => *all += points,
            None => boards.push((board, points)),
        }
    }
    boards.sort_by_key(|(_, points)| std::cmp::Reverse(*points));
    boards.truncate(TRIED);
    let seen = |board: &Board| -> Result<Vec<usize>, PhotographsError> {
        let points = |path: &PathBuf| Ok(detect(&reader.read(path)?, board).map_or(0, |found| found.points.len()));
        photos.par_iter().map(points).collect()
    };
    let mut best: Option<(Board, Vec<usize>)> = None;
    let worth = |points: &[usize]| (points.iter().filter(|count| **count > 0).count(), points.iter().sum::<usize>());
    for (board, _) in boards {
        let points = seen(&board)?;
        if best.as_ref().is_none_or(|(_, most)| worth(&points) > worth(most)) {
            best = Some((board, points));
        }
    }
    let without = |points: &Vec<usize>| (0..each.len()).filter(|place| of(&each[*place]).is_some() && points[*place] == 0).collect();
    let others = best.as_ref().map_or_else(Vec::new, |(_, points)| without(points));
    let best = best.map(|(board, points)| {
        let (photos, all) = worth(&points);
        (board, photos, all)
    });
    Ok(Shown { each, best, others })
}

/// A board that was identified, with the lengths of one that was asked for, as far as they fit.
pub fn with_lengths(found: Board, asked: &Board) -> Board {
    let near = |one: f64, other: f64| (one - other).abs() < TOLD;
    // Without the noise of a product.
    let product = |a: f64, b: f64| (a * b * 1e9).round() / 1e9;
    match (found, *asked) {
        (Board::Chessboard(board), Board::Chessboard(Chessboard { square, .. })) => Board::Chessboard(Chessboard { square, ..board }),
        (Board::Charuco(board), Board::Charuco(Charuco { square, marker, .. })) => {
            let marker = if near(marker / square, board.marker) { marker } else { product(board.marker, square) };
            Board::Charuco(Charuco { square, marker, ..board })
        }
        (Board::AprilGrid(board), Board::AprilGrid(AprilGrid { tag, spacing, .. })) => {
            let spacing = if near(spacing, board.spacing) { spacing } else { board.spacing };
            Board::AprilGrid(AprilGrid { tag, spacing, ..board })
        }
        (Board::GridBoard(board), Board::GridBoard(GridBoard { marker, separation, .. })) => {
            let fits = near(separation / marker, board.separation);
            let separation = if fits { separation } else { product(board.separation, marker) };
            Board::GridBoard(GridBoard { marker, separation, ..board })
        }
        (Board::Circles(board), Board::Circles(Circles { spacing, diameter, .. })) if board.marks.is_empty() => {
            Board::Circles(Circles { spacing, diameter, ..board })
        }
        (found, _) => found,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_has_the_lengths_that_were_asked_for() {
        for (found, asked, expected) in [
            ("charuco:8x5:1:0.7:DICT_4X4_50", "charuco:7x5:30:21:DICT_4X4_50", "charuco:8x5:30:21:DICT_4X4_50"),
            ("charuco:8x5:1:0.7:DICT_4X4_50", "charuco:7x5:30:24:DICT_4X4_50", "charuco:8x5:30:21:DICT_4X4_50"),
            ("charuco:8x5:1:0.7:DICT_4X4_50", "aprilgrid:6x6:0.088:0.3", "charuco:8x5:1:0.7:DICT_4X4_50"),
            ("aprilgrid:6x6:1:0.3", "aprilgrid:6x5:0.088:0.31", "aprilgrid:6x6:0.088:0.31"),
            ("gridboard:5x7:1:0.25:DICT_6X6_50", "gridboard:5x6:40:12:DICT_6X6_250", "gridboard:5x7:40:10:DICT_6X6_50"),
            ("chessboard:9x6:1", "chessboard:8x6:25", "chessboard:9x6:25"),
            ("circles:7x5:1", "acircles:4x11:20:8", "circles:7x5:20:8"),
        ] {
            assert_eq!(with_lengths(found.parse().unwrap(), &asked.parse().unwrap()).to_string(), expected, "{found} {asked}");
        }
    }
}
