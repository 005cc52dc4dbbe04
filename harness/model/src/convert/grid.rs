//! The pixels over which cameras are fitted and compared.

use serde::{Deserialize, Serialize};

use super::ConvertError;
use crate::PixelPoint;
use crate::camera::{CameraModel, ImageSize, NoCounterpart, Ray, fold_radius, without_ray};

/// A part of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Region {
    /// All of it.
    Frame,
    /// What lies within a radius of the image of the camera's axis.
    Radius {
        /// The radius, px.
        px: f64,
    },
}

impl Region {
    /// The share of a fold's radius within which a camera may be taken as true.
    pub const INSIDE_FOLD: f64 = 0.9;

    /// Where `camera` may be taken as true: the frame, or what lies within [`Self::INSIDE_FOLD`] of the radius of its fold.
    pub fn inside_fold(camera: &dyn CameraModel) -> Self {
        fold_radius(camera).map_or(Self::Frame, |px| Self::Radius { px: px * Self::INSIDE_FOLD })
    }
}

/// A vector in the image, for plots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector {
    /// Where it starts.
    pub at: PixelPoint,
    /// Along x, px.
    pub dx: f64,
    /// Along y, px, downwards.
    pub dy: f64,
}

impl Vector {
    /// Its length, px.
    pub fn length(&self) -> f64 {
        self.dx.hypot(self.dy)
    }
}

/// How large vectors over a region are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Root mean square length (2D), px: the mean over the area.
    pub rms_px: f64,
    /// Largest length, px.
    pub max_px: f64,
    /// Where the largest is.
    pub at: PixelPoint,
}

/// A point of the grid, with its share of the area.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) point: PixelPoint,
    pub(super) weight: f64,
}

/// A node and the ray that comes to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    pub(super) node: Node,
    pub(super) ray: Ray,
}

/// The share of a cell for which a place of a grid from the first pixel to the last stands in a mean over the area (trapezoidal rule): half of one at a border, a quarter in a
/// corner.
pub fn cell_share(size: ImageSize, at: PixelPoint) -> f64 {
    let along = |value: f64, length: u32| if value <= 0.0 || value >= f64::from(length.max(2) - 1) { 0.5 } else { 1.0 };
    along(at.x, size.width) * along(at.y, size.height)
}

/// Rows of a grid at most, in columns: frames that are taller have oblong cells, so that the cost does not grow with a stated size.
const TALLEST: usize = 4;

/// A regular grid of `columns` columns and as many rows as make it square, from the first pixel to the last; [`TALLEST`] bounds the rows. Weights are
/// those of the trapezoidal rule, so that sums converge with the square of the spacing; they sum up to one.
pub(super) fn nodes(size: ImageSize, columns: usize) -> Vec<Node> {
    let (width, height) = (f64::from(size.width.max(2) - 1), f64::from(size.height.max(2) - 1));
    let columns = columns.max(3);
    let rows = (((columns - 1) as f64 * height / width).round() as usize + 1).clamp(3, TALLEST * columns);
    let cell = 1.0 / (columns - 1) as f64 * (1.0 / (rows - 1) as f64);
    let place = |i: usize, count: usize, length: f64| length * i as f64 / (count - 1) as f64;
    (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (column, row)))
        .map(|(column, row)| PixelPoint::new(place(column, columns, width), place(row, rows, height)))
        .map(|point| Node { point, weight: cell_share(size, point) * cell })
        .collect()
}

/// The nodes of the region. The radius counts from where `camera` pictures its axis.
pub(super) fn nodes_in(camera: &dyn CameraModel, region: Region, columns: usize) -> Result<Vec<Node>, NoCounterpart> {
    let nodes = nodes(camera.size(), columns);
    let Region::Radius { px } = region else { return Ok(nodes) };
    let centre = axis(camera)?;
    Ok(nodes.into_iter().filter(|node| node.point.distance(centre) <= px).collect())
}

/// Where the axis is pictured: the principal point.
pub(super) fn axis(camera: &dyn CameraModel) -> Result<PixelPoint, NoCounterpart> {
    camera.project(Ray::from_tangent(0.0, 0.0))
}

/// The rays to all nodes of the region.
///
/// # Errors
/// A camera that folds over inside the region, a region without enough nodes.
pub(super) fn sights(camera: &dyn CameraModel, region: Region, columns: usize) -> Result<Vec<Sight>, ConvertError> {
    let fold = fold_radius(camera);
    let folded = |radius_px| ConvertError::Fold { radius_px, share: without_ray(camera) };
    if let (Region::Frame, Some(radius_px)) = (region, fold) {
        return Err(folded(radius_px));
    }
    let nodes = nodes_in(camera, region, columns)?;
    let sight = |node: Node| camera.unproject(node.point).map(|ray| Sight { node, ray });
    let mut sights: Vec<Sight> = nodes.into_iter().map(sight).collect::<Result<_, _>>().map_err(|why| match fold {
        Some(radius_px) => folded(radius_px),
        None => why.into(),
    })?;
    normalise(&mut sights);
    Ok(sights)
}

/// Makes the weights sum up to one.
pub(super) fn normalise(sights: &mut [Sight]) {
    let sum: f64 = sights.iter().map(|sight| sight.node.weight).sum();
    sights.iter_mut().for_each(|sight| sight.node.weight /= sum);
}

/// Spread of vectors at sights, whose weights sum up to one.
pub(super) fn spread(sights: &[Sight], vectors: &[Vector]) -> Spread {
    let mut spread = Spread { rms_px: 0.0, max_px: 0.0, at: PixelPoint::default() };
    for (sight, vector) in sights.iter().zip(vectors) {
        let length = vector.length();
        spread.rms_px += sight.node.weight * length * length;
        if length >= spread.max_px {
            (spread.max_px, spread.at) = (length, vector.at);
        }
    }
    Spread { rms_px: spread.rms_px.sqrt(), ..spread }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_integrate_over_the_frame() {
        let size = ImageSize { width: 601, height: 401 };
        let nodes = nodes(size, 31);
        assert_eq!(nodes.len(), 31 * 21);
        let mean = |f: fn(PixelPoint) -> f64| nodes.iter().map(|n| n.weight * f(n.point)).sum::<f64>();
        assert!((mean(|_| 1.0) - 1.0).abs() < 1e-12);
        assert!((mean(|p| p.x) - 300.0).abs() < 1e-9 && (mean(|p| p.y) - 200.0).abs() < 1e-9);
        // The mean of x^2 over the frame is w^2 / 3.
        assert!((mean(|p| p.x * p.x) / 120_000.0 - 1.0).abs() < 1e-3);
        assert_eq!(nodes.last().unwrap().point, PixelPoint::new(600.0, 400.0));
    }

    #[test]
    fn the_stated_size_does_not_set_the_cost() {
        for (width, height) in [(752, 1_048_576), (1, 1_048_576), (1_048_576, 1), (1, 1)] {
            let nodes = nodes(ImageSize { width, height }, 41);
            assert!(nodes.len() <= 41 * 164, "{width} x {height}: {} nodes", nodes.len());
            assert!((nodes.iter().map(|node| node.weight).sum::<f64>() - 1.0).abs() < 1e-12);
            assert_eq!(nodes.last().unwrap().point, PixelPoint::new(f64::from(width.max(2) - 1), f64::from(height.max(2) - 1)));
        }
        // Up to that, cells are square.
        assert_eq!(nodes(ImageSize { width: 1001, height: 3001 }, 41).len(), 41 * 121);
    }
}
