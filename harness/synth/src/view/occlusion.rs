//! Which plates are seen, and which hide others.

use calibench_model::Plate;
use nalgebra::{Point3, Vector3};

use super::polygon::{Convex, Tangent, apart, doubled_area};
use super::{Frame, View, ViewError, clip};

/// A plate before the camera.
pub(crate) struct Sheet<'a> {
    /// The plate.
    pub plate: &'a Plate,
    /// Its printed side is seen.
    pub front: bool,
    /// What hides it: convex polygons in tangents.
    pub hidden_by: Vec<Convex>,
}

/// The plates in the order of the testfield; `None` for one that is wholly behind the camera or outside the frame.
pub(super) fn sheets<'a>(view: &View<'a>, frame: &Frame) -> Result<Vec<Option<Sheet<'a>>>, ViewError> {
    let pictured: Vec<Option<Pictured<'a>>> = view.field.plates.iter().map(|plate| Pictured::new(view, plate, frame)).collect();
    let mut sheets = Vec::new();
    for (index, back) in pictured.iter().enumerate() {
        let Some(back) = back else {
            sheets.push(None);
            continue;
        };
        if back.facing == 0.0 {
            return Err(ViewError::EdgeOn(back.plate.id.clone()));
        }
        let mut hidden_by = Vec::new();
        for (other, front) in pictured.iter().enumerate() {
            let Some(front) = front.as_ref().filter(|_| other != index) else { continue };
            if front.hides(back, view)? {
                hidden_by.push(front.hull.clone());
            }
        }
        sheets.push(Some(Sheet { plate: back.plate, front: back.facing > 0.0, hidden_by }));
    }
    Ok(sheets)
}

/// A plate's part before the camera and within the frame.
struct Pictured<'a> {
    plate: &'a Plate,
    /// Positive if the front is seen: the height of the projection centre over the plate.
    facing: f64,
    hull: Convex,
}

impl<'a> Pictured<'a> {
    fn new(view: &View<'_>, plate: &'a Plate, frame: &Frame) -> Option<Self> {
        let border = clip::tangents(view.pose, plate, &plate.border());
        let seen = frame.directions.intersect(&border);
        if seen.is_empty() {
            return None;
        }
        let height = plate.normal().dot(&(view.pose.centre - plate.origin));
        Some(Self { plate, facing: height, hull: Convex::hull(border) })
    }

    fn hides(&self, back: &Self, view: &View<'_>) -> Result<bool, ViewError> {
        if apart(self.hull.bounds(), back.hull.bounds()) {
            return Ok(false);
        }
        let common = self.hull.intersect(&back.hull.0);
        if doubled_area(&common).abs() < 1e-15 {
            return Ok(false);
        }
        // Which is nearer at the corners of what they have in common? Plates that meet at an edge are as near there.
        let nearness = common.iter().map(|&tangent| {
            let (front, back) = (self.distance(view, tangent), back.distance(view, tangent));
            (back - front) / (back + front)
        });
        let (least, most) = nearness.fold((0.0_f64, 0.0_f64), |(least, most), n| (least.min(n), most.max(n)));
        let tolerance = 1e-9;
        if least < -tolerance && most > tolerance {
            return Err(ViewError::Cut(self.plate.id.clone(), back.plate.id.clone()));
        }
        if most <= tolerance {
            return Ok(false);
        }
        if self.plate.bend.is_some() {
            return Err(ViewError::BentBefore { front: self.plate.id.clone(), back: back.plate.id.clone() });
        }
        Ok(true)
    }

    /// How far along the direction of `tangent` the plate's plane is met, in lengths of that direction.
    fn distance(&self, view: &View<'_>, tangent: Tangent) -> f64 {
        let direction = view.pose.rotation.transpose() * Vector3::new(tangent[0], tangent[1], -1.0);
        -self.facing / self.plate.normal().dot(&direction)
    }
}

impl Sheet<'_> {
    /// Whether nothing hides `point`.
    pub fn shows(&self, view: &View<'_>, point: &Point3<f64>) -> bool {
        let Some((x, y)) = view.pose.ray(point).tangent() else { return false };
        self.front && !self.hidden_by.iter().any(|hull| hull.holds([x, y]))
    }
}
