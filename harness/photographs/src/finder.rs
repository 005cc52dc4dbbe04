//! Boards in photographs: their points in view as approximate positions that say what is pictured.

use std::path::PathBuf;

use calibench_detect::{FoundPoint, detect};
use calibench_model::boards::{Board, BoardError, BoardPoint, Layout};
use calibench_model::{ControlDisc, ControlRow, Image, PointRow, Start, TargetKind};
use rayon::prelude::*;

use crate::names::{names, once};
use crate::{PhotographsError, Reader};

/// A board and what finds it.
pub struct Finder {
    board: Board,
    layout: Layout,
}

/// What was found of a board in a photograph.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sighting {
    /// Its points in view, in the board's order.
    pub rows: Vec<PointRow>,
    /// Why there are none.
    pub why: Option<String>,
    /// What is in doubt about those that there are.
    pub doubts: Vec<String>,
}

impl Finder {
    /// What finds `board`.
    ///
    /// # Errors
    /// A board that cannot be.
    pub fn new(board: Board) -> Result<Self, BoardError> {
        Ok(Self { board, layout: board.layout()? })
    }

    /// What finds it, in records: name and version.
    pub const fn detector() -> (&'static str, &'static str) {
        ("detect", calibench_detect::VERSION)
    }

    /// Whether methods are told how large and how turned a point is pictured: of a chessboard they find out.
    pub(crate) const fn tells_size(&self) -> bool {
        !matches!(self.board, Board::Chessboard(_))
    }

    /// How many points the board has.
    pub fn count(&self) -> usize {
        self.layout.points.len()
    }

    /// What its points are.
    pub fn kind(&self) -> TargetKind {
        self.layout.points[0].kind
    }

    /// The method that measures them unless another is asked for.
    pub fn usual_method(&self) -> &'static str {
        if self.kind() == TargetKind::Disc { "ellipse_edges" } else { "parametric_corner" }
    }

    /// Its points, object units: X to the right, Y upwards, Z towards the viewer; of discs their radius and plane, too.
    pub fn control(&self) -> Vec<ControlRow> {
        let disc = |point: &BoardPoint| {
            let disc = ControlDisc { radius: 0.5 * point.size, normal: Some([0.0, 0.0, 1.0]) };
            (point.kind == TargetKind::Disc).then(|| Box::new(disc))
        };
        let row =
            |point: &BoardPoint| ControlRow { disc: disc(point), ..ControlRow::new(point.id.clone(), [point.at[0], point.at[1], 0.0]) };
        self.layout.points.iter().map(row).collect()
    }

    /// The board in photographs, in their order; `step` is called after each, on any thread.
    ///
    /// # Errors
    /// A photograph that cannot be read, or that is given twice.
    pub fn find_all(&self, reader: &Reader, step: &(dyn Fn() + Sync)) -> Result<Vec<Sighting>, PhotographsError> {
        let photos = reader.photos();
        once(photos)?;
        let one = |(path, name): (&PathBuf, &String)| {
            let found = self.find(&reader.read(path)?, name);
            step();
            Ok(found)
        };
        photos.par_iter().zip(&names(photos)).map(one).collect()
    }

    /// The board in the photograph `name`.
    pub fn find(&self, image: &Image, name: &str) -> Sighting {
        let found = match detect(image, &self.board) {
            Ok(found) => found,
            Err(why) => return Sighting { why: Some(why.to_string()), ..Sighting::default() },
        };
        let row = |point: &FoundPoint| PointRow {
            image: name.to_owned(),
            target: self.layout.points[point.index].id.clone(),
            start: Start { kind: Some(self.layout.points[point.index].kind), affine: Some(point.affine), ..Start::at(point.position) },
        };
        let doubts = found.doubts.iter().map(ToString::to_string).collect();
        Sighting { rows: found.points.iter().map(row).collect(), why: None, doubts }
    }
}
