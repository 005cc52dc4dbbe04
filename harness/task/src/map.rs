//! What a task costs elsewhere: the same measured over a plane through the volume.

use calibench_model::ControlRow;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Point3, Vector3};

use crate::budget::HALF_95;
use crate::scene::Scene;
use crate::{KnownCamera, Source, Task, TaskError};

/// Places along the longer side of a map.
const PLACES: usize = 48;
/// Places along the frame's sides whose rays bound the map.
const BORDER: usize = 24;
/// How far a map goes at most, in distances from the camera to what is measured.
const FAR: f64 = 2.0;

/// A plane with what a task costs all over it.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Names of the two axes of the map.
    pub axes: [String; 2],
    /// From where to where it goes along both, object units.
    pub extent: [[f64; 2]; 2],
    /// Where the plane lies along its normal, object units, with the name of that axis; `None` of a known plane.
    pub at: Option<(&'static str, f64)>,
    /// Places along both axes.
    pub grid: [usize; 2],
    /// Row by row, the first axis along a row, both from their lower ends: `None` where it cannot be measured.
    pub cells: Vec<Option<Cell>>,
}

/// What a task costs at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Half of the 95 % interval, object units or degrees; of several numbers the largest that has the unit of the first.
    pub half: f64,
    /// The source that makes the most of it.
    pub largest: Source,
}

/// The directions and the middle of a map.
struct Frame {
    names: [&'static str; 2],
    axes: [Vector3<f64>; 2],
    normal: Vector3<f64>,
    middle: Point3<f64>,
    at: Option<(&'static str, f64)>,
}

/// The task measured all over a plane: the known one, or that across the line of sight through what is measured, shifted by `offset` object units along its axis.
///
/// # Errors
/// As [`crate::Budget::of`], for a task that cannot be measured where it stands.
pub fn map(task: &Task, camera: &KnownCamera<'_>, control: Option<&[ControlRow]>, offset: f64) -> Result<Map, TaskError> {
    Scene::new(task, camera, control)?.rows()?;
    let frame = Frame::of(task, offset);
    let extent = frame.extent(task, camera.camera);
    let sides = extent.map(|[low, high]| high - low);
    let long = sides[0].max(sides[1]);
    let grid = sides.map(|side| ((PLACES as f64 * side / long).round() as usize).max(2));
    let along = |axis: usize, place: usize| extent[axis][0] + sides[axis] * (place as f64 + 0.5) / grid[axis] as f64;
    let cell = |index: usize| {
        let to = frame.middle + frame.axes[0] * along(0, index % grid[0]) + frame.axes[1] * along(1, index / grid[0]);
        let from = centroid(task);
        // Into the known plane itself, without what rounding leaves.
        let by = (to - from) - if task.plane.is_some() { frame.normal * frame.normal.dot(&(to - from)) } else { Vector3::zeros() };
        let moved = Task { quantity: task.quantity.moved(&by), ..task.clone() };
        let scene = Scene::new(&moved, camera, control).ok()?;
        let components = scene.components(&scene.rows().ok()?);
        let first = components.first()?.named.in_degrees;
        let most = components.iter().filter(|one| one.named.in_degrees == first).max_by(|a, b| a.sigma.total_cmp(&b.sigma))?;
        Some(Cell { half: HALF_95 * most.sigma, largest: most.largest()? })
    };
    let cells = (0..grid[0] * grid[1]).map(cell).collect();
    Ok(Map { axes: frame.names.map(str::to_owned), extent, at: frame.at, grid, cells })
}

fn centroid(task: &Task) -> Point3<f64> {
    let points = task.quantity.points();
    Point3::from(points.iter().map(|point| point.coords).sum::<Vector3<f64>>() / points.len() as f64)
}

impl Frame {
    fn of(task: &Task, offset: f64) -> Self {
        if let Some(plane) = &task.plane
            && plane.normal.amax() < 1.0 - 1e-9
        {
            return Self {
                names: ["along the plane", "across it"],
                axes: plane.axes(),
                normal: plane.normal,
                middle: plane.point,
                at: None,
            };
        }
        let sight: Vector3<f64> = task
            .plane
            .map_or_else(|| task.images.iter().map(|station| station.pose.rotation.row(2).transpose()).sum(), |plane| plane.normal);
        let axis = sight.iamax();
        let [first, second] = [[1, 2], [0, 2], [0, 1]][axis];
        let unit = |axis: usize| Vector3::from_fn(|row, _| f64::from(u8::from(row == axis)));
        let at = centroid(task)[axis] + if task.plane.is_some() { 0.0 } else { offset };
        let names = ["X", "Y", "Z"];
        Self {
            names: [names[first], names[second]],
            axes: [unit(first), unit(second)],
            normal: unit(axis),
            middle: Point3::from(unit(axis) * at),
            at: Some((names[axis], at)),
        }
    }

    /// From where to where the frames of the images reach, and no farther than [`FAR`].
    fn extent(&self, task: &Task, camera: &Camera) -> [[f64; 2]; 2] {
        let middle = centroid(task) - self.middle;
        let reach = task.images.iter().map(|station| (centroid(task) - station.pose.centre).norm()).fold(0.0, f64::max) * FAR;
        let mut extent = [0, 1].map(|axis| {
            let here = middle.dot(&self.axes[axis]);
            [here, here]
        });
        let bounds = extent.map(|[here, _]| [here - reach, here + reach]);
        for station in &task.images {
            for at in border(camera).filter_map(|at| self.foot(camera, &station.pose, at)) {
                for axis in 0..2 {
                    let value = (at - self.middle).dot(&self.axes[axis]).clamp(bounds[axis][0], bounds[axis][1]);
                    extent[axis] = [extent[axis][0].min(value), extent[axis][1].max(value)];
                }
            }
        }
        // Of a plane that no frame reaches there is something to see as well.
        extent.map(|[low, high]| if high - low > 1e-6 * reach { [low, high] } else { [low - 1e-3 * reach, high + 1e-3 * reach] })
    }

    /// Where the ray of an image point meets the plane.
    fn foot(&self, camera: &Camera, pose: &Pose, at: PixelPoint) -> Option<Point3<f64>> {
        let direction = pose.world_from_ray(camera.unproject(at).ok()?);
        let way = (self.middle - pose.centre).dot(&self.normal) / direction.dot(&self.normal);
        (way > 0.0 && way.is_finite()).then(|| pose.centre + way * direction)
    }
}

/// Places around the frame.
fn border(camera: &Camera) -> impl Iterator<Item = PixelPoint> {
    let size = camera.size();
    let [right, down] = [size.width, size.height].map(|side| f64::from(side) - 1.0);
    (0..BORDER).flat_map(move |step| {
        let part = step as f64 / BORDER as f64;
        let [x, y] = [part * right, part * down];
        [PixelPoint::new(x, 0.0), PixelPoint::new(right, y), PixelPoint::new(right - x, down), PixelPoint::new(0.0, down - y)]
    })
}
