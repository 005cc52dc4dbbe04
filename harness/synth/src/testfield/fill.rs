//! Targets strewn over a sheet: on a grid, or at random with a minimal distance.

use std::collections::HashMap;
use std::f64::consts::TAU;

use calibench_model::testfield::PlatePoint;
use calibench_random::{Key, Purpose, stream};
use rand::{Rng, RngExt};

use super::{FieldError, Shape, check};

/// Darts thrown for each target before a sheet counts as full.
const DARTS: usize = 1000;

/// Where the targets of a sheet are put.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Arrangement {
    /// In the middles of equal cells.
    Grid {
        /// Rows, from the top.
        rows: usize,
        /// Columns, from the left.
        columns: usize,
    },
    /// At random, none nearer to another than a distance.
    Random {
        /// The number of targets.
        count: usize,
        /// The least distance of two reference points, object units.
        distance: f64,
    },
}

/// How targets are turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// All by this angle, radians.
    Fixed(f64),
    /// Each by any angle.
    Random,
}

impl Fill {
    /// Whether places or turns are drawn by chance.
    pub fn is_random(&self) -> bool {
        matches!(self.arrangement, Arrangement::Random { .. }) || self.turn == Turn::Random
    }
}

/// The targets of every sheet of a wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Fill {
    /// The shapes, taken in turn.
    pub shapes: Vec<Shape>,
    /// The size of all, object units.
    pub size: f64,
    /// Where they are put.
    pub arrangement: Arrangement,
    /// How they are turned.
    pub turn: Turn,
}

/// A place for a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub shape: Shape,
    /// Reference point on the plate, object units.
    pub at: PlatePoint,
    /// Counter-clockwise, rad.
    pub turn: f64,
}

impl Fill {
    /// Checks what does not depend on a sheet.
    pub(super) fn check(&self) -> Result<(), FieldError> {
        check::length("size", self.size)?;
        if self.shapes.is_empty() {
            return Err(FieldError::Nothing("shapes"));
        }
        self.shapes.iter().try_for_each(|shape| check::shape(*shape))?;
        if let Turn::Fixed(turn) = self.turn {
            check::within("turn", turn, -7.0..=7.0)?;
        }
        match self.arrangement {
            Arrangement::Grid { rows, columns } => {
                check::counted("rows", rows, 1..=1000)?;
                check::counted("columns", columns, 1..=1000)
            }
            Arrangement::Random { count, distance } => {
                check::counted("count", count, 1..=1_000_000)?;
                check::length("distance", distance)
            }
        }
    }

    /// The places on sheet `plate` between its `corners`, clear of the `taken` circles (centre, radius).
    pub(super) fn places(
        &self,
        plate: &str,
        corners: [PlatePoint; 2],
        taken: &[(PlatePoint, f64)],
        key: Key<'_>,
    ) -> Result<Vec<Place>, FieldError> {
        let mut rng = stream(Key { target: plate, ..key }, Purpose::Layout);
        match self.arrangement {
            Arrangement::Grid { rows, columns } => Ok(self.grid(corners, [rows, columns], &mut rng)),
            Arrangement::Random { count, distance } => {
                let places = self.random(corners, taken, [count as f64, distance], &mut rng);
                let crowded = FieldError::Crowded { placed: places.len(), wanted: count, plate: plate.into() };
                if places.len() == count { Ok(places) } else { Err(crowded) }
            }
        }
    }

    fn shape(&self, index: usize) -> Shape {
        self.shapes[index % self.shapes.len()]
    }

    fn turned(&self, rng: &mut impl Rng) -> f64 {
        match self.turn {
            Turn::Fixed(turn) => turn,
            Turn::Random => rng.random::<f64>() * TAU,
        }
    }

    fn grid(&self, [[u0, v0], [u1, v1]]: [PlatePoint; 2], [rows, columns]: [usize; 2], rng: &mut impl Rng) -> Vec<Place> {
        let middle = |index: usize, count: usize| (index as f64 + 0.5) / count as f64;
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let place = |(index, (row, column))| {
            let at = [u0 + (u1 - u0) * middle(column, columns), v1 - (v1 - v0) * middle(row, rows)];
            Place { shape: self.shape(index), at, turn: self.turned(rng) }
        };
        cells.enumerate().map(place).collect()
    }

    /// Throws darts; those that hit are looked up in cells as wide as the distance.
    fn random(
        &self,
        [low, high]: [PlatePoint; 2],
        taken: &[(PlatePoint, f64)],
        [count, distance]: [f64; 2],
        rng: &mut impl Rng,
    ) -> Vec<Place> {
        let cell = |at: PlatePoint| at.map(|x| (x / distance).floor() as i64);
        let mut cells: HashMap<[i64; 2], Vec<PlatePoint>> = HashMap::new();
        let mut places = Vec::new();
        'targets: while (places.len() as f64) < count {
            let shape = self.shape(places.len());
            let reach = shape.reach(self.size);
            for _ in 0..DARTS {
                let dart = [0, 1].map(|i| low[i] + reach + rng.random::<f64>() * (high[i] - low[i] - 2.0 * reach));
                let apart = |other: &PlatePoint, least: f64| (dart[0] - other[0]).hypot(dart[1] - other[1]) >= least;
                let [i, j] = cell(dart);
                let mut neighbours =
                    (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj])).filter_map(|at| cells.get(&at)).flatten();
                if neighbours.all(|other| apart(other, distance)) && taken.iter().all(|(at, radius)| apart(at, radius + reach)) {
                    cells.entry([i, j]).or_default().push(dart);
                    places.push(Place { shape, at: dart, turn: self.turned(rng) });
                    continue 'targets;
                }
            }
            break;
        }
        places
    }
}
