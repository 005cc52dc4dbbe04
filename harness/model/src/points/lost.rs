//! Rows of a point file without a position.

use super::Names;

/// A row without a position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LostRow {
    /// The image's file name.
    pub image: String,
    /// The target's name.
    pub target: String,
    /// Its status as `measure` writes it: `rejected` or `unavailable`.
    pub status: String,
    /// Why, as `measure` says it.
    pub reason: String,
}

/// Rows without a position, in the order of the file; names and reasons are kept once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LostRows {
    images: Names,
    targets: Names,
    statuses: Names,
    reasons: Names,
    rows: Vec<[u32; 4]>,
}

impl LostRows {
    /// Adds a row: image, target, status, reason.
    pub fn push(&mut self, [image, target, status, reason]: [&str; 4]) {
        let places = [self.images.place(image), self.targets.place(target), self.statuses.place(status), self.reasons.place(reason)];
        self.rows.push(places.map(|place| place as u32));
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// None at all.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Image, target, status and reason of all rows.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = [&str; 4]> {
        let names = [&self.images, &self.targets, &self.statuses, &self.reasons];
        self.rows.iter().map(move |row| std::array::from_fn(|i| names[i].get(row[i] as usize)))
    }
}

impl FromIterator<LostRow> for LostRows {
    fn from_iter<I: IntoIterator<Item = LostRow>>(all: I) -> Self {
        let mut rows = Self::default();
        all.into_iter().for_each(|row| rows.push([&row.image, &row.target, &row.status, &row.reason]));
        rows
    }
}
