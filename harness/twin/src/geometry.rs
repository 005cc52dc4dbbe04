//! Where the edges and squares of a chessboard are in an image.

use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use nalgebra::Point3;

/// A chessboard before a camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// The camera.
    pub camera: Camera,
    /// Rows of inner corners.
    pub rows: usize,
    /// Inner corners in a row.
    pub columns: usize,
    /// Inner corners row by row, object units: X to the right, Y upwards, Z towards the viewer.
    pub corners: Vec<Point3<f64>>,
}

/// A side of a square between two neighbouring inner corners, as it is pictured: a straight chord and the height of its arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Its first end, px.
    pub from: PixelPoint,
    /// Direction of the chord, a unit vector in the image.
    pub along: [f64; 2],
    /// Length of the chord, px.
    pub length: f64,
    /// Height of the arc over the middle of the chord towards [`Self::normal`], px.
    pub sag: f64,
}

impl Edge {
    /// The direction across, a quarter turn from `along`.
    pub const fn normal(&self) -> [f64; 2] {
        [-self.along[1], self.along[0]]
    }

    /// Where a pixel stands: along the chord from its first end, and across from the edge, px.
    pub fn place(&self, x: f64, y: f64) -> [f64; 2] {
        let (dx, dy) = (x - self.from.x, y - self.from.y);
        let along = dx * self.along[0] + dy * self.along[1];
        let t = along / self.length;
        [along, -dx * self.along[1] + dy * self.along[0] - 4.0 * self.sag * t * (1.0 - t)]
    }

    /// The middle of the chord, px.
    pub fn middle(&self) -> PixelPoint {
        PixelPoint::new(self.from.x + 0.5 * self.length * self.along[0], self.from.y + 0.5 * self.length * self.along[1])
    }
}

/// A whole square between four inner corners, px, in the order of a walk around it.
pub type Square = [PixelPoint; 4];

impl Geometry {
    /// A board of [rows, columns] of inner corners, row by row at these places, object units.
    pub fn new(camera: Camera, [rows, columns]: [usize; 2], corners: impl Iterator<Item = [f64; 3]>) -> Self {
        Self { camera, rows, columns, corners: corners.map(Point3::from).collect() }
    }

    /// An inner corner, (0, 0) the first.
    fn corner(&self, row: usize, column: usize) -> Point3<f64> {
        self.corners[row * self.columns + column]
    }

    fn pictured(&self, pose: &Pose, point: &Point3<f64>) -> Option<PixelPoint> {
        self.camera.project(pose.ray(point)).ok()
    }

    /// The sides between neighbouring inner corners, those that are pictured whole.
    pub fn edges(&self, pose: &Pose) -> Vec<Edge> {
        let sides = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)));
        let both = sides.flat_map(|(row, column)| [((row, column), (row, column + 1)), ((row, column), (row + 1, column))]);
        let there = both.filter(|(_, (row, column))| *row < self.rows && *column < self.columns);
        there.filter_map(|(a, b)| self.edge(pose, &self.corner(a.0, a.1), &self.corner(b.0, b.1))).collect()
    }

    fn edge(&self, pose: &Pose, a: &Point3<f64>, b: &Point3<f64>) -> Option<Edge> {
        let (from, to) = (self.pictured(pose, a)?, self.pictured(pose, b)?);
        let middle = self.pictured(pose, &nalgebra::center(a, b))?;
        let length = from.distance(to);
        let along = [(to.x - from.x) / length, (to.y - from.y) / length];
        let straight = Edge { from, along, length, sag: 0.0 };
        let [at, sag] = straight.place(middle.x, middle.y);
        // The middle of the side is not that of the chord: the arc is the parabola through it.
        let t = at / length;
        (length > 1.0 && t > 0.05 && t < 0.95).then(|| Edge { sag: sag / (4.0 * t * (1.0 - t)), ..straight })
    }

    /// The squares between four inner corners, those that are pictured whole.
    pub fn squares(&self, pose: &Pose) -> Vec<Square> {
        let all = (1..self.rows).flat_map(|row| (1..self.columns).map(move |column| (row, column)));
        let corners = |(row, column): (usize, usize)| [(row - 1, column - 1), (row - 1, column), (row, column), (row, column - 1)];
        let square = |at| {
            let [a, b, c, d] = corners(at).map(|(row, column)| self.pictured(pose, &self.corner(row, column)));
            Some([a?, b?, c?, d?])
        };
        all.filter_map(square).collect()
    }

    /// The median length of the sides of squares, px; NaN where none is pictured.
    pub fn side(&self, pose: &Pose) -> f64 {
        calibench_model::median(self.edges(pose).iter().map(|edge| edge.length)).unwrap_or(f64::NAN)
    }
}
