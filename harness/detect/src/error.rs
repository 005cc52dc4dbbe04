//! Why an image does not show the board.

use calibench_model::boards::BoardError;
use thiserror::Error;

/// Why an image does not show the board, or not so that its points can be numbered.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NotFound {
    /// A board that cannot be.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// No chessboard of these counts that is seen whole.
    #[error("no board of {columns} x {rows} inner corners found{}", seen(*other))]
    NoChessboard {
        /// Inner corners in a row.
        columns: usize,
        /// Rows of them.
        rows: usize,
        /// The inner corners along both sides of a board that is seen whole instead, the larger number first.
        other: Option<[usize; 2]>,
    },
    /// An image of no use for its size.
    #[error("the image has {width} x {height} px: expected at least {least} px a side")]
    TooSmall {
        /// Columns, px.
        width: usize,
        /// Rows, px.
        height: usize,
        /// The least of both, px.
        least: usize,
    },
    /// No marker of any dictionary.
    #[error("no marker of {dictionary} is seen; {frames} dark frames with cells in them are, which belong to no dictionary")]
    NoMarker {
        /// The board's dictionary.
        dictionary: &'static str,
        /// Dark frames of the right width with cells in them.
        frames: usize,
    },
    /// Markers of another dictionary.
    #[error("{seen} markers of {other} are seen, and {fitting} of {dictionary}, which the board has")]
    OtherDictionary {
        /// The dictionary of most markers; of several, one.
        other: &'static str,
        /// Its markers.
        seen: usize,
        /// The board's dictionary.
        dictionary: &'static str,
        /// Markers of it.
        fitting: usize,
    },
    /// Markers whose frames are wider or narrower than the board's.
    #[error("{seen} markers of {dictionary} are seen with frames {border} cells wide: the board's are {expected} wide")]
    OtherFrames {
        /// The board's dictionary.
        dictionary: &'static str,
        /// Such markers.
        seen: usize,
        /// The width of their frames, cells.
        border: usize,
        /// The width of the board's, cells.
        expected: usize,
    },
    /// Markers of the board's dictionary that the board does not have.
    #[error("markers {seen:?} of {dictionary} are seen: the board has {first} to {last}{}", as_on(instead.as_deref()))]
    OtherIds {
        /// The dictionary.
        dictionary: &'static str,
        /// Their ids, ascending.
        seen: Vec<u32>,
        /// The board's lowest id.
        first: u32,
        /// The board's highest id.
        last: u32,
        /// The board of such markers that is there, in words; its rows as far as they are seen.
        instead: Option<String>,
    },
    /// The board's mirror image.
    #[error("the image is mirrored: {markers} marks are those of the board when read in a mirror")]
    Mirrored {
        /// Marks that can be read so.
        markers: usize,
    },
    /// Marks in the board's order, at other distances.
    #[error("another board: the distances of its marks are {times:.3} times those of the board, measured in the size of a mark")]
    OtherSpacing {
        /// By how much they are larger, in the median.
        times: f64,
    },
    /// Marks in another order than the board's.
    #[error(
        "another board: of {marks} marks that were read {together} stand to each other as the board has them; the image is of a board with other rows and \
         columns, in another order (legacy or not), or of several boards{}",
        as_on(instead.as_deref())
    )]
    OtherArrangement {
        /// Marks of the board's ids.
        marks: usize,
        /// The most of them that agree with each other.
        together: usize,
        /// The board of such marks that is there, in words; its rows as far as they are seen.
        instead: Option<String>,
    },
    /// Markers without the chessboard.
    #[error(
        "{markers} markers are seen, and {corners} of the {expected} corners of squares beside them: not this board, or too blurred or covered"
    )]
    NoCorners {
        /// Markers that were read.
        markers: usize,
        /// Corners of squares that were found.
        corners: usize,
        /// Corners that should be seen beside them.
        expected: usize,
    },
    /// No grid of circles of the board's rows and columns.
    #[error(
        "{round} round areas are seen, and the largest grid of them has {largest}: expected a whole grid of {expected}{}",
        instead.as_deref().map_or_else(String::new, |board| format!("; the grid is whole as one of {board}"))
    )]
    NoGrid {
        /// Round areas.
        round: usize,
        /// Those of the largest grid.
        largest: usize,
        /// The board's.
        expected: usize,
        /// The kind and counts that the grid has if it is whole.
        instead: Option<String>,
    },
    /// A grid of as many circles, in other rows and columns.
    #[error(
        "{circles} circles are seen in a grid, as many as the board has, and in other rows and columns{}",
        instead.as_deref().map_or_else(String::new, |board| format!(": it is whole as one of {board}"))
    )]
    OtherRows {
        /// Its circles.
        circles: usize,
        /// The kind and counts that the grid has if it is whole.
        instead: Option<String>,
    },
    /// A grid whose circles unlike the others are not where the board has them.
    #[error(
        "{circles} circles are seen in a grid; those unlike the others are not where the board has them, or too small to be told{}",
        instead.as_deref().map_or_else(String::new, |board| format!(": without them it is whole as one of {board}"))
    )]
    OtherMarks {
        /// Its circles.
        circles: usize,
        /// The kind and counts that the grid has if it is whole.
        instead: Option<String>,
    },
    /// A part of a grid that may be several parts of the board.
    #[error(
        "{circles} circles of {expected} are seen in a grid: too few, or too little of those that are unlike the others, to be sure which part of the board it is"
    )]
    UnsurePart {
        /// Its circles.
        circles: usize,
        /// The board's.
        expected: usize,
    },
    /// A grid whose circles stand where no smooth surface has them.
    #[error(
        "{circles} circles are seen in a grid, up to {by:.2} of their distance off where their neighbours have them: no flat board in one lens"
    )]
    BentGrid {
        /// Its circles.
        circles: usize,
        /// How far, in distances of neighbours.
        by: f64,
    },
    /// A grid of areas of many sizes.
    #[error(
        "{circles} round areas are seen in a grid, {unlike} of them larger or smaller than the others: no board whose circles are alike"
    )]
    OtherSizes {
        /// Its areas.
        circles: usize,
        /// Those of other sizes.
        unlike: usize,
    },
    /// No ring code of the board.
    #[error(
        "{round} round areas are seen, and {codes} of them have ring codes of {bits} sectors; the board's are not among them, or too few to be sure of"
    )]
    NoCode {
        /// Round areas.
        round: usize,
        /// Those with a ring of sectors.
        codes: usize,
        /// The board's sectors.
        bits: usize,
    },
    /// No chessboard with dots, or too few of them to tell a place from.
    #[error(
        "{corners} corners of squares with {dots} dots between them are seen together: no PuzzleBoard, or too little of it to be sure of its place"
    )]
    NoPuzzle {
        /// Corners of the grid with most dots.
        corners: usize,
        /// Dots between them that can be read.
        dots: usize,
    },
    /// No grid of corners with the three dots of the board.
    #[error(
        "{corners} corners of squares are seen together, {dots} of their squares with a dot, and nowhere three as the board has them: its dots are hidden, too \
         small or too blurred, or it is another board"
    )]
    NoDots {
        /// Corners of the largest grid.
        corners: usize,
        /// Its squares with a dot.
        dots: usize,
    },
    /// A chessboard with the three dots and corners that the board does not have.
    #[error(
        "another board: counted from its dots the columns {} to {} and rows {} to {} of inner corners are seen, the board has 1 to {} and 1 to {}",
        columns[0], columns[1], rows[0], rows[1], asked[0], asked[1]
    )]
    OtherCounts {
        /// The first and the last column that is seen.
        columns: [i32; 2],
        /// The first and the last row.
        rows: [i32; 2],
        /// The board's columns and rows.
        asked: [usize; 2],
    },
    /// Dots that belong to no place of the pattern.
    #[error(
        "another pattern: the place of the PuzzleBoard that fits best has {agreeing} of {dots} different dots that are seen, no more than chance; the board \
         has other codes, or too many dots are hidden"
    )]
    OtherDots {
        /// Dots that were read, those that repeat counted once.
        dots: usize,
        /// Those that the best place has.
        agreeing: usize,
    },
    /// Dots that belong to one place of the pattern a little better than to others.
    #[error(
        "{agreeing} of {dots} different dots belong to one place of the PuzzleBoard, and nearly as many to another: too few are seen to be sure"
    )]
    UnsurePlace {
        /// Dots that were read, those that repeat counted once.
        dots: usize,
        /// Those that the best place has.
        agreeing: usize,
    },
    /// Another part of the pattern than the board's.
    #[error(
        "another board: the columns {} to {} and rows {} to {} of the PuzzleBoard's corners are seen, the board has {} to {} and {} to {}",
        columns[0], columns[1], rows[0], rows[1], asked[0][0], asked[0][1], asked[1][0], asked[1][1]
    )]
    OtherPlace {
        /// The first and the last column that is seen, counted in the pattern.
        columns: [i32; 2],
        /// The first and the last row.
        rows: [i32; 2],
        /// Those of the board: columns, rows.
        asked: [[usize; 2]; 2],
    },
}

/// The board on which marks stand as they do.
fn as_on(board: Option<&str>) -> String {
    board.map_or_else(String::new, |board| format!(": they stand as on {board}"))
}

/// What is seen in place of the board.
fn seen(other: Option<[usize; 2]>) -> String {
    other.map_or_else(String::new, |[long, short]| format!(": one of {long} x {short} is seen"))
}

impl NotFound {
    /// The reason's name in files.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Board(_) => "board",
            Self::NoChessboard { .. } => "no_chessboard",
            Self::TooSmall { .. } => "too_small",
            Self::NoMarker { .. } => "no_marker",
            Self::OtherDictionary { .. } => "other_dictionary",
            Self::OtherFrames { .. } => "other_frames",
            Self::OtherIds { .. } => "other_ids",
            Self::Mirrored { .. } => "mirrored",
            Self::OtherSpacing { .. } => "other_spacing",
            Self::OtherArrangement { .. } => "other_arrangement",
            Self::NoCorners { .. } => "no_corners",
            Self::NoGrid { .. } => "no_grid",
            Self::OtherRows { .. } => "other_rows",
            Self::OtherMarks { .. } => "other_marks",
            Self::UnsurePart { .. } => "unsure_part",
            Self::BentGrid { .. } => "bent_grid",
            Self::OtherSizes { .. } => "other_sizes",
            Self::NoCode { .. } => "no_code",
            Self::NoPuzzle { .. } => "no_puzzle",
            Self::NoDots { .. } => "no_dots",
            Self::OtherCounts { .. } => "other_counts",
            Self::OtherDots { .. } => "other_dots",
            Self::UnsurePlace { .. } => "unsure_place",
            Self::OtherPlace { .. } => "other_place",
        }
    }
}
