//! Boards in photographs: their points in view as approximate positions that say what is pictured.

use std::path::PathBuf;

use calibench_detect::{Doubt, Found, FoundPoint, detect, detect_all, seen_several, warps};
use calibench_model::boards::{Board, BoardError, BoardPoint, Layout};
use calibench_model::camera::ImageSize;
use calibench_model::views::{photo_of, view_of};
use calibench_model::{ControlDisc, ControlRow, Image, PointRow, Start, TargetKind, Warp};
use rayon::prelude::*;

use crate::names::{names, once};
use crate::{PhotographsError, Reader};

/// A board and what finds it.
pub struct Finder {
    board: Board,
    layout: Layout,
    /// Whether each of several boards in a photograph counts, as a view of its own.
    each: bool,
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
    /// Whether they are circles lighter than what is around them.
    pub light: bool,
    /// How many points of each of several boards are seen, from the left; of one board none is counted.
    pub boards: Vec<usize>,
}

impl Finder {
    /// What finds `board`.
    ///
    /// # Errors
    /// A board that cannot be.
    pub fn new(board: Board) -> Result<Self, BoardError> {
        Ok(Self { board, layout: board.layout()?, each: false })
    }

    /// It, finding each of several such boards in a photograph as a view of its own, called as [`view_of`] has it: they are told apart in a photograph, from the
    /// left, and not from one photograph to the next.
    #[must_use]
    pub fn of_each(self, each: bool) -> Self {
        Self { each, ..self }
    }

    /// Whether each of several boards in a photograph counts.
    pub const fn is_of_each(&self) -> bool {
        self.each
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
        match self.kind() {
            TargetKind::Disc => "ellipse_edges",
            TargetKind::Corner => "parametric_junction:arms=2",
            _ => "parametric_corner",
        }
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
        if self.each {
            return match detect_all(image, &self.board) {
                Ok(all) => self.sighting((&all, image), |board| view_of(name, board + 1)),
                Err(why) => Sighting { why: Some(why.to_string()), ..Sighting::default() },
            };
        }
        let said = detect(image, &self.board);
        let boards = seen_several(image, &self.board, &said).unwrap_or_default();
        let several = Some(Doubt::Several { points: boards.clone() }).filter(|_| boards.len() > 1);
        match said {
            Ok(mut found) => {
                found.doubts.extend(several);
                Sighting { boards, ..self.sighting((&[found], image), |_| name.to_owned()) }
            }
            Err(why) => {
                let why = several.map_or_else(|| why.to_string(), |several| format!("{several}: {why}"));
                Sighting { why: Some(why), boards, ..Sighting::default() }
            }
        }
    }

    /// What a point is called in its photograph, by its board where each counts.
    pub(crate) fn key(&self, row: &PointRow) -> String {
        let board = photo_of(&row.image).filter(|_| self.each).map_or("", |photo| &row.image[photo.len()..]);
        format!("{}{board}", row.target)
    }

    fn sighting(&self, (all, image): (&[Found], &Image), view: impl Fn(usize) -> String) -> Sighting {
        let size = ImageSize { width: image.width() as u32, height: image.height() as u32 };
        let row = |(board, point, warp): (usize, &FoundPoint, Option<Warp>)| {
            let place = &self.layout.points[point.index];
            let start = Start { kind: Some(place.kind), affine: Some(point.affine), warp, ..Start::at(point.position) };
            PointRow { image: view(board), target: place.id.clone(), start }
        };
        let points = all.iter().enumerate().flat_map(|(board, found)| {
            found.points.iter().zip(warps(&self.layout, found, size)).map(move |(point, warp)| (board, point, warp))
        });
        Sighting {
            rows: points.map(row).collect(),
            why: None,
            doubts: all.iter().flat_map(|found| &found.doubts).map(ToString::to_string).collect(),
            light: all.iter().any(|found| found.light),
            boards: if self.each { all.iter().map(|found| found.points.len()).collect() } else { Vec::new() },
        }
    }
}
