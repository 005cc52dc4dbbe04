//! Better start values for models that do not converge from a camera without distortion: a simpler one is adjusted first, and converted.

use calibench_adjust::{Options, Solution, adjust};
use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::convert::{ConvertOptions, Region};

use super::start::Starts;
use super::{Settings, Survey, model, network};

/// Iterations of a simpler model at most: its minimum need not be exact.
const ITERATIONS: usize = 30;
/// Circles over which models are fitted, as shares of the one that holds all image points.
const CIRCLES: [f64; 4] = [1.0, 0.95, 0.9, 0.8];

/// `starts` with the camera of `settings`, by way of a simpler model adjusted from their own; `None` where that is not needed or does not work.
pub(super) fn by_stages(survey: &Survey, starts: &Starts, settings: &Settings) -> Option<Starts> {
    // What is not solved for keeps what a rough start says of it.
    if settings.start.is_some() || settings.solve.is_some() {
        return None;
    }
    let (simple, unknowns) = model::simpler(&starts.camera, settings)?;
    let first = Settings {
        model: Some(simple.to_owned()),
        solve: Some(unknowns.iter().map(|&name| name.to_owned()).collect()),
        priors: Vec::new(),
        ..settings.clone()
    };
    let started = Starts { camera: model::camera(&starts.camera, &first).ok()?, ..starts.clone() };
    let (network, ..) = network::network(survey, &started, &first).ok()?;
    let options = Options { huber: settings.huber, most_iterations: ITERATIONS, ..Options::default() };
    let solution = adjust(&network, &options).ok()?;
    Some(Starts {
        camera: converted(survey, &solution.cameras()[0], settings)?,
        origin: format!("{}, then an adjustment with {simple}, converted", starts.origin),
        poses: solution.poses().to_vec(),
        points: points(starts, &solution),
    })
}

/// The camera of `settings` that is nearest to `simple` in the circle about its axis that holds all image points, since a fit need not suit what was not
/// seen; in a smaller one if the model pictures no more.
fn converted(survey: &Survey, simple: &Camera, settings: &Settings) -> Option<Camera> {
    let axis = simple.project(Ray { x: 0.0, y: 0.0, z: -1.0 }).ok()?;
    let farthest = survey.sights.iter().map(|sight| sight.position.distance(axis)).fold(1.0, f64::max);
    CIRCLES.iter().find_map(|share| {
        let region = Region::Radius { px: share * farthest };
        model::converted(simple, settings, &ConvertOptions { accept: true, region, ..ConvertOptions::default() }).ok()
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
