//! What a network's geometry alone says: how many points are seen, and the standard deviations for a noise of one.

use std::sync::LazyLock;

use calibench_measure::Registry;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose, Testfield};
use calibench_records::figures::Quantity;
use calibench_records::results::{Figure, Trial, find};
use calibench_run::Plan;
use calibench_run::studies::network::{ImagePoint, Job, Observed, Wanted, adjusted};
use calibench_scenario::{Scenario, Subject, ViewsSubject, parse};

use crate::drawn::{Check, Drawn, Noise};

/// The first column of Table 2: standard deviations of c, x0, y0 (mm) and k1 (mm^-2).
pub const PRINTED: [f64; 4] = [0.0411, 0.0305, 0.0426, 0.000_027_2];
/// The parameters in this order.
pub const NAMES: [&str; 4] = ["c", "x0", "y0", "k1"];
/// Image points of networks like the paper's, which has 326.
const POINTS: std::ops::RangeInclusive<usize> = 316..=336;
/// Check points and control points of the second step, as in the paper.
const STEP: (usize, usize) = (23, 5);
/// By how much a calibration's standard deviations scatter about those of the geometry alone, and the tolerance besides.
const LIKE: f64 = 0.25;

/// A network with as many points as the paper's.
pub struct Screened {
    /// Image points.
    pub points: usize,
    /// Standard deviations for a standard deviation of unit weight of one.
    pub cofactors: [f64; 4],
    /// Control as coordinates, of which each is an observation.
    pub control: usize,
    /// The second step.
    pub check: Check,
}

impl Screened {
    /// How far the standard deviations are from the ratios of the print: the largest difference of logarithms.
    pub fn off(&self) -> f64 {
        let ratio = |index: usize| self.cofactors[index] / PRINTED[index];
        (1..4).map(|index| (ratio(index) / ratio(0)).ln().abs()).fold(0.0, f64::max)
    }

    /// Whether a calibration with noise can agree with the print.
    pub fn is_like_the_print(&self) -> bool {
        self.off() < LIKE
    }
}

/// `None` for a network with another number of points, or without a second step.
pub fn screened(drawn: &Drawn) -> Option<Screened> {
    // Most networks have too many points or too few: the pinhole camera says so a hundred times faster.
    if !POINTS.contains(&drawn.roughly_seen(POINTS.end() - POINTS.start())) {
        return None;
    }
    let noise = Noise { hand: 0.5, floor: 0.0, own: [0.5; 2] };
    let scenario = scenario(&drawn.scenario(&noise, drawn.survey, None, 1));
    let Subject::Views(views) = &scenario.subject else { unreachable!("a wall") };
    let seen = seen(views);
    let points = seen.iter().map(Vec::len).sum();
    if !POINTS.contains(&points) {
        return None;
    }
    let check = check(&views.field, &seen)?;
    let control = 3 * (0..views.field.targets.len()).filter(|target| seen.iter().any(|image| image.contains(target))).count();
    Some(Screened { points, cofactors: cofactors(views, &seen)?, control, check })
}

/// Standard deviations of the camera at the truth, for a standard deviation of unit weight of one.
fn cofactors(views: &ViewsSubject, seen: &[Vec<usize>]) -> Option<[f64; 4]> {
    let mut calibration = views.study.network().cloned()?;
    let Camera::Photogrammetric(truth) = views.camera else { return None };
    calibration.start = truth;
    let job = Job { calibration: &calibration, field: &views.field, unit: views.unit, camera: &views.camera, stations: &views.stations };
    let place = |target: usize| views.field.position(&views.field.targets[target]);
    let mut points = Vec::new();
    for (view, (station, targets)) in views.stations.iter().zip(seen).enumerate() {
        for &target in targets {
            // The alternating error makes no camera, but a standard deviation of unit weight that is not zero.
            let (at, sign) =
                (views.camera.project(station.pose.ray(&place(target))).ok()?, if points.len() % 2 == 0 { 1e-4 } else { -1e-4 });
            points.push(ImagePoint { method: 0, view, target, at: PixelPoint::new(at.x + sign, at.y - sign) });
        }
    }
    let observed = Observed { points, control: (0..views.field.targets.len()).map(place).collect() };
    let poses: Vec<Pose> = views.stations.iter().map(|station| station.pose).collect();
    let figures = adjusted(&job, &observed, 0, &NAMES, &poses, Wanted::Interior).ok()?.figures;
    let sigma0 = find(&figures, Quantity::Sigma0)?.value / calibration.sigma_px;
    Some(sigmas(&figures)?.map(|sigma| sigma / sigma0))
}

/// Reported standard deviations of the camera.
pub fn sigmas(figures: &[Figure]) -> Option<[f64; 4]> {
    let sigma = |name: &str| find(figures, Quantity::Parameter.of(&[name]))?.sigma;
    let [c, x0, y0, k1] = NAMES.map(sigma);
    Some([c?, x0?, y0?, k1?])
}

static METHODS: LazyLock<Registry> = LazyLock::new(Registry::builtin);

pub fn scenario(text: &str) -> Scenario {
    parse("galo-2011/networks", "networks.toml", text, &METHODS).unwrap_or_else(|problems| panic!("{problems}"))
}

/// All trials of a scenario.
pub fn trials(scenario: &Scenario, count: u64) -> Vec<Trial> {
    let plan = Plan { bounds: false, trials: count, ..Plan::new(scenario, calibench_run::Tools::default(), "".into()) };
    let mut trials = Vec::new();
    plan.run(&|| (), &mut |trial| {
        trials.push(trial);
        Ok(())
    })
    .unwrap_or_else(|error| panic!("{error}"));
    trials
}

/// The targets that each image shows, by their places.
fn seen(views: &ViewsSubject) -> Vec<Vec<usize>> {
    let size = views.camera.size();
    let inside = |station: &calibench_synth::stations::Station, target: &calibench_model::ObjectTarget| {
        let ray = station.pose.ray(&views.field.position(target));
        views
            .camera
            .project(ray)
            .is_ok_and(|at| at.x > 0.0 && at.y > 0.0 && at.x < f64::from(size.width) - 1.0 && at.y < f64::from(size.height) - 1.0)
    };
    let of =
        |station| views.field.targets.iter().enumerate().filter(|(_, target)| inside(station, target)).map(|(index, _)| index).collect();
    views.stations.iter().map(of).collect()
}

/// Of what images 6, 1 and 9 all show: the points nearest to the wall's corners and its middle are control, 23 others are checked.
fn check(field: &Testfield, seen: &[Vec<usize>]) -> Option<Check> {
    let mut common: Vec<usize> = seen[5].iter().filter(|index| seen[0].contains(index) && seen[8].contains(index)).copied().collect();
    if common.len() < STEP.0 + STEP.1 {
        return None;
    }
    let place = |index: usize| field.position(&field.targets[index]);
    let mut control = Vec::new();
    for (x, y) in [(-9.0, -9.0), (9.0, -9.0), (-9.0, 9.0), (9.0, 9.0), (0.0, 0.0)] {
        let far = |index: usize| (place(index).x - x).hypot(place(index).y - y);
        let nearest = (0..common.len()).min_by(|a, b| far(common[*a]).total_cmp(&far(common[*b])))?;
        control.push(common.remove(nearest));
    }
    let names = |places: &[usize]| places.iter().map(|index| field.targets[*index].id.clone()).collect();
    Some(Check { control: names(&control), points: names(&common[..STEP.0]) })
}
