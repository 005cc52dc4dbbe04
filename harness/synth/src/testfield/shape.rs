//! The shapes of targets.

use std::f64::consts::{FRAC_PI_2, PI};

use calibench_model::TargetKind;
use calibench_model::testfield::{Outline, PlatePoint, axes};

/// What a target looks like. Its reference point is at (0, 0) of the outlines below before they are turned and moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Two bars crossing at their middles; size: a bar's length.
    Cross {
        /// A bar's width, as a fraction of its length.
        bar: f64,
    },
    /// Two squares touching at a corner, which is the reference point; size: a square's side.
    Chess,
    /// A filled circle; size: its diameter.
    Disc,
    /// A filled square; size: its side.
    Square,
    /// A filled equilateral triangle, its reference point the centroid; size: its side.
    Triangle,
    /// The corner of a rhombus, which lies between the directions 0 and `angle`; size: its side.
    Corner {
        /// The angle between the two edges, radians.
        angle: f64,
    },
}

impl Shape {
    /// The kind of target.
    pub const fn kind(self) -> TargetKind {
        match self {
            Self::Cross { .. } => TargetKind::Cross,
            Self::Chess => TargetKind::ChessCorner,
            Self::Disc => TargetKind::Disc,
            Self::Square => TargetKind::Square,
            Self::Triangle => TargetKind::Triangle,
            Self::Corner { .. } => TargetKind::Corner,
        }
    }

    /// The outlines with the reference point at `at`, of `size` (in the unit of `at`), turned by `turn` (radians, from u towards v). They touch in
    /// points at most.
    pub fn outlines(self, at: PlatePoint, size: f64, turn: f64) -> Vec<Outline> {
        if self == Self::Disc {
            return vec![Outline::disc(at, 0.5 * size)];
        }
        let (sine, cosine) = turn.sin_cos();
        let place = |[u, v]: &PlatePoint| [at[0] + size * (u * cosine - v * sine), at[1] + size * (u * sine + v * cosine)];
        self.polygons().iter().map(|vertices| Outline::polygon(&vertices.iter().map(place).collect::<Vec<_>>())).collect()
    }

    /// The directions of its own axes, in which it lies as [`TargetKind::outlines`] say, turned by `turn` (radians, from u towards v).
    pub fn axes(self, turn: f64) -> [PlatePoint; 2] {
        match self {
            Self::Chess => axes(turn + FRAC_PI_2),
            Self::Corner { angle } => [turn + angle, turn].map(|direction| [direction.cos(), direction.sin()]),
            Self::Cross { .. } | Self::Disc | Self::Square | Self::Triangle => axes(turn),
        }
    }

    /// The distance from the reference point to the outline's farthest point, in the unit of `size`.
    pub fn reach(self, size: f64) -> f64 {
        if self == Self::Disc {
            return 0.5 * size;
        }
        size * self.polygons().iter().flatten().map(|[u, v]| u.hypot(*v)).fold(0.0, f64::max)
    }

    /// The vertices, of size 1 and not turned.
    fn polygons(self) -> Vec<Vec<PlatePoint>> {
        match self {
            Self::Disc => Vec::new(),
            Self::Cross { bar } => {
                let (a, b) = (0.5, 0.5 * bar);
                let arm = [[a, -b], [a, b], [b, b]];
                let turned = |k: i32, [u, v]: PlatePoint| match k {
                    0 => [u, v],
                    1 => [-v, u],
                    2 => [-u, -v],
                    _ => [v, -u],
                };
                vec![(0..4).flat_map(|k| arm.map(|p| turned(k, p))).collect()]
            }
            Self::Chess => {
                let square = |s: f64| vec![[0.0, 0.0], [s, 0.0], [s, s], [0.0, s]];
                vec![square(1.0), square(-1.0)]
            }
            Self::Square => vec![vec![[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]],
            Self::Triangle => {
                let radius = 1.0 / 3.0_f64.sqrt();
                let vertex = |k: i32| {
                    let (sine, cosine) = (PI / 2.0 + f64::from(k) * 2.0 * PI / 3.0).sin_cos();
                    [radius * cosine, radius * sine]
                };
                vec![vec![vertex(0), vertex(1), vertex(2)]]
            }
            Self::Corner { angle } => {
                let (sine, cosine) = angle.sin_cos();
                vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0 + cosine, sine], [cosine, sine]]]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::outline::polygon;
    use super::*;
    use crate::overlap::{crosses_itself, overlap};

    const ALL: [Shape; 6] =
        [Shape::Cross { bar: 0.3 }, Shape::Chess, Shape::Disc, Shape::Square, Shape::Triangle, Shape::Corner { angle: 0.7 }];

    /// Centroid and area of a polygon.
    fn moments(outline: &Outline) -> (f64, f64, f64) {
        let polygon = polygon(outline);
        let (mut u, mut v) = (0.0, 0.0);
        for (a, b) in polygon.edges() {
            let cross = a.x * b.y - b.x * a.y;
            u += (a.x + b.x) * cross;
            v += (a.y + b.y) * cross;
        }
        let doubled = polygon.doubled_area();
        (u / (3.0 * doubled), v / (3.0 * doubled), doubled / 2.0)
    }

    #[test]
    fn shapes_have_their_areas_around_their_reference_points() {
        let (size, at) = (2.0, [5.0, -1.0]);
        let areas = [4.0 * (0.6 - 0.09), 8.0, PI, 4.0, 3.0_f64.sqrt(), 4.0 * 0.7_f64.sin()];
        for (shape, expected) in ALL.into_iter().zip(areas) {
            let outlines = shape.outlines(at, size, 0.4);
            let all: Vec<_> = outlines.iter().map(moments).collect();
            let area: f64 = all.iter().map(|m| m.2).sum();
            assert!((area / expected - 1.0).abs() < 2e-4, "{shape:?} {area} {expected}");
            let centre = [0, 1].map(|i| all.iter().map(|m| [m.0, m.1][i] * m.2).sum::<f64>() / area);
            let off = (centre[0] - at[0]).hypot(centre[1] - at[1]);
            let expected = if let Shape::Corner { angle } = shape { size * (angle / 2.0).cos() } else { 0.0 };
            assert!((off - expected).abs() < 1e-12, "{shape:?}: the centroid is {off} off the reference point");
        }
    }

    #[test]
    fn shapes_are_simple_and_stay_within_their_reach() {
        for shape in ALL {
            let polygons: Vec<_> = shape.outlines([0.0, 0.0], 3.0, 1.1).iter().map(polygon).collect();
            assert!(polygons.iter().all(|p| crosses_itself(p).is_none()), "{shape:?}");
            assert!(polygons.len() < 2 || overlap(&polygons[0], &polygons[1]).is_none(), "{shape:?}");
            let farthest = polygons.iter().flat_map(|p| &p.vertices).map(|v| v.x.hypot(v.y)).fold(0.0, f64::max);
            assert!((farthest / shape.reach(3.0) - 1.0).abs() < 1e-4, "{shape:?}");
        }
    }

    /// What the kind says of its own plane is what is drawn: every vertex, in the same order around the area.
    #[test]
    fn every_shape_lies_in_its_own_axes_as_its_kind_says() {
        let bar = calibench_model::target::BAR;
        let shapes = [Shape::Cross { bar }, Shape::Chess, Shape::Square, Shape::Triangle];
        let corners = [20.0_f64, 60.0, 90.0, 150.0].map(|angle| Shape::Corner { angle: angle.to_radians() });
        for (shape, turn) in shapes.into_iter().chain(corners).flat_map(|shape| [0.0, 0.4, 2.0].map(|turn| (shape, turn))) {
            let [[ux, uy], [vx, vy]] = shape.axes(turn);
            let mapped = |[u, v]: [f64; 2]| [5.0 + 2.0 * (u * ux + v * vx), -1.0 + 2.0 * (u * uy + v * vy)];
            let drawn: Vec<[f64; 2]> =
                shape.outlines([5.0, -1.0], 2.0, turn).iter().flat_map(|outline| &outline.0).map(|c| c.at(0.0)).collect();
            let told: Vec<[f64; 2]> = shape.kind().outlines().iter().flat_map(|outline| &outline.0).map(|c| mapped(c.at(0.0))).collect();
            let near = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12;
            assert_eq!(told.len(), drawn.len());
            assert!(told.iter().all(|a| drawn.iter().any(|b| near(a, b))), "{shape:?}: {told:?}, drawn {drawn:?}");
            assert!(drawn.iter().all(|a| told.iter().any(|b| near(a, b))), "{shape:?}: {told:?}, drawn {drawn:?}");
        }
    }

    #[test]
    fn a_corner_opens_from_its_turn_to_its_angle() {
        let (angle, turn) = (150_f64.to_radians(), 0.3_f64);
        let outline = &Shape::Corner { angle }.outlines([1.0, 2.0], 0.5, turn)[0];
        let ends = [outline.0[0].at(1.0), outline.0[3].at(0.0)];
        for (end, direction) in ends.into_iter().zip([turn, turn + angle]) {
            assert!((end[0] - 1.0 - 0.5 * direction.cos()).abs() < 1e-12 && (end[1] - 2.0 - 0.5 * direction.sin()).abs() < 1e-12);
        }
    }
}
