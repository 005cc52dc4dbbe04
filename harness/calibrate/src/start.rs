//! Start values without truth.

use calibench_adjust::approximate::{
    Assumed, Control, Search, Shape, Sight as Ray, Tolerance, direct_linear, interior_from_planes, interior_from_size, intersect,
    planar_poses, resect,
};
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, OpenCvFisheye};
use calibench_model::{Pose, upper_median};
use nalgebra::Point3;
use rayon::prelude::*;

use super::{CalibrationError, Optics, Settings, Survey, model, prior};

/// Height of control, as a share of its extent, below which it is a plane for start values.
const FLAT: f64 = 1e-4;
/// Focal lengths that are tried for control with depth, in longer sides.
const FOCAL: [f64; 4] = [0.6, 1.2, 2.4, 4.8];
/// Focal lengths that are tried for lenses that picture angles, in longer sides: 180 degrees along it take 0.32.
const FOCAL_WIDE: [f64; 4] = [0.22, 0.32, 0.45, 0.65];
/// Rounds of resection and intersection for images that see too little control.
const ROUNDS: usize = 3;
/// Control points of an image that start values are found from, at most: their cost then grows with the images alone.
const ENOUGH: usize = 500;
/// Images of which one lens after another is tried, at most, and points of each.
const FEW: (usize, usize) = (24, 60);
/// Rays that meet at less are parallel, rad.
const PARALLEL: f64 = 1e-3;

/// Start values of everything.
#[derive(Clone, Debug)]
pub(super) struct Starts {
    /// Of each camera.
    pub(super) cameras: Vec<Camera>,
    /// Where each camera comes from, in words.
    pub(super) origins: Vec<String>,
    /// Of each image.
    pub(super) poses: Vec<Pose>,
    /// Of each target, or why there is none.
    pub(super) points: Vec<Result<Point3<f64>, String>>,
}

/// Start values of a survey, with cameras that need not be of the model asked for: from planes by Zhang's closed form, from control with depth by the direct linear transformation or the best of some usual
/// focal lengths; then resections and intersections in turn.
pub(super) fn starts(survey: &Survey, owners: &[usize], settings: &Settings) -> Result<Starts, CalibrationError> {
    settings.cameras.iter().try_for_each(model::check)?;
    prior::check(&settings.stations, &survey.images)?;
    let known: Vec<Option<Point3<f64>>> = (0..survey.targets()).map(|target| survey.known(target)).collect();
    let views: Vec<Vec<Control>> = (0..survey.images.len()).map(|image| some_control_of(survey, &known, image)).collect();
    let rough = |(index, optics): (usize, &Optics)| {
        let own: Vec<&[Control]> =
            views.iter().zip(owners).filter(|(_, owner)| **owner == index).map(|(view, _)| view.as_slice()).collect();
        rough(optics, &own, is_flat(&known))
    };
    let rough = settings.cameras.iter().enumerate().map(rough).collect::<Result<Vec<_>, _>>()?;
    let (rough, origins): (Vec<Camera>, Vec<String>) = rough.into_iter().unzip();
    orient_all(survey, owners, settings, rough, origins)
}

/// Poses of all images and tie points, from cameras.
pub(super) fn orient_all(
    survey: &Survey,
    owners: &[usize],
    settings: &Settings,
    cameras: Vec<Camera>,
    origins: Vec<String>,
) -> Result<Starts, CalibrationError> {
    let known: Vec<Option<Point3<f64>>> = (0..survey.targets()).map(|target| survey.known(target)).collect();
    let observed: Vec<Option<Pose>> =
        survey.images.iter().map(|image| prior::station(&settings.stations, image).map(|row| row.station.pose)).collect();
    let of_image: Vec<Camera> = owners.iter().map(|&owner| cameras[owner]).collect();
    let (poses, points) = orient(survey, &of_image, known, &observed, pose_finder(settings))?;
    Ok(Starts { cameras, origins, poses, points })
}

/// A camera to find poses with, and where it comes from.
fn rough(optics: &Optics, views: &[&[Control]], flat: bool) -> Result<(Camera, String), CalibrationError> {
    if let Some(camera) = optics.start {
        return Ok((camera, "the camera file given".to_owned()));
    }
    let usual = if flat { from_plane(views, optics.size)? } else { from_depth(views, optics.size)? };
    if model::is_wide(optics) { widest(views, optics.size, usual) } else { Ok(usual) }
}

/// What an image sees of the points that are known.
pub fn control_of(survey: &Survey, known: &[Option<Point3<f64>>], image: usize) -> Vec<Control> {
    seen_of(survey, known, image).collect()
}

fn seen_of<'s>(survey: &'s Survey, known: &'s [Option<Point3<f64>>], image: usize) -> impl Iterator<Item = Control> + 's {
    let sights = survey.of_image(image).map(move |index| survey.sight(index));
    sights.filter_map(move |sight| Some(Control { object: known[sight.target]?, image: sight.position }))
}

/// As [`control_of`], of many points [`ENOUGH`]: start values need no more.
fn some_control_of(survey: &Survey, known: &[Option<Point3<f64>>], image: usize) -> Vec<Control> {
    spread_control_of(survey, known, image, ENOUGH)
}

/// As [`control_of`], but `most` points, spread over their order.
pub(super) fn spread_control_of(survey: &Survey, known: &[Option<Point3<f64>>], image: usize, most: usize) -> Vec<Control> {
    let count = seen_of(survey, known, image).count();
    if count <= most {
        return control_of(survey, known, image);
    }
    let mut places = spread(count, most).peekable();
    seen_of(survey, known, image).enumerate().filter(|(place, _)| places.next_if_eq(place).is_some()).map(|(_, control)| control).collect()
}

/// `most` places of `count`, one in each of as many parts, at a different place within each: the points of a grid, whose order has a period, are not
/// taken from one of its lines.
pub(crate) fn spread(count: usize, most: usize) -> impl Iterator<Item = usize> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (0..most).map(move |part| {
        let (first, next) = (part * count / most, (part + 1) * count / most);
        first + ((part as f64 * GOLDEN).fract() * (next - first) as f64) as usize
    })
}

fn is_flat(known: &[Option<Point3<f64>>]) -> bool {
    Shape::of(known.iter().flatten().copied()).relative()[0] <= FLAT
}

pub(super) fn pinhole(size: ImageSize, focal: f64, [cx, cy]: [f64; 2]) -> Camera {
    OpenCv { size, fx: focal, fy: focal, cx, cy, distortion: [0.0; 14], coefficients: 5 }.into()
}

/// Where the principal point of a camera of which nothing is known lies.
pub(super) fn middle(size: ImageSize) -> Result<[f64; 2], CalibrationError> {
    let guess = interior_from_size(size)?;
    let named = |name: &str| guess.parameters().iter().find(|p| p.name == name).map_or(0.0, |p| p.value);
    Ok([named("cx"), named("cy")])
}

fn from_plane(views: &[&[Control]], size: ImageSize) -> Result<(Camera, String), CalibrationError> {
    let usable: Vec<&[Control]> = views.iter().copied().filter(|view| view.len() >= 4).collect();
    let Ok(found) = interior_from_planes(&usable, size) else {
        // The adjustment says what of it cannot be determined.
        return Ok((interior_from_size(size)?, "the size of the images alone: no view of the plane shows the principal distance".into()));
    };
    let value = |name: &str| found.camera.parameters().iter().find(|p| p.name == name).map_or(0.0, |p| p.value);
    let assumed = match found.assumed {
        Assumed::Nothing => "",
        Assumed::Centre => ", with the principal point in the centre of the frame",
        Assumed::CentreAndSquare => ", with the principal point in the centre of the frame and square pixels",
    };
    let origin = format!("Zhang's closed form from {} views of the plane{assumed}", found.used.len());
    // Square pixels: what is not solved for must not keep a difference that comes from distortion.
    Ok((pinhole(size, (value("fx") * value("fy")).sqrt(), [value("cx"), value("cy")]), origin))
}

fn from_depth(views: &[&[Control]], size: ImageSize) -> Result<(Camera, String), CalibrationError> {
    let side = f64::from(size.width.max(size.height));
    let centre = middle(size)?;
    let mut focal: Vec<(f64, &str)> = FOCAL.iter().map(|f| (f * side, "the best of some usual focal lengths")).collect();
    let some = some(views);
    let mut linear: Vec<f64> =
        some.par_iter().filter_map(|view| direct_linear(view, size, 1000.0, None).ok()).map(|dlt| dlt.camera.c).collect();
    linear.retain(|f| *f > 0.2 * side && *f < 20.0 * side);
    if let Some(median) = upper_median(linear) {
        focal.push((median, "the direct linear transformation (median of the images)"));
    }
    let few = few(&some);
    let tried = focal.into_iter().map(|(focal, origin)| {
        let camera = pinhole(size, focal, centre);
        (misfit(&camera, &few), camera, origin)
    });
    let best = tried.min_by(|a, b| a.0.total_cmp(&b.0));
    let (camera, origin) = best.map_or_else(|| (pinhole(size, side, centre), "a guess"), |(_, camera, origin)| (camera, origin));
    Ok((camera, origin.to_owned()))
}

/// Some of many views, spread over their order.
fn some<'v>(views: &[&'v [Control]]) -> Vec<&'v [Control]> {
    if views.len() <= FEW.0 { views.to_vec() } else { spread(views.len(), FEW.0).map(|place| views[place]).collect() }
}

/// Some of the many points of views.
fn few(views: &[&[Control]]) -> Vec<Vec<Control>> {
    let of =
        |view: &[Control]| if view.len() <= FEW.1 { view.to_vec() } else { spread(view.len(), FEW.1).map(|place| view[place]).collect() };
    views.iter().map(|view| of(view)).collect()
}

/// The median over the images of the standard deviation of an image coordinate after a resection, px.
fn misfit(camera: &Camera, views: &[Vec<Control>]) -> f64 {
    let sigma = |view: &Vec<Control>| resect(camera, view, None).map_or(f64::INFINITY, |found| found.sigma0);
    let sigmas: Vec<f64> = views.par_iter().filter(|view| view.len() >= 4).map(sigma).collect();
    upper_median(sigmas).unwrap_or(f64::INFINITY)
}

/// `usual`, or a lens that pictures angles if one suits the images better.
fn widest(views: &[&[Control]], size: ImageSize, usual: (Camera, String)) -> Result<(Camera, String), CalibrationError> {
    let side = f64::from(size.width.max(size.height));
    let [cx, cy] = middle(size)?;
    let equidistant = |f: f64| OpenCvFisheye { size, fx: f * side, fy: f * side, cx, cy, skew: 0.0, k: [0.0; 4] }.into();
    let views = few(&some(views));
    let tried = FOCAL_WIDE.map(equidistant).into_iter().map(|camera| (misfit(&camera, &views), camera));
    let best = tried.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(misfits, _)| *misfits < misfit(&usual.0, &views));
    Ok(best.map_or(usual, |(_, camera)| (camera, "the best of some equidistant lenses".to_owned())))
}

/// The pose of an image: before a plane, or else by resection, against gross errors if it does not work without.
///
/// # Errors
/// In words.
pub fn pose_of(camera: &Camera, control: &[Control]) -> Result<Pose, String> {
    if control.len() < 4 {
        return Err(format!("{} known points, a resection takes at least 4", control.len()));
    }
    if let Some(best) = planar_poses(camera, control).ok().and_then(|poses| poses.first().copied()) {
        return Ok(best.pose);
    }
    let against = Search { seed: 1, tolerance: Tolerance::Unknown };
    let found = resect(camera, control, None).or_else(|error| resect(camera, control, Some(&against)).map_err(|_| error));
    found.map(|found| found.pose).map_err(|error| error.to_string())
}

/// As [`pose_of`], against gross errors in the first place.
///
/// # Errors
/// As of [`pose_of`].
pub fn robust_pose_of(camera: &Camera, control: &[Control]) -> Result<Pose, String> {
    let against = Search { seed: 1, tolerance: Tolerance::Unknown };
    resect(camera, control, Some(&against)).map(|found| found.pose).or_else(|_| pose_of(camera, control))
}

/// How poses are found: where gross errors are looked for, against them in the first place.
pub(super) fn pose_finder(settings: &Settings) -> PoseFinder {
    if settings.gross.of_start().is_some() { robust_pose_of } else { pose_of }
}

pub(super) type PoseFinder = fn(&Camera, &[Control]) -> Result<Pose, String>;

type Points = Vec<Result<Point3<f64>, String>>;

/// Poses from known points, or else as observed, and tie points from oriented images, in turn.
fn orient(
    survey: &Survey,
    cameras: &[Camera],
    mut known: Vec<Option<Point3<f64>>>,
    observed: &[Option<Pose>],
    finder: PoseFinder,
) -> Result<(Vec<Pose>, Points), CalibrationError> {
    let mut poses: Vec<Result<Pose, String>> = vec![Err(String::new()); survey.images.len()];
    let mut why = vec![String::new(); known.len()];
    for round in 0..ROUNDS {
        let lost: Vec<usize> = (0..poses.len()).filter(|&image| poses[image].is_err()).collect();
        let pose = |&image: &usize| {
            let found = finder(&cameras[image], &some_control_of(survey, &known, image));
            found.or_else(|why| observed[image].ok_or(why))
        };
        let found: Vec<Result<Pose, String>> = lost.par_iter().map(pose).collect();
        let new = found.iter().any(Result::is_ok);
        lost.into_iter().zip(found).for_each(|(image, pose)| poses[image] = pose);
        if round > 0 && !new {
            // Tie points would come out as they are.
            break;
        }
        let ties: Vec<usize> = (0..known.len()).filter(|&target| survey.control(target).is_none()).collect();
        let found: Vec<Result<Point3<f64>, String>> = ties.par_iter().map(|&target| tie_point(survey, cameras, &poses, target)).collect();
        for (target, found) in ties.into_iter().zip(found) {
            match found {
                Ok(point) => known[target] = Some(point),
                Err(reason) => why[target] = reason,
            }
        }
    }
    let lost: Vec<_> =
        survey.images.iter().zip(&poses).filter_map(|(name, pose)| Some((name.clone(), pose.as_ref().err()?.clone()))).collect();
    if !lost.is_empty() {
        return Err(CalibrationError::NoPose { images: lost });
    }
    let points = known.into_iter().zip(why).map(|(point, why)| point.ok_or(why)).collect();
    Ok((poses.into_iter().flatten().collect(), points))
}

fn tie_point(survey: &Survey, cameras: &[Camera], poses: &[Result<Pose, String>], target: usize) -> Result<Point3<f64>, String> {
    let seen = survey.of_target(target).map(|index| survey.sight(index));
    let rays: Vec<Ray<'_>> = seen
        .filter_map(|sight| Some(Ray { camera: &cameras[sight.image], pose: poses[sight.image].as_ref().ok()?, image: sight.position }))
        .collect();
    if rays.len() < 2 {
        return Err("no control point, and not seen in two oriented images".into());
    }
    intersect(&rays, PARALLEL, None).map(|found| found.point).map_err(|error| format!("no control point, and no intersection: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_spread_and_have_no_period() {
        for count in [501, 1000, 999_983, 1_000_000] {
            let places: Vec<usize> = spread(count, ENOUGH).collect();
            assert_eq!(places.len(), ENOUGH);
            assert!(places.is_sorted_by(|a, b| a < b) && places[ENOUGH - 1] < count && places[0] < count / ENOUGH + 1);
        }
        // A grid of 2000 columns and 500 rows, row by row: every column of ten is met.
        let mut met = [0; 10];
        spread(1_000_000, ENOUGH).for_each(|place| met[place % 2000 / 200] += 1);
        assert!(met.iter().all(|&count| count > 40), "{met:?}");
    }

    #[test]
    fn control_is_flat_below_a_ten_thousandth_of_its_extent() {
        let field = |height: f64, tilt: f64| -> Vec<Option<Point3<f64>>> {
            let point = |i: i32| {
                Point3::new(f64::from(i % 10) + 50.0, f64::from(i / 10) - 70.0, height * f64::from(i % 3) + tilt * f64::from(i % 10))
            };
            (0..100).map(point).map(Some).chain([None]).collect()
        };
        assert!(is_flat(&field(0.0, 0.0)) && is_flat(&field(0.0, 0.7)) && is_flat(&field(1e-4, 0.7)));
        assert!(!is_flat(&field(1e-3, 0.0)) && !is_flat(&field(1e-3, 0.7)) && !is_flat(&field(5.0, 0.0)));
    }
}
