//! Outlines to the targets that they are.

use calibench_model::testfield::{Outline, PlatePoint, axes};
use calibench_model::{Curve, TargetKind};

/// A target on the plate.
pub(super) struct Cell {
    pub kind: TargetKind,
    pub at: PlatePoint,
    /// Object units.
    pub size: f64,
    /// Of length 1.
    pub axes: [PlatePoint; 2],
}

/// The opposite corners of an upright rectangle, the lower values first.
pub(super) fn rectangle(outline: &Outline) -> Option<[PlatePoint; 2]> {
    let corners = vertices(outline)?;
    let [a, _, c, _] = corners.as_slice() else { return None };
    let (low, high) = ([a[0].min(c[0]), a[1].min(c[1])], [a[0].max(c[0]), a[1].max(c[1])]);
    let upright = corners.iter().all(|p| (0..2).all(|i| p[i] == low[i] || p[i] == high[i]));
    upright.then_some([low, high])
}

/// The target with this outline: four arcs are a disc, three, four and twelve lines a triangle, a square and a cross.
///
/// Vertices are in the order of the outlines of the kinds, turned or not: a triangle begins at the vertex that lies straight up, a square with the side
/// along u, a cross with the end of a bar.
pub(super) fn target(outline: &Outline) -> Option<Cell> {
    if let [Curve::Arc { centre, radius, .. }, ..] = outline.0.as_slice() {
        return Some(Cell { kind: TargetKind::Disc, at: *centre, size: 2.0 * radius, axes: axes(0.0) });
    }
    let corners = vertices(outline)?;
    let n = corners.len() as f64;
    let at = [0, 1].map(|i| corners.iter().map(|p| p[i]).sum::<f64>() / n);
    let side = [corners[1][0] - corners[0][0], corners[1][1] - corners[0][1]];
    let length = side[0].hypot(side[1]);
    let (kind, size, turn) = match corners.len() {
        3 => (TargetKind::Triangle, length, (at[0] - corners[0][0]).atan2(corners[0][1] - at[1])),
        4 => (TargetKind::Square, length, side[1].atan2(side[0])),
        12 => {
            let end = [0, 1].map(|i| 0.5 * (corners[0][i] + corners[1][i]) - at[i]);
            (TargetKind::Cross, 2.0 * end[0].hypot(end[1]), end[1].atan2(end[0]))
        }
        _ => return None,
    };
    Some(Cell { kind, at, size, axes: axes(turn) })
}

fn vertices(outline: &Outline) -> Option<Vec<PlatePoint>> {
    let start = |curve: &Curve| if let Curve::Line { from, .. } = curve { Some(*from) } else { None };
    let vertices: Vec<PlatePoint> = outline.0.iter().map(start).collect::<Option<_>>()?;
    (vertices.len() > 2).then_some(vertices)
}
