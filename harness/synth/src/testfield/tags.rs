//! Free-standing markers, each a sheet of its own in space.

use calibench_model::TargetKind;
use calibench_model::boards::{BoardPoint, Dictionary, Marker, marker_shapes, square_marker};
use calibench_model::testfield::{Plate, Testfield};
use nalgebra::{Point3, Vector3};

use super::{FieldError, Levels, check};

/// Markers of one dictionary, each on a sheet of its own.
///
/// The targets are their outer corners: `t7c0` is the upper left one of marker 7 as it is read, `c1` to `c3` follow clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Tags {
    /// The dictionary.
    pub dictionary: &'static Dictionary,
    /// Cells of a marker's dark frame, 1 or 2.
    pub border: usize,
    /// The width of the light rim around a marker, as a fraction of its side.
    pub rim: f64,
    /// The markers.
    pub tags: Vec<Tag>,
    /// Reflectances.
    pub levels: Levels,
    /// The radiance behind all, as a fraction of full scale.
    pub background: f64,
}

/// A marker in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Tag {
    /// Its id.
    pub id: u32,
    /// Its middle, object units.
    pub middle: Point3<f64>,
    /// The direction of its upper edge, to the right for who reads it; any length.
    pub right: Vector3<f64>,
    /// The direction of its left edge, upwards, at a right angle to `right`; any length.
    pub up: Vector3<f64>,
    /// Its side, object units.
    pub side: f64,
}

impl Tags {
    /// The sheets and their targets.
    ///
    /// # Errors
    /// A parameter out of its range, an id twice or unknown, axes that are not at a right angle.
    pub fn generate(&self) -> Result<Testfield, FieldError> {
        check::counted("border", self.border, 1..=2)?;
        check::within("rim", self.rim, 0.0..=2.0)?;
        check::levels(self.levels)?;
        check::within("background", self.background, 0.0..=1.0)?;
        if self.tags.is_empty() {
            return Err(FieldError::Nothing("tags"));
        }
        let mut field = Testfield { plates: Vec::new(), targets: Vec::new(), background: self.background };
        for tag in &self.tags {
            self.add(tag, &mut field)?;
        }
        Ok(field)
    }

    fn add(&self, tag: &Tag, field: &mut Testfield) -> Result<(), FieldError> {
        let name = format!("tag {}", tag.id);
        if tag.id as usize >= self.dictionary.codes.len() {
            let expected = format!("0 to {}: the ids of {}", self.dictionary.codes.len() - 1, self.dictionary.name);
            return Err(FieldError::Parameter { parameter: "id", value: f64::from(tag.id), expected });
        }
        if field.plates.iter().any(|plate| plate.id == name) {
            return Err(FieldError::Twice { what: "tag", id: tag.id.to_string() });
        }
        check::length("side", tag.side)?;
        let (Some(u), Some(v)) = (tag.right.try_normalize(1e-12), tag.up.try_normalize(1e-12)) else {
            return Err(FieldError::Axes(name));
        };
        if u.dot(&v).abs() > 1e-6 {
            return Err(FieldError::Axes(name));
        }
        let half = 0.5 * tag.side;
        let marker = Marker { id: tag.id, corners: square_marker([-half, -half], tag.side, 0) };
        let shapes = marker_shapes(&marker, self.dictionary, self.border);
        let reach = half + self.rim * tag.side;
        let plate = Plate {
            id: name,
            origin: tag.middle,
            u,
            v: (v - u * u.dot(&v)).normalize(),
            bend: None,
            corners: [[-reach, -reach], [reach, reach]],
            level: self.levels.paper,
            areas: shapes.into_iter().map(|shape| shape.area(self.levels.paper, self.levels.ink)).collect(),
        };
        // A corner's area is at its own lower right: quarter turns from u towards v.
        for ((k, at), turns) in marker.corners.into_iter().enumerate().zip([0, 3, 2, 1]) {
            let point =
                BoardPoint { id: format!("t{}c{k}", tag.id), kind: TargetKind::Corner, at, size: tag.side, turns, room: self.room(tag) };
            let target = point.target(field.plates.len(), at);
            field.targets.push(calibench_model::ObjectTarget { surveyed: plate.point(at), ..target });
        }
        field.plates.push(plate);
        Ok(())
    }

    fn room(&self, tag: &Tag) -> f64 {
        let frame = self.border as f64 / (self.dictionary.side + 2 * self.border) as f64;
        frame.min(self.rim) * tag.side
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tags() -> Tags {
        let tag = |id: u32, x: f64| Tag {
            id,
            middle: Point3::new(x, 0.0, 1.0),
            right: Vector3::new(2.0, 0.0, 0.0),
            up: Vector3::new(0.0, 0.0, 3.0),
            side: 0.2,
        };
        Tags {
            dictionary: Dictionary::named("DICT_4X4_50").unwrap(),
            border: 1,
            rim: 0.25,
            tags: vec![tag(3, 0.0), tag(7, 1.0)],
            levels: Levels::default(),
            background: 0.2,
        }
    }

    #[test]
    fn corners_are_counted_clockwise_as_a_marker_is_read() {
        let field = tags().generate().unwrap();
        assert_eq!((field.plates.len(), field.targets.len()), (2, 8));
        let at = |id: &str| field.targets.iter().find(|target| target.id == id).unwrap();
        for (id, expected) in [("t7c0", [0.9, 1.1]), ("t7c1", [1.1, 1.1]), ("t7c2", [1.1, 0.9]), ("t7c3", [0.9, 0.9])] {
            let found = field.position(at(id));
            assert!((found - Point3::new(expected[0], 0.0, expected[1])).norm() < 1e-12, "{id}: {found}");
            assert_eq!(found, at(id).surveyed);
        }
        // The area of a corner lies between its own u and v: towards the middle of the marker.
        for target in &field.targets {
            let [[a, b], [c, d]] = target.axes;
            let inwards = [target.at[0] + 0.1 * (a + c), target.at[1] + 0.1 * (b + d)];
            assert!(inwards[0].hypot(inwards[1]) < 1e-12, "{}: {inwards:?}", target.id);
        }
    }

    #[test]
    fn mistakes_are_named() {
        let changed = |change: fn(&mut Tags)| {
            let mut tags = tags();
            change(&mut tags);
            tags.generate().unwrap_err().to_string()
        };
        for (change, said) in [
            ((|tags| tags.tags[1].id = 3) as fn(&mut Tags), "tag `3` stands here a second time"),
            (|tags| tags.tags[1].id = 50, "`id` is 50: expected 0 to 49"),
            (|tags| tags.tags[0].up = Vector3::x(), "the axes of plate `tag 3`"),
            (|tags| tags.tags.clear(), "has no tags"),
            (|tags| tags.border = 3, "`border` is 3"),
            (|tags| tags.tags[0].side = 0.0, "`side` is 0"),
        ] {
            let found = changed(change);
            assert!(found.contains(said), "{found}\nexpected {said}");
        }
    }
}
