//! The outlines of a picture, so that those that do not matter to a window are passed over whole.

use std::ops::Range;

use super::{Picture, Piece};

/// A picture whose outlines are known: there are far fewer of them than of their pieces.
#[derive(Clone, Debug)]
pub struct Outlined<'a> {
    /// What is to be rendered.
    pub picture: &'a Picture,
    outlines: Vec<Outline>,
}

/// Pieces of one contrast, each of which starts where the one before it ends.
#[derive(Clone, Debug)]
struct Outline {
    pieces: Range<usize>,
    extent: Extent,
    closed: bool,
}

/// What something reaches at most, px: low, high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    pub columns: [f64; 2],
    pub rows: [f64; 2],
}

impl Extent {
    pub fn of(piece: &Piece) -> Self {
        Self { columns: piece.columns(), rows: piece.rows() }
    }

    fn with(&self, other: &Self) -> Self {
        let both = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        Self { columns: both(self.columns, other.columns), rows: both(self.rows, other.rows) }
    }

    /// How far its farthest place is from (x, y), along a row or a column, px.
    pub fn farthest(&self, [x, y]: [f64; 2]) -> f64 {
        let far = |[low, high]: [f64; 2], from: f64| (low - from).abs().max((high - from).abs());
        far(self.rows, y).max(far(self.columns, x))
    }
}

impl<'a> Outlined<'a> {
    /// The outlines of `picture`.
    pub fn of(picture: &'a Picture) -> Self {
        let mut outlines: Vec<Outline> = Vec::new();
        for (index, piece) in picture.pieces.iter().enumerate() {
            let extent = Extent::of(piece);
            let goes_on = |outline: &Outline| picture.pieces[outline.pieces.end - 1].goes_on_in(piece);
            match outlines.last_mut().filter(|outline| goes_on(outline)) {
                Some(outline) => {
                    outline.pieces.end = index + 1;
                    outline.extent = outline.extent.with(&extent);
                }
                None => outlines.push(Outline { pieces: index..index + 1, extent, closed: false }),
            }
        }
        for outline in &mut outlines {
            outline.closed = picture.pieces[outline.pieces.start].points[0] == picture.pieces[outline.pieces.end - 1].points[4];
        }
        Self { picture, outlines }
    }

    /// The pieces of all outlines but those that `is_kept` says no of, and of closed ones those that `is_left` names.
    pub(crate) fn pieces(&self, is_left: impl Fn(&Extent) -> bool, is_kept: impl Fn(&Extent) -> bool) -> impl Iterator<Item = &'a Piece> {
        let seen = move |outline: &&Outline| is_kept(&outline.extent) && !(outline.closed && is_left(&outline.extent));
        let picture = self.picture;
        self.outlines.iter().filter(seen).flat_map(move |outline| &picture.pieces[outline.pieces.clone()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::piece::rectangle;

    #[test]
    fn outlines_are_told_by_their_contrast_and_their_ends() {
        let square = |x: f64, contrast: f64| rectangle(x, 3.0, contrast);
        let open = Piece::straight([30.0, 1.0], [40.0, 5.0], 0.5);
        let pieces: Vec<Piece> = square(0.0, 0.5).chain(square(0.0, 0.25)).chain(square(10.0, 0.25)).chain([open]).collect();
        let picture = Picture { width: 50, height: 9, background: 0.1, pieces };
        let outlined = Outlined::of(&picture);
        let found: Vec<_> = outlined.outlines.iter().map(|outline| (outline.pieces.clone(), outline.closed)).collect();
        assert_eq!(found, [(0..4, true), (4..8, true), (8..12, true), (12..13, false)]);
        // A straight piece may be a third of its length beyond its ends, by what is said of any.
        let third = 1.0 / 3.0;
        let Extent { columns, rows } = outlined.outlines[2].extent;
        assert!((columns[0] - 10.0 + 2.0 * third).abs() < 1e-12 && (columns[1] - 12.0 - 2.0 * third).abs() < 1e-12, "{columns:?}");
        assert!((rows[0] + 1.0).abs() < 1e-12 && (rows[1] - 4.0).abs() < 1e-12, "{rows:?}");
        // All of it counts, with whichever piece it begins.
        let upright = Picture { pieces: [&picture.pieces[9..12], &picture.pieces[8..9]].concat(), ..picture.clone() };
        assert_eq!(Outlined::of(&upright).outlines[0].extent, outlined.outlines[2].extent);
        assert_eq!(outlined.outlines[2].extent.farthest([11.0, 3.0]), 4.0);
        assert_eq!(outlined.outlines[2].extent.farthest([20.0, 3.0]), 10.0 + 2.0 * third);
        let of = |left: f64, kept: f64| -> Vec<Piece> {
            outlined.pieces(|extent| extent.columns[1] < left, |extent| extent.columns[0] < kept).copied().collect()
        };
        assert_eq!(of(f64::NEG_INFINITY, f64::INFINITY), picture.pieces);
        assert_eq!(of(5.0, f64::INFINITY), picture.pieces[8..]);
        // Of an open one the ends count, wherever they lie.
        assert_eq!(of(100.0, f64::INFINITY), [open]);
        assert_eq!(of(5.0, 20.0), picture.pieces[8..12]);
    }
}
