//! Which image points are of discs.

use calibench_model::{ControlDisc, TargetKind};
use nalgebra::Vector3;

use crate::{CalibrationError, Discs, Survey};

/// Radius, object units, and normal of a disc.
pub(super) type Face = (f64, Vector3<f64>);

/// What is known of the discs among some object points before their planes are sought.
pub(crate) struct Known {
    /// Of each object point.
    points: Vec<Option<ControlDisc>>,
    /// Whether each image point is of a disc.
    is_disc: Vec<bool>,
    unstated: usize,
}

impl Known {
    /// The discs among `count` object points, of which image points are given with the sight of a survey behind each: those of a known radius that were not
    /// measured as another kind of target.
    pub(crate) fn of(survey: &Survey, count: usize, seen: impl Iterator<Item = (usize, usize)>, discs: Discs) -> Self {
        let (mut points, mut unstated) = (vec![None; count], 0);
        let is_disc = seen.map(|(point, sight)| {
            let kind = survey.kind(sight);
            if kind.is_some_and(|kind| kind != TargetKind::Disc) {
                return false;
            }
            let stated = survey.disc(survey.sight(sight).target).copied();
            let usual = match discs {
                Discs::Control => None,
                Discs::Radius(radius) => Some(ControlDisc { radius, normal: None }),
            };
            points[point] = stated.or(usual);
            unstated += usize::from(points[point].is_none() && kind.is_some());
            points[point].is_some()
        });
        let is_disc = is_disc.collect();
        Self { points, is_disc, unstated }
    }

    /// How many image points are of discs.
    pub(crate) fn count(&self) -> usize {
        self.is_disc.iter().filter(|is_disc| **is_disc).count()
    }

    /// Whether an image point is of a disc.
    pub(super) fn is_disc(&self, image_point: usize) -> bool {
        self.is_disc[image_point]
    }

    /// How many image points were measured as discs whose radius nobody states.
    pub(super) fn unstated(&self) -> usize {
        self.unstated
    }

    /// How many object points are discs.
    pub(super) fn discs(&self) -> usize {
        self.points.iter().flatten().count()
    }

    /// Radius and normal of each object point that is a disc; normals that nobody stated are `planes`' at the point.
    ///
    /// # Errors
    /// The discs without a plane, by name.
    pub(super) fn normals(
        &self,
        name: impl Fn(usize) -> String,
        plane: impl Fn(usize) -> Option<Vector3<f64>>,
    ) -> Result<Vec<Option<Face>>, CalibrationError> {
        let mut without = Vec::new();
        let normal = |(index, disc): (usize, &Option<ControlDisc>)| {
            let disc = (*disc)?;
            let found = disc.normal.map(Vector3::from).or_else(|| plane(index));
            if found.is_none() {
                without.push(name(index));
            }
            Some((disc.radius, found?))
        };
        let normals = self.points.iter().enumerate().map(normal).collect();
        if without.is_empty() { Ok(normals) } else { Err(CalibrationError::NoPlane { targets: without }) }
    }
}
