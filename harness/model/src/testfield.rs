//! Testfields in object space: plates with areas printed on them, and the targets whose positions are known.

use nalgebra::{Point3, Vector3};

use crate::TargetKind;

/// A position (u, v) on a plate, in its own axes, object units.
pub type PlatePoint = [f64; 2];

/// A piece of an outline on a plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// A straight line.
    Line {
        /// From here
        from: PlatePoint,
        /// to here.
        to: PlatePoint,
    },
    /// Part of a circle.
    Arc {
        /// Its centre.
        centre: PlatePoint,
        /// Its radius, in the unit of the centre's coordinates.
        radius: f64,
        /// The angle at which it starts, from u towards v, radians.
        start: f64,
        /// How far it turns, radians; positive from u towards v.
        sweep: f64,
    },
}

impl Curve {
    /// The point at parameter `t`, from 0 to 1.
    pub fn at(&self, t: f64) -> PlatePoint {
        match *self {
            Self::Line { from, to } => [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])],
            Self::Arc { centre, radius, start, sweep } => {
                let (sine, cosine) = (start + t * sweep).sin_cos();
                [centre[0] + radius * cosine, centre[1] + radius * sine]
            }
        }
    }
}

/// A closed outline: each curve begins where the one before it ends. It must not cross itself; either sense of rotation.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline(pub Vec<Curve>);

impl Outline {
    /// The polygon with these vertices; the last joins the first.
    pub fn polygon(vertices: &[PlatePoint]) -> Self {
        let next = vertices.iter().cycle().skip(1);
        Self(vertices.iter().zip(next).map(|(&from, &to)| Curve::Line { from, to }).collect())
    }

    /// The rectangle between two corners.
    pub fn rectangle([u0, v0]: PlatePoint, [u1, v1]: PlatePoint) -> Self {
        Self::polygon(&[[u0, v0], [u1, v0], [u1, v1], [u0, v1]])
    }

    /// The full circle of `radius` (in the unit of `centre`) around `centre`, in four arcs.
    pub fn disc(centre: PlatePoint, radius: f64) -> Self {
        let quarter = std::f64::consts::FRAC_PI_2;
        Self((0..4).map(|i| Curve::Arc { centre, radius, start: f64::from(i) * quarter, sweep: quarter }).collect())
    }
}

/// An area of one reflectance.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// Its border.
    pub outline: Outline,
    /// Its reflectance, as a fraction of what makes full scale.
    pub level: f64,
    /// The reflectance, likewise, of what it is printed on: the plate's, or that of the one area around it.
    pub ground: f64,
}

/// A smooth bend: the height over the plane, `w = peak (1 - (s^2 + along t^2) / reach^2)`, where `s` runs along one direction from `middle` and `t` at a right angle to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// The height at the crest, along the plate's normal, object units.
    pub peak: f64,
    /// Where the crest passes.
    pub middle: PlatePoint,
    /// The direction across the crest, from u towards v, radians.
    pub across: f64,
    /// How far from the crest the height is zero, object units.
    pub reach: f64,
    /// How much it falls along the crest, as a part of how it falls across; 0 of a cylinder, below 0 of a saddle.
    pub along: f64,
}

impl Bend {
    /// The height at `at`, object units.
    pub fn height(&self, at: PlatePoint) -> f64 {
        let (sine, cosine) = self.across.sin_cos();
        let (du, dv) = (at[0] - self.middle[0], at[1] - self.middle[1]);
        let s = (du * cosine + dv * sine) / self.reach;
        if self.along == 0.0 {
            return self.peak * (1.0 - s * s);
        }
        let t = (dv * cosine - du * sine) / self.reach;
        self.peak * (1.0 - s * s - self.along * t * t)
    }
}

/// An opaque rectangular sheet in space, printed on its front.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// Its name.
    pub id: String,
    /// Where its (0, 0) is, object units.
    pub origin: Point3<f64>,
    /// The direction of u in object space, of length 1.
    pub u: Vector3<f64>,
    /// The direction of v in object space, of length 1, at a right angle to u. The front looks along `u x v`.
    pub v: Vector3<f64>,
    /// Its bend; `None` if it is flat.
    pub bend: Option<Bend>,
    /// Two opposite corners of the sheet, the lower values first.
    pub corners: [PlatePoint; 2],
    /// Its reflectance where nothing is printed, as a fraction of what makes full scale.
    pub level: f64,
    /// What is printed: areas lie side by side or one wholly inside another, and may share edges.
    pub areas: Vec<Area>,
}

impl Plate {
    /// The normal of the unbent front in object space, of length 1.
    pub fn normal(&self) -> Vector3<f64> {
        self.u.cross(&self.v)
    }

    /// A position on the sheet in object space, bend included, object units.
    pub fn point(&self, at: PlatePoint) -> Point3<f64> {
        let flat = self.origin + self.u * at[0] + self.v * at[1];
        match &self.bend {
            None => flat,
            Some(bend) => flat + self.normal() * bend.height(at),
        }
    }

    /// The sheet's own border.
    pub fn border(&self) -> Outline {
        Outline::rectangle(self.corners[0], self.corners[1])
    }
}

/// A target on a plate.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectTarget {
    /// Its name in records and tables.
    pub id: String,
    /// The kind of target.
    pub kind: TargetKind,
    /// The plate that it is on: an index into [`Testfield::plates`].
    pub plate: usize,
    /// Its reference point, as printed.
    pub at: PlatePoint,
    /// Its size, object units: a disc's diameter, the side of a square, a triangle or a chessboard's square, a bar's length.
    pub size: f64,
    /// The directions on the plate of its own axes u and v, of length 1: [`axes`], but for the corner of one area, whose axes run along its edges.
    pub axes: [PlatePoint; 2],
    /// Where a user believes it to be, object units: the plan or the survey, without what went wrong in printing or mounting.
    pub surveyed: Point3<f64>,
    /// The half side of the largest square around it, along its own axes, that holds nothing of anything else, object units; where that is known.
    pub room: Option<f64>,
}

/// A testfield: what a camera is pointed at.
#[derive(Clone, Debug, PartialEq)]
pub struct Testfield {
    /// The sheets. They must not cut through each other.
    pub plates: Vec<Plate>,
    /// The targets.
    pub targets: Vec<ObjectTarget>,
    /// The radiance of what lies behind all plates, as a fraction of full scale.
    pub background: f64,
}

/// The directions on a plate of the own axes u, to the right, and v, down, of a target that is turned by `turn` (radians, from the plate's u towards its v).
pub fn axes(turn: f64) -> [PlatePoint; 2] {
    let (sine, cosine) = turn.sin_cos();
    [[cosine, sine], [sine, -cosine]]
}

impl Testfield {
    /// Where a target really is, object units.
    ///
    /// # Panics
    /// If the target's plate is not one of this field's.
    pub fn position(&self, target: &ObjectTarget) -> Point3<f64> {
        self.plates[target.plate].point(target.at)
    }

    /// A box around all sheets, bends included, lowest and highest coordinates, object units; `None` without a plate.
    pub fn extent(&self) -> Option<[Point3<f64>; 2]> {
        let border = |plate: &Plate| {
            let [[u0, v0], [u1, v1]] = plate.corners;
            let crest = plate.normal() * plate.bend.map_or(0.0, |bend| bend.peak);
            let corners = [[u0, v0], [u1, v0], [u1, v1], [u0, v1]];
            corners.map(|at| [plate.point(at), plate.origin + plate.u * at[0] + plate.v * at[1] + crest]).into_iter().flatten()
        };
        self.plates.iter().flat_map(border).fold(None, |found, p| {
            let [low, high] = found.unwrap_or([p, p]);
            Some([low.inf(&p), high.sup(&p)])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plate(bend: Option<Bend>) -> Plate {
        let (origin, u, v) = (Point3::new(1.0, 2.0, 3.0), Vector3::y(), Vector3::z());
        Plate { id: "p".into(), origin, u, v, bend, corners: [[-2.0, -1.0], [2.0, 1.0]], level: 0.8, areas: Vec::new() }
    }

    #[test]
    fn a_bend_is_zero_at_its_reach_and_highest_at_its_crest() {
        let bend = Bend { peak: 0.5, middle: [0.0, 0.0], across: 0.0, reach: 2.0, along: 0.0 };
        let plate = plate(Some(bend));
        assert_eq!(plate.point([2.0, 0.7]), Point3::new(1.0, 4.0, 3.7));
        assert_eq!(plate.point([0.0, 0.7]), Point3::new(1.5, 2.0, 3.7));
    }

    #[test]
    fn outlines_are_closed() {
        for outline in [Outline::disc([1.0, 2.0], 3.0), Outline::rectangle([0.0, 1.0], [4.0, 5.0])] {
            let next = outline.0.iter().cycle().skip(1);
            for (curve, next) in outline.0.iter().zip(next) {
                let (end, start) = (curve.at(1.0), next.at(0.0));
                assert!((end[0] - start[0]).hypot(end[1] - start[1]) < 1e-14);
            }
        }
    }

    #[test]
    fn the_extent_holds_all_corners() {
        let field = Testfield { plates: vec![plate(None)], targets: Vec::new(), background: 0.0 };
        assert_eq!(field.extent(), Some([Point3::new(1.0, 0.0, 2.0), Point3::new(1.0, 4.0, 4.0)]));
        let bend = Bend { peak: 0.5, middle: [0.0, 0.0], across: 0.0, reach: 2.0, along: 0.0 };
        let bent = Testfield { plates: vec![plate(Some(bend))], ..field.clone() };
        assert_eq!(bent.extent(), Some([Point3::new(1.0, 0.0, 2.0), Point3::new(1.5, 4.0, 4.0)]), "the crest is inside");
        assert_eq!(Testfield { plates: Vec::new(), ..field }.extent(), None);
    }
}
