//! What strokes are together: what is drawn row by row, pixel by pixel or by short lines is one thing to a drawing of lines.

use plotters_backend::{BackendColor, BackendCoord};

use super::Stroke;

/// Rows of a scale of colours that are drawn as one.
pub(crate) const STEP: usize = 6;

/// Some strokes in a row.
pub(crate) enum Run<'s> {
    /// The rows of a scale of colours, one below the other.
    Scale(&'s [Stroke]),
    /// Single pixels: an image.
    Dots(&'s [Stroke]),
    /// Any other stroke.
    One(&'s Stroke),
}

/// All strokes, in their order.
pub(crate) fn runs(strokes: &[Stroke]) -> impl Iterator<Item = Run<'_>> {
    let mut rest = strokes;
    std::iter::from_fn(move || {
        let first = rest.first()?;
        let (rows, dots) = (scale(rest), rest.iter().take_while(|one| matches!(one, Stroke::Dots(..))).count());
        let (run, after) = rest.split_at(rows.max(dots));
        rest = after;
        Some(if rows > 1 {
            Run::Scale(run)
        } else if dots > 0 {
            Run::Dots(run)
        } else {
            Run::One(first)
        })
    })
}

/// A line along a row: left, right, row and colour.
pub(crate) fn row(stroke: &Stroke) -> Option<(i32, i32, i32, BackendColor)> {
    let (from, to, pen) = match stroke {
        Stroke::Line([from, to], pen) => (*from, *to, pen),
        Stroke::Path(path, pen) if path.len() == 2 => (path[0], path[1], pen),
        _ => return None,
    };
    (from.1 == to.1 && pen.width == 1).then_some((from.0.min(to.0), from.0.max(to.0), from.1, pen.colour))
}

/// How many strokes from the first on are the rows of a scale of colours, one below the other; 1 if it is none.
fn scale(strokes: &[Stroke]) -> usize {
    let Some((left, right, first, _)) = row(&strokes[0]) else { return 1 };
    let follows = |(place, stroke): (i32, &Stroke)| row(stroke).is_some_and(|(l, r, y, _)| (l, r, y) == (left, right, first + place));
    let rows = (0..).zip(strokes).take_while(|one| follows(*one)).count();
    if rows > STEP { rows } else { 1 }
}

/// The centre and the radius of a mark that is drawn as a circle of short lines.
pub(crate) fn ring(path: &[BackendCoord]) -> Option<(BackendCoord, u32)> {
    const LEAST: usize = 20;
    if path.len() < LEAST || path.first() != path.last() {
        return None;
    }
    let ends = |of: fn(&BackendCoord) -> i32| Some((path.iter().map(of).min()?, path.iter().map(of).max()?));
    let ((left, right), (top, bottom)) = (ends(|at| at.0)?, ends(|at| at.1)?);
    let (x, y, radius) = ((left + right) / 2, (top + bottom) / 2, (right - left) / 2);
    let near = |(px, py): &BackendCoord| (f64::from(px - x).hypot(f64::from(py - y)) - f64::from(radius)).abs() < 0.75;
    (right - left == bottom - top && path.iter().all(near)).then_some(((x, y), radius as u32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_of_short_lines_is_a_circle_and_no_other_shape_is() {
        let round = |r: f64, squeeze: f64| -> Vec<BackendCoord> {
            let at = |k: i32| f64::from(k) * std::f64::consts::TAU / 24.0;
            (0..=24).map(|k| (50 + (r * at(k).cos()).round() as i32, 60 + (squeeze * r * at(k).sin()).round() as i32)).collect()
        };
        assert_eq!(ring(&round(6.0, 1.0)), Some(((50, 60), 6)));
        assert_eq!(ring(&round(20.0, 0.8)), None);
        assert_eq!(ring(&round(6.0, 1.0)[..24]), None);
        assert_eq!(ring(&[(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)]), None);
    }
}
