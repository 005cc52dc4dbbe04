//! What an adjustment is told of a trial, and what is true.

use calibench_calibrate::{Optics, Settings};
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::observation::Start;
use calibench_model::{Points, Pose};
use calibench_random::Key;
use calibench_records::results::{Outcome, PointResult};
use calibench_scenario::ViewsSubject;
use calibench_synth::stations::Station;
use glob::Pattern;
use nalgebra::Point3;

use crate::studies::calibrators::in_model;

/// A trial of one method.
pub(super) struct Trial<'a> {
    model: &'a str,
    sigma_px: f64,
    pub(super) subject: &'a ViewsSubject,
    /// Where its images were taken from.
    pub(super) stations: Vec<Station>,
    /// What was measured.
    pub(super) points: Points,
    /// The true camera, in the model that is calibrated.
    pub(super) camera: Camera,
}

impl<'a> Trial<'a> {
    /// What was measured in the trial of `key`, for a calibration in the camera model `model` that is told `sigma_px` of an image coordinate.
    ///
    /// # Errors
    /// In words: stations that cannot be drawn, a camera that is none of the model.
    pub(super) fn of(
        (model, sigma_px): (&'a str, f64),
        subject: &'a ViewsSubject,
        (points, method): (&[PointResult], usize),
        key: Key<'_>,
    ) -> Result<Self, String> {
        let stations = subject.stations_of(key).map_err(|error| error.to_string())?.into_owned();
        let camera = in_model(&subject.camera, model).ok_or_else(|| format!("[camera] is none of the model {model}"))?;
        let mut told = Points::default();
        for point in points.iter().filter(|point| point.method == method) {
            let Outcome::Measured { position, .. } = point.outcome else { continue };
            told.push(&point.view, &point.target, Start::at(position));
        }
        Ok(Self { model, sigma_px, subject, stations, points: told, camera })
    }

    /// A camera of the model asked for that took the images of these names.
    pub(super) fn optics(&self, name: &str, images: &str) -> Result<Optics, String> {
        let pattern = Pattern::new(images).map_err(|error| error.to_string())?;
        let model = Some(self.model.to_owned());
        Ok(Optics { name: name.to_owned(), images: vec![pattern], model, ..Optics::new(self.subject.camera.size()) })
    }

    pub(super) fn settings(&self, cameras: Vec<Optics>) -> Settings {
        Settings { sigma_px: Some(self.sigma_px), ..Settings::new(cameras) }
    }

    /// The true pose of an image.
    pub(super) fn pose(&self, image: &str) -> Option<Pose> {
        Some(self.stations.iter().find(|station| station.name == image)?.pose)
    }

    /// In how many images a target was measured.
    pub(super) fn images_of(&self, target: &str) -> usize {
        self.points.rows().filter(|row| row.target == target).count()
    }

    /// Where a target truly is.
    pub(super) fn target(&self, name: &str) -> Option<Point3<f64>> {
        Some(self.subject.field.position(self.subject.field.targets.iter().find(|target| target.id == name)?))
    }

    /// Less the true value, of a parameter of the camera.
    pub(super) fn error(&self, found: &Camera, name: &str) -> Option<f64> {
        let value = |camera: &Camera| Some(camera.parameters().iter().find(|parameter| parameter.name == name)?.value);
        Some(value(found)? - value(&self.camera)?)
    }
}
