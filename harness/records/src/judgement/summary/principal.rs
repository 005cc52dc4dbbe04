//! Does the principal point come out the same again?

use std::sync::Arc;

use super::super::{Row, measure};

/// A principal point and its standard deviations, px: x, y from the centre of the first pixel, y down.
pub type Point = [(f64, f64); 2];

/// The principal point from all views and from parts of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Principal {
    /// From all views.
    pub all: Point,
    /// From both halves of each split.
    pub halves: Vec<[Point; 2]>,
    /// From all views but some.
    pub without: Vec<Point>,
}

impl Principal {
    pub(super) fn new(rows: &[&Row]) -> Option<Self> {
        let axis = |axis: usize, place: &str| {
            let mut of = rows.iter().filter(|row| &*row.measure == measure::PRINCIPAL[axis] && &*row.place == place);
            of.find_map(|row| Some((row.value?, row.sigma?)))
        };
        let point = |place: &str| Some([axis(0, place)?, axis(1, place)?]);
        let places: Vec<&Arc<str>> = rows.iter().filter(|row| &*row.measure == measure::PRINCIPAL[0]).map(|row| &row.place).collect();
        let half = |place: &&Arc<str>| {
            let number = place.strip_prefix("half ")?.strip_suffix('a')?;
            Some([point(place)?, point(&format!("half {number}b"))?])
        };
        let halves = places.iter().filter_map(half).collect();
        let without = places.iter().filter(|place| place.starts_with("without ")).filter_map(|place| point(place)).collect();
        Some(Self { all: point("all")?, halves, without })
    }

    /// The standard deviation of all views' point that leaving views out shows (the jackknife): x, y, px. It holds as well where errors of one view
    /// depend on each other. `None` of fewer than three.
    ///
    /// Source: Efron 1982, The jackknife, the bootstrap and other resampling plans, Eq. 3.1.
    pub fn jackknife(&self) -> Option<[f64; 2]> {
        let n = self.without.len() as f64;
        let of = |axis: usize| {
            let mean = self.without.iter().map(|point| point[axis].0).sum::<f64>() / n;
            ((n - 1.0) / n * self.without.iter().map(|point| (point[axis].0 - mean).powi(2)).sum::<f64>()).sqrt()
        };
        (self.without.len() > 2).then(|| [of(0), of(1)])
    }

    /// The standard deviation of a half's point that the pairs of halves show, and the predicted one: x, y, px. `None` without halves.
    pub fn between_halves(&self) -> Option<[(f64, f64); 2]> {
        let n = self.halves.len() as f64;
        let of = |axis: usize| {
            let found = self.halves.iter().map(|[a, b]| (a[axis].0 - b[axis].0).powi(2) / 2.0).sum::<f64>() / n;
            let predicted = self.halves.iter().map(|[a, b]| (a[axis].1.powi(2) + b[axis].1.powi(2)) / 2.0).sum::<f64>() / n;
            (found.sqrt(), predicted.sqrt())
        };
        (!self.halves.is_empty()).then(|| [of(0), of(1)])
    }
}
