//! Polygons in the plane of tangents.

use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, Ray};

use super::View;

/// Tangents of a ray (right, up).
pub(crate) type Tangent = [f64; 2];

/// How many points of the frame's border are looked at, a side.
const BORDER_POINTS: usize = 64;

/// A convex polygon, anticlockwise.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Convex(pub Vec<Tangent>);

impl Convex {
    /// The convex hull of some points.
    pub fn hull(mut points: Vec<Tangent>) -> Self {
        points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let chain = |points: &mut dyn Iterator<Item = Tangent>| {
            let mut chain: Vec<Tangent> = Vec::new();
            for p in points {
                while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                    chain.pop();
                }
                chain.push(p);
            }
            chain.pop();
            chain
        };
        let mut hull = chain(&mut points.iter().copied());
        hull.extend(chain(&mut points.iter().rev().copied()));
        Self(hull)
    }

    /// Its edges.
    pub fn edges(&self) -> impl Iterator<Item = (Tangent, Tangent)> + '_ {
        self.0.iter().copied().zip(self.0.iter().copied().cycle().skip(1))
    }

    /// Whether it holds `p`, border included.
    pub fn holds(&self, p: Tangent) -> bool {
        self.edges().all(|(a, b)| turn(a, b, p) >= 0.0)
    }

    /// The part of `polygon` inside.
    pub fn intersect(&self, polygon: &[Tangent]) -> Vec<Tangent> {
        self.edges().fold(polygon.to_vec(), |left, edge| half(&left, edge, 1.0))
    }

    /// The parts of `polygon` outside, disjoint: what lies beyond each edge and within all edges before it.
    pub fn subtract(&self, polygon: &[Tangent]) -> Vec<Vec<Tangent>> {
        let mut rest = polygon.to_vec();
        let mut parts = Vec::new();
        for edge in self.edges() {
            parts.push(half(&rest, edge, -1.0));
            rest = half(&rest, edge, 1.0);
        }
        parts.retain(|part| part.len() > 2);
        parts
    }

    /// The box around it: lowest and highest.
    pub fn bounds(&self) -> [Tangent; 2] {
        bounds(&self.0)
    }
}

/// The box around some points.
pub(crate) fn bounds(points: &[Tangent]) -> [Tangent; 2] {
    let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    points.iter().fold(start, |[low, high], p| [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]])
}

/// Whether two boxes have no point in common.
pub(crate) fn apart(a: [Tangent; 2], b: [Tangent; 2]) -> bool {
    (0..2).any(|i| a[1][i] < b[0][i] || b[1][i] < a[0][i])
}

/// Twice the signed area of a polygon.
pub(crate) fn doubled_area(polygon: &[Tangent]) -> f64 {
    let Some(&origin) = polygon.first() else { return 0.0 };
    polygon.windows(2).map(|pair| turn(origin, pair[0], pair[1])).sum()
}

/// Positive where `p` lies left of the line from `a` to `b`.
fn turn(a: Tangent, b: Tangent, p: Tangent) -> f64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// The part of `polygon` on the left (`side` 1) or right (-1) of an edge, after Sutherland and Hodgman: where that falls apart, its parts are
/// joined by edges that run to and fro along the cut and add nothing to any integral.
fn half(polygon: &[Tangent], (a, b): (Tangent, Tangent), side: f64) -> Vec<Tangent> {
    let mut kept = Vec::with_capacity(polygon.len() + 2);
    for (i, &p) in polygon.iter().enumerate() {
        let next = polygon[(i + 1) % polygon.len()];
        let (here, there) = (side * turn(a, b, p), side * turn(a, b, next));
        if here >= 0.0 {
            kept.push(p);
        }
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            let t = here / (here - there);
            kept.push([p[0] + t * (next[0] - p[0]), p[1] + t * (next[1] - p[1])]);
        }
    }
    if kept.len() < 3 { Vec::new() } else { kept }
}

/// A convex polygon around the tangents of the rectangle with these sides (left, top, right, bottom), px.
///
/// # Errors
/// A point of the border that no ray comes to.
pub(super) fn border(view: &View<'_>, [left, top, right, bottom]: [f64; 4]) -> Result<Convex, PixelPoint> {
    let along = |i: usize, from: f64, to: f64| from + (to - from) * i as f64 / BORDER_POINTS as f64;
    let point = |i: usize| {
        [
            PixelPoint::new(along(i, left, right), top),
            PixelPoint::new(right, along(i, top, bottom)),
            PixelPoint::new(along(i, right, left), bottom),
            PixelPoint::new(left, along(i, bottom, top)),
        ]
    };
    let tangent = |p: PixelPoint| {
        let at = view.local.map_or(p, |local| local.undisplaced(p));
        view.camera.unproject(at).ok().and_then(Ray::tangent).map(|(x, y)| [x, y]).ok_or(p)
    };
    let tangents = (0..BORDER_POINTS).flat_map(point).map(tangent).collect::<Result<Vec<_>, _>>()?;
    Ok(Convex::hull(tangents))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Vec<Tangent> {
        vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side]]
    }

    #[test]
    fn what_is_inside_and_what_is_outside_make_the_whole() {
        let hull = Convex::hull(vec![[0.0, 0.0], [2.0, 0.2], [1.0, 0.4], [1.6, 2.1], [-0.3, 1.4], [0.9, 0.8]]);
        assert_eq!(hull.0.len(), 4, "inner points are dropped: {hull:?}");
        // A polygon with a notch: its part outside falls apart.
        let notched = vec![[-1.0, 0.5], [3.0, 0.5], [3.0, 1.0], [0.5, 0.9], [3.0, 1.5], [-1.0, 1.5]];
        let inside = doubled_area(&hull.intersect(&notched));
        let outside: f64 = hull.subtract(&notched).iter().map(|part| doubled_area(part)).sum();
        assert!((inside + outside - doubled_area(&notched)).abs() < 1e-12);
        assert!(inside > 0.5 && outside > 0.5);
    }

    #[test]
    fn disjoint_and_nested_squares() {
        let hull = Convex(square(0.0, 0.0, 1.0));
        assert!(hull.intersect(&square(2.0, 0.0, 1.0)).is_empty());
        assert!((doubled_area(&hull.intersect(&square(0.2, 0.2, 0.5))) - 0.5).abs() < 1e-15);
        assert!(hull.subtract(&square(0.2, 0.2, 0.5)).is_empty());
        assert!(hull.holds([0.5, 0.0]) && !hull.holds([0.5, -1e-9]));
    }
}
