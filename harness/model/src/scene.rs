//! A flat scene given directly in the image: areas of constant grey, and the points that are to be measured.

use crate::{PixelPoint, TargetKind};

/// An area of constant grey value. Simple, not closed (the last vertex joins the first), either sense of rotation.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Its name in the scenario.
    pub id: String,
    /// At least three vertices.
    pub vertices: Vec<PixelPoint>,
    /// Grey value, fraction of full scale.
    pub grey: f64,
}

impl Polygon {
    /// The edges, as pairs of vertices.
    pub fn edges(&self) -> impl Iterator<Item = (PixelPoint, PixelPoint)> + '_ {
        let next = self.vertices.iter().cycle().skip(1);
        self.vertices.iter().copied().zip(next.copied())
    }

    /// Twice the signed area, px^2, positive when x turns to y (clockwise as displayed).
    pub fn doubled_area(&self) -> f64 {
        self.edges().map(|(a, b)| a.x * b.y - b.x * a.y).sum()
    }

    /// The polygon moved by (`dx`, `dy`) px.
    #[must_use]
    pub fn shifted(&self, dx: f64, dy: f64) -> Self {
        let vertices = self.vertices.iter().map(|v| PixelPoint::new(v.x + dx, v.y + dy)).collect();
        Self { vertices, ..self.clone() }
    }
}

/// A point whose image position is known exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneTarget {
    /// Its name in records and tables.
    pub id: String,
    /// The kind of target.
    pub kind: TargetKind,
    /// Its true position.
    pub at: PixelPoint,
}

/// Disjoint polygons on a uniform background.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Columns, px.
    pub width: usize,
    /// Rows, px.
    pub height: usize,
    /// Grey value between the polygons, fraction of full scale.
    pub background: f64,
    /// The areas. They may share edges; they must not overlap.
    pub polygons: Vec<Polygon>,
    /// The points to be measured.
    pub targets: Vec<SceneTarget>,
}

impl Scene {
    /// The scene, truth and all, moved by (`dx`, `dy`) px.
    #[must_use]
    pub fn shifted(&self, dx: f64, dy: f64) -> Self {
        let polygons = self.polygons.iter().map(|polygon| polygon.shifted(dx, dy)).collect();
        let targets =
            self.targets.iter().map(|target| SceneTarget { at: PixelPoint::new(target.at.x + dx, target.at.y + dy), ..target.clone() });
        Self { targets: targets.collect(), polygons, ..self.clone() }
    }
}
