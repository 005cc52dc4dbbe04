//! Boards as options write them.

use std::fmt;
use std::str::FromStr;

use super::{AprilGrid, Board, BoardError, Charuco, Chessboard, Circles, Dictionary, Dotted, GridBoard, Marks, Puzzle, Rings};

/// The kinds of board, how each is written, and an example.
pub const KINDS: [(&str, &str, &str); 9] = [
    ("chessboard", "COLUMNSxROWS:SQUARE", "chessboard:9x6:25"),
    ("charuco", "COLUMNSxROWS:SQUARE:MARKER:DICTIONARY[:FIRST][:legacy]", "charuco:8x5:30:21:DICT_4X4_50"),
    ("aprilgrid", "COLUMNSxROWS:TAG:SPACING[:FIRST][:border1][:plain]", "aprilgrid:6x6:0.088:0.3"),
    ("gridboard", "COLUMNSxROWS:MARKER:SEPARATION:DICTIONARY[:FIRST][:border2]", "gridboard:5x7:40:10:DICT_6X6_250"),
    ("circles", "COLUMNSxROWS:SPACING[:DIAMETER][:FORM@POINT,...]", "circles:7x5:20"),
    ("acircles", "COLUMNSxROWS:SPACING[:DIAMETER][:FORM@POINT,...]", "acircles:4x11:20"),
    ("rings", "BITS:COLUMNSxROWS:SPACING:DIAMETER", "rings:12:6x5:50:8"),
    ("puzzle", "COLUMNSxROWS:SQUARE[:X,Y]", "puzzle:23x16:30:50,100"),
    ("dotted", "COLUMNSxROWS:SQUARE[:X,Y]", "dotted:13x9:25:2,1"),
];

/// Examples of kinds whose forms differ in what finds them.
const MORE: [(&str, &str); 2] = [("circles", "circles:9x7:20:9:16@r7c1"), ("acircles", "acircles:5x9:20:14:14/7@r3c2,r7c2,r7c4")];

/// Every kind of board with an example, of some kinds two.
pub fn examples() -> impl Iterator<Item = (&'static str, &'static str)> {
    KINDS.into_iter().map(|(kind, _, example)| (kind, example)).chain(MORE)
}

impl FromStr for Board {
    type Err = BoardError;

    fn from_str(text: &str) -> Result<Self, BoardError> {
        let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
        let Some((_, form, example)) = KINDS.iter().find(|(name, ..)| *name == kind) else {
            let known = KINDS.map(|(name, ..)| name).join(", ");
            return Err(BoardError::Text(format!("`{kind}` is no kind of board: expected one of {known}")));
        };
        let mut parts = Parts { all: rest.split(':').filter(|part| !part.is_empty()).collect(), next: 0 };
        let board = match kind {
            "chessboard" => parts.chessboard(),
            "charuco" => parts.charuco(),
            "aprilgrid" => parts.aprilgrid(),
            "gridboard" => parts.gridboard(),
            "rings" => parts.rings(),
            "puzzle" => parts.puzzle(),
            "dotted" => parts.dotted(),
            _ => parts.circles(kind == "acircles"),
        };
        let wrong = |why: String| BoardError::Text(format!("`{text}`: {why}; expected {kind}:{form}, as in {example}"));
        let board = board.map_err(wrong)?;
        if let Some(more) = parts.all.get(parts.next) {
            return Err(wrong(format!("`{more}` is one too many")));
        }
        board.layout().map_err(|error| BoardError::Text(format!("`{text}`: {error}")))?;
        Ok(board)
    }
}

/// As options write it.
impl fmt::Display for Board {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.kind())?;
        match self {
            Self::Chessboard(Chessboard { columns, rows, square }) => write!(f, "{columns}x{rows}:{square}"),
            Self::Charuco(Charuco { columns, rows, square, marker, dictionary, first, legacy }) => {
                write!(f, "{columns}x{rows}:{square}:{marker}:{}", dictionary.name)?;
                optional(f, *first != 0, first)?;
                optional(f, *legacy, "legacy")
            }
            Self::AprilGrid(AprilGrid { columns, rows, tag, spacing, first, border, squares, .. }) => {
                write!(f, "{columns}x{rows}:{tag}:{spacing}")?;
                optional(f, *first != 0, first)?;
                optional(f, *border == 1, "border1")?;
                optional(f, squares.is_none(), "plain")
            }
            Self::GridBoard(GridBoard { columns, rows, marker, separation, dictionary, first, border }) => {
                write!(f, "{columns}x{rows}:{marker}:{separation}:{}", dictionary.name)?;
                optional(f, *first != 0, first)?;
                optional(f, *border == 2, "border2")
            }
            Self::Circles(Circles { columns, rows, spacing, diameter, marks, .. }) => {
                write!(f, "{columns}x{rows}:{spacing}:{diameter}{marks}")
            }
            Self::Rings(Rings { bits, columns, rows, spacing, diameter, .. }) => {
                write!(f, "{bits}:{columns}x{rows}:{spacing}:{diameter}")
            }
            Self::Puzzle(Puzzle { columns, rows, square, place: [x, y], .. }) => {
                write!(f, "{columns}x{rows}:{square}")?;
                optional(f, [*x, *y] != [0, 0], format_args!("{x},{y}"))
            }
            Self::Dotted(Dotted { columns, rows, square, place: [x, y], .. }) => {
                write!(f, "{columns}x{rows}:{square}")?;
                optional(f, [*x, *y] != Dotted::middle(*columns, *rows), format_args!("{x},{y}"))
            }
        }
    }
}

fn optional(f: &mut fmt::Formatter<'_>, is_there: bool, what: impl fmt::Display) -> fmt::Result {
    if is_there { write!(f, ":{what}") } else { Ok(()) }
}

/// The parts of a text between its colons.
struct Parts<'a> {
    all: Vec<&'a str>,
    next: usize,
}

impl<'a> Parts<'a> {
    fn take(&mut self, what: &str) -> Result<&'a str, String> {
        let part = self.all.get(self.next).copied().ok_or_else(|| format!("no {what}"))?;
        self.next += 1;
        Ok(part)
    }

    /// The next part, if it reads as a `T`.
    fn optional<T: FromStr>(&mut self) -> Option<T> {
        let read = self.all.get(self.next)?.parse().ok()?;
        self.next += 1;
        Some(read)
    }

    fn flag(&mut self, name: &str) -> bool {
        let found = self.all.get(self.next).is_some_and(|part| part.eq_ignore_ascii_case(name));
        self.next += usize::from(found);
        found
    }

    fn number<T: FromStr>(&mut self, what: &str) -> Result<T, String> {
        let part = self.take(what)?;
        part.parse().map_err(|_| format!("`{part}` is no {what}"))
    }

    fn counts(&mut self) -> Result<(usize, usize), String> {
        let part = self.take("count")?;
        let read = part.split_once(['x', 'X']).and_then(|(columns, rows)| Some((columns.parse().ok()?, rows.parse().ok()?)));
        read.ok_or_else(|| format!("`{part}` is no count of columns and rows"))
    }

    fn chessboard(&mut self) -> Result<Board, String> {
        let (columns, rows) = self.counts()?;
        Ok(Board::Chessboard(Chessboard { columns, rows, square: self.number("side of a square")? }))
    }

    fn charuco(&mut self) -> Result<Board, String> {
        let (columns, rows) = self.counts()?;
        let (square, marker) = (self.number("side of a square")?, self.number("side of a marker")?);
        let dictionary = self.dictionary()?;
        let (first, legacy) = (self.optional().unwrap_or(0), self.flag("legacy"));
        Ok(Board::Charuco(Charuco { columns, rows, square, marker, dictionary, first, legacy }))
    }

    fn dictionary(&mut self) -> Result<&'static Dictionary, String> {
        let name = self.take("dictionary")?;
        Dictionary::named(name).ok_or_else(|| format!("`{name}` is no dictionary ({})", Dictionary::names().collect::<Vec<_>>().join(", ")))
    }

    fn gridboard(&mut self) -> Result<Board, String> {
        let (columns, rows) = self.counts()?;
        let (marker, separation) = (self.number("side of a marker")?, self.number("separation")?);
        let dictionary = self.dictionary()?;
        let first = self.optional().unwrap_or(0);
        let border = if self.flag("border2") { 2 } else { 1 };
        Ok(Board::GridBoard(GridBoard { columns, rows, marker, separation, dictionary, first, border }))
    }

    fn aprilgrid(&mut self) -> Result<Board, String> {
        let (columns, rows) = self.counts()?;
        let (tag, spacing) = (self.number("side of a tag")?, self.number("spacing")?);
        let dictionary = Dictionary::named("DICT_APRILTAG_36h11").ok_or("no dictionary")?;
        let first = self.optional().unwrap_or(0);
        let border = if self.flag("border1") { 1 } else { 2 };
        let squares = (!self.flag("plain")).then_some(0.0);
        Ok(Board::AprilGrid(AprilGrid { columns, rows, tag, spacing, dictionary, first, border, squares }))
    }

    fn circles(&mut self, asymmetric: bool) -> Result<Board, String> {
        let (columns, rows) = self.counts()?;
        let spacing: f64 = self.number("spacing")?;
        let diameter = self.optional().unwrap_or(0.5 * spacing);
        let marks = Marks::read(&self.all[self.next..])?;
        self.next = self.all.len();
        Ok(Board::Circles(Circles { columns, rows, spacing, diameter, hole: None, asymmetric, marks }))
    }

    fn rings(&mut self) -> Result<Board, String> {
        let bits = self.number("number of sectors")?;
        let (columns, rows) = self.counts()?;
        let (spacing, diameter) = (self.number("spacing")?, self.number("diameter")?);
        Ok(Board::Rings(Rings { bits, columns, rows, spacing, diameter, ring: [2.0, 3.0], even: false, first: 1 }))
    }

    fn puzzle(&mut self) -> Result<Board, String> {
        let (columns, rows) = self.counts()?;
        let square = self.number("side of a square")?;
        let place = self.place("first corner in the pattern")?.unwrap_or([0, 0]);
        Ok(Board::Puzzle(Puzzle { columns, rows, square, place, dot: Puzzle::DOT }))
    }

    fn dotted(&mut self) -> Result<Board, String> {
        let (columns, rows) = self.counts()?;
        let square = self.number("side of a square")?;
        let place = self.place("square with the first dot")?.unwrap_or(Dotted::middle(columns, rows));
        Ok(Board::Dotted(Dotted { columns, rows, square, place, dot: Dotted::DOT }))
    }

    /// Two whole numbers with a comma between them, if there is one more part.
    fn place(&mut self, of: &str) -> Result<Option<[usize; 2]>, String> {
        let Some(part) = self.all.get(self.next) else { return Ok(None) };
        self.next += 1;
        let read = part.split_once(',').and_then(|(x, y)| Some([x.parse().ok()?, y.parse().ok()?]));
        read.map(Some).ok_or_else(|| format!("`{part}` is no place X,Y of the {of}"))
    }
}
