//! The principal point from all photographs, from halves of them, and with some left out.

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

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
    }

    fn without(x: &[f64], y: &[f64]) -> Principal {
        let without = x.iter().zip(y).map(|(x, y)| [(*x, 0.5), (*y, 0.25)]).collect();
        Principal { all: [(0.0, 1.0); 2], halves: Vec::new(), without }
    }

    /// x: mean 3, squares 4 + 1 + 9; y: mean 2, squares 4 + 1 + 1; both times 2/3.
    #[test]
    fn leaving_views_out_is_the_jackknife_of_efron() {
        let [x, y] = without(&[1.0, 2.0, 6.0], &[0.0, 3.0, 3.0]).jackknife().unwrap();
        close(x, (28.0_f64 / 3.0).sqrt());
        close(y, 2.0);
        assert_eq!(without(&[1.0, 2.0], &[0.0, 3.0]).jackknife(), None, "two are too few");
        assert!(without(&[1.0; 5], &[2.0; 5]).jackknife().unwrap().iter().all(|sigma| *sigma == 0.0));
    }

    /// Halves 3 and 1 apart in x, 1 and 5 in y: of one half sqrt((9/2 + 1/2) / 2) and sqrt((1/2 + 25/2) / 2).
    #[test]
    fn the_scatter_of_a_half_is_that_of_the_difference_by_the_root_of_two() {
        let halves = vec![[[(1.0, 3.0), (7.0, 1.0)], [(4.0, 4.0), (6.0, 1.0)]], [[(2.0, 1.0), (-2.0, 3.0)], [(1.0, 2.0), (3.0, 6.0)]]];
        let [x, y] = Principal { halves, ..without(&[], &[]) }.between_halves().unwrap();
        close(x.0, 2.5_f64.sqrt());
        close(x.1, 7.5_f64.sqrt());
        close(y.0, 6.5_f64.sqrt());
        close(y.1, 11.75_f64.sqrt());
        assert_eq!(without(&[], &[]).between_halves(), None);
    }

    #[test]
    fn points_are_gathered_by_the_set_of_views_they_come_from() {
        let row = |axis: usize, place: &str, value: f64, sigma: f64| Row::px(measure::PRINCIPAL[axis], place, value).beside(sigma);
        let places = ["all", "half 1a", "half 1b", "half 2a", "without v1", "without v2"];
        let mut rows: Vec<Row> = Vec::new();
        for (number, place) in (0..).zip(places) {
            let value = f64::from(number);
            rows.extend([row(0, place, value, 0.5 + value), row(1, place, -value, 10.0 + value)]);
        }
        rows.extend([row(0, "without v3", 9.0, 1.0), Row::px("other", "all", 5.0).beside(6.0)]);
        let principal = Principal::new(&rows.iter().collect::<Vec<_>>()).unwrap();
        let point = |number: f64| [(number, 0.5 + number), (-number, 10.0 + number)];
        assert_eq!(principal, Principal { all: point(0.0), halves: vec![[point(1.0), point(2.0)]], without: vec![point(4.0), point(5.0)] });
        assert_eq!(Principal::new(&rows.iter().skip(1).collect::<Vec<_>>()), None, "not of all views");
    }
}
