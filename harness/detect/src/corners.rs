//! From markers to a board's points.

use calibench_model::boards::{BoardPoint, Layout};
use calibench_model::testfield::axes;
use calibench_model::{Image, TargetKind};

use crate::markers::Seen;
use crate::plane::{Linear, Point, distance, mean, pixel};
use crate::saddle::Corner;
use crate::{FoundPoint, NotFound};

/// A point as it was found.
pub(crate) fn found(index: usize, point: &BoardPoint, at: Point, linear: Linear) -> FoundPoint {
    let axes = axes(f64::from(point.turns) * std::f64::consts::FRAC_PI_2);
    FoundPoint { index, position: pixel(at), affine: linear.affine(axes, point.size) }
}

fn corner(point: &BoardPoint, at: Point, linear: Linear, contrast: f64) -> Corner {
    Corner { at, plate: point.at, linear, room: point.room, turns: point.turns, contrast }
}

/// The corners of markers that are points of the board, where they are seen: where squares meet, or where one ends.
pub(crate) fn of_markers(image: &Image, layout: &Layout, seen: &[Seen]) -> Vec<FoundPoint> {
    let mut points = Vec::new();
    for marker in seen {
        let printed = layout.markers[marker.index].corners;
        let near = 0.01 * distance(printed[0], printed[1]);
        let own = |point: &BoardPoint| printed.iter().position(|corner| distance(*corner, point.at) < near);
        // Points are listed marker by marker.
        let per_marker = layout.points.len() / layout.markers.len();
        let listed = layout.points.iter().enumerate().skip(marker.index * per_marker).take(per_marker);
        for (index, point, k) in listed.filter_map(|(index, point)| Some((index, point, own(point)?))) {
            let (at, linear) = (marker.corners[k], marker.map.linear(point.at));
            let corner = corner(point, at, linear, marker.contrast);
            let at = match point.kind {
                TargetKind::ChessCorner => corner.found(image),
                _ => corner.is_single(image, mean(&printed)).then_some(at),
            };
            let Some(at) = at else { continue };
            points.push(found(index, point, at, linear));
        }
    }
    points
}

/// The corners of squares beside the markers.
///
/// # Errors
/// [`NotFound::NoCorners`] where few of them are seen.
pub(crate) fn of_squares(image: &Image, layout: &Layout, seen: &[Seen], square: f64) -> Result<Vec<FoundPoint>, NotFound> {
    let middles: Vec<Point> = seen.iter().map(|marker| mean(&layout.markers[marker.index].corners)).collect();
    let (mut points, mut expected) = (Vec::new(), 0);
    for (index, point) in layout.points.iter().enumerate() {
        let beside: Vec<&Seen> = seen
            .iter()
            .zip(&middles)
            .filter(|(_, middle)| distance(**middle, point.at) < 0.75 * square)
            .map(|(marker, _)| marker)
            .collect();
        let Some(first) = beside.first() else { continue };
        let at = mean(&beside.iter().map(|marker| marker.map.at(point.at)).collect::<Vec<_>>());
        if !image.holds(at[0].round() as i64, at[1].round() as i64, 4) {
            continue;
        }
        expected += 1;
        let linear = first.map.linear(point.at);
        if let Some(at) = corner(point, at, linear, first.contrast).found(image) {
            points.push(found(index, point, at, linear));
        }
    }
    if points.is_empty() || 3 * points.len() < expected {
        return Err(NotFound::NoCorners { markers: seen.len(), corners: points.len(), expected });
    }
    Ok(points)
}
