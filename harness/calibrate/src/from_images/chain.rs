//! Images chained to a pair that is oriented.

use calibench_adjust::approximate::{Control, Search, Sight, Tolerance, intersect, resect};
use calibench_adjust::{Datum, Exterior, ImageObservation, Interior, Network, ObjectPoint, Options, adjust, adjust_robustly};
use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel};
use nalgebra::Point3;

use super::pairs::Seed;
use crate::Survey;
use crate::start::spread_control_of;

/// Known targets that an image must show to be oriented.
const FEWEST: usize = 6;
/// The same, once all coordinates are known.
const RESECTED: usize = 4;
/// Of the targets that the best of the images not yet oriented shows, the share at which others are oriented with it.
const WITH: f64 = 0.6;
/// Targets of an image that a resection uses.
const ENOUGH: usize = 200;
/// Rays that meet at less give no point, rad.
const PARALLEL: f64 = 0.02;
/// A-priori standard deviation of an image coordinate on the way, px, and the bound of Huber's weights.
const SIGMA: f64 = 1.0;
const BOUND: f64 = 2.0;
/// Adjustments in between: iterations at most, and growth of the number of images from one to the next.
const ITERATIONS: usize = 15;
const GROWN: f64 = 1.3;
/// Images from which the focal length is adjusted, and from which distortion is.
const FOCAL_FROM: usize = 3;
const LENS_FROM: usize = 5;
/// A residual is as bad as it gets at this part of the longer side.
const LOST: f64 = 2e-3;

/// Images with poses, and targets with coordinates, in the axes of one of the images.
pub(super) struct Chain<'s> {
    survey: &'s Survey,
    owners: &'s [usize],
    cameras: Vec<Camera>,
    poses: Vec<Option<Pose>>,
    points: Vec<Option<Point3<f64>>>,
}

impl<'s> Chain<'s> {
    /// As far as it goes, with `most` images or somewhat more.
    pub(super) fn begun(survey: &'s Survey, owners: &'s [usize], cameras: Vec<Camera>, seed: &Seed, most: usize) -> Self {
        let mut chain = Self { survey, owners, cameras, poses: vec![None; survey.images.len()], points: vec![None; survey.targets()] };
        chain.poses[seed.images[0]] = Some(Pose { rotation: nalgebra::Matrix3::identity(), centre: Point3::origin() });
        chain.poses[seed.images[1]] = Some(seed.orientation.pose);
        seed.points.iter().for_each(|(target, point)| chain.points[*target] = Some(*point));
        chain.adjust();
        chain.grow(most);
        chain
    }

    /// Goes on as far as it leads, with `most` images or somewhat more.
    pub(super) fn grow(&mut self, most: usize) {
        let mut adjusted = 0;
        loop {
            let more = self.oriented() < most && self.orient_more();
            self.intersect();
            // Of many images a few more change little.
            if !more || self.oriented() as f64 >= GROWN * adjusted as f64 {
                let is_settled = adjusted == self.oriented();
                adjusted = self.oriented();
                self.adjust();
                // What was far off on the way may fit now.
                if !more && is_settled {
                    return;
                }
            }
        }
    }

    fn oriented(&self) -> usize {
        self.poses.iter().flatten().count()
    }

    /// Orients the images that show most of what is known; whether there were any.
    fn orient_more(&mut self) -> bool {
        let lost: Vec<usize> = (0..self.poses.len()).filter(|&image| self.poses[image].is_none()).collect();
        let counts: Vec<usize> = lost.iter().map(|&image| self.known(image)).collect();
        let most = counts.iter().copied().max().unwrap_or_default();
        let bound = FEWEST.max((WITH * most as f64) as usize);
        let candidates = || lost.iter().zip(&counts).filter(|(_, count)| **count >= bound).map(|(image, _)| *image);
        let found: Vec<(usize, Pose)> = candidates().filter_map(|image| Some((image, self.pose_of(image)?))).collect();
        if !found.is_empty() {
            found.into_iter().for_each(|(image, pose)| self.poses[image] = Some(pose));
            return true;
        }
        // Those with fewer, before it ends.
        let rest = lost.iter().zip(&counts).filter(|(_, count)| (FEWEST..bound).contains(*count)).map(|(image, _)| *image);
        let found: Vec<(usize, Pose)> = rest.filter_map(|image| Some((image, self.pose_of(image)?))).collect();
        let any = !found.is_empty();
        found.into_iter().for_each(|(image, pose)| self.poses[image] = Some(pose));
        any
    }

    fn pose_of(&self, image: usize) -> Option<Pose> {
        let control: Vec<Control> = spread_control_of(self.survey, &self.points, image, ENOUGH);
        let against = Search { seed: 1, tolerance: Tolerance::Unknown };
        let camera = &self.cameras[self.owners[image]];
        let found = resect(camera, &control, Some(&against)).or_else(|_| resect(camera, &control, None)).ok()?;
        (control.len() - found.rejected.len() >= FEWEST.min(control.len())).then_some(found.pose)
    }

    /// Targets that oriented images show and that have no coordinates.
    fn intersect(&mut self) {
        let against = Search { seed: 1, tolerance: Tolerance::Unknown };
        for target in 0..self.points.len() {
            if self.points[target].is_some() {
                continue;
            }
            let seen = self.survey.of_target(target).map(|index| self.survey.sight(index));
            let rays: Vec<Sight<'_>> = seen
                .filter_map(|sight| {
                    let (camera, pose) = (&self.cameras[self.owners[sight.image]], self.poses[sight.image].as_ref()?);
                    Some(Sight { camera, pose, image: sight.position })
                })
                .collect();
            if rays.len() < 2 {
                continue;
            }
            let found = intersect(&rays, PARALLEL, Some(&against)).or_else(|_| intersect(&rays, PARALLEL, None));
            self.points[target] = found.ok().map(|found| found.point);
        }
    }

    /// Adjusts what there is, with as much of the lens as so many images tell; without effect where that leads nowhere. Targets that are no points of
    /// the result are given up.
    fn adjust(&mut self) {
        let images: Vec<usize> = (0..self.poses.len()).filter(|&image| self.poses[image].is_some()).collect();
        let lens: &[&str] = match images.len() {
            count if count >= LENS_FROM => &["fx", "fy", "k1"],
            count if count >= FOCAL_FROM => &["fx", "fy"],
            _ => &[],
        };
        for names in [lens, &[]] {
            let (network, targets) = self.network(&images, names);
            let options = Options { most_iterations: ITERATIONS, ..Options::default() };
            let found = adjust_robustly(&network, &options, BOUND).map(|(solution, _)| solution).or_else(|_| adjust(&network, &options));
            let Ok(solution) = found else { continue };
            if solution.cameras().iter().any(|camera| !is_lens(camera)) {
                continue;
            }
            self.cameras = solution.cameras().to_vec();
            images.iter().zip(solution.poses()).for_each(|(&image, pose)| self.poses[image] = Some(*pose));
            targets.iter().zip(solution.points()).for_each(|(&target, point)| self.points[target] = Some(*point));
            return;
        }
    }

    fn network(&self, images: &[usize], names: &[&str]) -> (Network, Vec<usize>) {
        let mut seen = vec![0; self.points.len()];
        let mut place = vec![usize::MAX; self.poses.len()];
        images.iter().enumerate().for_each(|(k, &image)| place[image] = k);
        let pictured = |image: usize, target: usize| {
            let (pose, point) = (self.poses[image]?, self.points[target]?);
            self.cameras[self.owners[image]].project(pose.ray(&point)).ok()
        };
        let sights: Vec<_> = images
            .iter()
            .flat_map(|&image| self.survey.of_image(image).map(|index| self.survey.sight(index)))
            .filter(|sight| pictured(sight.image, sight.target).is_some())
            .collect();
        sights.iter().for_each(|sight| seen[sight.target] += 1);
        let targets: Vec<usize> = (0..self.points.len()).filter(|&target| seen[target] > 1).collect();
        let mut point = vec![usize::MAX; self.points.len()];
        targets.iter().enumerate().for_each(|(k, &target)| point[target] = k);
        let own = |camera: &Camera| of_start(camera, names);
        let network = Network {
            cameras: self.cameras.iter().map(own).collect(),
            images: images
                .iter()
                .filter_map(|&image| Some(Exterior::free(self.survey.images[image].clone(), self.owners[image], self.poses[image]?)))
                .collect(),
            points: targets
                .iter()
                .filter_map(|&target| Some(ObjectPoint::free(self.survey.target(target), self.points[target]?)))
                .collect(),
            observations: sights
                .iter()
                .filter(|sight| point[sight.target] != usize::MAX)
                .map(|sight| ImageObservation::new(place[sight.image], point[sight.target], sight.position, SIGMA))
                .collect(),
            datum: Datum::Inner,
            ..Network::default()
        };
        (network, targets)
    }

    /// Mean of the squared residuals of the image points of oriented images, in parts of what is as bad as it gets; one that is not pictured is that, and
    /// so are those of an image that misses to `most`.
    pub(super) fn misfit(&self, most: usize) -> f64 {
        let square = |index: usize| {
            let sight = self.survey.sight(index);
            let camera = &self.cameras[self.owners[sight.image]];
            let ray = self.poses[sight.image]?.ray(&self.points[sight.target]?);
            let pixel = camera.project(ray).ok()?;
            let side = f64::from(camera.size().width.max(camera.size().height));
            Some(((pixel.x - sight.position.x).powi(2) + (pixel.y - sight.position.y).powi(2)) / (LOST * side).powi(2))
        };
        let of_image = |image: usize| {
            let sights = self.survey.of_image(image);
            let count = sights.len().max(1) as f64;
            sights.map(|index| square(index).map_or(1.0, |square| square.min(1.0))).sum::<f64>() / count
        };
        let oriented = (0..self.poses.len()).filter(|&image| self.poses[image].is_some());
        let (sum, count) = oriented.map(of_image).fold((0.0, 0), |(sum, count), misfit| (sum + misfit, count + 1));
        let missing = most.saturating_sub(count);
        (sum + missing as f64) / (count + missing).max(1) as f64
    }

    /// Names of the images that it did not reach, and that show too few of its targets for a resection.
    pub(super) fn lost(&self) -> Vec<String> {
        let is_lost = |image: &usize| self.poses[*image].is_none() && self.known(*image) < RESECTED;
        (0..self.poses.len()).filter(is_lost).map(|image| self.survey.images[image].clone()).collect()
    }

    /// How many of the targets with coordinates an image shows.
    fn known(&self, image: usize) -> usize {
        self.survey.of_image(image).filter(|&index| self.points[self.survey.sight(index).target].is_some()).count()
    }

    pub(super) fn into_points(self) -> Vec<Option<Point3<f64>>> {
        self.points
    }
}

/// Whether its focal lengths are alike, and those of a lens.
fn is_lens(camera: &Camera) -> bool {
    let side = f64::from(camera.size().width.max(camera.size().height));
    let value = |name: &str| camera.parameters().iter().find(|p| p.name == name).map(|p| p.value);
    match (value("fx"), value("fy")) {
        (Some(x), Some(y)) => x > 0.1 * side && x < 30.0 * side && (x / y - 1.0).abs() < 0.3,
        _ => true,
    }
}

/// With those of the parameters free that the model has.
fn of_start(camera: &Camera, names: &[&str]) -> Interior {
    let own: Vec<&str> = names.iter().copied().filter(|name| camera.parameters().iter().any(|p| p.name == *name)).collect();
    let fixed = Interior::fixed("the camera", *camera);
    fixed.clone().free(&own).unwrap_or(fixed)
}
