//! Where the cameras sit and the rig stood, from the pose of each image for itself.

use calibench_adjust::{AdjustError, Defect, mounted, relative};
use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, upper_median};
use nalgebra::{Matrix3, Point3};

use super::pairing::Moments;
use crate::CalibrationError;
use crate::start::spread;

/// Relative poses of two cameras that are compared with each other, at most.
const MOST: usize = 200;
/// Residuals beyond count as this, px: a wrong pose of one image must not outweigh all else.
const FAR_PX: f64 = 50.0;

/// An image as starts are found from.
pub(super) struct Seen {
    pub(super) camera: usize,
    pub(super) set: usize,
    /// Its own pose, where it has one.
    pub(super) pose: Option<Pose>,
    /// Known points and where they are pictured.
    pub(super) points: Vec<(Point3<f64>, PixelPoint)>,
}

/// The mount of each camera against that of the camera `origin`, from the images that share a set: along the pairs of cameras that share most.
///
/// # Errors
/// Cameras that no chain of sets joins, by name.
pub(super) fn mounts(images: &[Seen], names: &[String], origin: usize) -> Result<Vec<Pose>, CalibrationError> {
    let count = names.len();
    let pairs: Vec<Vec<Vec<Pose>>> = (0..count).map(|a| (0..count).map(|b| shared(images, a, b)).collect()).collect();
    let distance =
        upper_median(images.iter().filter_map(|image| Some((image.points.first()?.0 - image.pose?.centre).norm()))).unwrap_or(1.0);
    let mut mounts: Vec<Option<Pose>> = vec![None; count];
    mounts[origin] = Some(Pose { rotation: Matrix3::identity(), centre: Point3::origin() });
    while let Some((from, to)) = next(&mounts, &pairs) {
        let step = middle(&pairs[from][to], distance);
        mounts[to] = mounts[from].zip(step).map(|(mount, step)| mounted(&step, &mount));
    }
    if mounts.iter().any(Option::is_none) {
        return Err(CalibrationError::Adjust(AdjustError::Undetermined(Box::new(Defect::Unconnected { sets: sets(names, &pairs) }))));
    }
    Ok(mounts.into_iter().flatten().collect())
}

/// The pair of a camera that is placed and one that is not that shares most sets.
fn next(mounts: &[Option<Pose>], pairs: &[Vec<Vec<Pose>>]) -> Option<(usize, usize)> {
    let is_next = |&(a, b): &(usize, usize)| mounts[a].is_some() && mounts[b].is_none() && !pairs[a][b].is_empty();
    let all = (0..mounts.len()).flat_map(|a| (0..mounts.len()).map(move |b| (a, b)));
    // Of equal ones the first.
    all.filter(is_next).min_by_key(|&(a, b)| (std::cmp::Reverse(pairs[a][b].len()), a, b))
}

/// The relative poses of two cameras, one of each set that both see.
fn shared(images: &[Seen], a: usize, b: usize) -> Vec<Pose> {
    if a == b {
        return Vec::new();
    }
    let of = |camera: usize| images.iter().filter(move |image| image.camera == camera).filter_map(|image| Some((image.set, image.pose?)));
    let second: std::collections::BTreeMap<usize, Pose> = of(b).collect();
    of(a).filter_map(|(set, first)| Some(relative(&first, second.get(&set)?))).collect()
}

/// The one of some poses that is nearest to all others, so that wrong ones are no matter.
fn middle(all: &[Pose], distance: f64) -> Option<Pose> {
    let some: Vec<Pose> = if all.len() <= MOST { all.to_vec() } else { spread(all.len(), MOST).map(|place| all[place]).collect() };
    let away = |a: &Pose, b: &Pose| {
        let cosine = (0.5 * ((a.rotation * b.rotation.transpose()).trace() - 1.0)).clamp(-1.0, 1.0);
        cosine.acos() + (a.centre - b.centre).norm() / distance
    };
    let sum = |pose: &Pose| some.iter().map(|other| away(pose, other)).sum::<f64>();
    some.iter().map(|pose| (sum(pose), *pose)).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, pose)| pose)
}

/// Cameras that are connected with each other.
fn sets(names: &[String], pairs: &[Vec<Vec<Pose>>]) -> Vec<Vec<String>> {
    let mut set: Vec<usize> = (0..names.len()).collect();
    for (a, b) in (0..names.len()).flat_map(|a| (0..names.len()).map(move |b| (a, b))).filter(|&(a, b)| !pairs[a][b].is_empty()) {
        let (low, high) = (set[a].min(set[b]), set[a].max(set[b]));
        set.iter_mut().filter(|set| **set == high).for_each(|set| *set = low);
    }
    let members = |first: usize| (0..names.len()).filter(|&camera| set[camera] == first).map(|camera| names[camera].clone()).collect();
    (0..names.len()).map(members).filter(|members: &Vec<String>| !members.is_empty()).collect()
}

/// Where the rig stood at each moment: of the places that the images say, the one from which all are pictured best; `None` where no image has a pose.
pub(super) fn stations(images: &[Seen], moments: &Moments, mounts: &[Pose], cameras: &[Camera]) -> Vec<Option<Pose>> {
    let mut of_set: Vec<Vec<&Seen>> = vec![Vec::new(); moments.names.len()];
    images.iter().for_each(|image| of_set[image.set].push(image));
    let misfit = |station: &Pose, members: &[&Seen]| -> f64 {
        let of = |image: &&Seen| {
            let pose = mounted(&mounts[image.camera], station);
            let off = |(point, at): &(Point3<f64>, PixelPoint)| {
                let seen = cameras[image.camera].project(pose.ray(point)).ok();
                seen.map_or(FAR_PX, |seen| seen.distance(*at).min(FAR_PX)).powi(2)
            };
            image.points.iter().map(off).sum::<f64>()
        };
        members.iter().map(of).sum()
    };
    let best = |members: &Vec<&Seen>| {
        let places = members.iter().filter_map(|image| {
            let (mount, pose) = (&mounts[image.camera], image.pose?);
            let rotation = mount.rotation.transpose() * pose.rotation;
            Some(Pose { rotation, centre: pose.centre - rotation.tr_mul(&mount.centre.coords) })
        });
        places.map(|place| (misfit(&place, members), place)).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, place)| place)
    };
    of_set.iter().map(best).collect()
}
