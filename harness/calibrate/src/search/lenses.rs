//! The lenses that a search starts from.

use calibench_adjust::approximate::{Control, interior_from_size};
use calibench_model::camera::{Camera, CameraModel, OpenCvFisheye};
use calibench_model::{PixelPoint, Pose, upper_median};

use super::clean::without_gross;
use super::ladder::{BROWN, EQUIDISTANT, climbed};
use super::sample::{Arrived, Sample};
use super::{LOWER, kept};
use crate::Optics;
use crate::model;
use crate::network::interior;
use crate::stages::converted;
use crate::start::{middle, pinhole, pose_of};

/// Focal lengths of lenses without distortion, in longer sides.
const FOCAL: [f64; 7] = [0.3, 0.45, 0.7, 1.1, 1.8, 3.0, 6.0];
/// Focal lengths of lenses that picture angles, in longer sides.
const FOCAL_WIDE: [f64; 6] = [0.16, 0.22, 0.32, 0.45, 0.65, 1.0];
/// Half the field of a lens that need not be tried as one that pictures angles, rad.
const NARROW: f64 = 0.7;
/// Iterations at most, of the model asked for.
const ITERATIONS: usize = 100;

/// A lens to start from, with the poses that it gives.
struct Lens {
    camera: Camera,
    poses: Vec<Option<Pose>>,
    rungs: &'static [&'static [&'static str]],
    origin: &'static str,
}

/// The minima of the model asked for: the one that the usual camera leads to, then those that are reached from a lens without distortion and from one that
/// pictures angles. Images that none of the three orients are left out of the sample.
pub(super) fn arrived(sample: &mut Sample, optics: &Optics, usual: Option<&(Camera, String)>) -> (Option<Arrived>, Vec<Arrived>) {
    if sample.is_robust() {
        let cameras = usual.map(|(camera, _)| *camera).into_iter().chain(undistorted(optics).into_iter().flatten()).collect::<Vec<_>>();
        sample.views = without_gross(std::mem::take(&mut sample.views), &cameras);
    }
    let lenses = lenses(sample, optics);
    let of_usual = usual.map(|(camera, _)| sample.poses(camera));
    let all: Vec<&Vec<Option<Pose>>> = lenses.iter().map(|lens| &lens.poses).chain(&of_usual).collect();
    // A pose from another camera where the own one gives none.
    let somehow: Vec<Option<Pose>> = (0..sample.views.len()).map(|view| all.iter().find_map(|poses| poses[view])).collect();
    let filled = |poses: &[Option<Pose>]| poses.iter().zip(&somehow).filter_map(|(own, other)| own.or(*other)).collect::<Vec<Pose>>();
    sample.keep(&somehow.iter().map(Option::is_some).collect::<Vec<_>>());
    let first = usual
        .zip(of_usual.as_ref())
        .and_then(|((camera, origin), poses)| sample.adjusted(interior(optics, camera).ok()?, &filled(poses), ITERATIONS, origin));
    let mut others: Vec<Arrived> = Vec::new();
    for lens in &lenses {
        // The lens that pictures angles decides of wide fields alone, once two starts agree.
        let agree = first.as_ref().zip(others.first()).is_some_and(|(a, b)| (a.cost - b.cost).abs() <= LOWER * a.cost);
        if !(agree && first.as_ref().is_some_and(|first| is_narrow(&first.camera))) {
            let reached = climbed(sample, &lens.camera, filled(&lens.poses), lens.rungs, lens.origin);
            others.extend(reached.and_then(|reached| in_model(sample, optics, &reached)));
        }
    }
    (first, others)
}

/// Whether the corners of the frame are pictured at less than [`NARROW`] from the axis.
fn is_narrow(camera: &Camera) -> bool {
    let [right, bottom] = [camera.size().width, camera.size().height].map(|side| f64::from(side) - 1.0);
    let corners = [(0.0, 0.0), (right, 0.0), (0.0, bottom), (right, bottom)];
    let angle = |(x, y)| camera.unproject(PixelPoint::new(x, y)).map_or(f64::INFINITY, |ray| ray.x.hypot(ray.y).atan2(-ray.z));
    corners.into_iter().all(|corner| angle(corner) < NARROW)
}

/// Lenses without distortion, and ones that picture angles.
fn undistorted(optics: &Optics) -> [Vec<Camera>; 2] {
    let Ok(centre @ [cx, cy]) = middle(optics.size) else { return Default::default() };
    let (size, side) = (optics.size, f64::from(optics.size.width.max(optics.size.height)));
    let straight = |f: f64| pinhole(size, f * side, centre);
    let angles = |f: f64| OpenCvFisheye { size, fx: f * side, fy: f * side, cx, cy, skew: 0.0, k: [0.0; 4] }.into();
    [FOCAL.map(straight).to_vec(), FOCAL_WIDE.map(angles).to_vec()]
}

fn lenses(sample: &Sample, optics: &Optics) -> Vec<Lens> {
    let few = sample.few();
    let nearest = |cameras: Vec<Camera>| {
        let tried = cameras.into_iter().map(|camera| (misfit(&camera, &few), camera));
        tried.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, camera)| camera)
    };
    let [straight, angles] = undistorted(optics);
    let straight = (nearest(straight), &BROWN[..], "the best of some focal lengths, distortion term by term");
    let wide = (nearest(angles), &EQUIDISTANT[..], "the best of some equidistant lenses, distortion term by term");
    let lens =
        |(camera, rungs, origin): (Option<Camera>, _, _)| camera.map(|camera| Lens { camera, poses: sample.poses(&camera), rungs, origin });
    [straight, wide].into_iter().filter_map(lens).collect()
}

/// The median over the images of the mean squared distance after a resection, px^2.
fn misfit(camera: &Camera, views: &[Vec<Control>]) -> f64 {
    let square = |pose: &Pose, control: &Control| {
        camera.project(pose.ray(&control.object)).map_or(f64::INFINITY, |seen| seen.distance(control.image).powi(2))
    };
    let of = |view: &Vec<Control>| {
        let pose = pose_of(camera, view).ok();
        pose.map_or(f64::INFINITY, |pose| view.iter().map(|control| square(&pose, control)).sum::<f64>() / view.len() as f64)
    };
    upper_median(views.iter().map(of)).unwrap_or(f64::INFINITY)
}

/// The minimum of the model asked for, from a lens of another one.
fn in_model(sample: &Sample, optics: &Optics, lens: &Arrived) -> Option<Arrived> {
    let farthest = sample.farthest(&lens.camera)?;
    let rest = model::camera(&interior_from_size(optics.size).ok()?, optics).ok()?;
    let camera = converted(farthest, &lens.camera, optics)?;
    sample.adjusted(interior(optics, &kept(&camera, optics, &rest)).ok()?, &lens.poses, ITERATIONS, &lens.origin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{board, lens};
    use calibench_model::camera::ImageSize;

    #[test]
    fn focal_lengths_are_in_longer_sides() {
        let [straight, angles] = undistorted(&Optics::new(ImageSize { width: 1201, height: 1601 }));
        for (lenses, shares) in [(straight, &FOCAL[..]), (angles, &FOCAL_WIDE)] {
            assert_eq!(lenses.len(), shares.len());
            for (lens, share) in lenses.iter().zip(shares) {
                let found = lens.parameters();
                assert!(found[..2].iter().all(|f| (f.value - share * 1601.0).abs() < 1e-9), "{found:?}");
                assert_eq!([found[2].value, found[3].value], [600.0, 800.0]);
            }
        }
    }

    /// Of the lens that took them images are resected without a misfit; of another one with so much, whatever one image of three says.
    #[test]
    fn a_misfit_is_the_median_over_the_images() {
        let scene = board(lens());
        let controls = |pose: &Pose, off: f64| -> Vec<Control> {
            let one = |(i, object): (usize, &nalgebra::Point3<f64>)| {
                let seen = scene.camera.project(pose.ray(object)).unwrap();
                let sign = if i % 2 == 0 { off } else { -off };
                Control { object: *object, image: PixelPoint::new(seen.x + sign, seen.y) }
            };
            scene.targets.iter().enumerate().map(one).collect()
        };
        let views: Vec<Vec<Control>> = scene.poses[..3].iter().map(|pose| controls(pose, 0.0)).collect();
        assert!(misfit(&scene.camera, &views) < 1e-12);
        let mut one_bad = views.clone();
        one_bad[1] = controls(&scene.poses[1], 10.0);
        assert!(misfit(&scene.camera, &one_bad) < 1e-12);
        // The pose makes up for next to nothing of what alternates: 10 px, squared.
        one_bad[2] = controls(&scene.poses[2], 10.0);
        let found = misfit(&scene.camera, &one_bad);
        assert!((80.0..=100.0).contains(&found), "{found}");
        assert!(misfit(&pinhole(scene.camera.size(), 800.0, [800.0, 600.0]), &views) > 1.0);
        assert_eq!(misfit(&scene.camera, &[]), f64::INFINITY);
    }

    #[test]
    fn a_field_is_narrow_by_the_corner_of_its_frame() {
        let size = ImageSize { width: 1601, height: 1201 };
        let lens = |f: f64| pinhole(size, f, [800.0, 600.0]);
        // The corner is 1000 px from the middle: tan 0.7 = 0.842.
        assert!(is_narrow(&lens(1200.0)) && !is_narrow(&lens(1180.0)));
    }
}
