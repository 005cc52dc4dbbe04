//! Measured points and control, joined by name.

use std::collections::HashMap;

use calibench_diagnostics::nearest;
use calibench_exchange::{ControlRow, PointRow};
use calibench_model::{Covariance, PixelPoint};
use nalgebra::Point3;

use super::CalibrationError;

/// Who measured what.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// Names of the images, in the order in which they come.
    pub images: Vec<String>,
    /// The targets, in the order in which they come.
    pub targets: Vec<Target>,
    /// The image points, in the order given.
    pub sights: Vec<Sight>,
}

/// A measured target.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Its name.
    pub name: String,
    /// What is known of it; `None` for a tie point.
    pub control: Option<ControlRow>,
}

/// A measured image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Index of its image.
    pub image: usize,
    /// Index of its target.
    pub target: usize,
    /// Where it was measured.
    pub position: PixelPoint,
    /// How well, as its operator estimates it, px^2.
    pub covariance: Option<Covariance>,
}

/// A sight that takes no part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Index of the sight.
    pub sight: usize,
    /// Why.
    pub why: String,
}

impl Survey {
    /// Joins points with control.
    ///
    /// # Errors
    /// [`CalibrationError::NothingInCommon`].
    pub fn new(points: &[PointRow], control: &[ControlRow]) -> Result<Self, CalibrationError> {
        let survey = Self::join(points, control);
        if survey.targets.iter().all(|target| target.control.is_none()) {
            let measured = survey.targets.first().map_or_else(String::new, |target| target.name.clone());
            let near = nearest(&measured, control.iter().map(|row| row.target.as_str())).map(str::to_owned);
            let control = control.first().map_or_else(String::new, |row| row.target.clone());
            return Err(CalibrationError::NothingInCommon { measured, control, near });
        }
        Ok(survey)
    }

    /// Tie points alone.
    pub fn without_control(points: &[PointRow]) -> Self {
        Self::join(points, &[])
    }

    fn join(points: &[PointRow], control: &[ControlRow]) -> Self {
        let known: HashMap<&str, &ControlRow> = control.iter().map(|row| (row.target.as_str(), row)).collect();
        let (mut images, mut targets) = (Names::default(), Names::default());
        let sight = |row: &PointRow| Sight {
            image: images.place(&row.image),
            target: targets.place(&row.target),
            position: row.start.position,
            covariance: row.start.covariance,
        };
        let sights = points.iter().map(sight).collect();
        let target = |name: String| Target { control: known.get(name.as_str()).map(|row| (*row).clone()), name };
        let targets = targets.list.into_iter().map(target).collect();
        Self { images: images.list, targets, sights }
    }

    /// Known coordinates of a target.
    pub fn known(&self, target: usize) -> Option<Point3<f64>> {
        self.targets[target].control.as_ref().map(|row| row.position.into())
    }
}

#[derive(Default)]
struct Names {
    list: Vec<String>,
    places: HashMap<String, usize>,
}

impl Names {
    fn place(&mut self, name: &str) -> usize {
        if let Some(&place) = self.places.get(name) {
            return place;
        }
        self.list.push(name.to_owned());
        self.places.insert(name.to_owned(), self.list.len() - 1);
        self.list.len() - 1
    }
}
