//! Errors in place of true positions, for who reads a table by eye.

use std::borrow::Cow;

use csv::StringRecord;

use crate::digits::{coordinate, difference};

/// Pairs of columns: measured, true, and the name of their difference.
const PAIRS: [[&str; 3]; 2] = [["x", "x_true", "dx"], ["y", "y_true", "dy"]];

/// Where a table of points has measured and true coordinates; nothing of another table.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Errors([Option<(usize, usize)>; 2]);

impl Errors {
    pub(crate) fn of(header: &StringRecord) -> Self {
        let place = |name: &str| header.iter().position(|column| column == name);
        Self(PAIRS.map(|[measured, truth, _]| place(measured).zip(place(truth))))
    }

    /// The header with `dx` and `dy` in place of `x_true` and `y_true`.
    pub(crate) fn header(self, header: &StringRecord) -> StringRecord {
        let name = |(place, column): (usize, _)| self.pair(place).map_or(column, |(pair, _)| PAIRS[pair][2]);
        header.iter().enumerate().map(name).collect()
    }

    /// A row with the errors, px, in place of the true position; as it is where it holds no such numbers.
    pub(crate) fn cells(self, record: &StringRecord) -> impl Iterator<Item = Cow<'_, str>> {
        record.iter().enumerate().map(move |(place, cell)| {
            let number = |place: usize| record.get(place)?.parse::<f64>().ok();
            let error = self.pair(place).and_then(|(_, measured)| Some(difference(number(measured)?, number(place)?)));
            error.map_or(Cow::Borrowed(cell), |error| Cow::Owned(coordinate(error)))
        })
    }

    /// The pair whose true coordinate stands at `place`, and where its measured one does.
    fn pair(self, place: usize) -> Option<(usize, usize)> {
        self.0
            .iter()
            .enumerate()
            .find_map(|(pair, places)| places.filter(|(_, truth)| *truth == place).map(|(measured, _)| (pair, measured)))
    }
}
