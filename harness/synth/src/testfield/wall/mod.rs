//! The wall of ground control points: sheets in space with targets, surveyed with some error.

use calibench_model::testfield::{Area, ObjectTarget, Outline, Plate, PlatePoint, Testfield};
use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Vector3};
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use super::{FieldError, Fill, Levels, Shape, SheetBend, check, sheet_layout};

/// A sheet of the wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Its name.
    pub id: String,
    /// Where its middle was when it was surveyed, object units; (0, 0) of its own axes.
    pub middle: Point3<f64>,
    /// The direction of its width in object axes, of any length, to the right as one looks at its front.
    pub u: Vector3<f64>,
    /// The direction of its height in object axes, of any length, upwards, at a right angle to `u`.
    pub v: Vector3<f64>,
    /// Width and height, object units.
    pub size: [f64; 2],
    /// Its bend, which the survey has seen.
    pub bend: Option<SheetBend>,
    /// Reflectances.
    pub levels: Levels,
    /// How far it has moved since the survey, object units: a wall that is not quite where it was.
    pub shift: Vector3<f64>,
}

/// A target that is put where the scenario says.
#[derive(Clone, Debug, PartialEq)]
pub struct WallTarget {
    /// Its name.
    pub id: String,
    /// Its sheet.
    pub plate: String,
    /// What it looks like.
    pub shape: Shape,
    /// Its reference point, from the sheet's middle, object units.
    pub at: PlatePoint,
    /// Its size, object units, as [`Shape`] says.
    pub size: f64,
    /// How it is turned, from u towards v, radians.
    pub turn: f64,
    /// Its surveyed position, object units; `None`: the true one at the time of the survey, with the survey's error.
    pub surveyed: Option<Point3<f64>>,
}

/// A wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Its sheets.
    pub sheets: Vec<Sheet>,
    /// Targets at given places.
    pub targets: Vec<WallTarget>,
    /// Targets strewn over every sheet between the others, called after the sheet: `p1-1/1`, `p1-1/2`, ...
    pub fill: Option<Fill>,
    /// Standard deviation of the survey per axis, object units.
    pub survey_sigma: f64,
    /// The radiance behind the wall, as a fraction of full scale.
    pub background: f64,
}

impl Wall {
    /// The wall. `key` seeds places and turns of the strewn targets and the survey's errors; its `target` is not used.
    ///
    /// # Errors
    /// A parameter out of its range, sheets or targets of one name, targets that overlap, leave their sheet, name none or find no room on it.
    pub fn generate(&self, key: Key<'_>) -> Result<Testfield, FieldError> {
        self.check()?;
        let mut targets = self.targets.clone();
        if let Some(fill) = &self.fill {
            for sheet in &self.sheets {
                targets.extend(self.strewn(sheet, fill, key)?);
            }
        }
        if targets.is_empty() {
            return Err(FieldError::Nothing("targets"));
        }
        unique("target", targets.iter().map(|target| target.id.as_str()))?;
        let of_sheet = |target: &WallTarget| self.sheets.iter().position(|sheet| sheet.id == target.plate);
        let unknown = |t: &WallTarget| FieldError::UnknownPlate { target: t.id.clone(), plate: t.plate.clone() };
        let on: Vec<usize> = targets.iter().map(|t| of_sheet(t).ok_or_else(|| unknown(t))).collect::<Result<_, _>>()?;
        let mut plates = self.sheets.iter().map(Sheet::plate).collect::<Result<Vec<_>, _>>()?;
        for (index, plate) in plates.iter_mut().enumerate() {
            let here = targets.iter().zip(&on).filter(|(_, sheet)| **sheet == index).map(|(target, _)| target);
            plate.areas = printed(&self.sheets[index], &here.collect::<Vec<_>>())?;
        }
        let targets = targets.into_iter().zip(on).map(|(target, plate)| {
            let surveyed = target.surveyed.unwrap_or_else(|| {
                let mut rng = stream(Key { target: &target.id, ..key }, Purpose::Survey);
                let then = plates[plate].point(target.at) - self.sheets[plate].shift;
                then + Vector3::from_fn(|_, _| self.survey_sigma * standard(&mut rng))
            });
            let (kind, axes) = (target.shape.kind(), target.shape.axes(target.turn));
            ObjectTarget { id: target.id, kind, plate, at: target.at, size: target.size, axes, surveyed, room: None }
        });
        Ok(Testfield { targets: targets.collect(), plates, background: self.background })
    }

    fn check(&self) -> Result<(), FieldError> {
        if self.sheets.is_empty() {
            return Err(FieldError::Nothing("plates"));
        }
        unique("plate", self.sheets.iter().map(|sheet| sheet.id.as_str()))?;
        self.sheets.iter().try_for_each(Sheet::check)?;
        self.targets.iter().try_for_each(WallTarget::check)?;
        self.fill.iter().try_for_each(Fill::check)?;
        check::distance("survey_sigma", self.survey_sigma)?;
        check::within("background", self.background, 0.0..=1.0)
    }

    fn strewn(&self, sheet: &Sheet, fill: &Fill, key: Key<'_>) -> Result<Vec<WallTarget>, FieldError> {
        let given = self.targets.iter().filter(|target| target.plate == sheet.id);
        let taken: Vec<_> = given.map(|target| (target.at, target.shape.reach(target.size))).collect();
        let places = fill.places(&sheet.id, sheet.corners(), &taken, key)?;
        let target = |(index, place): (usize, super::fill::Place)| WallTarget {
            id: format!("{}/{}", sheet.id, index + 1),
            plate: sheet.id.clone(),
            shape: place.shape,
            at: place.at,
            size: fill.size,
            turn: place.turn,
            surveyed: None,
        };
        Ok(places.into_iter().enumerate().map(target).collect())
    }
}

impl Sheet {
    fn check(&self) -> Result<(), FieldError> {
        check::length("width", self.size[0])?;
        check::length("height", self.size[1])?;
        let far = |parameter, vector: &Vector3<f64>| vector.iter().try_for_each(|&x| check::within(parameter, x, -1e9..=1e9));
        far("middle", &self.middle.coords)?;
        far("shift", &self.shift)?;
        check::bend(self.bend, self.size)?;
        check::levels(self.levels)
    }

    fn corners(&self) -> [PlatePoint; 2] {
        let [u, v] = self.size.map(|side| 0.5 * side);
        [[-u, -v], [u, v]]
    }

    /// The sheet where it is now, with nothing printed on it.
    fn plate(&self) -> Result<Plate, FieldError> {
        let axes = || {
            let (u, v) = (self.u.try_normalize(1e-9)?, self.v.try_normalize(1e-9)?);
            let upright = (v - u * u.dot(&v)).try_normalize(0.5)?;
            (u.dot(&v).abs() < 1e-6).then_some((u, upright))
        };
        let (u, v) = axes().ok_or_else(|| FieldError::Axes(self.id.clone()))?;
        let corners = self.corners();
        let bend = self.bend.map(|bend| bend.over(corners));
        let (id, level) = (self.id.clone(), self.levels.paper);
        Ok(Plate { id, origin: self.middle + self.shift, u, v, bend, corners, level, areas: Vec::new() })
    }
}

impl WallTarget {
    fn check(&self) -> Result<(), FieldError> {
        check::length("size", self.size)?;
        check::within("turn", self.turn, -7.0..=7.0)?;
        self.at.iter().try_for_each(|&x| check::within("at", x, -1e6..=1e6))?;
        let surveyed = self.surveyed.iter().flat_map(|point| point.iter());
        surveyed.copied().try_for_each(|x| check::within("surveyed", x, -1e9..=1e9))?;
        check::shape(self.shape)
    }
}

/// A standard normal number.
fn standard(rng: &mut impl Rng) -> f64 {
    StandardNormal.sample(rng)
}

fn unique<'a>(what: &'static str, ids: impl Iterator<Item = &'a str>) -> Result<(), FieldError> {
    let mut sorted: Vec<&str> = ids.collect();
    sorted.sort_unstable();
    match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(FieldError::Twice { what, id: pair[0].into() }),
        None => Ok(()),
    }
}

/// What is printed on a sheet.
fn printed(sheet: &Sheet, targets: &[&WallTarget]) -> Result<Vec<Area>, FieldError> {
    let outlined: Vec<(&str, Vec<Outline>)> =
        targets.iter().map(|target| (target.id.as_str(), target.shape.outlines(target.at, target.size, target.turn))).collect();
    sheet_layout::check(&sheet.id, sheet.corners(), &outlined)?;
    let area = |outline| Area { outline, level: sheet.levels.ink, ground: sheet.levels.paper };
    Ok(outlined.into_iter().flat_map(|(_, outlines)| outlines).map(area).collect())
}

#[cfg(test)]
mod tests;
