//! The board that is there where markers do not stand as on the one that was asked for.

use calibench_model::boards::{AprilGrid, Board, Charuco};

use crate::NotFound;
use crate::cells::Sight;
use crate::markers::{Markers, arranged, identified};

/// Columns of boards that are tried.
const COLUMNS: std::ops::RangeInclusive<usize> = 2..=40;
/// So many markers name a board, and this share of those that were read stand as it has them.
const FEWEST: usize = 6;
const SHARE: f64 = 0.9;

/// The same reason; of markers in another arrangement or with other ids, with the board of the same markers on which nearly all of them stand, if there is one.
pub(crate) fn named(why: NotFound, board: &Board, sights: &[Sight]) -> NotFound {
    let there = || instead(board, sights).map(|board| board.to_string());
    match why {
        NotFound::OtherArrangement { marks, together, .. } => NotFound::OtherArrangement { marks, together, instead: there() },
        NotFound::OtherIds { dictionary, seen, first, last, .. } => NotFound::OtherIds { dictionary, seen, first, last, instead: there() },
        other => other,
    }
}

/// Of the boards with other columns and, of ChArUco boards, in the other order, the one that most markers agree with; with no more rows than it takes for those
/// that were read.
fn instead(board: &Board, sights: &[Sight]) -> Option<Board> {
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
    let ((kept, all), best) = judged.max_by_key(|((kept, _), _)| *kept)?;
    (kept >= FEWEST && kept as f64 >= SHARE * all as f64).then_some(best)
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
        _ => None,
    })
}
