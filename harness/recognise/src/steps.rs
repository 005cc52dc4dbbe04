//! What recognition makes of an image on its way, as pictures.

use calibench_model::Image;

use crate::contour::follow;
use crate::error::NotRecognised;
use crate::grid;
use crate::ground::INSET;
use crate::level::Level;
use crate::normal::SIDE;
use crate::recogniser::Recogniser;
use crate::ridge::ridges;
use crate::square::Square;

/// Grey values of paper and ink in pictures of squares, fractions of full scale.
const PAPER: f32 = 0.9;
const INK: f32 = 0.1;

/// The steps of recognition, as figures 4 and 5 of the paper have them. Grey values are fractions of full scale.
#[derive(Clone, Debug)]
pub struct Steps {
    /// The whole squares as if seen from the front, as many pixels to a square as in the paper's normal image (60).
    pub normal: Image<'static>,
    /// One of them, enlarged by two (120 px).
    pub enlarged: Image<'static>,
    /// Its dark areas: ink is 0, paper 1.
    pub binary: Image<'static>,
    /// Their outer contours, black on white.
    pub contours: Image<'static>,
}

impl Recogniser {
    /// The steps for `image` as it is, and for the square that is nearest to the middle of all.
    ///
    /// # Errors
    /// An image without a grid or a whole square, as [`Self::recognise`].
    pub fn steps(&self, image: &Image) -> Result<Steps, NotRecognised> {
        let level = Level::of(image, 1);
        let grid = grid::find(&ridges(image)?, level.size())?;
        let inset = 0.5 * self.design.line + INSET;
        let whole = grid.whole(inset, level.size());
        let squares = self.squares(&level, &grid.adjusted.mapping, &whole, (inset * SIDE as f64).round() as usize);
        let middle = [0, 1].map(|axis| squares.iter().map(|square| square.at[axis]).sum::<i64>() / squares.len().max(1) as i64);
        let off = |square: &&Square| (0..2).map(|axis| (square.at[axis] - middle[axis]).abs()).sum::<i64>();
        let shown = squares.iter().min_by_key(off).ok_or(NotRecognised::NoWholeSquare)?;
        Ok(Steps { normal: normal(&squares), enlarged: enlarged(shown), binary: binary(shown), contours: contours(shown) })
    }
}

fn grey(dark: f32) -> f32 {
    PAPER - (PAPER - INK) * dark.clamp(-0.1, 1.1)
}

/// All squares side by side, each two pixels to one; white where there is none.
fn normal(squares: &[Square]) -> Image<'static> {
    let side = SIDE / 2;
    let range = |axis: usize| {
        let all = squares.iter().map(|square| square.at[axis]);
        (all.clone().min().unwrap_or(0), all.max().unwrap_or(0))
    };
    let [(left, right), (top, bottom)] = [range(0), range(1)];
    let [columns, rows] = [right - left + 1, bottom - top + 1].map(|count| count as usize * side);
    Image::from_fn(columns, rows, |x, y| {
        let at = [left + (x / side) as i64, top + (y / side) as i64];
        let Some(square) = squares.iter().find(|square| square.at == at) else { return 1.0 };
        let (x, y) = (2 * (x % side), 2 * (y % side));
        let dark = |x: usize, y: usize| square.normal.dark[y * SIDE + x];
        grey(0.25 * (dark(x, y) + dark(x + 1, y) + dark(x, y + 1) + dark(x + 1, y + 1)))
    })
}

fn enlarged(square: &Square) -> Image<'static> {
    Image::from_fn(SIDE, SIDE, |x, y| grey(square.normal.dark[y * SIDE + x]))
}

fn binary(square: &Square) -> Image<'static> {
    Image::from_fn(SIDE, SIDE, |x, y| f32::from(u8::from(square.areas.labels[y * SIDE + x] == 0)))
}

fn contours(square: &Square) -> Image<'static> {
    let mut black = vec![false; SIDE * SIDE];
    for [x, y] in (0..square.areas.areas.len()).flat_map(|area| follow(&square.areas, area)) {
        black[y as usize * SIDE + x as usize] = true;
    }
    Image::from_fn(SIDE, SIDE, |x, y| f32::from(u8::from(!black[y * SIDE + x])))
}
