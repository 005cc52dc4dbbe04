//! A board as it came out of the printer and off the wall: corners at their own places, sheets of second order, ink that spreads, edges that are not straight.

use std::collections::BTreeMap;

use calibench_model::testfield::{Area, Bend, Curve, Outline, Plate, PlatePoint, Testfield};
use calibench_random::{Key, Purpose, stream};
use nalgebra::{DMatrix, DVector, Matrix2, Point3, Vector3};
use rand_distr::{Distribution, StandardNormal};

use super::{FieldError, check};

/// What a print differs by from a perfect one. The default does not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Print {
    /// Names of targets and where they are, object units; of the others the nearest one's displacement is taken. Empty: all are where they are meant to be.
    pub corners: Vec<(String, Point3<f64>)>,
    /// Dark areas grow by this on every straight side, but not at its ends, object units; below 0 they shrink.
    pub ink_spread: f64,
    /// Standard deviation of nodes of straight edges across themselves, object units.
    pub ragged: f64,
    /// Distance of these nodes, object units.
    pub ragged_length: f64,
}

/// With fewer corners a sheet's form is not told.
const FEWEST: usize = 6;
/// Ends of a side over which spread ink comes to its full width, in widths: dark areas that meet in a point still do.
const RAMP: f64 = 2.0;
/// Parts of a side at most.
const MOST_PARTS: usize = 400;

impl Print {
    /// Whether it is a perfect one.
    pub fn is_perfect(&self) -> bool {
        self.corners.is_empty() && self.ink_spread == 0.0 && self.ragged == 0.0
    }

    /// The testfield, of one plate, as it was printed. `key` seeds the edges; its `target` is not used.
    ///
    /// # Errors
    /// A parameter out of its range; names that the field does not have, too few corners, corners that are elsewhere.
    pub fn applied(&self, field: Testfield, key: Key<'_>) -> Result<Testfield, FieldError> {
        if self.is_perfect() {
            return Ok(field);
        }
        let step = field.targets.iter().map(|target| target.size).fold(f64::INFINITY, f64::min);
        check::within("ink_spread", self.ink_spread, -0.1 * step..=0.1 * step)?;
        check::within("ragged", self.ragged, 0.0..=0.02 * step)?;
        check::within("ragged_length", self.ragged_length, 1e-3 * step..=step)?;
        let field = if self.corners.is_empty() { field } else { self.placed(field)? };
        Ok(self.inked(field, key))
    }

    /// With every target and every vertex at its own place, on a sheet of second order through the corners.
    fn placed(&self, mut field: Testfield) -> Result<Testfield, FieldError> {
        let at: BTreeMap<&str, Point3<f64>> = self.corners.iter().map(|(name, at)| (name.as_str(), *at)).collect();
        let wrong = |expected: String| FieldError::Parameter { parameter: "corners", value: at.len() as f64, expected };
        let known = |name: &&str| field.targets.iter().any(|target| target.id == **name);
        if let Some(strange) = at.keys().find(|name| !known(name)) {
            return Err(wrong(format!("corners of this board: `{strange}` is none of them")));
        }
        let [plate] = field.plates.as_slice() else { return Err(wrong("a board of one sheet".into())) };
        if at.len() < FEWEST {
            return Err(wrong(format!("{FEWEST} corners or more")));
        }
        let sheet = surface(plate, &at);
        let mut moved: Vec<(PlatePoint, PlatePoint)> = Vec::new();
        for target in &field.targets {
            let Some(place) = at.get(target.id.as_str()) else { continue };
            let own = in_sheet(&sheet, place);
            if (own[0] - target.at[0]).hypot(own[1] - target.at[1]) > 0.25 * target.size {
                return Err(wrong(format!(
                    "`{}` within a quarter of its size from where it is meant to be: it is {} off",
                    target.id,
                    (own[0] - target.at[0]).hypot(own[1] - target.at[1])
                )));
            }
            moved.push((target.at, [own[0] - target.at[0], own[1] - target.at[1]]));
        }
        let apart = |a: PlatePoint, b: PlatePoint| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
        let place = |point: PlatePoint| {
            let nearest = moved.iter().min_by(|a, b| apart(a.0, point).total_cmp(&apart(b.0, point)));
            nearest.map_or(point, |(_, by)| [point[0] + by[0], point[1] + by[1]])
        };
        // As their vertices, to the last bit: what meets in a point goes on doing so.
        field.targets.iter_mut().for_each(|target| target.at = place(target.at));
        let curve = |curve: &Curve| match *curve {
            Curve::Line { from, to } => Curve::Line { from: place(from), to: place(to) },
            Curve::Arc { centre, radius, start, sweep } => Curve::Arc { centre: place(centre), radius, start, sweep },
        };
        let areas =
            plate.areas.iter().map(|area| Area { outline: Outline(area.outline.0.iter().map(curve).collect()), ..area.clone() }).collect();
        field.plates = vec![Plate { areas, ..sheet }];
        Ok(field)
    }

    /// With spread ink and ragged edges.
    fn inked(&self, mut field: Testfield, key: Key<'_>) -> Testfield {
        if self.ink_spread == 0.0 && self.ragged == 0.0 {
            return field;
        }
        for (plate, sheet) in field.plates.iter_mut().enumerate() {
            for (index, area) in sheet.areas.iter_mut().enumerate() {
                let name = format!("edge {plate} {index}");
                let mut rng = stream(Key { target: &name, ..key }, Purpose::PrintNoise);
                let outwards = turn(&area.outline) * if area.level < area.ground { 1.0 } else { -1.0 };
                let sides = area.outline.0.iter().flat_map(|curve| match *curve {
                    Curve::Line { from, to } => {
                        self.side(from, to, outwards, &mut || Distribution::<f64>::sample(&StandardNormal, &mut rng))
                    }
                    arc @ Curve::Arc { .. } => vec![arc],
                });
                area.outline = Outline(sides.collect());
            }
        }
        field
    }

    /// A straight side as it was printed: from end to end through nodes that lie aside. `outwards` is 1 where the dark lies at the right of the walk.
    fn side(&self, from: PlatePoint, to: PlatePoint, outwards: f64, normal: &mut dyn FnMut() -> f64) -> Vec<Curve> {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy);
        let ramp = (RAMP * self.ink_spread.abs()).min(0.25 * length);
        // (place along the side, how far aside); at its ends nothing is, since dark areas meet there.
        let mut nodes: Vec<(f64, f64)> = Vec::new();
        if self.ragged > 0.0 {
            let parts = ((length / self.ragged_length).round() as usize).clamp(2, MOST_PARTS);
            let inner = (1..parts).map(|part| length * part as f64 / parts as f64).filter(|s| *s > ramp && *s < length - ramp);
            nodes.extend(inner.map(|s| (s, self.ink_spread + self.ragged * normal())));
        }
        if ramp > 0.0 {
            nodes.insert(0, (ramp, self.ink_spread));
            nodes.push((length - ramp, self.ink_spread));
        }
        let mut points = vec![from];
        for (s, aside) in nodes {
            let by = outwards * aside / length;
            points.push([from[0] + dx * s / length + dy * by, from[1] + dy * s / length - dx * by]);
        }
        points.push(to);
        points.windows(2).map(|pair| Curve::Line { from: pair[0], to: pair[1] }).collect()
    }
}

/// 1 of an outline that is walked anticlockwise: its outside lies at the right of the walk; -1 of another.
fn turn(outline: &Outline) -> f64 {
    let area: f64 = outline
        .0
        .iter()
        .map(|curve| {
            let (a, b) = (curve.at(0.0), curve.at(1.0));
            a[0] * b[1] - a[1] * b[0]
        })
        .sum();
    if area < 0.0 { -1.0 } else { 1.0 }
}

/// The plate as a sheet of second order through corners, by least squares.
fn surface(plate: &Plate, at: &BTreeMap<&str, Point3<f64>>) -> Plate {
    let local = |point: &Point3<f64>| {
        let from = point - plate.origin;
        [from.dot(&plate.u), from.dot(&plate.v), from.dot(&plate.normal())]
    };
    let places: Vec<[f64; 3]> = at.values().map(local).collect();
    let n = places.len() as f64;
    let mean = [0, 1].map(|k| places.iter().map(|place| place[k]).sum::<f64>() / n);
    let extent = places.iter().map(|place| (place[0] - mean[0]).hypot(place[1] - mean[1])).fold(f64::MIN_POSITIVE, f64::max);
    // In units of the extent, so that the equations are of one size.
    let row = |place: &[f64; 3]| {
        let (x, y) = ((place[0] - mean[0]) / extent, (place[1] - mean[1]) / extent);
        [1.0, x, y, x * x, x * y, y * y]
    };
    let design = DMatrix::from_fn(places.len(), 6, |i, j| row(&places[i])[j]);
    let heights = DVector::from_iterator(places.len(), places.iter().map(|place| place[2]));
    let found = design.svd(true, true).solve(&heights, 1e-9).unwrap_or_else(|_| DVector::zeros(6));
    let quadratic = Matrix2::new(found[3], 0.5 * found[4], 0.5 * found[4], found[5]).symmetric_eigen();
    let first = usize::from(quadratic.eigenvalues[0].abs() < quadratic.eigenvalues[1].abs());
    let (most, least) = (quadratic.eigenvalues[first], quadratic.eigenvalues[1 - first]);
    let direction = quadratic.eigenvectors.column(first);
    let bend = (most != 0.0).then(|| Bend {
        peak: -most,
        middle: mean,
        across: direction[1].atan2(direction[0]),
        reach: extent,
        along: least / most,
    });
    // The plane of the sheet: what is linear in the heights turns it, and the height of the crest is that of the bend.
    let slope = [found[1] / extent, found[2] / extent];
    let crest = bend.map_or(0.0, |bend| bend.peak);
    let u = (plate.u + plate.normal() * slope[0]).normalize();
    let v = (plate.v + plate.normal() * slope[1]).normalize();
    let v = (v - u * u.dot(&v)).normalize();
    let centre = plate.origin + plate.u * mean[0] + plate.v * mean[1] + plate.normal() * (found[0] - crest);
    let origin = centre - u * mean[0] - v * mean[1];
    Plate { origin, u, v, bend, ..plate.clone() }
}

/// Where a point stands over a sheet.
fn in_sheet(sheet: &Plate, point: &Point3<f64>) -> PlatePoint {
    let from: Vector3<f64> = point - sheet.origin;
    [from.dot(&sheet.u), from.dot(&sheet.v)]
}

#[cfg(test)]
mod tests;
