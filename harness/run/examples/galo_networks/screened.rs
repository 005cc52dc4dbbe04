//! What a network's geometry alone says: how many points are seen, and the standard deviations for a noise of one.

use std::sync::LazyLock;

use calibench_adjust::{Exterior, ImageObservation, Interior, Network, ObjectPoint, Options, Test, Variance, adjust};
use calibench_measure::Registry;
use calibench_model::Testfield;
use calibench_model::camera::CameraModel;
use calibench_records::figures::Quantity;
use calibench_records::results::{Figure, Trial, find};
use calibench_run::Plan;
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
    /// Redundancy of all image coordinates, and of all coordinates of control: sums of their redundancy numbers.
    pub redundancy: [f64; 2],
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
    let (cofactors, redundancy) = geometry(views, &seen)?;
    Some(Screened { points, cofactors, redundancy, check })
}

/// Standard deviations of the camera at the truth, for a standard deviation of unit weight of one, and the sums of redundancy numbers of image coordinates and
/// of control.
fn geometry(views: &ViewsSubject, seen: &[Vec<usize>]) -> Option<([f64; 4], [f64; 2])> {
    let calibration = views.study.network()?;
    let place = |target: usize| views.field.position(&views.field.targets[target]);
    let mut used: Vec<usize> = seen.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let points =
        used.iter().map(|&target| ObjectPoint::observed(&views.field.targets[target].id, place(target), [calibration.control_sigma; 3]));
    let mut network = Network {
        cameras: vec![Interior::fixed("camera", views.camera).free(&NAMES).ok()?],
        points: points.collect(),
        ..Network::default()
    };
    for (image, (station, targets)) in views.stations.iter().zip(seen).enumerate() {
        network.images.push(Exterior::free(station.name.clone(), 0, station.pose));
        for &target in targets {
            let at = views.camera.project(station.pose.ray(&place(target))).ok()?;
            network.observations.push(ImageObservation::new(image, used.binary_search(&target).ok()?, at, calibration.sigma_px));
        }
    }
    let solution = adjust(&network, &Options::default()).ok()?;
    let (names, covariance) = solution.covariances(Variance::Apriori).ok()?.of_camera(0);
    let sigma = |name: &str| names.iter().position(|other| *other == name).map(|row| covariance[(row, row)].sqrt());
    let [c, x0, y0, k1] = NAMES.map(sigma);
    let reliability = solution.reliability(Test::default()).ok()?;
    let image = reliability.points.iter().map(|point| point.redundancy[0] + point.redundancy[1]).sum();
    let control = reliability.observed.iter().map(|observed| observed.redundancy).sum();
    Some(([c?, x0?, y0?, k1?], [image, control]))
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
