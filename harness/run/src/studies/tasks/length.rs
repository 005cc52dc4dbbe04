//! A length that a camera measures: its error, and what is said of it.

use calibench_adjust::approximate::{Control, Sight, fit_pose, intersect};
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use calibench_scenario::studies::tasks::Tasks;
use calibench_task::{Budget, ControlErrors, KnownCamera, KnownPlane, Quantity, Station, Task};
use nalgebra::{Point3, Rotation3, Vector3};
use rand::{Rng, RngExt};

use super::board::{Board, normal};

/// How a length is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// In two images whose poses are stated.
    Stated,
    /// In two images whose poses come from the board in them.
    FromBoard,
    /// In one image, before a plane that is known.
    Plane,
}

impl Way {
    pub(super) const ALL: [Self; 3] = [Self::Stated, Self::FromBoard, Self::Plane];

    /// Its name in records.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Stated => "poses stated",
            Self::FromBoard => "poses from the board",
            Self::Plane => "before a plane",
        }
    }
}

/// A measured length.
pub(super) struct Measured {
    /// How long it is, object units.
    pub(super) length: f64,
    /// Found less true length, object units.
    pub(super) error: f64,
    /// The standard uncertainty that `task` says, object units.
    pub(super) sigma: f64,
}

/// Draws of stations and ends until all of it is in view.
const TRIES: usize = 1000;
/// Of a board's shorter half, how far over and below it ends of lengths are.
const HEIGHT: f64 = 0.4;
/// Of the distance to the board, how far the stations of a pair are at least from each other.
const BASE: f64 = 0.35;

/// Two ends of a length in view.
struct Scene {
    /// Where they are, object units.
    ends: [Point3<f64>; 2],
    /// Where images are taken from.
    poses: Vec<Pose>,
    /// Where each image pictures both, as they are measured, px.
    seen: Vec<[PixelPoint; 2]>,
}

/// What measures: the true camera, and what is known of it.
pub(super) struct Measuring<'a> {
    pub(super) plan: &'a Tasks,
    pub(super) board: &'a Board,
    /// The true camera.
    pub(super) truth: &'a Camera,
    /// What the calibration says of it.
    pub(super) found: KnownCamera<'a>,
    /// Where images are taken from.
    pub(super) poses: &'a [Pose],
}

impl Measuring<'_> {
    /// A length, measured in this way; `None` where no pair of ends and stations was found, or the budget refuses it.
    pub(super) fn measure(&self, way: Way, rng: &mut impl Rng) -> Option<Measured> {
        let Scene { ends, poses, seen } = (0..TRIES).find_map(|_| self.scene(way, rng))?;
        let stated = way != Way::FromBoard;
        let [sigma_centre, sigma_angles] = [self.plan.centre_sigma, self.plan.angle_sigma].map(|sigma| if stated { sigma } else { 0.0 });
        let plane =
            KnownPlane { point: Point3::origin(), normal: Vector3::z(), sigma: self.plan.plane_sigma, sigma_tilt: self.plan.tilt_sigma };
        let errors = self.plan.board;
        let task = Task {
            unit: None,
            quantity: Quantity::Length(ends),
            images: poses.iter().map(|pose| Station { pose: *pose, sigma_centre, sigma_angles }).collect(),
            plane: (way == Way::Plane).then_some(plane),
            sigma_px: self.plan.noise_px,
            control: ControlErrors { sigma_px: self.plan.noise_px, print_sigma: errors.print, flatness_sigma: errors.flatness },
            scale_sigma: if stated { 0.0 } else { errors.scale },
            temperature: None,
        };
        let control = (!stated).then_some(&self.board.nominal[..]);
        let budget = Budget::of(&task, &self.found, control).ok()?;
        let known: Vec<Pose> = poses.iter().map(|pose| self.known_pose(pose, stated, rng)).collect::<Option<_>>()?;
        let found = match way {
            Way::Plane => {
                let lift = self.plan.plane_sigma * normal(rng);
                let normal = Vector3::new(self.plan.tilt_sigma * normal(rng), self.plan.tilt_sigma * normal(rng), 1.0);
                self.before_plane(&known[0], seen[0], Point3::new(0.0, 0.0, lift), normal)?
            }
            Way::Stated | Way::FromBoard => self.intersected(&known, &seen)?,
        };
        let length = (ends[1] - ends[0]).norm();
        Some(Measured { length, error: (found[1] - found[0]).norm() - length, sigma: budget.components.first()?.sigma })
    }

    /// Ends and stations as they are drawn; `None` where something is not in view.
    fn scene(&self, way: Way, rng: &mut impl Rng) -> Option<Scene> {
        let [half_x, half_y] = self.board.half;
        let height = if way == Way::Plane { 0.0 } else { HEIGHT * half_x.min(half_y) };
        let mut end = || {
            let [x, y, z] = [half_x, half_y, height].map(|half| half * (2.0 * rng.random::<f64>() - 1.0));
            Point3::new(self.board.middle[0] + x, self.board.middle[1] + y, z)
        };
        let ends = [end(), end()];
        let count = self.poses.len();
        let [one, other] = [rng.random_range(0..count), rng.random_range(0..count)];
        let poses = if way == Way::Plane { vec![self.poses[one]] } else { vec![self.poses[one], self.poses[other]] };
        let base = BASE * (poses[0].centre - Point3::new(self.board.middle[0], self.board.middle[1], 0.0)).norm();
        let apart = poses.len() == 1 || (poses[0].centre - poses[1].centre).norm() > base;
        if !apart || (ends[1] - ends[0]).norm() < self.plan.length {
            return None;
        }
        let mut seen = Vec::new();
        for pose in &poses {
            let [from, to] = ends.map(|end| self.seen(pose, &end, rng));
            seen.push([from?, to?]);
        }
        Some(Scene { ends, poses, seen })
    }

    /// Where the true camera pictures a point, as it is measured.
    fn seen(&self, pose: &Pose, object: &Point3<f64>, rng: &mut impl Rng) -> Option<PixelPoint> {
        let at = self.truth.project(pose.ray(object)).ok()?;
        let size = self.truth.size();
        let inside = |at: f64, pixels: u32| (-0.5..f64::from(pixels) - 0.5).contains(&at);
        let in_frame = inside(at.x, size.width) && inside(at.y, size.height);
        in_frame.then(|| PixelPoint::new(at.x + self.plan.noise_px * normal(rng), at.y + self.plan.noise_px * normal(rng)))
    }

    /// A pose as the user has it: stated with its errors, or from the board as its file has it.
    fn known_pose(&self, pose: &Pose, stated: bool, rng: &mut impl Rng) -> Option<Pose> {
        let mut three = |sigma: f64| Vector3::from_fn(|_, _| sigma * normal(rng));
        if stated {
            let turn = Rotation3::new(three(self.plan.angle_sigma));
            return Some(Pose { rotation: turn * pose.rotation, centre: pose.centre + three(self.plan.centre_sigma) });
        }
        let pairs = self.board.nominal.iter().zip(&self.board.real);
        let control: Vec<Control> = pairs
            .filter_map(|(nominal, real)| Some(Control { object: nominal.position.into(), image: self.seen(pose, real, rng)? }))
            .collect();
        Some(fit_pose(self.found.camera, pose, &control).ok()?.pose)
    }

    fn intersected(&self, known: &[Pose], seen: &[[PixelPoint; 2]]) -> Option<[Point3<f64>; 2]> {
        let point = |end: usize| {
            let sights: Vec<Sight<'_>> =
                known.iter().zip(seen).map(|(pose, seen)| Sight { camera: self.found.camera, pose, image: seen[end] }).collect();
            Some(intersect(&sights, 0.0, None).ok()?.point)
        };
        Some([point(0)?, point(1)?])
    }

    fn before_plane(&self, pose: &Pose, seen: [PixelPoint; 2], through: Point3<f64>, normal: Vector3<f64>) -> Option<[Point3<f64>; 2]> {
        let point = |at: PixelPoint| {
            let ray = pose.world_from_ray(self.found.camera.unproject(at).ok()?);
            Some(pose.centre + ray * ((through - pose.centre).dot(&normal) / ray.dot(&normal)))
        };
        Some([point(seen[0])?, point(seen[1])?])
    }
}
