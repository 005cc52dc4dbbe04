//! The colour filter in front of the photosites, as a grey target sees it.

use super::{SensorError, check};

/// A Bayer filter: each photosite sees one colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourFilter {
    /// Which photosite sees which colour.
    pub pattern: Pattern,
    /// Signal of a grey target behind the red, green and blue filter, in this order, relative to the light before the filter: numbers.
    pub sensitivity: [f64; 3],
}

/// The colours of the first two photosites of the first two rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// Red green, green blue.
    Rggb,
    /// Blue green, green red.
    Bggr,
    /// Green red, blue green.
    Grbg,
    /// Green blue, red green.
    Gbrg,
}

/// Index of red in a triple of colours.
pub(super) const RED: usize = 0;
/// Index of green.
pub(super) const GREEN: usize = 1;
/// Index of blue.
pub(super) const BLUE: usize = 2;

impl Pattern {
    /// The colours of row `y` at even and odd columns: 0 red, 1 green, 2 blue.
    pub fn row(self, y: usize) -> [usize; 2] {
        let rows = match self {
            Pattern::Rggb => [[RED, GREEN], [GREEN, BLUE]],
            Pattern::Bggr => [[BLUE, GREEN], [GREEN, RED]],
            Pattern::Grbg => [[GREEN, RED], [BLUE, GREEN]],
            Pattern::Gbrg => [[GREEN, BLUE], [RED, GREEN]],
        };
        rows[y % 2]
    }
}

impl ColourFilter {
    pub(super) fn check(&self) -> Result<(), SensorError> {
        self.sensitivity.iter().try_for_each(|&s| check("a colour's sensitivity", s, 1e-3, 10.0))
    }

    pub(super) fn apply(&self, row: &mut [f32], y: usize) {
        scale_colours(row, self.pattern.row(y), self.sensitivity);
    }
}

/// Multiplies each photosite of a row, whose even and odd columns have `colours`, by its colour's factor.
pub(super) fn scale_colours(row: &mut [f32], colours: [usize; 2], factors: [f64; 3]) {
    let factors = colours.map(|colour| factors[colour] as f32);
    for (x, grey) in row.iter_mut().enumerate() {
        *grey *= factors[x % 2];
    }
}
