//! The board that is there where markers do not stand as on the one that was asked for.

use calibench_model::boards::{AprilGrid, Board, Charuco, GridBoard};

use crate::NotFound;
use crate::cells::Sight;
use crate::markers::{Markers, arranged, identified};

/// Columns of boards that are tried.
const COLUMNS: std::ops::RangeInclusive<usize> = 1..=40;
/// So many markers name a board, and this share of those that were read stand as it has them.
const FEWEST: usize = 6;
const SHARE: f64 = 0.9;

/// The same reason; of markers in another arrangement or with other ids, with the board of the same markers on which nearly all of them stand, if there is one.
pub(crate) fn named(why: NotFound, board: &Board, sights: &[Sight]) -> NotFound {
    let there = || instead(board, sights).map(|(_, board)| board.to_string());
    match why {
        NotFound::OtherArrangement { marks, together, .. } => NotFound::OtherArrangement { marks, together, instead: there() },
        NotFound::OtherIds { dictionary, seen, first, last, .. } => NotFound::OtherIds { dictionary, seen, first, last, instead: there() },
        other => other,
    }
}

/// The board in words on which more of the markers stand than so many that stand on this one, if there is one: with odd columns and even rows one order of a ChArUco
/// board is the other moved by a square, but for the markers at the ends of rows.
pub(crate) fn better(board: &Board, sights: &[Sight], kept: usize) -> Option<String> {
    instead(board, sights).filter(|(most, _)| *most > kept).map(|(_, board)| board.to_string())
}

/// Of the boards with other columns and, of ChArUco boards, in the other order, the one that most markers agree with, of several the one with fewest columns; with
/// no more rows than it takes for those that were read. With how many do.
pub(crate) fn instead(board: &Board, sights: &[Sight]) -> Option<(usize, Board)> {
    let (dictionary, _) = board.dictionary()?;
    let ids = sights.iter().filter_map(|sight| sight.identify(dictionary)).map(|(id, ..)| id);
    let last = ids.max()?;
    let agreeing = |other: &Board| -> Option<(usize, usize)> {
        let layout = other.layout().ok()?;
        let of = Markers::new(other, &layout)?;
        let (seen, foreign) = identified(sights, &of);
        Some((arranged(&seen, &of).ok()?.kept.len(), seen.len() + foreign.len()))
    };
    let judged = alternatives(board, last).filter_map(|other| Some((agreeing(&other)?, other)));
    let ((kept, all), best) = judged.reduce(|best, other| if other.0.0 > best.0.0 { other } else { best })?;
    (kept >= FEWEST && kept as f64 >= SHARE * all as f64).then_some((kept, best))
}

/// Boards of the same markers up to the id `last`.
fn alternatives(board: &Board, last: u32) -> impl Iterator<Item = Board> {
    let board = *board;
    COLUMNS.flat_map(move |columns| [false, true].map(|legacy| (columns, legacy))).filter_map(move |(columns, legacy)| match board {
        Board::Charuco(charuco) => {
            let before = last.checked_sub(charuco.first)? as usize + 1;
            // Of two rows one has the markers that the other has not.
            let pairs = before / columns;
            let rows = (2 * pairs..2 * pairs + 3).map(|rows| Charuco { columns, rows, legacy, ..charuco });
            // Without an even number of rows both orders are one.
            let holds = |board: &Charuco| Board::Charuco(*board).layout().is_ok_and(|layout| layout.markers.len() >= before);
            rows.map(|board| Charuco { legacy: legacy && board.rows % 2 == 0, ..board }).find(holds).map(Board::Charuco)
        }
        Board::AprilGrid(grid) => {
            let before = last.checked_sub(grid.first)? as usize + 1;
            (!legacy).then(|| Board::AprilGrid(AprilGrid { columns, rows: before.div_ceil(columns), ..grid }))
        }
        Board::GridBoard(grid) => {
            let before = last.checked_sub(grid.first)? as usize + 1;
            (!legacy).then(|| Board::GridBoard(GridBoard { columns, rows: before.div_ceil(columns), ..grid }))
        }
        _ => None,
    })
}
