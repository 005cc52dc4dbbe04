//! What finders of boards make of the images of a trial, counted against the truth.
//!
//! A point of the board is right within [`LOST`] px of its true place. Beyond that it was taken for another one, if the true place of one is as near, or it lies somewhere.

use std::collections::{BTreeMap, HashMap};

use calibench_measure::finder::Named;
use calibench_model::{PixelPoint, Rejection};
use calibench_records::figures::Quantity;
use calibench_records::results::{Calibrated, Figure, LOST};

/// How many of what.
type Counts = BTreeMap<Quantity, u64>;

/// What is counted of an image in which a board was found; none of it where none was.
const COUNTED: [Quantity; 6] = [
    Quantity::BoardGrids,
    Quantity::BoardLabels,
    Quantity::BoardLabelled,
    Quantity::BoardNotExpected,
    Quantity::BoardWrongLabels,
    Quantity::BoardOff,
];

/// Counts by method.
#[derive(Clone, Debug, Default)]
pub struct Tally(BTreeMap<usize, Counts>);

/// Where the points of a board truly are in an image.
pub struct TruePlaces<'a> {
    /// By name, px, and whether it is in view and so expected: what lies at the border may be found or not.
    pub all: HashMap<&'a str, (PixelPoint, bool)>,
}

impl TruePlaces<'_> {
    fn expected(&self) -> usize {
        self.all.values().filter(|(_, expected)| *expected).count()
    }

    /// What a found point is called in the records.
    fn judged(&self, name: &str, at: PixelPoint) -> Quantity {
        let near = |place: &PixelPoint| place.distance(at) <= LOST;
        match self.all.get(name).filter(|(place, _)| near(place)) {
            Some((_, true)) => Quantity::BoardLabelled,
            Some((_, false)) => Quantity::BoardNotExpected,
            None if self.all.values().any(|(place, _)| near(place)) => Quantity::BoardWrongLabels,
            None => Quantity::BoardOff,
        }
    }
}

impl Tally {
    /// Adds what `method` found in an image.
    pub fn image(&mut self, method: usize, found: &Result<Named<'_>, Rejection>, truth: &TruePlaces<'_>) {
        let counts = self.0.entry(method).or_default();
        let mut add = |what: Quantity, count: usize| *counts.entry(what).or_default() += count as u64;
        add(Quantity::BoardImages, 1);
        add(Quantity::BoardTargets, truth.expected());
        COUNTED.into_iter().for_each(|what| add(what, 0));
        let Some(found) = found.as_ref().ok().filter(|found| !found.is_empty()) else { return };
        add(Quantity::BoardGrids, 1);
        add(Quantity::BoardLabels, found.len());
        found.iter().for_each(|(name, at)| add(truth.judged(name, *at), 1));
    }

    /// Adds what another one counted.
    pub fn join(&mut self, other: Self) {
        for (method, counts) in other.0 {
            let all = self.0.entry(method).or_default();
            counts.into_iter().for_each(|(what, count)| *all.entry(what).or_default() += count);
        }
    }

    /// The figures of a trial, by method, under the set of place `set`.
    pub fn calibrated(self, set: usize) -> Vec<Calibrated> {
        let figure = |(quantity, count): (Quantity, u64)| Figure::plain(quantity, count as f64, "");
        let of = |(method, counts): (usize, Counts)| Calibrated {
            method,
            set,
            outcome: Ok(counts.into_iter().map(figure).collect()),
            check_failed: None,
        };
        self.0.into_iter().map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn at(x: f64) -> PixelPoint {
        PixelPoint { x, y: 20.0 }
    }

    fn counted(found: &Result<Named<'_>, Rejection>) -> impl Fn(&str) -> Option<f64> + use<> {
        let all = [("a", 10.0, true), ("b", 30.0, true), ("c", 50.0, true), ("rim", 70.0, false)];
        let truth = TruePlaces { all: all.map(|(name, x, expected)| (name, (at(x), expected))).into() };
        let mut tally = Tally::default();
        tally.image(2, found, &truth);
        let mut all = tally.calibrated(4);
        let one = all.pop().unwrap();
        assert_eq!((all.len(), one.method, one.set), (0, 2, 4));
        let figures = one.outcome.unwrap();
        move |what| figures.iter().find(|figure| figure.name.text() == format!("board/{what}/all")).map(|figure| figure.value)
    }

    #[test]
    fn counts_of_images_are_summed_by_method() {
        let truth = TruePlaces { all: [("a", (at(10.0), true))].into() };
        let images = [(2, Ok(vec![("a", at(10.0))])), (5, Err(Rejection::NotDetected)), (2, Ok(vec![("a", at(90.0)), ("b", at(10.0))]))];
        let (mut together, mut joined) = (Tally::default(), Tally::default());
        for (method, found) in &images {
            together.image(*method, found, &truth);
            let mut one = Tally::default();
            one.image(*method, found, &truth);
            joined.join(one);
        }
        assert_eq!(joined.0, together.0);
        let count = |method: usize, quantity| joined.0[&method][&quantity];
        assert_eq!([count(2, Quantity::BoardImages), count(2, Quantity::BoardOff), count(5, Quantity::BoardImages)], [2, 1, 1]);
    }

    #[test]
    fn every_point_is_right_taken_for_another_or_somewhere() {
        let found = counted(&Ok(vec![("a", at(10.6)), ("b", at(50.2)), ("c", at(41.0)), ("rim", at(70.0))]));
        for (what, count) in [
            ("images", 1.0),
            ("grids", 1.0),
            ("targets", 3.0),
            ("labels", 4.0),
            ("labelled", 1.0),
            ("not expected", 1.0),
            ("wrong labels", 1.0),
            ("off", 1.0),
        ] {
            assert_eq!(found(what), Some(count), "{what}");
        }
    }

    #[test]
    fn a_name_that_the_board_does_not_have_in_view_is_no_right_one() {
        let found = counted(&Ok(vec![("z", at(10.0)), ("y", at(90.0))]));
        assert_eq!([found("wrong labels"), found("off"), found("labelled")], [Some(1.0), Some(1.0), Some(0.0)]);
    }

    #[test]
    fn nothing_found_is_everything_missed() {
        for nothing in [Err(Rejection::NotDetected), Ok(Vec::new())] {
            let found = counted(&nothing);
            assert_eq!(
                [found("images"), found("grids"), found("targets"), found("labelled")],
                [Some(1.0), Some(0.0), Some(3.0), Some(0.0)]
            );
        }
    }
}
