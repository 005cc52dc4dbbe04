//! What is photographed, and how it was so far.

use calibench_adjust::{ObjectPoint, Status};
use nalgebra::{Point3, Vector3};

use crate::shape::board::board;
use crate::start::spread;
use crate::{Board, Calibration};

/// Tilt up to which photographs are proposed whatever was taken, radians: 45 degrees.
const TILT: f64 = std::f64::consts::FRAC_PI_4;
/// Known points at least.
const LEAST: usize = 6;
/// Share of the control that photographs have in view where it must be in view as a whole, as a detector of boards may ask for.
const WHOLE: f64 = 0.95;

/// Points that are looked at of each photograph that could be taken; of what is chosen all are.
const MOST: usize = 120;

/// The control, and the limits within which it is photographed.
pub(super) struct Field {
    /// Object units.
    pub(super) points: Vec<Point3<f64>>,
    /// Some of them, from everywhere.
    pub(super) sparse: Vec<Point3<f64>>,
    pub(super) middle: Point3<f64>,
    /// Unit vectors: two along it, and the one to the side from which it is seen; right-handed.
    pub(super) axes: [Vector3<f64>; 3],
    pub(super) is_plane: bool,
    /// Distances of the middle along the camera's axis so far: the least, the median, the largest.
    pub(super) depths: [f64; 3],
    /// The largest tilt, radians.
    pub(super) tilt: f64,
    /// Whether all of it must be in view.
    pub(super) whole: bool,
}

impl Field {
    /// How many points each of the sparse ones stands for.
    pub(super) fn share(&self) -> f64 {
        self.points.len() as f64 / self.sparse.len() as f64
    }

    pub(super) fn of(calibration: &Calibration<'_>, camera: usize) -> Result<Self, String> {
        let network = &calibration.prepared.network;
        let known: Vec<usize> = (0..network.points.len()).filter(|&i| is_known(&network.points[i])).collect();
        if known.len() < LEAST {
            return Err(format!("{} control points are known; it takes {LEAST}", known.len()));
        }
        let points: Vec<Point3<f64>> = known.iter().map(|&i| calibration.solution.points()[i]).collect();
        let poses: Vec<_> = calibration.taken(camera).filter(|(_, points)| !points.is_empty()).collect();
        let board = board(network).ok();
        let middle = board.as_ref().map_or_else(|| mean(&points), |board| board.middle);
        let facing = || poses.iter().map(|(pose, _)| (pose.centre - middle).normalize()).sum::<Vector3<f64>>();
        let axes = match &board {
            // A board has its axes as the object has them, whatever the side from which it is seen.
            Some(Board { axes: [u, _, facing], .. }) => [*u, facing.cross(u), *facing],
            None => upright(facing().try_normalize(1e-9).ok_or("the photographs surround the control")?),
        };
        let mut depths: Vec<f64> = poses.iter().map(|(pose, _)| -pose.ray(&middle).z).filter(|depth| *depth > 0.0).collect();
        depths.sort_by(f64::total_cmp);
        let [Some(&near), Some(&far)] = [depths.first(), depths.last()] else {
            return Err("no photograph has the control before it".into());
        };
        let tilts = poses.iter().map(|(pose, _)| (pose.rotation * axes[2]).z.clamp(-1.0, 1.0).acos());
        let mut shares: Vec<usize> = poses.iter().map(|(_, seen)| seen.len()).collect();
        shares.sort_unstable();
        let whole = shares.get(shares.len() / 10).is_some_and(|&seen| seen as f64 >= WHOLE * points.len() as f64);
        let depths = [near, depths[depths.len() / 2], far];
        let sparse = if points.len() <= MOST { points.clone() } else { spread(points.len(), MOST).map(|place| points[place]).collect() };
        Ok(Self { points, sparse, middle, axes, is_plane: board.is_some(), depths, tilt: tilts.fold(TILT, f64::max).min(1.2), whole })
    }
}

/// Whether a point is control: its position is known or observed.
pub(super) fn is_known(point: &ObjectPoint) -> bool {
    point.coordinates.iter().all(|status| matches!(status, Status::Fixed | Status::Observed { .. }))
}

fn mean(points: &[Point3<f64>]) -> Point3<f64> {
    Point3::from(points.iter().map(|point| point.coords).sum::<Vector3<f64>>() / points.len() as f64)
}

/// Axes about `facing`: the first as level as can be, as Z or Y is up.
fn upright(facing: Vector3<f64>) -> [Vector3<f64>; 3] {
    let up = if facing.z.abs() > 0.9 { Vector3::y() } else { Vector3::z() };
    let along = up.cross(&facing).normalize();
    [along, facing.cross(&along), facing]
}
