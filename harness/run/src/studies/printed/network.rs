//! A network of stations in nine numbers.

use calibench_adjust::approximate::{Sight, intersect};
use calibench_model::camera::{Camera, CameraModel, Photogrammetric};
use calibench_model::{Frame, PixelPoint, Pose, SensorPoint};
use calibench_records::figures::Quantity;
use calibench_scenario::studies::printed::{CheckPoint, NetworkPlan};
use nalgebra::{Matrix3, Point3, Vector3};

/// The numbers of a network.
pub const NUMBERS: usize = 9;
/// What they are, in their order.
pub const NUMBERS_OF: [Quantity; NUMBERS] = [
    Quantity::SiteDistance,
    Quantity::SiteCurve,
    Quantity::SiteHalfBase,
    Quantity::SiteShift,
    Quantity::SiteHeight,
    Quantity::SiteHeightStep,
    Quantity::SiteAimToTheRight,
    Quantity::SiteAimSpread,
    Quantity::SiteAimUpwards,
];
/// Rays that meet at less are parallel, rad.
const PARALLEL: f64 = 1e-3;

/// The points that stations look at, and the axes along which these are placed.
#[derive(Clone, Debug)]
pub struct Site {
    middle: Point3<f64>,
    from: Vector3<f64>,
    right: Vector3<f64>,
    up: Vector3<f64>,
    stations: usize,
    names: Vec<String>,
    points: Vec<Point3<f64>>,
    frame: Frame,
}

/// Of every station, its exterior orientation and where it pictures the points: `None` outside of its frame.
pub type Pictures = Vec<(Pose, Vec<Option<PixelPoint>>)>;

impl Site {
    /// That of `plan`, about the mean of `points`; `frame` is that of all cameras.
    pub fn new(plan: &NetworkPlan, points: &[CheckPoint], frame: Frame) -> Self {
        // From the first point, so that large coordinates cost no digits.
        let origin = points[0].at;
        let middle = origin + points.iter().map(|point| point.at - origin).sum::<Vector3<f64>>() / points.len() as f64;
        let names = points.iter().map(|point| point.name.clone()).collect();
        let points = points.iter().map(|point| Point3::from(point.at - middle)).collect();
        Self { middle, from: plan.from, right: plan.up.cross(&plan.from), up: plan.up, stations: plan.stations, names, points, frame }
    }

    /// The mean of the points, object units.
    pub fn middle(&self) -> Point3<f64> {
        self.middle
    }

    /// Exterior orientations from the numbers of a network, about the mean of the points, object units: stations along a base that is bent to the points,
    /// at two heights in turn, upright. Each looks at a place on the points' surface that moves with its own along the base.
    ///
    /// `None` where a station looks along the vertical.
    pub fn poses(&self, numbers: &[f64; NUMBERS]) -> Option<Vec<Pose>> {
        let [distance, curve, base, shift, height, step, aim_right, spread, aim_up] = *numbers;
        let pose = |index: usize| {
            let along = 2.0 * index as f64 / (self.stations - 1) as f64 - 1.0;
            let height = height + if index.is_multiple_of(2) { step } else { -step };
            let centre = self.from * (distance + curve * along * along) + self.right * (shift + base * along) + self.up * height;
            let aim = self.right * (aim_right + spread * along) + self.up * aim_up;
            Pose::looking_at(Point3::from(centre), Point3::from(aim), self.up, 0.0)
        };
        (0..self.stations).map(pose).collect()
    }

    /// What stations with the true `camera` picture.
    pub fn pictured(&self, poses: Vec<Pose>, camera: &Camera) -> Pictures {
        let size = camera.size();
        let within =
            |at: &PixelPoint| at.x >= 0.0 && at.y >= 0.0 && at.x <= f64::from(size.width - 1) && at.y <= f64::from(size.height - 1);
        let picture = |pose: Pose| {
            let points = self.points.iter().map(|point| camera.project(pose.ray(point)).ok().filter(within)).collect();
            (pose, points)
        };
        poses.into_iter().map(picture).collect()
    }

    /// Errors of the points, object units: intersected less true, with the exterior orientations held and image coordinates corrected by `camera`.
    ///
    /// # Errors
    /// In words: a point whose rays do not meet.
    pub fn errors(&self, pictures: &Pictures, camera: &Photogrammetric) -> Result<Vec<Vector3<f64>>, String> {
        let ideal = Camera::from(without_distortion(camera));
        let frame = self.frame;
        let of = |index: usize| {
            let seen = pictures.iter().filter_map(|(pose, seen)| Some((pose, seen[index]?)));
            let sights: Vec<Sight<'_>> = seen
                .map(|(pose, pixel)| Sight { camera: &ideal, pose, image: frame.to_pixel(corrected(camera, frame.to_sensor(pixel))) })
                .collect();
            let found = intersect(&sights, PARALLEL, None).map_err(|why| format!("point {}: {why}", self.names[index]))?;
            Ok(found.point - self.points[index])
        };
        (0..self.points.len()).map(of).collect()
    }

    /// As [`Self::errors`], by [`STEPS`] steps of Gauss and Newton from the true points: what a fit asks for ten thousand times. `None` where a point is seen
    /// from fewer than two stations.
    pub fn nearly(&self, pictures: &Pictures, camera: &Photogrammetric) -> Option<Vec<Vector3<f64>>> {
        let frame = self.frame;
        let of = |index: usize| {
            let seen = pictures.iter().filter_map(|(pose, seen)| Some((pose, corrected(camera, frame.to_sensor(seen[index]?)))));
            let seen: Vec<(&Pose, SensorPoint)> = seen.collect();
            if seen.len() < 2 {
                return None;
            }
            let start = self.points[index];
            let last = (0..STEPS).try_fold(start, |point, _| Some(point + step(&seen, &point, camera.c)?))?;
            Some(last - start)
        };
        (0..self.points.len()).map(of).collect()
    }
}

/// Steps from a true point to an intersected one: each squares the error, as a part of the distance, and the first is a few hundredths.
const STEPS: usize = 2;

/// A step of least squares in corrected image coordinates, mm, from `point`.
fn step(seen: &[(&Pose, SensorPoint)], point: &Point3<f64>, c: f64) -> Option<Vector3<f64>> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (pose, image) in seen {
        let n = pose.camera_from_world(point);
        let rows = [(n.x, pose.rotation.row(0), image.x), (n.y, pose.rotation.row(1), image.y)];
        for (across, row, measured) in rows {
            let computed = -c * across / n.z;
            // x = -c Nx / Nz
            let slope = (row * -c - pose.rotation.row(2) * computed).transpose() / n.z;
            normal += slope * slope.transpose();
            right += slope * (measured - computed);
        }
    }
    normal.cholesky().map(|factor| factor.solve(&right))
}

fn without_distortion(camera: &Photogrammetric) -> Photogrammetric {
    Photogrammetric { x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2], ..*camera }
}

/// The printed correction of measured coordinates, mm.
fn corrected(camera: &Photogrammetric, measured: SensorPoint) -> SensorPoint {
    let [x, y] = camera.corrected([measured.x - camera.x0, measured.y - camera.y0]);
    SensorPoint { x, y }
}
