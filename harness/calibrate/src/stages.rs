//! Better start values for models that do not converge from a camera without distortion: a simpler one is adjusted first, and converted.

use calibench_adjust::{Options, Solution, adjust};
use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::convert::{ConvertOptions, Region};

use super::start::Starts;
use super::{CalibrationError, Optics, Settings, Survey, model, network};

/// Iterations of a simpler model at most: its minimum need not be exact.
const ITERATIONS: usize = 30;
/// Circles over which models are fitted, as shares of the one that holds all image points.
const CIRCLES: [f64; 4] = [1.0, 0.95, 0.9, 0.8];

/// `starts` with cameras of the models of `settings`.
pub(super) fn refined(survey: &Survey, owners: &[usize], starts: Starts, settings: &Settings) -> Result<Starts, CalibrationError> {
    if let Some(better) = by_stages(survey, owners, &starts, settings) {
        return Ok(better);
    }
    let cameras = starts.cameras.iter().zip(&settings.cameras).map(|(rough, optics)| model::camera(rough, optics));
    Ok(Starts { cameras: cameras.collect::<Result<_, _>>()?, ..starts })
}

/// `starts` with the camera of `settings`, by way of a simpler model adjusted from their own; `None` where that is not needed or does not work.
fn by_stages(survey: &Survey, owners: &[usize], starts: &Starts, settings: &Settings) -> Option<Starts> {
    let simpler: Vec<Option<Optics>> = settings.cameras.iter().zip(&starts.cameras).map(|(optics, rough)| simpler(optics, rough)).collect();
    if simpler.iter().all(Option::is_none) {
        return None;
    }
    let staged = simpler.iter().zip(&settings.cameras).map(|(simpler, optics)| simpler.as_ref().unwrap_or(optics).clone());
    let first = Settings { cameras: staged.collect(), ..settings.clone() };
    let cameras = first.cameras.iter().zip(&starts.cameras).map(|(optics, rough)| model::camera(rough, optics));
    let started = Starts { cameras: cameras.collect::<Result<_, _>>().ok()?, ..starts.clone() };
    let (network, ..) = network::network(survey, owners, &started, &first).ok()?;
    let options = Options { huber: settings.gross.of_start(), most_iterations: ITERATIONS, ..Options::default() };
    let solution = adjust(&network, &options).ok()?;
    let (mut cameras, mut origins) = (solution.cameras().to_vec(), starts.origins.clone());
    for (index, simple) in simpler.iter().enumerate().filter_map(|(index, simple)| Some((index, simple.as_ref()?))) {
        let own = (0..survey.sights()).map(|index| survey.sight(index)).filter(|sight| owners[sight.image] == index);
        let axis = cameras[index].project(Ray { x: 0.0, y: 0.0, z: -1.0 }).ok()?;
        let farthest = own.map(|sight| sight.position.distance(axis)).fold(1.0, f64::max);
        cameras[index] = converted(farthest, &cameras[index], &settings.cameras[index])?;
        origins[index] = format!("{}, then an adjustment with {}, converted", origins[index], model::name(simple));
    }
    Some(Starts { cameras, origins, poses: solution.poses().to_vec(), points: points(starts, &solution) })
}

/// The camera with a simpler model, if it needs one: what is not solved for keeps what a rough start says of it.
fn simpler(optics: &Optics, rough: &Camera) -> Option<Optics> {
    if optics.start.is_some() || optics.solve.is_some() {
        return None;
    }
    let (simple, unknowns) = model::simpler(rough, optics)?;
    let solve = unknowns.iter().map(|&name| name.to_owned()).collect();
    Some(Optics { model: Some(simple.to_owned()), solve: Some(solve), priors: Vec::new(), ..optics.clone() })
}

/// The camera of `optics` that is nearest to `simple` in the circle about its axis that holds all its image points, `farthest` px wide, since a fit need not
/// suit what was not seen; in a smaller one if the model pictures no more.
pub(super) fn converted(farthest: f64, simple: &Camera, optics: &Optics) -> Option<Camera> {
    CIRCLES.iter().find_map(|share| {
        let region = Region::Radius { px: share * farthest };
        model::converted(simple, optics, &ConvertOptions { accept: true, region, ..ConvertOptions::default() }).ok()
    })
}

/// The network holds the targets that have a position, in their order.
fn points(starts: &Starts, solution: &Solution<'_>) -> Vec<Result<nalgebra::Point3<f64>, String>> {
    let mut adjusted = solution.points().iter();
    let new = |old: &Result<nalgebra::Point3<f64>, String>| match old {
        Ok(position) => Ok(*adjusted.next().unwrap_or(position)),
        Err(why) => Err(why.clone()),
    };
    starts.points.iter().map(new).collect()
}

#[cfg(test)]
mod tests {
    use calibench_model::camera::OpenCvFisheye;
    use calibench_model::convert::{DifferenceOptions, difference};

    use super::*;
    use crate::scenes::{SIZE, board, lens, optics, settings};
    use crate::start::starts;

    #[test]
    fn a_wide_lens_is_adjusted_as_one_that_pictures_angles_and_then_converted() {
        let k = [0.02, -0.01, 0.0, 0.0];
        let truth: Camera = OpenCvFisheye { size: SIZE, fx: 700.0, fy: 700.0, cx: 790.0, cy: 610.0, skew: 0.0, k }.into();
        let (scene, settings) = (board(truth), settings("prism-fisheye"));
        let survey = Survey::new(scene.points(), &scene.known()).unwrap();
        let owners = vec![0; survey.images.len()];
        let rough = starts(&survey, &owners, &settings).unwrap();
        let found = by_stages(&survey, &owners, &rough, &settings).unwrap();
        assert!(found.origins[0].ends_with("then an adjustment with opencv-fisheye, converted"), "{:?}", found.origins);
        let apart = |camera: &Camera| difference(&truth, camera, &DifferenceOptions::default()).unwrap().spread.rms_px;
        assert!(
            apart(&found.cameras[0]) < 0.1 && apart(&rough.cameras[0]) > 5.0,
            "{} {}",
            apart(&found.cameras[0]),
            apart(&rough.cameras[0])
        );
        for (found, truth) in found.poses.iter().zip(&scene.poses) {
            assert!((found.centre - truth.centre).norm() < 0.1, "{found:?} for {truth:?}");
        }
    }

    /// Where one camera needs stages the others have their own models meanwhile.
    #[test]
    fn a_camera_beside_one_in_stages_has_its_own_model() {
        let of = |name: &str, images: &str, model: &str| Optics {
            name: name.into(),
            images: vec![glob::Pattern::new(images).unwrap()],
            ..optics(model)
        };
        let settings = Settings::new(vec![of("left", "image_[0-2]*", "photogrammetric"), of("right", "image_*", "opencv8")]);
        let scene = board(lens());
        let survey = Survey::new(scene.points(), &scene.known()).unwrap();
        let owners = crate::optics::owners(&settings.cameras, &survey.images).unwrap();
        let rough = starts(&survey, &owners, &settings).unwrap();
        let found = by_stages(&survey, &owners, &rough, &settings).unwrap();
        assert!(matches!(found.cameras[..], [Camera::Photogrammetric(_), Camera::OpenCv(_)]), "{:?}", found.cameras);
        assert_eq!(found.origins[0], rough.origins[0]);
    }
}
