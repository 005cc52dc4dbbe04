//! What board is in an image of which nothing is known.

use calibench_model::Image;
use calibench_model::boards::{Board, Chessboard, Circles, Dotted, Marks, Puzzle};

use crate::kinds::{detect, proved};
use crate::unknown_markers::{Tags, tags};
use crate::{Doubt, Found, NotFound};

/// More inner corners than any board has that is seen: what is whole instead is named.
const ANY: [usize; 2] = [100, 99];
/// Likewise of circles.
const ANY_CIRCLES: [usize; 2] = [61, 53];

/// What is in an image.
#[derive(Clone, Debug, PartialEq)]
pub enum Identified {
    /// A board.
    Board {
        /// The board, its lengths in sides of a square, of a marker, or in distances of circles.
        board: Board,
        /// Its points that are seen.
        points: usize,
        /// Its markers, by id, ascending; of boards without markers none.
        markers: Vec<u32>,
    },
    /// Markers that stand on no board that is known, or too few to tell.
    Markers {
        /// The dictionary that has most of them, of several the smallest.
        dictionary: &'static str,
        /// The width of their frames, cells.
        border: usize,
        /// Their ids, ascending, each as often as it is seen.
        ids: Vec<u32>,
    },
}

/// What is in an image of which nothing is known: the first that is found of boards of markers, PuzzleBoards, chessboards with three dots, other chessboards, grids of
/// circles; then markers by themselves. Ring codes are not among them.
///
/// Boards with markers are named as far as they are seen: with as many rows as it takes, from marker 0 unless those before the first would be in view. What is
/// named is what [`detect`] finds by that name in this image.
pub fn identify(image: &Image) -> Option<Identified> {
    let tags = tags(image);
    let of_tags = tags.as_ref().and_then(|tags| tags.board(image));
    if let Some((board, found)) = of_tags {
        let markers = tags.map_or_else(Vec::new, |tags| tags.ids());
        return Some(Identified::Board { board, points: found.points.len(), markers });
    }
    let plain = [puzzle, dotted, chessboard, circles].iter().find_map(|find| find(image));
    if let Some((board, found)) = plain {
        return Some(Identified::Board { board, points: found.points.len(), markers: Vec::new() });
    }
    let Tags { dictionary, form, .. } = tags.as_ref().filter(|tags| tags.are_sure())?;
    Some(Identified::Markers { dictionary: dictionary.name, border: form.border, ids: tags.as_ref().map_or_else(Vec::new, Tags::ids) })
}

fn puzzle(image: &Image) -> Option<(Board, Found)> {
    let any = Puzzle { columns: 6, rows: 6, square: 1.0, place: [0, 0], dot: Puzzle::DOT };
    match detect(image, &Board::Puzzle(any)) {
        Ok(found) => Some((Board::Puzzle(any), found)),
        Err(NotFound::OtherPlace { columns, rows, .. }) => {
            let span = |ends: [i32; 2]| Some((usize::try_from(ends[0]).ok()?, usize::try_from(ends[1] - ends[0] + 1).ok()?));
            let ((column, columns), (row, rows)) = (span(columns)?, span(rows)?);
            proved(image, Board::Puzzle(Puzzle { columns, rows, place: [column, row], ..any }))
        }
        Err(_) => None,
    }
}

fn dotted(image: &Image) -> Option<(Board, Found)> {
    let any = Dotted { columns: 4, rows: 4, square: 1.0, place: [1, 1], dot: Dotted::DOT };
    match detect(image, &Board::Dotted(any)) {
        Ok(found) => Some((Board::Dotted(any), found)),
        Err(NotFound::OtherCounts { columns, rows, .. }) => {
            // Counted from the dots, which are one square from the first column and row that were asked for.
            let place = [columns, rows].map(|ends| usize::try_from(2 - ends[0]).ok());
            let count = [columns, rows].map(|ends| usize::try_from(ends[1] - ends[0] + 1).ok());
            let ([Some(u), Some(v)], [Some(columns), Some(rows)]) = (place, count) else { return None };
            proved(image, Board::Dotted(Dotted { columns, rows, place: [u, v], ..any }))
        }
        Err(_) => None,
    }
}

fn chessboard(image: &Image) -> Option<(Board, Found)> {
    let any = Chessboard { columns: ANY[0], rows: ANY[1], square: 1.0 };
    match detect(image, &Board::Chessboard(any)) {
        Err(NotFound::NoChessboard { other: Some([columns, rows]), .. }) => {
            proved(image, Board::Chessboard(Chessboard { columns, rows, ..any }))
        }
        _ => None,
    }
}

/// A grid without marks, and then, if circles unlike the others tell which end is which, the one with them.
fn circles(image: &Image) -> Option<(Board, Found)> {
    let [columns, rows] = ANY_CIRCLES;
    let any = Circles { columns, rows, spacing: 1.0, diameter: 0.5, hole: None, asymmetric: false, marks: Marks::default() };
    let named = match detect(image, &Board::Circles(any)) {
        Err(NotFound::NoGrid { instead, .. } | NotFound::OtherRows { instead, .. } | NotFound::OtherMarks { instead, .. }) => instead?,
        _ => return None,
    };
    let (board, found) = proved(image, format!("{named}:1").parse().ok()?)?;
    let marked = found.doubts.iter().find_map(|doubt| match doubt {
        Doubt::Unlike { instead: Some(words), .. } => words.parse::<Board>().ok(),
        _ => None,
    });
    let marked = marked.and_then(|marked| proved(image, marked)).filter(|(_, with)| with.points.len() * 10 >= found.points.len() * 9);
    Some(marked.unwrap_or((board, found)))
}

impl Identified {
    /// In words.
    pub fn words(&self) -> String {
        match self {
            Self::Board { board, markers, .. } => {
                let of = |ids: &[u32]| match ids {
                    [] => String::new(),
                    [one] => format!(", marker {one}"),
                    [first, .., last] => format!(", {} markers from {first} to {last}", ids.len()),
                };
                format!("{}{}", described(board), of(markers))
            }
            Self::Markers { dictionary, border, ids } => {
                let ids = ids.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
                format!("markers of {dictionary} with frames {border} wide, on no board that is known: {ids}")
            }
        }
    }
}

/// Kind, counts, dictionary and pattern.
fn described(board: &Board) -> String {
    let marked = |circles: &Circles| if circles.marks.is_empty() { "" } else { ", some unlike the others" };
    match board {
        Board::Chessboard(board) => format!("a chessboard of {} x {} inner corners", board.columns, board.rows),
        Board::Charuco(board) => {
            let order = match (board.rows % 2, board.legacy) {
                (0, true) => "a light square at the upper left (legacy, as OpenCV had it before 4.6)",
                _ => "a dark square at the upper left",
            };
            format!("a ChArUco board of {} x {} squares, {order}, {}", board.columns, board.rows, board.dictionary.name)
        }
        Board::AprilGrid(board) => {
            let squares = if board.squares.is_some() { "with small squares" } else { "without small squares" };
            format!("an AprilGrid of {} x {} tags {squares}, {}", board.columns, board.rows, board.dictionary.name)
        }
        Board::GridBoard(board) => format!("a GridBoard of {} x {} markers, {}", board.columns, board.rows, board.dictionary.name),
        Board::Circles(board) => {
            let kind = if board.asymmetric { "an asymmetric" } else { "a symmetric" };
            format!("{kind} grid of {} x {} circles{}", board.columns, board.rows, marked(board))
        }
        Board::Rings(board) => format!("{} x {} ring codes", board.columns, board.rows),
        Board::Puzzle(board) => {
            let [column, row] = board.place;
            format!("a PuzzleBoard of {} x {} inner corners from {column},{row} of the pattern", board.columns, board.rows)
        }
        Board::Dotted(board) => format!("a chessboard of {} x {} inner corners with three dots", board.columns, board.rows),
    }
}
