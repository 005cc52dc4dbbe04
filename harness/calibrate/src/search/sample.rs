//! Some images and control points of a camera, for trials that cost the same however many there are.

use calibench_adjust::approximate::Control;
use calibench_adjust::{Exterior, ImageObservation, Interior, Network, ObjectPoint, Options, adjust, adjust_robustly};
use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel};

use crate::start::{PoseFinder, pose_finder, spread_control_of};
use crate::{Optics, Settings, Survey, model};

/// Images at most.
const IMAGES: usize = 24;
/// Control points of an image at most.
const POINTS: usize = 60;
/// Images of which one focal length after another is tried.
const FEW_IMAGES: usize = 6;
/// Points of each of them.
const FEW_POINTS: usize = 16;
/// Control points of an image at least.
const LEAST: usize = 6;
/// Iterations of a nested model at most: its minimum need not be exact.
const ITERATIONS: usize = 20;

/// What some images of a camera see of the control points.
pub(super) struct Sample {
    pub(super) views: Vec<Vec<Control>>,
    /// The camera has more images or points than these.
    pub(super) is_part: bool,
    sigma: f64,
    huber: Option<f64>,
    finder: PoseFinder,
}

/// With weights that follow the residuals an adjustment takes so many times the steps.
const PATIENCE: usize = 10;

/// Where an adjustment of the sample ended.
#[derive(Clone, Debug)]
pub(super) struct Arrived {
    pub(super) camera: Camera,
    pub(super) poses: Vec<Pose>,
    /// Weighted sum of squares, a number; where gross errors are expected, the one that the median residual stands for.
    pub(super) cost: f64,
    /// Where the camera comes from, in words.
    pub(super) origin: String,
}

impl Sample {
    /// Images of camera `index` with [`LEAST`] control points or more, spread over their order; `None` where there are none.
    pub(super) fn of(survey: &Survey, owners: &[usize], index: usize, settings: &Settings) -> Option<Self> {
        let known: Vec<_> = (0..survey.targets()).map(|target| survey.known(target)).collect();
        let own: Vec<usize> = (0..owners.len()).filter(|&image| owners[image] == index).collect();
        let chosen = (0..own.len().min(IMAGES)).map(|place| own[place * own.len() / own.len().min(IMAGES)]);
        let views: Vec<Vec<Control>> = chosen.map(|image| spread_control_of(survey, &known, image, POINTS)).collect();
        let views: Vec<Vec<Control>> = views.into_iter().filter(|view| view.len() >= LEAST).collect();
        let taken: usize = views.iter().map(Vec::len).sum();
        let all: usize =
            own.iter().map(|&image| survey.of_image(image).filter(|&sight| known[survey.sight(sight).target].is_some()).count()).sum();
        let is_part = taken < all;
        (!views.is_empty()).then(|| Self {
            views,
            is_part,
            sigma: settings.sigma(),
            huber: settings.gross.of_start(),
            finder: pose_finder(settings),
        })
    }

    /// Poses of the images with a camera; `None` where there is none.
    pub(super) fn poses(&self, camera: &Camera) -> Vec<Option<Pose>> {
        self.views.iter().map(|view| (self.finder)(camera, view).ok()).collect()
    }

    /// Whether gross errors are to be expected.
    pub(super) fn is_robust(&self) -> bool {
        self.huber.is_some()
    }

    /// Leaves out images that `keep` is false of.
    pub(super) fn keep(&mut self, keep: &[bool]) {
        let mut keep = keep.iter();
        self.views.retain(|_| keep.next().is_none_or(|keep| *keep));
    }

    /// The minimum of the named parameters, from a camera and poses.
    pub(super) fn with(&self, camera: &Camera, poses: &[Pose], names: &[&str], origin: &str) -> Option<Arrived> {
        self.adjusted(Interior::fixed("camera", *camera).free(names).ok()?, poses, ITERATIONS, origin)
    }

    pub(super) fn adjusted(&self, interior: Interior, poses: &[Pose], most_iterations: usize, origin: &str) -> Option<Arrived> {
        let network = self.network(interior, poses);
        let (cost, solution) = match self.huber {
            None => adjust(&network, &Options { most_iterations, ..Options::default() }).map(|found| (found.cost(), found)).ok()?,
            // The bound follows the residuals: those of a lens that is not found yet are no gross errors.
            Some(bound) => {
                let options = Options { most_iterations: PATIENCE * most_iterations, ..Options::default() };
                let (solution, _) = adjust_robustly(&network, &options, bound).ok()?;
                let cost = solution.scale()?.powi(2) * 2.0 * network.observations.len() as f64;
                (cost, solution)
            }
        };
        let camera = solution.cameras()[0];
        Some(Arrived { camera, poses: solution.poses().to_vec(), cost, origin: origin.to_owned() })
    }

    fn network(&self, interior: Interior, poses: &[Pose]) -> Network {
        let (mut points, mut observations) = (Vec::new(), Vec::new());
        for (image, view) in self.views.iter().enumerate() {
            for control in view {
                observations.push(ImageObservation::new(image, points.len(), control.image, self.sigma));
                points.push(ObjectPoint::fixed(String::new(), control.object));
            }
        }
        let images = poses.iter().map(|pose| Exterior::free(String::new(), 0, *pose)).collect();
        Network { cameras: vec![interior], images, points, observations, ..Network::default() }
    }

    /// A few points of a few images, for what is tried often.
    pub(super) fn few(&self) -> Vec<Vec<Control>> {
        let some = |count: usize, most: usize| (0..count.min(most)).map(move |place| place * count / count.min(most));
        some(self.views.len(), FEW_IMAGES)
            .map(|view| some(self.views[view].len(), FEW_POINTS).map(|point| self.views[view][point]).collect())
            .collect()
    }

    /// Observations less unknowns of the model asked for.
    pub(super) fn redundancy(&self, optics: &Optics, camera: &Camera) -> usize {
        let observations: usize = self.views.iter().map(|view| 2 * view.len()).sum();
        observations.saturating_sub(6 * self.views.len() + model::unknowns(camera, optics).len())
    }

    /// The longest distance of a point from where `camera` pictures its axis, px.
    pub(super) fn farthest(&self, camera: &Camera) -> Option<f64> {
        let axis = camera.project(calibench_model::camera::Ray { x: 0.0, y: 0.0, z: -1.0 }).ok()?;
        Some(self.views.iter().flatten().map(|control| control.image.distance(axis)).fold(1.0, f64::max))
    }
}
