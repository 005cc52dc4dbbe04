//! The grid's mapping adjusted to the points of its lines.

use nalgebra::{Matrix3, RowVector3, SMatrix, SVector, Vector2, Vector3};

use crate::mapping::{Mapping, Unit, by_bend, by_place, straight};
use crate::ridge::Ridge;

/// How far from a line its points may be, px, step by step.
const WITHIN: [f64; 6] = [3.0, 2.0, 1.5, 1.0, 0.8, 0.8];
/// The cosine of the angle between a point's direction and that of its line.
const ALIGNED: f64 = 0.94;
/// What is known of the bend beforehand: its standard deviation, and that of a point, px.
const BEND: f64 = 0.1;
const POINT: f64 = 0.1;

/// A mapping and what it was adjusted to.
#[derive(Clone, Debug)]
pub(crate) struct Adjusted {
    pub mapping: Mapping,
    /// Root mean square distance of the points from their lines, px.
    pub rms: f64,
    /// The points on lines of the grid.
    pub on: Vec<OnLine>,
}

/// A point on a line of the grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnLine {
    /// An index into the points.
    pub point: usize,
    /// 0 if x is whole on the line, 1 if y is.
    pub family: usize,
    pub number: i64,
    /// Its place along the line, squares.
    pub along: f64,
    /// Its distance from the line, px.
    pub off: f64,
}

/// What is known of a grid coordinate at a point.
struct Seen {
    value: f64,
    /// Derivatives by the straight place, and by the place in the image.
    by_straight: RowVector3<f64>,
    by_image: Vector2<f64>,
    depth: f64,
    q: Vector3<f64>,
}

fn seen(mapping: &Mapping, at: [f64; 2], family: usize) -> Option<Seen> {
    let p = mapping.unit.of_px(at);
    let straight = straight(p, mapping.bend);
    let q = Vector3::new(straight.x, straight.y, 1.0);
    let h = mapping.to_grid * q;
    let value = h[family] / h.z;
    let by_straight = (mapping.to_grid.row(family) - mapping.to_grid.row(2) * value) / h.z;
    let by_image = by_place(p, mapping.bend).transpose() * Vector2::new(by_straight[0], by_straight[1]);
    (h.z > 1e-3).then_some(Seen { value, by_straight, by_image, depth: h.z, q })
}

/// The points that lie on lines of the grid, within so many px.
fn on_lines(mapping: &Mapping, points: &[Ridge], within: f64) -> Vec<OnLine> {
    let mut on = Vec::with_capacity(points.len());
    for (index, point) in points.iter().enumerate() {
        for family in 0..2 {
            let Some(seen) = seen(mapping, point.at, family) else { continue };
            let slope = seen.by_image.norm();
            let number = seen.value.round();
            let off = (seen.value - number) / slope * mapping.unit.reach;
            let aligned = (seen.by_image.x * point.normal[0] + seen.by_image.y * point.normal[1]).abs() > ALIGNED * slope;
            // Of the other lines, so near that no number is meant.
            if aligned && off.abs() < within && (seen.value - number).abs() < 0.25 {
                let along = mapping.grid(point.at).map_or(f64::NAN, |grid| grid[1 - family]);
                on.push(OnLine { point: index, family, number: number as i64, along, off });
            }
        }
    }
    on
}

/// Adjusts a mapping to the points of lines by least squares of their distances, px; `None` if they do not determine it.
pub(crate) fn adjust(start: &Mapping, points: &[Ridge]) -> Option<Adjusted> {
    let mut mapping = *start;
    for within in WITHIN {
        let on = on_lines(&mapping, points, within);
        mapping = step(&mapping, points, &on)?;
    }
    let on = on_lines(&mapping, points, WITHIN[WITHIN.len() - 1]);
    let squares: f64 = on.iter().map(|on| on.off * on.off).sum();
    (on.len() > 12).then(|| Adjusted { mapping, rms: (squares / on.len() as f64).sqrt(), on })
}

/// One Gauss-Newton step in the eight elements of the homography and the bend.
fn step(mapping: &Mapping, points: &[Ridge], on: &[OnLine]) -> Option<Mapping> {
    let (mut normal, mut right) = (SMatrix::<f64, 9, 9>::zeros(), SVector::<f64, 9>::zeros());
    for on in on {
        let point = &points[on.point];
        let seen = seen(mapping, point.at, on.family)?;
        let scale = mapping.unit.reach / seen.by_image.norm();
        let mut row = SVector::<f64, 9>::zeros();
        for column in 0..3 {
            row[3 * on.family + column] = scale * seen.q[column] / seen.depth;
        }
        for column in 0..2 {
            row[6 + column] = -scale * seen.value * seen.q[column] / seen.depth;
        }
        let bend = by_bend(mapping.unit.of_px(point.at), mapping.bend);
        row[8] = scale * (seen.by_straight[0] * bend.x + seen.by_straight[1] * bend.y);
        let residual = scale * (seen.value - on.number as f64);
        normal += row * row.transpose() * point.weight;
        right -= row * (residual * point.weight);
    }
    let prior = (POINT / BEND).powi(2);
    normal[(8, 8)] += prior;
    right[8] -= prior * mapping.bend;
    let by = normal.cholesky()?.solve(&right);
    let g = &mapping.to_grid;
    let moved = Matrix3::from_fn(|row, column| g[(row, column)] + if row == 2 && column == 2 { 0.0 } else { by[3 * row + column] });
    Mapping::new(mapping.unit, moved, (mapping.bend + by[8]).clamp(-0.4, 0.4))
}

/// The mapping that brings places of the image (straight, px from its middle) to nodes of the grid, by least squares; `None` if they do not determine it.
pub(crate) fn through(unit: Unit, nodes: &[([f64; 2], [f64; 2])], bend: f64) -> Option<Mapping> {
    let (mut normal, mut right) = (SMatrix::<f64, 8, 8>::zeros(), SVector::<f64, 8>::zeros());
    for (at, grid) in nodes {
        let q = [at[0] / unit.reach, at[1] / unit.reach, 1.0];
        for family in 0..2 {
            let mut row = SVector::<f64, 8>::zeros();
            for column in 0..3 {
                row[3 * family + column] = q[column];
            }
            for column in 0..2 {
                row[6 + column] = -grid[family] * q[column];
            }
            normal += row * row.transpose();
            right += row * grid[family];
        }
    }
    let g = normal.cholesky()?.solve(&right);
    Mapping::new(unit, Matrix3::new(g[0], g[1], g[2], g[3], g[4], g[5], g[6], g[7], 1.0), bend)
}
