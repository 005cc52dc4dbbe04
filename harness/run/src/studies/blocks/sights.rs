//! What a method measured, image by image, with a first orientation from the survey.

use std::collections::HashMap;

use calibench_adjust::approximate::Control;
use calibench_calibrate::robust_pose_of;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use calibench_random::{Key, Purpose, stream};
use calibench_records::results::{Outcome, PointResult};

use rand::RngExt;

use super::Job;

/// Points that an image takes at least.
const LEAST_POINTS: usize = 6;

/// The measured points of a method.
pub struct Sights {
    /// Of each station, in the order of the scenario's.
    pub images: Vec<Sighted>,
}

/// What was measured in an image.
#[derive(Clone, Debug, Default)]
pub struct Sighted {
    /// Resected from the survey; `None` where that failed.
    pub pose: Option<Pose>,
    /// Target and image coordinates (px), without gross errors.
    pub points: Vec<(usize, PixelPoint)>,
    /// Targets whose points were left out as gross errors.
    pub gross: Vec<usize>,
}

impl Sights {
    /// The points of `method` among those of a trial.
    pub fn of(job: &Job<'_>, points: &[PointResult], method: usize) -> Self {
        let views: HashMap<&str, usize> = job.stations.iter().enumerate().map(|(i, station)| (station.name.as_str(), i)).collect();
        let targets: HashMap<&str, usize> = job.field.targets.iter().enumerate().map(|(i, target)| (target.id.as_str(), i)).collect();
        let mut images = vec![Sighted::default(); job.stations.len()];
        for point in points.iter().filter(|point| point.method == method) {
            if let (Outcome::Measured { position, .. }, Some(&view), Some(&target)) =
                (point.outcome, views.get(&*point.view), targets.get(&*point.target))
            {
                images[view].points.push((target, position));
            }
        }
        images.iter_mut().for_each(|image| image.resect(job));
        Self { images }
    }
}

impl Sighted {
    /// The points of some targets; of more than `most` a random choice that is the image's own, whatever the method.
    pub fn chosen(&self, job: &Job<'_>, image: usize, wanted: &[bool], most: Option<usize>) -> Vec<(usize, PixelPoint)> {
        let mut points: Vec<(usize, PixelPoint)> = self.points.iter().copied().filter(|(target, _)| wanted[*target]).collect();
        if let Some(most) = most.filter(|most| *most < points.len()) {
            let lot = |target: usize| -> u64 {
                let key = Key { view: &job.stations[image].name, target: &job.field.targets[target].id, ..job.key };
                stream(key, Purpose::LeftOut).random()
            };
            points.sort_by_cached_key(|(target, _)| lot(*target));
            points.truncate(most);
            points.sort_by_key(|(target, _)| *target);
        }
        points
    }

    /// Finds the pose, and leaves out what lies far from where it pictures the survey.
    fn resect(&mut self, job: &Job<'_>) {
        if self.points.len() < LEAST_POINTS {
            return;
        }
        // Ebner's parameters are zero yet.
        let camera: Camera = job.blocks.camera.base.into();
        let surveyed = |target: usize| job.field.targets[target].surveyed;
        let control: Vec<Control> = self.points.iter().map(|&(target, image)| Control { object: surveyed(target), image }).collect();
        let Ok(pose) = robust_pose_of(&camera, &control) else { return };
        let near = |&(target, at): &(usize, PixelPoint)| {
            camera.project(pose.ray(&surveyed(target))).is_ok_and(|seen| seen.distance(at) <= job.blocks.gross_px)
        };
        self.gross = self.points.extract_if(.., |point| !near(point)).map(|(target, _)| target).collect();
        self.pose = Some(pose).filter(|_| self.points.len() >= LEAST_POINTS);
    }
}
