//! What an image shows before anything is decided: the grid, its whole squares and their dark areas.

use crate::bank::Bank;
use crate::blobs::Areas;
use crate::error::NotRecognised;
use crate::grid::{self, Grid};
use crate::level::Level;
use crate::mapping::Mapping;
use crate::normal::{Normal, SIDE};
use crate::recogniser::Recogniser;
use crate::ridge::{Ridge, ridges};
use crate::sharpness::blur;
use crate::square::Square;

/// What lies nearer to the middle of a line than its half width and this, in squares, is the line's.
pub(crate) const INSET: f64 = 0.011;
/// The least contrast of a square, as a share of the best one's.
const CONTRAST: f64 = 0.3;
/// Dark areas smaller than this share of the smallest target are none.
const SMALLEST: f64 = 0.2;

/// The grid in one of the sizes of an image, the same for all classifiers of one design.
pub(crate) struct Ground<'a> {
    pub level: Level<'a>,
    pub points: Vec<Ridge>,
    pub grid: Grid,
    /// Whole squares of enough contrast, nothing decided.
    pub squares: Vec<Square>,
    /// The side of a square in the mean, px of the level.
    pub side: f64,
    /// Of the grid's lines, px of the level.
    pub blur: f64,
    /// The drawings under this blur.
    pub bank: Bank,
}

impl Recogniser {
    /// The grid in `level`.
    pub(crate) fn ground<'a>(&self, level: Level<'a>) -> Result<Ground<'a>, NotRecognised> {
        let points = ridges(&level.image)?;
        let grid = grid::find(&points, level.size())?;
        let mapping = &grid.adjusted.mapping;
        let inset = 0.5 * self.design.line + INSET;
        let whole = grid.whole(inset, level.size());
        if whole.is_empty() {
            return Err(NotRecognised::NoWholeSquare);
        }
        let mut squares = self.squares(&level, mapping, &whole, (inset * SIDE as f64).round() as usize);
        let contrast = squares.iter().map(|square| square.normal.contrast).fold(0.0, f64::max);
        squares.retain(|square| square.normal.contrast >= CONTRAST * contrast);
        let (side, sides) = side(mapping, &squares);
        let blur = blur(&level.image, &grid, self.design.line, contrast);
        let bank = self.bank.blurred(sides.map(|side| blur * SIDE as f64 / side));
        Ok(Ground { level, points, grid, squares, side, blur, bank })
    }

    pub(crate) fn squares(&self, level: &Level<'_>, mapping: &Mapping, whole: &[[i64; 2]], inset: usize) -> Vec<Square> {
        let least = SMALLEST * self.design.smallest() * (SIDE * SIDE) as f64;
        let square = |&at: &[i64; 2]| {
            let normal = Normal::of(&level.image, mapping, at)?;
            let areas = Areas::of(&normal, inset, least);
            Some(Square { at, normal, areas, decisions: None })
        };
        whole.iter().filter_map(square).collect()
    }
}

/// The side of a square in the mean of the squares, px; that along x and that along y of the grid.
fn side(mapping: &Mapping, squares: &[Square]) -> (f64, [f64; 2]) {
    let middle = |square: &Square| mapping.by_grid(square.at.map(|v| v as f64 + 0.5));
    let all: Vec<[f64; 2]> = squares.iter().filter_map(middle).map(|by| [by.column(0).norm(), by.column(1).norm()]).collect();
    let mean = [0, 1].map(|i| all.iter().map(|sides| sides[i]).sum::<f64>() / all.len().max(1) as f64);
    ((mean[0] * mean[1]).sqrt(), mean.map(|side| side.max(1.0)))
}
