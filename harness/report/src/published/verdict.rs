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
    /// Within what the cell allows of a model that was fitted to other printed figures.
    Consistent,
    /// Further off than that.
    Inconsistent,
    /// Not the same thing, and why.
    NotComparable(String),
}

impl Verdict {
    /// In reports.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Reproduces => "reproduces",
            Self::Differs => "differs",
            Self::Consistent => "consistent",
            Self::Inconsistent => "inconsistent",
            Self::NotComparable(_) => "not comparable",
        }
    }

    /// Rank by gravity: a row of cells is as good as its gravest.
    pub fn gravity(&self) -> u8 {
        match self {
            Self::Reproduces | Self::Consistent => 0,
            Self::NotComparable(_) => 1,
            Self::Differs | Self::Inconsistent => 2,
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
    /// Cells that are consistent with a model that was fitted to others.
    pub consistent: usize,
    /// Cells that are not.
    pub inconsistent: usize,
    /// Cells that are not comparable.
    pub not_comparable: usize,
}

impl Tally {
    /// Counts one cell.
    pub fn count(&mut self, verdict: &Verdict) {
        match verdict {
            Verdict::Reproduces => self.reproduce += 1,
            Verdict::Differs => self.differ += 1,
            Verdict::Consistent => self.consistent += 1,
            Verdict::Inconsistent => self.inconsistent += 1,
            Verdict::NotComparable(_) => self.not_comparable += 1,
        }
    }

    /// All cells.
    pub fn cells(&self) -> usize {
        self.reproduce + self.differ + self.consistent + self.inconsistent + self.not_comparable
    }

    /// What became of the cells, as in "18 reproduce, 16 differ and 48 are not comparable"; consistent and inconsistent ones where there are any.
    pub fn words(&self) -> String {
        let Self { reproduce, differ, consistent, inconsistent, not_comparable } = self;
        let fitted = if consistent + inconsistent > 0 {
            format!(", {consistent} are consistent, {inconsistent} inconsistent")
        } else {
            String::new()
        };
        format!("{reproduce} reproduce, {differ} differ{fitted} and {not_comparable} are not comparable")
    }

    /// The closing line of a table.
    pub fn sentence(&self) -> String {
        format!("Of {} cells, {}.", self.cells(), self.words())
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.reproduce += other.reproduce;
        self.differ += other.differ;
        self.consistent += other.consistent;
        self.inconsistent += other.inconsistent;
        self.not_comparable += other.not_comparable;
    }
}

impl Cell {
    /// By how many units of the last digit ours may differ.
    fn units(&self) -> f64 {
        self.units.unwrap_or_else(|| self.metric.units())
    }

    /// Compares `ours` with this cell.
    pub fn verdict(&self, ours: Option<f64>) -> Verdict {
        if let Some(why) = &self.not_comparable {
            return Verdict::NotComparable(why.clone());
        }
        if let (Some(most), Some(ours)) = (self.at_most, ours) {
            return bounded(most, ours);
        }
        match (Printed::parse(&self.printed), ours) {
            (None, _) => Verdict::NotComparable("the printed figure cannot be read".into()),
            (_, None) => Verdict::NotComparable("no record of ours".into()),
            (Some(printed), Some(ours)) if let Some(within) = self.consistent_within => {
                if (ours - printed.value).abs() <= within {
                    Verdict::Consistent
                } else {
                    Verdict::Inconsistent
                }
            }
            // Rounding of the decimal text itself must not decide.
            (Some(printed), Some(ours)) if (ours - printed.value).abs() <= printed.unit * self.units() * (1.0 + 1e-6) => {
                Verdict::Reproduces
            }
            _ => Verdict::Differs,
        }
    }

    /// Compares a printed figure of a single run with where many lie: it reproduces from `low` to `high`, in the unit of the printed figure, widened by half a unit of its last digit.
    pub fn verdict_between(&self, low: f64, high: f64) -> Verdict {
        if let (Some(most), None) = (self.at_most, &self.not_comparable) {
            return bounded(most, low);
        }
        match (&self.not_comparable, Printed::parse(&self.printed)) {
            (Some(why), _) => Verdict::NotComparable(why.clone()),
            (None, None) => Verdict::NotComparable("the printed figure cannot be read".into()),
            (None, Some(printed)) if (low - 0.5 * printed.unit..=high + 0.5 * printed.unit).contains(&printed.value) => Verdict::Reproduces,
            _ => Verdict::Differs,
        }
    }
}

/// Of a printed bound.
fn bounded(most: f64, ours: f64) -> Verdict {
    if ours <= most { Verdict::Reproduces } else { Verdict::Differs }
}

#[cfg(test)]
mod tests {

    use super::super::Metric;
    use super::*;

    fn cell(printed: &str, metric: Metric) -> Cell {
        Cell::bare(printed, metric)
    }

    #[test]
    fn a_fraction_is_known_to_the_last_digit_of_its_denominator() {
        let found = Printed::parse("3/0.8").unwrap();
        assert!((found.value - 3.75).abs() < 1e-12 && (found.unit - (3.0 / 0.7 - 3.75)).abs() < 1e-12, "{found:?}");
        assert_eq!((Printed::parse("1/1"), Printed::parse("1/-2"), Printed::parse("1/0.1")), (None, None, None), "no denominator is left");
        assert_eq!(Printed::parse("0.05").unwrap().unit, 0.01);
    }

    /// A coordinate may be off by half a unit, what is computed by one; 0.3 less 0.2 is a little less than 0.1, 0.8 less 0.7 a little more.
    #[test]
    fn the_last_digit_decides_and_not_the_rounding_of_the_text() {
        for (metric, ours, expected) in [
            (Metric::MeanDx, 0.8, Verdict::Reproduces),
            (Metric::MeanDx, 0.6, Verdict::Reproduces),
            (Metric::MeanDx, 0.8001, Verdict::Differs),
            (Metric::MeanDx, 0.5999, Verdict::Differs),
            (Metric::X, 0.75, Verdict::Reproduces),
            (Metric::X, 0.7501, Verdict::Differs),
            (Metric::X, 0.6499, Verdict::Differs),
            (Metric::X, -0.7, Verdict::Differs),
        ] {
            assert_eq!(cell("0.7", metric).verdict(Some(ours)), expected, "{metric:?} {ours}");
        }
        let said = |verdict| matches!(verdict, Verdict::NotComparable(why) if why.contains("cannot be read"));
        assert!(said(cell("?", Metric::X).verdict(Some(1.0))) && said(cell("?", Metric::X).verdict_between(-8.0, 10.0)));
        assert_eq!(cell("0.7", Metric::X).verdict(None), Verdict::NotComparable("no record of ours".into()));
    }

    #[test]
    fn a_single_run_may_lie_anywhere_in_the_range_of_runs() {
        let within = |printed: &str, mean: f64, range: f64| cell(printed, Metric::MeanDx).verdict_between(mean - range, mean + range);
        assert_eq!(
            (within("2.0", 1.5, 0.5), within("2.0", 2.5, 0.5), within("2.0", 1.5, 0.25)),
            (Verdict::Reproduces, Verdict::Reproduces, Verdict::Differs)
        );
        // Half a unit of 0.1 more.
        assert_eq!(
            (within("2.0", 1.46, 0.5), within("2.0", 1.44, 0.5), within("2.0", 2.56, 0.5)),
            (Verdict::Reproduces, Verdict::Differs, Verdict::Differs)
        );
        assert_eq!(
            (within("-2.0", 2.0, 0.5), within("2", 2.5, 0.0), within("2", 2.6, 0.0)),
            (Verdict::Differs, Verdict::Reproduces, Verdict::Differs)
        );
        let told = Cell { not_comparable: Some("another axis".into()), ..cell("2.0", Metric::MeanDx) };
        assert_eq!(told.verdict_between(1.0, 3.0), Verdict::NotComparable("another axis".into()));
    }

    /// A model's prediction is consistent within what the cell allows, whatever the digits; a count is met or not.
    #[test]
    fn predictions_are_consistent_and_counts_are_met() {
        let predicted = |ours| Cell { consistent_within: Some(0.25), ..cell("1.5", Metric::Figure) }.verdict(Some(ours));
        assert_eq!(
            [1.25, 1.75, 1.8, 1.2].map(predicted),
            [Verdict::Consistent, Verdict::Consistent, Verdict::Inconsistent, Verdict::Inconsistent]
        );
        let counted = |ours| Cell { units: Some(0.5), ..cell("4", Metric::Figure) }.verdict(Some(ours));
        assert_eq!([4.0, 3.6, 5.0].map(counted), [Verdict::Reproduces, Verdict::Reproduces, Verdict::Differs]);
        assert_eq!(cell("4", Metric::Figure).verdict(Some(5.0)), Verdict::Reproduces, "computed from rounded figures");
        let mut tally = Tally::default();
        [1.5, 2.0, 2.0].into_iter().for_each(|ours| tally.count(&predicted(ours)));
        assert_eq!(tally.sentence(), "Of 3 cells, 0 reproduce, 0 differ, 1 are consistent, 2 inconsistent and 0 are not comparable.");
        assert_eq!((Verdict::Consistent.gravity(), Verdict::Inconsistent.gravity()), (0, 2));
    }

    /// A single run that keeps the printed bound is one of ours, or none of ours keeps it.
    #[test]
    fn a_bound_is_kept_by_some_runs() {
        let bound = || Cell { at_most: Some(0.1), ..cell("0.1 or better", Metric::Figure) };
        assert_eq!([0.05, 0.1, 0.101].map(|ours| bound().verdict(Some(ours)).word()), ["reproduces", "reproduces", "differs"]);
        assert_eq!([(0.02, 0.11), (0.11, 0.2)].map(|(low, high)| bound().verdict_between(low, high).word()), ["reproduces", "differs"]);
        let told = || Cell { not_comparable: Some("another line".into()), ..bound() };
        let why = Verdict::NotComparable("another line".into());
        assert_eq!((told().verdict(Some(0.05)), told().verdict_between(0.0, 0.2)), (why.clone(), why));
        assert!(matches!(bound().verdict(None), Verdict::NotComparable(_)));
    }

    #[test]
    fn cells_are_tallied_by_verdict() {
        let mut tally = Tally::default();
        let why = || Verdict::NotComparable(String::new());
        let verdicts = [Verdict::Reproduces, Verdict::Differs, why(), Verdict::Reproduces, why(), Verdict::Reproduces];
        verdicts.iter().for_each(|verdict| tally.count(verdict));
        assert_eq!((tally, tally.cells()), (Tally { reproduce: 3, differ: 1, not_comparable: 2, ..Tally::default() }, 6));
        tally += Tally { reproduce: 4, differ: 5, not_comparable: 7, ..Tally::default() };
        assert_eq!(tally.sentence(), "Of 22 cells, 7 reproduce, 6 differ and 9 are not comparable.");
        assert_eq!(
            verdicts.map(|verdict| (verdict.word(), verdict.gravity()))[..3],
            [("reproduces", 0), ("differs", 2), ("not comparable", 1)]
        );
    }
}
