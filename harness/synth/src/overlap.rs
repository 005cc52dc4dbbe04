//! Overlap of areas: coverage adds up only where there is none.

use calibench_model::{PixelPoint, Polygon};

/// How much a point may be off a line, px, and still lie on it: shared edges are given in decimals.
const TOLERANCE: f64 = 1e-9;

/// A place where the interiors of `a` and `b` overlap; `None` if they are disjoint or share no more than edges and vertices.
///
/// Both are cut into the pieces of their edges between all intersections; where a piece's middle, moved a little to its own inside, lies inside
/// the other, they overlap.
pub fn overlap(a: &Polygon, b: &Polygon) -> Option<PixelPoint> {
    border_inside(a, b).or_else(|| border_inside(b, a))
}

/// Whether a polygon's border crosses or touches itself: its coverage would then count some area twice or not at all.
pub fn crosses_itself(polygon: &Polygon) -> Option<PixelPoint> {
    let edges: Vec<_> = polygon.edges().collect();
    let n = edges.len();
    for i in 0..n {
        for j in i + 1..n {
            let neighbours = j == i + 1 || (i == 0 && j == n - 1);
            for at in crossings(edges[i], edges[j]) {
                let shared = if j == i + 1 { edges[j].0 } else { edges[i].0 };
                if !neighbours || at.distance(shared) > TOLERANCE {
                    return Some(at);
                }
            }
        }
    }
    None
}

fn border_inside(inner: &Polygon, outer: &Polygon) -> Option<PixelPoint> {
    let inwards = inner.doubled_area().signum();
    for edge in inner.edges() {
        let mut cuts = vec![edge.0, edge.1];
        cuts.extend(outer.edges().flat_map(|other| crossings(edge, other)));
        cuts.sort_by(|p, q| p.distance(edge.0).total_cmp(&q.distance(edge.0)));
        for pair in cuts.windows(2) {
            let length = pair[0].distance(pair[1]);
            if length <= TOLERANCE {
                continue;
            }
            let step = inwards * 10.0 * TOLERANCE / length;
            let (dx, dy) = (pair[1].x - pair[0].x, pair[1].y - pair[0].y);
            let middle = PixelPoint::new((pair[0].x + pair[1].x) / 2.0 - dy * step, (pair[0].y + pair[1].y) / 2.0 + dx * step);
            if contains(outer, middle) {
                return Some(middle);
            }
        }
    }
    None
}

/// Where two edges meet: one point, the ends of a common stretch, or nothing.
fn crossings(a: (PixelPoint, PixelPoint), b: (PixelPoint, PixelPoint)) -> Vec<PixelPoint> {
    let (ux, uy) = (a.1.x - a.0.x, a.1.y - a.0.y);
    let (vx, vy) = (b.1.x - b.0.x, b.1.y - b.0.y);
    let determinant = ux * vy - uy * vx;
    let (wx, wy) = (b.0.x - a.0.x, b.0.y - a.0.y);
    let length = ux.hypot(uy);
    if determinant.abs() <= 1e-12 * length * vx.hypot(vy) {
        if (wx * uy - wy * ux).abs() > TOLERANCE * length {
            return Vec::new();
        }
        return [b.0, b.1].into_iter().filter(|p| on_segment(a, *p)).chain([a.0, a.1].into_iter().filter(|p| on_segment(b, *p))).collect();
    }
    let s = (wx * vy - wy * vx) / determinant;
    let at = PixelPoint::new(a.0.x + s * ux, a.0.y + s * uy);
    if on_segment(a, at) && on_segment(b, at) { vec![at] } else { Vec::new() }
}

fn on_segment((from, to): (PixelPoint, PixelPoint), p: PixelPoint) -> bool {
    let (ux, uy) = (to.x - from.x, to.y - from.y);
    let (wx, wy) = (p.x - from.x, p.y - from.y);
    let length = ux.hypot(uy);
    let along = (wx * ux + wy * uy) / length;
    (wx * uy - wy * ux).abs() <= TOLERANCE * length && along >= -TOLERANCE && along <= length + TOLERANCE
}

/// Whether `p` is inside, by the even-odd rule; a point within 1e-9 px of the border counts as outside.
pub fn contains(polygon: &Polygon, p: PixelPoint) -> bool {
    if polygon.edges().any(|edge| on_segment(edge, p)) {
        return false;
    }
    let crossed = polygon.edges().filter(|(a, b)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y));
    crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(vertices: &[(f64, f64)]) -> Polygon {
        Polygon { id: "p".into(), grey: 0.0, vertices: vertices.iter().map(|&(x, y)| PixelPoint::new(x, y)).collect() }
    }

    fn square(x: f64, y: f64, side: f64) -> Polygon {
        polygon(&[(x, y), (x + side, y), (x + side, y + side), (x, y + side)])
    }

    #[test]
    fn neighbours_may_touch_but_not_overlap() {
        let a = square(0.0, 0.0, 10.0);
        assert!(overlap(&a, &square(10.0, 0.0, 10.0)).is_none(), "a shared edge");
        assert!(overlap(&a, &square(10.0, 10.0, 5.0)).is_none(), "a shared vertex");
        assert!(overlap(&a, &square(10.0, 3.0, 4.0)).is_none(), "part of an edge");
        assert!(overlap(&a, &square(9.9, 3.0, 4.0)).is_some(), "a thin overlap");
        assert!(overlap(&a, &square(2.0, 3.0, 4.0)).is_some(), "one inside the other");
        assert!(overlap(&a, &a).is_some(), "the same twice");
        assert!(overlap(&a, &polygon(&[(3.0, 0.0), (8.0, -6.0), (12.0, 3.0)])).is_some(), "a corner cut off");
        let cross = (
            polygon(&[(4.0, -5.0), (6.0, -5.0), (6.0, 15.0), (4.0, 15.0)]),
            polygon(&[(-5.0, 4.0), (15.0, 4.0), (15.0, 6.0), (-5.0, 6.0)]),
        );
        assert!(overlap(&cross.0, &cross.1).is_some(), "crossing bars, no vertex inside the other");
    }

    #[test]
    fn a_bow_tie_crosses_itself_and_a_square_does_not() {
        assert!(crosses_itself(&square(0.0, 0.0, 3.0)).is_none());
        assert!(crosses_itself(&polygon(&[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)])).is_some());
        assert!(crosses_itself(&polygon(&[(0.0, 0.0), (4.0, 0.0), (2.0, 0.0), (2.0, 3.0)])).is_some(), "an edge folded back");
    }
}
