//! Digests, counts and moments as rows of a baseline.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::baseline_file::{BaselineError, Kind, Row};
use super::cells::Kept;
use super::finding::{Finding, Verdict};
use super::moments::{PointSums, Sum, digest};
use super::point_entry::{Entry, Place};
use super::sums_judged::judged;
use super::table::MethodTable;

impl PointSums {
    fn of_points(points: &BTreeMap<Place, Entry>) -> Self {
        let mut by_target: BTreeMap<Arc<str>, Vec<&Entry>> = BTreeMap::new();
        for (place, entry) in points {
            by_target.entry(place.target.clone()).or_default().push(entry);
        }
        let targets = by_target.into_iter().map(|(target, entries)| (target, Sum::of(&entries))).collect();
        Self { digest: digest(points), targets }
    }
}

impl Kept for PointSums {
    const KIND: Kind = Kind::Sums;
    const COLUMNS: &'static [&'static str] =
        &["target", "digest", "measured", "lost", "rejected", "mean_x", "mean_y", "cov_xx", "cov_xy", "cov_yy", "sigma", "nan"];

    fn of(method: &MethodTable) -> Self {
        Self::of_points(&method.points)
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let mut rows = vec![vec![String::new(); Self::COLUMNS.len()]];
        rows[0][1].clone_from(&self.digest);
        for (target, sum) in &self.targets {
            let mut row = vec![target.to_string(), String::new()];
            row.extend(sum.counts.map(|count| count.to_string()));
            if sum.counts[0] > 0 {
                row.extend(sum.mean.map(|mean| format!("{mean:.8}")));
                row.extend(sum.covariance.map(|value| format!("{value:.6e}")));
            }
            row.resize(Self::COLUMNS.len() - 2, String::new());
            row.push(sum.sigma.map_or_else(String::new, |sigma| format!("{sigma:.7}")));
            row.push(if sum.nans > 0 { sum.nans.to_string() } else { String::new() });
            rows.push(row);
        }
        rows
    }

    fn add(&mut self, row: &Row<'_>) -> Result<(), BaselineError> {
        if row.text(2).is_empty() {
            row.text(3).clone_into(&mut self.digest);
            return Ok(());
        }
        let counts = [row.parse(4)?, row.parse(5)?, row.parse(6)?];
        let mut sum = Sum { counts, sigma: row.optional(12)?, nans: row.optional(13)?.unwrap_or(0), ..Sum::default() };
        if counts[0] > 0 {
            sum.mean = [row.parse(7)?, row.parse(8)?];
            sum.covariance = [row.parse(9)?, row.parse(10)?, row.parse(11)?];
        }
        let twice = self.targets.insert(row.text(2).into(), sum);
        if twice.is_some() { Err(row.wrong(2, "the target is there twice")) } else { Ok(()) }
    }

    fn compare(&self, now: &Self, finding: &dyn Fn(Verdict, &'static str, String) -> Finding) -> Vec<Finding> {
        judged(self, now, finding)
    }

    fn count(&self) -> usize {
        self.targets.values().map(|sum| sum.points() as usize).sum()
    }
}

/// The image points behind the adjustments of a method in a cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImageSums(PointSums);

impl Kept for ImageSums {
    const KIND: Kind = Kind::Images;
    const COLUMNS: &'static [&'static str] = PointSums::COLUMNS;

    fn of(method: &MethodTable) -> Self {
        Self(PointSums::of_points(&method.images))
    }

    fn rows(&self) -> Vec<Vec<String>> {
        // Of a method without such points, as one that is adjusted alone, there is nothing to keep.
        if self.count() == 0 { Vec::new() } else { self.0.rows() }
    }

    fn add(&mut self, row: &Row<'_>) -> Result<(), BaselineError> {
        self.0.add(row)
    }

    fn compare(&self, now: &Self, finding: &dyn Fn(Verdict, &'static str, String) -> Finding) -> Vec<Finding> {
        self.0.compare(&now.0, finding)
    }

    fn count(&self) -> usize {
        self.0.count()
    }
}
