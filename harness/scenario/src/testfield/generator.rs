//! What makes a testfield.

use calibench_synth::testfield::{BoardSheet, Chessboard, Coded, House, Panels, Tags, Wall};

/// What makes the testfield.
#[derive(Clone, Debug, PartialEq)]
pub enum Generator {
    /// A chessboard.
    Chessboard(Chessboard),
    /// A wall, whose sheets are those of the panels, if any, after its own.
    Wall(Wall, Option<Panels>),
    /// The coded field.
    Coded(Coded),
    /// The house.
    House(House),
    /// A board with markers, circles or ring codes.
    Board(BoardSheet),
    /// Free-standing markers.
    Tags(Tags),
}
