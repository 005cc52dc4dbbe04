//! The map of the uncertainty over the frame, and its values at chosen places.

use super::table::{self, Column, Side};
use super::{LEFT, NOTE, RIGHT, SMALL, Told};
use crate::answer::Size;
use crate::digits::three;
use crate::document::{GREY, INK, Paper, Style};
use crate::record::FrameRecord;

/// The most that the map is wide and high, points.
const WIDE: f64 = 176.0;
const HIGH: f64 = 132.0;
/// Light to dark, readable in grey and without colour vision.
const SHADES: [[f64; 3]; 8] = [
    [0.97, 0.97, 0.90],
    [0.85, 0.92, 0.72],
    [0.66, 0.85, 0.58],
    [0.43, 0.74, 0.55],
    [0.25, 0.58, 0.56],
    [0.20, 0.42, 0.55],
    [0.24, 0.24, 0.50],
    [0.27, 0.00, 0.33],
];

/// The first of a series 1, 2, 5, 10, ... that is at least a number.
fn round_up(value: f64) -> f64 {
    let decade = 10_f64.powf(value.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|step| step * decade).find(|round| *round >= value * 0.999_999).unwrap_or(10.0 * decade)
}

/// The upper bounds of the classes of colour, px: eight at most, the last without a bound above it.
fn classes(sigmas: &[Option<f64>]) -> Vec<f64> {
    let known = || sigmas.iter().flatten().copied().filter(|sigma| sigma.is_finite() && *sigma > 0.0);
    let (least, most) = (known().fold(f64::INFINITY, f64::min), known().fold(0.0, f64::max));
    if most <= 0.0 {
        return Vec::new();
    }
    let mut bounds = vec![round_up(least)];
    while bounds.len() < SHADES.len() && bounds.last().is_some_and(|last| *last < most) {
        let next = bounds.last().map_or(most, |last| round_up(last * 1.5));
        bounds.push(next);
    }
    bounds
}

fn class(bounds: &[f64], sigma: f64) -> usize {
    bounds.iter().position(|bound| sigma <= *bound).unwrap_or(bounds.len().saturating_sub(1))
}

/// The map at the left, its places at the right; returns where the next begins.
pub(super) fn write(paper: &mut Paper, y: f64, told: &Told<'_>, size: &Size) -> f64 {
    let frame = told.certificate.record.cameras.get(told.certificate.camera).and_then(|camera| camera.frame.as_ref());
    let Some(frame) =
        frame.filter(|frame| frame.grid.iter().product::<usize>() == frame.sigma_px.len() && frame.measured.len() == frame.sigma_px.len())
    else {
        paper.write([LEFT, y], SMALL, "The interior orientation was not adjusted: there is no map.");
        return y + 12.0;
    };
    let scale = (WIDE / f64::from(size.width)).min(HIGH / f64::from(size.height));
    let drawn = [f64::from(size.width) * scale, f64::from(size.height) * scale];
    let top = y - 6.0;
    let bounds = classes(&frame.sigma_px);
    map(paper, [LEFT, top], drawn, frame, &bounds);
    legend(paper, [LEFT + drawn[0] + 8.0, top], &bounds);
    let below = places(paper, y, told, frame);
    below.max(top + drawn[1] + 10.0)
}

fn map(paper: &mut Paper, at: [f64; 2], drawn: [f64; 2], frame: &FrameRecord, bounds: &[f64]) {
    let [columns, rows] = frame.grid;
    let cell = [drawn[0] / columns as f64, drawn[1] / rows as f64];
    let place = |column: usize, row: usize| [at[0] + column as f64 * cell[0], at[1] + row as f64 * cell[1]];
    let shade = |column: usize, row: usize| frame.sigma_px[row * columns + column].map(|sigma| class(bounds, sigma));
    for row in 0..rows {
        let mut from = 0;
        for column in 1..=columns {
            if column < columns && shade(column, row) == shade(from, row) {
                continue;
            }
            if let Some(class) = shade(from, row) {
                // A little wider than its cells, so that nothing shines through between them.
                let size = [(column - from) as f64 * cell[0], (cell[1] + 0.15).min(at[1] + drawn[1] - place(0, row)[1])];
                paper.fill(place(from, row), size, SHADES[class.min(SHADES.len() - 1)]);
            }
            from = column;
        }
    }
    // The edge of what was measured.
    let inside = |column: usize, row: usize| frame.measured[row * columns + column];
    for row in 0..rows {
        for column in 0..columns {
            if column + 1 < columns && inside(column, row) != inside(column + 1, row) {
                paper.line(place(column + 1, row), place(column + 1, row + 1), (0.8, INK));
            }
            if row + 1 < rows && inside(column, row) != inside(column, row + 1) {
                paper.line(place(column, row + 1), place(column + 1, row + 1), (0.8, INK));
            }
        }
    }
    let [left, top] = at;
    let (right, bottom) = (left + drawn[0], top + drawn[1]);
    for (from, to) in
        [([left, top], [right, top]), ([right, top], [right, bottom]), ([right, bottom], [left, bottom]), ([left, bottom], [left, top])]
    {
        paper.line(from, to, (0.6, GREY));
    }
}

fn legend(paper: &mut Paper, [x, y]: [f64; 2], bounds: &[f64]) {
    paper.write([x, y + 6.0], NOTE, "u, px");
    for (index, bound) in bounds.iter().enumerate() {
        let top = y + 11.0 + 11.0 * index as f64;
        paper.fill([x, top], [10.0, 8.5], SHADES[index]);
        let is_last = index + 1 == bounds.len() && index + 1 == SHADES.len();
        let words = if is_last {
            format!("> {}", bounds.get(index.saturating_sub(1)).map_or(0.0, |below| *below))
        } else {
            format!("\u{2264} {bound}")
        };
        paper.write([x + 14.0, top + 7.0], SMALL, &words);
    }
}

fn places(paper: &mut Paper, y: f64, told: &Told<'_>, frame: &FrameRecord) -> f64 {
    let budget = told.budget;
    let left = LEFT + WIDE + 64.0;
    let columns: [Column<'_>; 6] = [
        ("place", Side::Left, left, 78.0),
        ("x", Side::Right, left + 104.0, 26.0),
        ("y", Side::Right, left + 131.0, 26.0),
        ("u adjusted", Side::Right, left + 176.0, 42.0),
        ("u combined", Side::Right, left + 222.0, 44.0),
        ("U", Side::Right, RIGHT, 32.0),
    ];
    let mut y = table::head(paper, y, &columns, ([left, RIGHT], table::ROW));
    for place in &frame.places {
        let numbers = place.sigma_px.map_or(["no ray", "", ""].map(str::to_owned), |sigma| {
            let combined = sigma * budget.beyond;
            [sigma, combined, budget.k * combined].map(three)
        });
        let mark = if place.measured { "" } else { " *" };
        let at = [place.x, place.y].map(|at| format!("{at:.0}"));
        let cells: Vec<String> = [format!("{}{mark}", place.name)].into_iter().chain(at).chain(numbers).collect();
        y = table::row(paper, y, &columns, (SMALL, table::ROW), &cells);
    }
    if frame.places.iter().any(|place| !place.measured) {
        paper.write(
            [left, y],
            Style { size: 6.5, ..NOTE },
            "* outside of the measured points (line in the map): extrapolated by the model alone",
        );
        y += table::ROW;
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_round_and_hold_all() {
        assert_eq!([0.012, 0.02, 0.5, 7.0].map(round_up), [0.02, 0.02, 0.5, 10.0]);
        let found = classes(&[Some(0.03), None, Some(0.4)]);
        assert_eq!(found, [0.05, 0.1, 0.2, 0.5]);
        assert_eq!([0.03, 0.05, 0.06, 0.4, 9.0].map(|sigma| class(&found, sigma)), [0, 0, 1, 3, 3]);
        assert_eq!(classes(&[Some(1e-6), Some(1e6)]).len(), SHADES.len());
        assert!(classes(&[None]).is_empty());
    }
}
