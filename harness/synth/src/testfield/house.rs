//! A house whose junctions are known, with or without texture.

use std::f64::consts::TAU;

use calibench_model::testfield::{Area, ObjectTarget, Outline, Plate, PlatePoint, Testfield, axes};
use calibench_model::{PixelPoint, TargetKind};
use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Vector3};
use rand::{Rng, RngExt};

use super::outline::polygon;
use super::{FieldError, Shape, check};
use crate::overlap::contains;

/// A house as it is drawn: two walls, a gable, a roof, a chimney, a door and a window before the sky, on a plane sheet of 16 x 12 units of the drawing.
///
/// The paper's figure is not at hand: this house is ours, made to have the paper's twelve junctions of three or more areas. Texture is small squares of a
/// slightly other reflectance, strewn over walls, roof, gable and ground, none nearer to an edge of an area than half of its own side.
///
/// The sheet lies in the plane z = 0, its lower left corner at the origin, and faces +z.
///
/// After Zhu, Wu & Wan 2007, Fig. 5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct House {
    /// The width of the sheet, object units; its height is three quarters of it.
    pub width: f64,
    /// How many small squares make the texture, 0 to 10000.
    pub specks: usize,
    /// The side of these squares, object units; at most a sixteenth of the width.
    pub speck: f64,
    /// Their reflectance (fraction of what makes full scale) differs from their ground's by up to this, 0 to 0.2.
    pub contrast: f64,
    /// The radiance behind the sheet, as a fraction of full scale.
    pub background: f64,
}

impl Default for House {
    fn default() -> Self {
        Self { width: 16.0, specks: 400, speck: 0.12, contrast: 0.1, background: 0.5 }
    }
}

/// The sheet in units of the drawing.
const SHEET: PlatePoint = [16.0, 12.0];
/// Reflectance of the sky.
const SKY: f64 = 0.75;
/// Darts thrown for each square of the texture.
const DARTS: usize = 1000;

/// An area of the drawing: vertices, reflectance, and the area that it lies in.
struct Part {
    vertices: &'static [PlatePoint],
    level: f64,
    inside: Option<usize>,
    textured: bool,
}

const FRONT: usize = 1;
const SIDE: usize = 2;

const PARTS: [Part; 9] = [
    part(&[[0.0, 0.0], [16.0, 0.0], [16.0, 1.5], [0.0, 1.5]], 0.30, true),
    part(&[[2.0, 1.5], [8.0, 1.5], [8.0, 6.0], [2.0, 6.0]], 0.60, true),
    part(&[[8.0, 1.5], [14.0, 1.5], [14.0, 6.0], [8.0, 6.0]], 0.42, true),
    part(&[[2.0, 6.0], [8.0, 6.0], [5.0, 9.0]], 0.50, true),
    part(&[[8.0, 6.0], [14.0, 6.0], [11.0, 9.0], [5.0, 9.0]], 0.22, true),
    part(&[[5.0, 9.0], [6.2, 9.0], [6.2, 10.5], [5.0, 10.5]], 0.35, false),
    part_in(FRONT, &[[3.0, 1.5], [4.4, 1.5], [4.4, 4.1], [3.0, 4.1]], 0.12),
    part_in(SIDE, &[[10.0, 3.0], [11.0, 3.0], [11.0, 5.0], [10.0, 5.0]], 0.08),
    part_in(SIDE, &[[11.0, 3.0], [12.0, 3.0], [12.0, 5.0], [11.0, 5.0]], 0.18),
];

/// The junctions.
const JUNCTIONS: [(PlatePoint, &str); 12] = [
    ([2.0, 1.5], "front-foot"),
    ([3.0, 1.5], "door-left"),
    ([4.4, 1.5], "door-right"),
    ([8.0, 1.5], "middle-foot"),
    ([14.0, 1.5], "side-foot"),
    ([11.0, 3.0], "window-sill"),
    ([11.0, 5.0], "window-head"),
    ([2.0, 6.0], "front-eaves"),
    ([8.0, 6.0], "middle-eaves"),
    ([14.0, 6.0], "side-eaves"),
    ([5.0, 9.0], "gable-top"),
    ([6.2, 9.0], "chimney-foot"),
];

const fn part(vertices: &'static [PlatePoint], level: f64, textured: bool) -> Part {
    Part { vertices, level, inside: None, textured }
}

const fn part_in(inside: usize, vertices: &'static [PlatePoint], level: f64) -> Part {
    Part { vertices, level, inside: Some(inside), textured: false }
}

impl House {
    /// The house; its targets are the twelve junctions, of the size of the shortest edge at any of them. `key` seeds the texture; its `target` is not used.
    ///
    /// # Errors
    /// A parameter out of its range; [`FieldError::Crowded`] if the texture finds no room.
    pub fn generate(&self, key: Key<'_>) -> Result<Testfield, FieldError> {
        self.check()?;
        let scale = self.width / SHEET[0];
        let scaled = |[u, v]: PlatePoint| [u * scale, v * scale];
        let area = |part: &Part| Area {
            outline: Outline::polygon(&part.vertices.iter().copied().map(scaled).collect::<Vec<_>>()),
            level: part.level,
            ground: part.inside.map_or(SKY, |index| PARTS[index].level),
        };
        let mut areas: Vec<Area> = PARTS.iter().map(area).collect();
        areas.extend(self.texture(&areas, key)?);
        let target = |&(at, name): &(PlatePoint, &str)| {
            let at = scaled(at);
            let surveyed = Point3::new(at[0], at[1], 0.0);
            ObjectTarget { id: name.into(), kind: TargetKind::Junction, plate: 0, at, size: scale, axes: axes(0.0), surveyed, room: None }
        };
        let plate = Plate {
            id: "house".into(),
            origin: Point3::origin(),
            u: Vector3::x(),
            v: Vector3::y(),
            bend: None,
            corners: [[0.0, 0.0], scaled(SHEET)],
            level: SKY,
            areas,
        };
        Ok(Testfield { plates: vec![plate], targets: JUNCTIONS.iter().map(target).collect(), background: self.background })
    }

    fn check(&self) -> Result<(), FieldError> {
        check::length("width", self.width)?;
        check::counted("specks", self.specks, 0..=10_000)?;
        check::within("speck", self.speck, 1e-6 * self.width..=self.width / 16.0)?;
        check::within("contrast", self.contrast, 0.0..=0.2)?;
        check::within("background", self.background, 0.0..=1.0)
    }

    /// The squares of the texture, each wholly in one textured area, apart from each other and from all edges.
    fn texture(&self, areas: &[Area], key: Key<'_>) -> Result<Vec<Area>, FieldError> {
        let mut rng = stream(Key { target: "house", ..key }, Purpose::Texture);
        let edges: Vec<(PixelPoint, PixelPoint)> = areas.iter().flat_map(|a| polygon(&a.outline).edges().collect::<Vec<_>>()).collect();
        let polygons: Vec<_> = areas.iter().map(|area| polygon(&area.outline)).collect();
        let reach = Shape::Square.reach(self.speck);
        let mut put: Vec<PixelPoint> = Vec::new();
        let mut specks = Vec::new();
        let height = self.width * SHEET[1] / SHEET[0];
        while specks.len() < self.specks {
            let ground = |at: PixelPoint| {
                let innermost = PARTS.iter().zip(&polygons).rfind(|(_, outline)| contains(outline, at));
                innermost.map(|(part, _)| part).filter(|part| part.textured)
            };
            let found = (0..DARTS).find_map(|_| {
                let at = PixelPoint::new(rng.random::<f64>() * self.width, rng.random::<f64>() * height);
                let apart = put.iter().all(|other| other.distance(at) >= 2.0 * reach);
                let part = if apart { ground(at)? } else { return None };
                let clear = edges.iter().all(|&edge| from_edge(at, edge) >= reach + 0.5 * self.speck);
                (clear && at.x >= reach && at.x <= self.width - reach && at.y >= reach).then_some((at, part.level))
            });
            let Some((at, ground)) = found else {
                return Err(FieldError::Crowded { placed: specks.len(), wanted: self.specks, plate: "house".into() });
            };
            put.push(at);
            specks.push(self.speck_at(at, ground, &mut rng));
        }
        Ok(specks)
    }

    fn speck_at(&self, at: PixelPoint, ground: f64, rng: &mut impl Rng) -> Area {
        let level = (ground + (2.0 * rng.random::<f64>() - 1.0) * self.contrast).clamp(0.0, 1.0);
        let outline = Shape::Square.outlines([at.x, at.y], self.speck, rng.random::<f64>() * TAU).remove(0);
        Area { outline, level, ground }
    }
}

fn from_edge(p: PixelPoint, (a, b): (PixelPoint, PixelPoint)) -> f64 {
    let (u, v) = (b.x - a.x, b.y - a.y);
    let t = (((p.x - a.x) * u + (p.y - a.y) * v) / (u * u + v * v)).clamp(0.0, 1.0);
    p.distance(PixelPoint::new(a.x + t * u, a.y + t * v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::overlap::overlap;

    const KEY: Key<'_> = Key { seed: 2007, of: "house", trial: 0, view: "", target: "" };

    /// The reflectance at a point: that of the innermost area.
    fn level(field: &Testfield, at: [f64; 2]) -> f64 {
        let p = PixelPoint::new(at[0], at[1]);
        let around = field.plates[0].areas.iter().rfind(|area| contains(&polygon(&area.outline), p));
        around.map_or(SKY, |area| area.level)
    }

    #[test]
    fn three_or_more_areas_meet_at_each_of_the_twelve_junctions() {
        let field = House::default().generate(KEY).unwrap();
        assert_eq!(field.targets.len(), 12);
        for target in &field.targets {
            let around = (0..360).map(|i| {
                let (sine, cosine) = (f64::from(i).to_radians() + 0.001).sin_cos();
                level(&field, [target.at[0] + 0.01 * cosine, target.at[1] + 0.01 * sine])
            });
            let mut levels: Vec<f64> = around.collect();
            levels.sort_by(f64::total_cmp);
            levels.dedup();
            assert!(levels.len() >= 3, "{}: {levels:?}", target.id);
            assert!(levels.windows(2).all(|pair| pair[1] - pair[0] > 0.05), "{}: {levels:?}", target.id);
        }
    }

    #[test]
    fn areas_lie_side_by_side_or_inside_the_one_that_is_their_ground() {
        let field = House::default().generate(KEY).unwrap();
        let areas = &field.plates[0].areas;
        assert_eq!(areas.len(), 9 + 400);
        let polygons: Vec<_> = areas.iter().map(|area| polygon(&area.outline)).collect();
        for (i, inner) in polygons.iter().enumerate() {
            let outer: Vec<usize> = (0..i).filter(|&j| overlap(inner, &polygons[j]).is_some()).collect();
            let ground = outer.iter().map(|&j| areas[j].level).next_back().unwrap_or(SKY);
            assert!(outer.len() <= 1 && areas[i].ground == ground, "area {i} in {outer:?}");
            for &j in &outer {
                let within = inner.vertices.iter().all(|&v| {
                    let near = polygons[j].edges().map(|edge| from_edge(v, edge)).fold(f64::MAX, f64::min);
                    contains(&polygons[j], v) || near < 1e-9
                });
                assert!(within, "area {i} is wholly inside {j}");
            }
        }
    }

    #[test]
    fn texture_has_its_seed_and_its_limits() {
        let house = House { width: 4.0, speck: 0.03, ..House::default() };
        let field = house.generate(KEY).unwrap();
        assert_eq!(field, house.generate(KEY).unwrap());
        assert_ne!(field, house.generate(Key { seed: 1, ..KEY }).unwrap());
        let plain = House { specks: 0, ..house }.generate(KEY).unwrap();
        assert_eq!(plain.plates[0].areas[..], field.plates[0].areas[..9]);
        assert_eq!(plain.targets, field.targets);
        assert!(matches!(House { specks: 5000, speck: 0.2, ..house }.generate(KEY), Err(FieldError::Crowded { .. })));
    }

    #[test]
    fn bad_parameters_are_named() {
        let h = House::default();
        let bad = [
            ("width", House { width: 0.0, ..h }),
            ("specks", House { specks: 10_001, ..h }),
            ("speck", House { speck: f64::NAN, ..h }),
            ("speck", House { speck: 2.0, ..h }),
            ("contrast", House { contrast: 0.3, ..h }),
            ("background", House { background: -1.0, ..h }),
        ];
        for (name, house) in bad {
            match house.generate(KEY) {
                Err(FieldError::Parameter { parameter, .. }) => assert_eq!(parameter, name),
                other => panic!("{name}: {other:?}"),
            }
        }
    }
}
