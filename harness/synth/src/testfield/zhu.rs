//! The eight images of Zhu, Wu & Wan, Fig. 4: an end point, line corners and solid corners.

use calibench_model::{PixelPoint, Polygon, Scene, SceneTarget, TargetKind};

use super::join::Join;
use super::pen::grown;
use super::{FieldError, check};

/// An image of Fig. 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure4 {
    /// (a): the end of a line.
    EndPoint,
    /// (b): two lines meet at 30 degrees.
    Line30,
    /// (c): at 45 degrees.
    Line45,
    /// (d): at 60 degrees.
    Line60,
    /// (e): the corner of an area, of 30 degrees.
    Solid30,
    /// (f): of 45 degrees.
    Solid45,
    /// (g): of 60 degrees.
    Solid60,
    /// (h): of 90 degrees.
    Solid90,
}

impl Figure4 {
    /// All eight, (a) to (h).
    pub const ALL: [Self; 8] =
        [Self::EndPoint, Self::Line30, Self::Line45, Self::Line60, Self::Solid30, Self::Solid45, Self::Solid60, Self::Solid90];

    /// Its letter in the paper, and its target's name.
    pub const fn letter(self) -> &'static str {
        ["a", "b", "c", "d", "e", "f", "g", "h"][self as usize]
    }

    /// The angle of the corner, degrees; 0 for the end point.
    pub const fn degrees(self) -> f64 {
        [0.0, 30.0, 45.0, 60.0, 30.0, 45.0, 60.0, 90.0][self as usize]
    }

    /// Whether it is a corner of two lines.
    pub const fn is_of_lines(self) -> bool {
        matches!(self, Self::Line30 | Self::Line45 | Self::Line60)
    }

    const fn is_solid(self) -> bool {
        matches!(self, Self::Solid30 | Self::Solid45 | Self::Solid60 | Self::Solid90)
    }
}

/// How the images are drawn. The paper gives the angles and the true coordinates, (248.5, 248.5) in all; the rest is ours.
///
/// Corners open towards +x, as the printed residuals of (e) to (g) lie along x; (h) opens to the right and upwards, its edges along the axes. The reference
/// point is the vertex of solid corners, the meeting of the lines' middles at line corners, the middle of the short end at the end point (all are called
/// `corner`: the paper's end point has no kind of its own).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zhu {
    /// Columns and rows, px.
    pub side: usize,
    /// The reference point.
    pub at: PixelPoint,
    /// The length of lines and of the solid corners' edges, px.
    pub arm: f64,
    /// The width of lines, px.
    pub stroke: f64,
    /// Grey value of lines and areas, fraction of full scale.
    pub ink: f64,
    /// Grey value around them, fraction of full scale.
    pub background: f64,
    /// Another angle for line and solid corners, degrees; solid ones then open about +x. `None`: that of the image.
    pub angle: Option<f64>,
    /// The width of the pen, px, with which the outline is drawn beside the filling: what is drawn reaches half of it past the geometry, as in drawing programs.
    pub pen: f64,
    /// One edge of a corner runs along +x, rather than its bisector; (h) stays as it is.
    pub edge_along_x: bool,
    /// How the two lines of a corner join.
    pub join: Join,
}

impl Default for Zhu {
    fn default() -> Self {
        Self {
            side: 498,
            at: PixelPoint::new(248.5, 248.5),
            arm: 150.0,
            stroke: 3.0,
            ink: 0.0,
            background: 1.0,
            angle: None,
            pen: 0.0,
            edge_along_x: false,
            join: Join::Mitre,
        }
    }
}

impl Zhu {
    /// One of the images.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn scene(&self, figure: Figure4) -> Result<Scene, FieldError> {
        self.check(figure)?;
        let id = figure.letter().to_owned();
        let fixed = figure == Figure4::EndPoint || (figure == Figure4::Solid90 && self.angle.is_none());
        let turn = if self.edge_along_x && !fixed { 0.5 * self.degrees(figure).to_radians() } else { 0.0 };
        let vertices = self.vertices(figure).into_iter().map(|vertex| turned(vertex, self.at, turn)).collect();
        let target = SceneTarget { id: id.clone(), kind: TargetKind::Corner, at: self.at };
        Ok(Scene {
            width: self.side,
            height: self.side,
            background: self.background,
            polygons: vec![grown(&Polygon { id, vertices, grey: self.ink }, self.pen)],
            targets: vec![target],
        })
    }

    /// All eight images on one sheet, (a) to (d) above (e) to (h), each `side` px wide and with its own reference point.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn sheet(&self) -> Result<Scene, FieldError> {
        let side = self.side;
        let mut sheet = Scene { width: 4 * side, height: 2 * side, background: self.background, polygons: Vec::new(), targets: Vec::new() };
        for (index, figure) in Figure4::ALL.into_iter().enumerate() {
            let (left, top) = ((index % 4 * side) as f64, (index / 4 * side) as f64);
            let own = Self { angle: None, ..*self };
            let image = own.scene(figure)?.shifted(left, top);
            sheet.polygons.extend(image.polygons);
            sheet.targets.extend(image.targets);
        }
        Ok(sheet)
    }

    /// The angle of an image's corner, degrees.
    fn degrees(&self, figure: Figure4) -> f64 {
        self.angle.filter(|_| figure != Figure4::EndPoint).unwrap_or_else(|| figure.degrees())
    }

    fn check(&self, figure: Figure4) -> Result<(), FieldError> {
        check::counted("side", self.side, 16..=20_000)?;
        let inside = self.side as f64 - 1.0;
        check::within("at", self.at.x, 0.0..=inside)?;
        check::within("at", self.at.y, 0.0..=inside)?;
        check::within("arm", self.arm, 4.0..=f64::from(40_000))?;
        if let Some(angle) = self.angle {
            check::within("angle", angle, 5.0..=175.0)?;
        }
        let sine = (0.5 * self.degrees(figure).to_radians()).sin();
        let narrow = if figure == Figure4::EndPoint { 0.25 } else { sine.min(0.25) };
        check::within("stroke", self.stroke, 0.01..=narrow * self.arm)?;
        check::within("pen", self.pen, 0.0..=5.0)?;
        check::within("ink", self.ink, 0.0..=1.0)?;
        check::within("background", self.background, 0.0..=1.0)?;
        if (self.ink - self.background).abs() < 1e-3 {
            return Err(FieldError::Parameter { parameter: "ink", value: self.ink, expected: "another grey than `background`".into() });
        }
        Ok(())
    }

    fn vertices(&self, figure: Figure4) -> Vec<PixelPoint> {
        let (half, arm) = (0.5 * self.stroke, self.arm);
        let at = |x: f64, y: f64| PixelPoint::new(self.at.x + x, self.at.y + y);
        let (sine, cosine) = (0.5 * self.degrees(figure).to_radians()).sin_cos();
        match figure {
            Figure4::EndPoint => vec![at(0.0, -half), at(arm, -half), at(arm, half), at(0.0, half)],
            Figure4::Solid90 if self.angle.is_none() => vec![at(0.0, 0.0), at(0.0, -arm), at(arm, -arm), at(arm, 0.0)],
            _ if figure.is_solid() => vec![at(0.0, 0.0), at(arm * cosine, -arm * sine), at(arm * cosine, arm * sine)],
            _ => {
                // Inside, the edges go on until they meet.
                let inside = at(half / sine, 0.0);
                let end = |side: f64, out: f64| at(arm * cosine - out * half * sine, side * (arm * sine + out * half * cosine));
                let outside = self.join.outside(half, self.degrees(figure).to_radians()).into_iter().map(|[x, y]| at(x, y));
                outside.chain([end(-1.0, 1.0), end(-1.0, -1.0), inside, end(1.0, -1.0), end(1.0, 1.0)]).collect()
            }
        }
    }
}

/// `point` turned about `at` by `angle`, from x towards y.
fn turned(point: PixelPoint, at: PixelPoint, angle: f64) -> PixelPoint {
    let ((sine, cosine), x, y) = (angle.sin_cos(), point.x - at.x, point.y - at.y);
    PixelPoint::new(at.x + cosine * x - sine * y, at.y + sine * x + cosine * y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::overlap::crosses_itself;

    #[test]
    fn corners_have_their_angles_and_their_areas() {
        let zhu = Zhu::default();
        for figure in Figure4::ALL {
            let scene = zhu.scene(figure).unwrap();
            let polygon = &scene.polygons[0];
            assert!(crosses_itself(polygon).is_none(), "{figure:?}");
            assert_eq!((scene.targets[0].at, scene.targets[0].id.as_str()), (PixelPoint::new(248.5, 248.5), figure.letter()));
            let angle = figure.degrees().to_radians();
            let area = match figure {
                Figure4::EndPoint => 450.0,
                Figure4::Solid90 => 22500.0,
                _ if figure.is_solid() => 0.5 * 22500.0 * angle.sin(),
                // Two bars; at the corner a kite is cut in two in the middle: what one loses inside the other gains outside.
                _ => 2.0 * 450.0,
            };
            assert!((polygon.doubled_area().abs() / 2.0 - area).abs() < 1e-9, "{figure:?}");
            assert!(polygon.vertices.iter().all(|v| v.x > 0.0 && v.x < 497.0 && v.y > 0.0 && v.y < 497.0));
            if figure != Figure4::EndPoint {
                let v = &polygon.vertices;
                let direction = |from: PixelPoint, to: PixelPoint| (to.y - from.y).atan2(to.x - from.x);
                let between = direction(v[0], v[v.len() - 1]) - direction(v[0], v[1]);
                assert!((between - angle).abs() < 1e-12, "{figure:?}");
            }
        }
    }

    /// Two bars, less what they share inside, and the join's own area outside; pens and joins go together.
    #[test]
    fn lines_join_in_every_way() {
        for figure in [Figure4::Line30, Figure4::Line45, Figure4::Line60] {
            for join in Join::ALL {
                let drawn = |pen: f64| Zhu { pen, join, ..Zhu::default() }.scene(figure).unwrap().polygons.remove(0);
                assert!(crosses_itself(&drawn(0.0)).is_none(), "{figure:?} {join:?}");
                assert!(drawn(0.5).doubled_area().abs() > drawn(0.0).doubled_area().abs(), "{figure:?} {join:?}");
                let (tangent, angle) = ((0.5 * figure.degrees().to_radians()).tan(), figure.degrees().to_radians());
                // A quarter of the squared stroke, 2.25, is the unit.
                let outside = match join {
                    Join::Mitre => 1.0 / tangent,
                    Join::Bevel => 0.5 * angle.sin(),
                    Join::Round => 0.5 * (std::f64::consts::PI - angle),
                    Join::Butt => 0.0,
                    Join::Square => 2.0 - tangent,
                };
                let area = 2.0 * 450.0 + 2.25 * (outside - 1.0 / tangent);
                assert!((drawn(0.0).doubled_area().abs() / 2.0 - area).abs() < 0.02, "{figure:?} {join:?}");
            }
        }
    }

    #[test]
    fn a_sheet_holds_all_eight_where_they_were() {
        let zhu = Zhu { side: 61, at: PixelPoint::new(30.0, 30.0), arm: 20.0, ..Zhu::default() };
        let sheet = zhu.sheet().unwrap();
        assert_eq!((sheet.width, sheet.height, sheet.polygons.len()), (244, 122, 8));
        let letters: Vec<&str> = sheet.targets.iter().map(|target| target.id.as_str()).collect();
        assert_eq!(letters, ["a", "b", "c", "d", "e", "f", "g", "h"]);
        assert_eq!((sheet.targets[0].at, sheet.targets[6].at), (PixelPoint::new(30.0, 30.0), PixelPoint::new(152.0, 91.0)));
        let alone = zhu.scene(Figure4::Solid60).unwrap();
        assert_eq!(sheet.polygons[6].vertices, alone.shifted(122.0, 61.0).polygons[0].vertices);
    }

    #[test]
    fn an_edge_can_run_along_x() {
        let zhu = Zhu { edge_along_x: true, ..Zhu::default() };
        let v = zhu.scene(Figure4::Solid30).unwrap().polygons[0].vertices.clone();
        assert!((v[1].y - v[0].y).abs() < 1e-9 && v[1].x > v[0].x && v[2].y > v[0].y);
        assert_eq!(zhu.scene(Figure4::Solid90), Zhu::default().scene(Figure4::Solid90));
    }

    #[test]
    fn a_corner_can_have_any_angle() {
        for (figure, angle) in [(Figure4::Solid90, 120.0_f64), (Figure4::Solid30, 75.0), (Figure4::Line45, 100.0)] {
            let scene = Zhu { angle: Some(angle), ..Zhu::default() }.scene(figure).unwrap();
            let v = &scene.polygons[0].vertices;
            let (first, last) = (v[1], v[v.len() - 1]);
            let direction = |to: PixelPoint| (to.y - v[0].y).atan2(to.x - v[0].x).to_degrees();
            assert!((direction(last) - direction(first) - angle).abs() < 1e-9 && (direction(last) + direction(first)).abs() < 1e-9);
        }
    }

    #[test]
    fn line_corners_meet_where_their_middles_do() {
        let zhu = Zhu { stroke: 4.0, ..Zhu::default() };
        let v = zhu.scene(Figure4::Line60).unwrap().polygons[0].vertices.clone();
        for (a, b, side) in [(v[1], v[2], -1.0), (v[4], v[5], 1.0)] {
            assert!((a.distance(b) - 4.0).abs() < 1e-12, "as wide as its stroke");
            let middle = PixelPoint::new((a.x + b.x) / 2.0 - 248.5, (a.y + b.y) / 2.0 - 248.5);
            assert!((middle.y.atan2(middle.x) - side * 30_f64.to_radians()).abs() < 1e-12);
        }
        assert_eq!((v[0].x + v[3].x) / 2.0, 248.5);
    }

    #[test]
    fn bad_parameters_are_named() {
        let z = Zhu::default();
        let bad = [
            ("side", Zhu { side: 3, ..z }),
            ("at", Zhu { at: PixelPoint::new(-1.0, 5.0), ..z }),
            ("at", Zhu { at: PixelPoint::new(1.0, f64::NAN), ..z }),
            ("arm", Zhu { arm: f64::INFINITY, ..z }),
            ("stroke", Zhu { stroke: 0.0, ..z }),
            ("stroke", Zhu { stroke: 38.0, ..z }),
            ("ink", Zhu { ink: 1.0, ..z }),
            ("background", Zhu { background: 1.5, ..z }),
            ("angle", Zhu { angle: Some(180.0), ..z }),
        ];
        for (name, zhu) in bad {
            match zhu.scene(Figure4::Line30) {
                Err(FieldError::Parameter { parameter, .. }) => assert_eq!(parameter, name),
                other => panic!("{name}: {other:?}"),
            }
        }
    }
}
