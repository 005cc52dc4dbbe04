//! How ours compares with what was printed.

use std::ops::AddAssign;

use super::Cell;

/// A printed number: its value and one unit of its last digit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printed {
    /// Its value.
    pub value: f64,
    /// One unit of the last digit.
    pub unit: f64,
}

impl Printed {
    /// Reads `22.520` or a fraction `1/18.9`; `None` for anything else.
    pub fn parse(text: &str) -> Option<Self> {
        let decimal = |text: &str| {
            let value: f64 = text.parse().ok().filter(|v: &f64| v.is_finite())?;
            let digits = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
            Some((value, 10_f64.powi(-(digits as i32))))
        };
        match text.split_once('/') {
            None => decimal(text).map(|(value, unit)| Self { value, unit }),
            Some((one, below)) => {
                let ((numerator, _), (denominator, unit)) = (decimal(one)?, decimal(below)?);
                let value = numerator / denominator;
                (denominator > unit).then(|| Self { value, unit: (numerator / (denominator - unit) - value).abs() })
            }
        }
    }
}

/// How ours compares with a printed cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within half a unit of the last printed digit for a coordinate, within one for what is computed from rounded figures.
    Reproduces,
    /// Further off.
    Differs,
    /// Not the same thing, and why.
    NotComparable(String),
}

impl Verdict {
    /// In reports.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Reproduces => "reproduces",
            Self::Differs => "differs",
            Self::NotComparable(_) => "not comparable",
        }
    }

    /// Rank by gravity: a row of cells is as good as its gravest.
    pub fn gravity(&self) -> u8 {
        match self {
            Self::Reproduces => 0,
            Self::NotComparable(_) => 1,
            Self::Differs => 2,
        }
    }
}

/// How many cells have which verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Cells that reproduce.
    pub reproduce: usize,
    /// Cells that differ.
    pub differ: usize,
    /// Cells that are not comparable.
    pub not_comparable: usize,
}

impl Tally {
    /// Counts one cell.
    pub fn count(&mut self, verdict: &Verdict) {
        match verdict {
            Verdict::Reproduces => self.reproduce += 1,
            Verdict::Differs => self.differ += 1,
            Verdict::NotComparable(_) => self.not_comparable += 1,
        }
    }

    /// All cells.
    pub fn cells(&self) -> usize {
        self.reproduce + self.differ + self.not_comparable
    }

    /// The closing line of a table.
    pub fn sentence(&self) -> String {
        let Self { reproduce, differ, not_comparable } = self;
        format!("Of {} cells, {reproduce} reproduce, {differ} differ and {not_comparable} are not comparable.", self.cells())
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.reproduce += other.reproduce;
        self.differ += other.differ;
        self.not_comparable += other.not_comparable;
    }
}

impl Cell {
    /// Compares `ours` with this cell.
    pub fn verdict(&self, ours: Option<f64>) -> Verdict {
        if let Some(why) = &self.not_comparable {
            return Verdict::NotComparable(why.clone());
        }
        match (Printed::parse(&self.printed), ours) {
            (None, _) => Verdict::NotComparable("the printed figure cannot be read".into()),
            (_, None) => Verdict::NotComparable("no record of ours".into()),
            // Rounding of the decimal text itself must not decide.
            (Some(printed), Some(ours)) if (ours - printed.value).abs() <= printed.unit * self.metric.units() * (1.0 + 1e-6) => {
                Verdict::Reproduces
            }
            _ => Verdict::Differs,
        }
    }

    /// Compares a printed figure of a single run with the mean of many: it reproduces within `range` of `mean`, widened by half a unit of its last digit.
    pub fn verdict_within(&self, mean: f64, range: f64) -> Verdict {
        match (&self.not_comparable, Printed::parse(&self.printed)) {
            (Some(why), _) => Verdict::NotComparable(why.clone()),
            (None, None) => Verdict::NotComparable("the printed figure cannot be read".into()),
            (None, Some(printed)) if (mean - printed.value).abs() <= range + 0.5 * printed.unit => Verdict::Reproduces,
            _ => Verdict::Differs,
        }
    }
}
