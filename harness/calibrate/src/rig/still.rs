//! Whether the cameras of a rig still sit where they sat: the relative pose from new images against that of a file.

use calibench_adjust::Mount;
use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::{NamedCamera, PixelPoint, Pose};
use nalgebra::{Matrix2x3, Matrix2x6, Matrix3, Matrix3x6, Matrix6, Point3, Vector3, Vector6};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use super::calibration::RigCalibration;
use super::leave_out::motion;
use crate::CalibrationError;

/// Columns and rows of the grid of points over the frame of the first camera.
const GRID: [u32; 2] = [21, 15];
/// Probability by chance below which a camera has moved.
const ALPHA: f64 = 1e-3;
/// Standard deviations that are allowed for.
const TIMES: f64 = 2.0;

/// A value with its standard deviation, in the same unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// Whether a camera still sits where it sat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Still {
    /// It moved by less than the margin, as far as the images tell.
    Stands,
    /// It moved by more than the margin, and that is no chance.
    Moved,
    /// The images do not tell.
    CannotTell,
}

/// A camera of a rig as the first one sees it, now and before.
#[derive(Clone, Debug, PartialEq)]
pub struct Stand {
    /// The camera.
    pub camera: usize,
    /// How far its projection centre has moved, object units; the standard deviation along that way.
    pub moved: Known,
    /// By what angle it has turned, degrees; alike.
    pub turned_deg: Known,
    /// By how much points at the distance are elsewhere across its line of sight, object units, root mean square over what both picture.
    pub across: Known,
    /// By how much they are pictured elsewhere, px, alike (2D).
    pub px: Known,
    /// Fisher's statistic of the whole motion.
    pub f: f64,
    /// Probability of so much by chance.
    pub p: f64,
    /// By how much more than the adjustment says leaving moments out moves it: standard deviations count that often; 1 at least.
    pub times: f64,
}

impl Stand {
    /// Whether it still sits there, up to `margin_px` at the distance.
    pub fn verdict(&self, margin_px: f64) -> Still {
        // What the noise makes of no motion at all is as large as its standard deviation.
        let Known { value, sigma } = self.px;
        let net = (value * value - sigma * sigma).max(0.0).sqrt();
        if net + TIMES * sigma <= margin_px {
            Still::Stands
        } else if net - TIMES * sigma > margin_px && self.p < ALPHA {
            Still::Moved
        } else {
            Still::CannotTell
        }
    }
}

/// Each camera but the first against where `before` has it, by points at `distance` (object units) along the axis of the first. Cameras of `before` are those of the rig, in its
/// order, each with its pose.
///
/// # Errors
/// A camera without a pose, other cameras than the rig has, no point at that distance that both picture.
pub fn still_stands(found: &RigCalibration<'_>, before: &[NamedCamera], distance: f64) -> Result<Vec<Stand>, CalibrationError> {
    let refused = |why: String| CalibrationError::Rig(why);
    let count = found.solution.mounts().len();
    if before.len() != count {
        return Err(refused(format!("the rig before has {} cameras; expected {count}", before.len())));
    }
    let pose = |camera: &NamedCamera| camera.pose.ok_or_else(|| refused(format!("camera `{}` has no pose in its rig", camera.name)));
    let first = pose(&before[0])?;
    (1..count)
        .map(|camera| {
            let was = with_y_up(&pose(&before[camera])?.seen_from(&first));
            let sights = Sights::of([&before[0].camera, &before[camera].camera], &was, distance);
            let sights = sights.ok_or_else(|| {
                let names = [found.name_of(0), found.name_of(camera)];
                refused(format!("no point at a distance of {distance} is in the images of both {} and {}", names[0], names[1]))
            })?;
            Ok(stand(found, camera, &was, &sights))
        })
        .collect()
}

/// A relative pose of files (x right, y down, z forward) as adjustments have it, y and z the other way on both sides.
fn with_y_up(pose: &calibench_model::named_camera::Pose) -> Pose {
    let sign = [1.0, -1.0, -1.0];
    Pose {
        rotation: Matrix3::from_fn(|i, j| sign[i] * pose.camera_from_world[i][j] * sign[j]),
        centre: Point3::from(std::array::from_fn::<f64, 3, _>(|i| sign[i] * pose.position[i])),
    }
}

fn stand(found: &RigCalibration<'_>, camera: usize, was: &Pose, sights: &Sights) -> Stand {
    let now = found.covariances.relative(0, camera);
    let times = by_sets(found, camera, &now);
    let covariance = now.covariance * (times * times);
    let step = motion(was, &now.pose);
    let redundancy = found.solution.counts().redundancy();
    let (f, p) = test(&step, &covariance, redundancy).unwrap_or((f64::NAN, 1.0));
    let along = |from: usize, part: Vector3<f64>| {
        let direction = part.try_normalize(0.0).unwrap_or_else(Vector3::x);
        let variance = direction.dot(&(covariance.fixed_view::<3, 3>(from, from) * direction));
        Known { value: part.norm(), sigma: variance.max(0.0).sqrt() }
    };
    let turned = along(0, step.fixed_rows::<3>(0).into_owned());
    Stand {
        camera,
        moved: along(3, step.fixed_rows::<3>(3).into_owned()),
        turned_deg: Known { value: turned.value.to_degrees(), sigma: turned.sigma.to_degrees() },
        across: Sights::moved(&sights.across, &step, &covariance),
        px: Sights::moved(&sights.pictured, &step, &covariance),
        f,
        p,
        times,
    }
}

/// By how much more leaving moments out moves a camera than the adjustment says; 1 at least.
fn by_sets(found: &RigCalibration<'_>, camera: usize, now: &Mount) -> f64 {
    let Ok(sets) = &found.by_sets else { return 1.0 };
    let largest = |mount: &Mount| mount.centre_sigmas().into_iter().fold(0.0, f64::max);
    // The frame is that of the first camera.
    let ratio = largest(&sets.cameras[camera].mount) / largest(now);
    if ratio.is_finite() { ratio.max(1.0) } else { 1.0 }
}

/// Fisher's statistic of a motion in its covariance, and the probability of so much by chance.
fn test(step: &Vector6<f64>, covariance: &Matrix6<f64>, redundancy: i64) -> Option<(f64, f64)> {
    let scale = covariance.diagonal().map(|variance| variance.max(f64::MIN_POSITIVE).sqrt());
    let correlations = Matrix6::from_fn(|i, j| covariance[(i, j)] / (scale[i] * scale[j]));
    let scaled = step.component_div(&scale);
    let f = scaled.dot(&correlations.cholesky()?.solve(&scaled)) / 6.0;
    let fisher = FisherSnedecor::new(6.0, redundancy as f64).ok()?;
    Some((f, fisher.sf(f)))
}

/// Points at a distance that two cameras picture: how a small motion of the second moves each.
struct Sights {
    /// On the sphere around it, brought to the distance: across the line of sight, object units.
    across: Vec<Matrix2x6<f64>>,
    /// In its image, px.
    pictured: Vec<Matrix2x6<f64>>,
}

impl Sights {
    /// `None` where no point is in both images.
    fn of([first, second]: [&Camera; 2], was: &Pose, distance: f64) -> Option<Self> {
        let (size, of) = (first.size(), second.size());
        let inside = |at: &PixelPoint| (0.0..=f64::from(of.width - 1)).contains(&at.x) && (0.0..=f64::from(of.height - 1)).contains(&at.y);
        let part = |i: u32, of: u32, side: u32| f64::from(i) / f64::from(of - 1) * f64::from(side - 1);
        let (mut across, mut pictured) = (Vec::new(), Vec::new());
        for (column, row) in (0..GRID[1]).flat_map(|row| (0..GRID[0]).map(move |column| (column, row))) {
            let at = PixelPoint::new(part(column, GRID[0], size.width), part(row, GRID[1], size.height));
            let Some(ray) = first.unproject(at).ok().filter(|ray| ray.z < 0.0) else { continue };
            let point = Vector3::new(ray.x, ray.y, ray.z) * (distance / -ray.z);
            let n = was.rotation * (point - was.centre.coords);
            let Ok(slopes) = second.slopes(Ray { x: n.x, y: n.y, z: n.z }) else { continue };
            if !inside(&slopes.point) {
                continue;
            }
            // N becomes N + d x N + s.
            let by_motion = Matrix3x6::from_fn(|i, j| if j < 3 { -n.cross_matrix()[(i, j)] } else { f64::from(u8::from(i + 3 == j)) });
            let by_ray = Matrix2x3::from_fn(|i, j| slopes.by_ray[i][j]);
            pictured.push(by_ray * by_motion);
            across.push(beside(&n)? * by_motion);
        }
        (!pictured.is_empty()).then_some(Self { across, pictured })
    }

    /// Root mean square of what a motion makes, and its standard deviation.
    fn moved(by: &[Matrix2x6<f64>], step: &Vector6<f64>, covariance: &Matrix6<f64>) -> Known {
        let count = by.len() as f64;
        let square: f64 = by.iter().map(|by| (by * step).norm_squared()).sum();
        let variance: f64 = by.iter().map(|by| (by * covariance * by.transpose()).trace()).sum();
        Known { value: (square / count).sqrt(), sigma: (variance / count).max(0.0).sqrt() }
    }
}

/// Two directions at right angles to one and each other.
fn beside(direction: &Vector3<f64>) -> Option<Matrix2x3<f64>> {
    let along = direction.try_normalize(0.0)?;
    let other = if along.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let first = along.cross(&other).try_normalize(0.0)?;
    Some(Matrix2x3::from_rows(&[first.transpose(), along.cross(&first).transpose()]))
}
