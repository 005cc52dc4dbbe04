//! Tables.

use super::{RULE, SMALL};
use crate::document::{Paper, Style};

/// Which side of a column its cells are at.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Side {
    Left,
    Right,
}

/// A column: its title, where its side is, points, and how much room its cells have.
pub(super) type Column<'a> = (&'a str, Side, f64, f64);

/// Height of a row, points.
pub(super) const ROW: f64 = 10.2;

/// Writes the titles above rows of a height; returns where the first begins.
pub(super) fn head(paper: &mut Paper, y: f64, columns: &[Column<'_>], (ends, height): ([f64; 2], f64)) -> f64 {
    for (title, side, x, _) in columns {
        put(paper, [*x, y], Style { bold: true, ..SMALL }, *side, title);
    }
    paper.line([ends[0], y + 3.0], [ends[1], y + 3.0], (0.5, RULE));
    y + height + 2.0
}

/// Writes a row of a height; returns where the next begins.
pub(super) fn row(paper: &mut Paper, y: f64, columns: &[Column<'_>], (style, height): (Style, f64), cells: &[String]) -> f64 {
    for ((_, side, x, room), cell) in columns.iter().zip(cells) {
        let cell = paper.shortened(cell, style, *room);
        put(paper, [*x, y], style, *side, &cell);
    }
    y + height
}

fn put(paper: &mut Paper, at: [f64; 2], style: Style, side: Side, text: &str) {
    match side {
        Side::Left => paper.write(at, style, text),
        Side::Right => paper.write_before(at, style, text),
    }
}
