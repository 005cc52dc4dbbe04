//! Measured points and control, joined by name.

use calibench_diagnostics::nearest;
use calibench_model::points::Groups;
use calibench_model::{ControlDisc, ControlRow, Covariance, PixelPoint, Points, TargetKind};
use std::collections::HashMap;

use nalgebra::Point3;

use super::CalibrationError;

/// Who measured what: image points, and the control points among their targets.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// Names of the images, in the order in which they come.
    pub images: Vec<String>,
    points: Points,
    by_image: Groups,
    by_target: Groups,
    /// Of each target: its place in `control`, or [`TIE`].
    known: Vec<u32>,
    control: Vec<Known>,
    /// Of the targets whose control says so.
    discs: HashMap<usize, ControlDisc>,
}

/// No place: of a tie point.
const TIE: u32 = u32::MAX;

/// What is known of a target, object units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// X, Y, Z in the frame of the control file, object units.
    pub position: Point3<f64>,
    /// Their standard deviations, object units; `None` where the file gives none.
    pub sigmas: Option<[f64; 3]>,
}

/// A measured image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Index of its image.
    pub image: usize,
    /// Index of its target.
    pub target: usize,
    /// Where it was measured, px; 0 is the centre of the first pixel, y down.
    pub position: PixelPoint,
    /// How well, as its operator estimates it, px^2.
    pub covariance: Option<Covariance>,
}

/// A sight that takes no part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Index of the sight.
    pub sight: usize,
    /// The reason.
    pub why: String,
}

impl Survey {
    /// Joins points with control.
    ///
    /// # Errors
    /// [`CalibrationError::NothingInCommon`].
    pub fn new(points: Points, control: &[ControlRow]) -> Result<Self, CalibrationError> {
        let survey = Self::join(points, control);
        if survey.control.is_empty() {
            let measured = survey.points.targets().iter().next().unwrap_or_default().to_owned();
            let near = nearest(&measured, control.iter().map(|row| row.target.as_str())).map(str::to_owned);
            let control = control.first().map_or_else(String::new, |row| row.target.clone());
            return Err(CalibrationError::NothingInCommon { measured, control, near });
        }
        Ok(survey)
    }

    /// Tie points alone.
    pub fn without_control(points: Points) -> Self {
        Self::join(points, &[])
    }

    fn join(points: Points, rows: &[ControlRow]) -> Self {
        let (mut known, mut control, mut discs) = (vec![TIE; points.targets().len()], Vec::new(), HashMap::new());
        for row in rows {
            let Some(target) = points.targets().find(&row.target) else { continue };
            row.disc.as_deref().and_then(|disc| discs.insert(target, *disc));
            let new = Known { position: row.position.into(), sigmas: row.sigmas };
            match control.get_mut(known[target] as usize) {
                Some(earlier) => *earlier = new,
                None => {
                    known[target] = control.len() as u32;
                    control.push(new);
                }
            }
        }
        let images = points.images().iter().map(str::to_owned).collect();
        let (by_image, by_target) = (points.by_image(), points.by_target());
        Self { images, points, by_image, by_target, known, control, discs }
    }

    /// The points alone.
    pub(crate) fn into_points(self) -> Points {
        self.points
    }

    /// How many targets were measured.
    pub fn targets(&self) -> usize {
        self.known.len()
    }

    /// The name of a target.
    pub fn target(&self, target: usize) -> &str {
        self.points.targets().get(target)
    }

    /// The target of a name, if it was measured.
    pub fn target_called(&self, name: &str) -> Option<usize> {
        self.points.targets().find(name)
    }

    /// What is known of a target; `None` for a tie point.
    pub fn control(&self, target: usize) -> Option<&Known> {
        self.control.get(self.known[target] as usize)
    }

    /// How many of the targets are control points.
    pub fn control_points(&self) -> usize {
        self.control.len()
    }

    /// Known coordinates of a target.
    pub fn known(&self, target: usize) -> Option<Point3<f64>> {
        self.control(target).map(|known| known.position)
    }

    /// What the control says of a target that is a disc.
    pub fn disc(&self, target: usize) -> Option<&ControlDisc> {
        self.discs.get(&target)
    }

    /// Whether the control says of any measured target that it is a disc.
    pub fn states_discs(&self) -> bool {
        !self.discs.is_empty()
    }

    /// What an image point was measured as, if its file says so.
    pub fn kind(&self, sight: usize) -> Option<TargetKind> {
        self.points.kind(sight)
    }

    /// How many image points there are.
    pub fn sights(&self) -> usize {
        self.points.len()
    }

    /// An image point, in the order given.
    #[inline]
    pub fn sight(&self, index: usize) -> Sight {
        Sight {
            image: self.points.image_of(index),
            target: self.points.target_of(index),
            position: self.points.position(index),
            covariance: self.points.covariance(index),
        }
    }

    /// Indices of the image points of an image, in their order.
    pub fn of_image(&self, image: usize) -> impl ExactSizeIterator<Item = usize> + Clone + '_ {
        self.by_image.of_group(image)
    }

    /// Indices of the image points of a target, in their order.
    pub fn of_target(&self, target: usize) -> impl ExactSizeIterator<Item = usize> + Clone + '_ {
        self.by_target.of_group(target)
    }
}
