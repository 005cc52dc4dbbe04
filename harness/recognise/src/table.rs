//! The table of likelihoods of contours, learned from images of known fields.

use std::fmt::Write as _;

use calibench_model::TargetKind;
use thiserror::Error;

use crate::found::SizeGroup;

/// Numbers of a feature that the table tells apart; more are counted as the last.
const COUNTS: usize = 24;
/// The features, as the file calls them.
const FEATURES: [&str; 4] = ["blunt", "right", "sharp", "concave"];
/// Added to every frequency: what was not seen is not impossible.
const UNSEEN: f64 = 0.5;
const HEADER: &str = "size_group,kind,feature,number,frequency";

/// How often each number of each feature of contours was counted: by size group, kind, feature and number.
///
/// Source: Vosselman & Förstner 1988, section 3.3, whose table "has been made manually after examining a few test images".
#[derive(Clone, Debug, PartialEq)]
pub struct ContourTable {
    frequencies: [[[[f64; COUNTS]; FEATURES.len()]; 2]; 4],
}

/// A line that is none of a table.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("line {line}: expected {HEADER}, found `{text}`")]
pub struct TableError {
    /// Counted from 1.
    pub line: usize,
    /// What stands there.
    pub text: String,
}

impl Default for ContourTable {
    /// Nothing is known: all likelihoods are equal.
    fn default() -> Self {
        Self { frequencies: [[[[0.0; COUNTS]; FEATURES.len()]; 2]; 4] }
    }
}

impl ContourTable {
    /// The table of the repository, `data/contours.csv`, made by the example `learn_contours`.
    ///
    /// # Panics
    /// Never: the tests read it.
    pub fn learned() -> Self {
        Self::parse(include_str!("../data/contours.csv")).expect("the table of the repository")
    }

    /// The table of three sharp frontal images, `data/contours-few.csv`, made by the same example: what a table from "a few test images" may be like.
    ///
    /// # Panics
    /// Never: the tests read it.
    pub fn learned_on_few() -> Self {
        Self::parse(include_str!("../data/contours-few.csv")).expect("the table of the repository")
    }

    /// From lines of size group, kind, feature, number and frequency under a header.
    ///
    /// # Errors
    /// The first line that is not so.
    pub fn parse(text: &str) -> Result<Self, TableError> {
        let mut table = Self::default();
        for (index, line) in text.lines().enumerate() {
            let wrong = || TableError { line: index + 1, text: line.to_owned() };
            if index == 0 {
                (line == HEADER).then_some(()).ok_or_else(wrong)?;
                continue;
            }
            let (place, frequency) = entry(line).ok_or_else(wrong)?;
            let [group, kind, feature, number] = place;
            table.frequencies[group][kind][feature][number] = frequency;
        }
        Ok(table)
    }

    /// Counts a contour of a target of this kind; one that is not of the size group is not counted.
    pub fn count(&mut self, group: SizeGroup, kind: TargetKind, features: [usize; 4]) {
        let Some(kind) = group.kinds().iter().position(|known| *known == kind) else { return };
        for (feature, number) in features.into_iter().enumerate() {
            self.frequencies[group as usize][kind][feature][number.min(COUNTS - 1)] += 1.0;
        }
    }

    /// As a file, to be read again.
    pub fn to_csv(&self) -> String {
        let mut text = format!("{HEADER}\n");
        for (group, kinds) in SizeGroup::ALL.into_iter().zip(&self.frequencies) {
            for (kind, features) in group.kinds().into_iter().zip(kinds) {
                for (feature, frequencies) in FEATURES.into_iter().zip(features) {
                    for (number, frequency) in frequencies.iter().enumerate().filter(|(_, frequency)| **frequency > 0.0) {
                        let _ = writeln!(text, "{},{kind},{feature},{number},{frequency}", group.name());
                    }
                }
            }
        }
        text
    }

    /// The logarithm of the likelihood of the first kind of the group less that of the second; features are taken as independent.
    pub(crate) fn gain(&self, group: SizeGroup, features: [usize; 4]) -> f64 {
        let of = |kind: usize| -> f64 {
            let of_feature = |(feature, &count): (usize, &usize)| {
                let frequencies = &self.frequencies[group as usize][kind][feature];
                let all: f64 = frequencies.iter().sum();
                ((frequencies[count.min(COUNTS - 1)] + UNSEEN) / (all + UNSEEN * COUNTS as f64)).ln()
            };
            features.iter().enumerate().map(of_feature).sum()
        };
        of(0) - of(1)
    }
}

fn entry(line: &str) -> Option<([usize; 4], f64)> {
    let mut cells = line.split(',');
    let mut next = || cells.next();
    let name = next()?;
    let group = SizeGroup::ALL.into_iter().position(|group| group.name() == name)?;
    let name = next()?;
    let kind = SizeGroup::ALL[group].kinds().iter().position(|kind| kind.name() == name)?;
    let name = next()?;
    let feature = FEATURES.iter().position(|known| *known == name)?;
    let number = next()?.parse().ok().filter(|number| *number < COUNTS)?;
    let frequency = next()?.parse().ok().filter(|frequency: &f64| frequency.is_finite() && *frequency >= 0.0)?;
    Some(([group, kind, feature, number], frequency))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn likelihoods_are_products_of_frequencies() {
        let text = format!(
            "{HEADER}\nsmall squares and triangles,square,sharp,2,30\nsmall squares and triangles,triangle,sharp,2,10\n\
             small squares and triangles,triangle,sharp,7,20\n"
        );
        let table = ContourTable::parse(&text).unwrap();
        let gain = table.gain(SizeGroup::SmallAngular, [0, 0, 2, 0]);
        assert!((gain - ((30.5_f64 / 42.0) / (10.5 / 42.0)).ln()).abs() < 1e-12, "{gain}");
        assert!((table.gain(SizeGroup::SmallAngular, [0, 0, 7, 0]) - ((0.5 / 42.0) / (20.5_f64 / 42.0)).ln()).abs() < 1e-12);
        assert!(table.gain(SizeGroup::LargeRound, [0, 0, 2, 0]).abs() < 1e-12, "nothing known of it");
    }

    #[test]
    fn what_was_counted_is_read_again_and_wrong_lines_are_named() {
        let mut table = ContourTable::default();
        table.count(SizeGroup::LargeRound, TargetKind::Cross, [0, 2, 1, 99]);
        table.count(SizeGroup::LargeRound, TargetKind::Cross, [0, 0, 1, 0]);
        table.count(SizeGroup::LargeRound, TargetKind::Square, [0, 0, 1, 0]);
        let text = table.to_csv();
        assert!(
            text.contains("large crosses and discs,cross,sharp,1,2\n") && text.contains("cross,concave,23,1\n") && !text.contains("square")
        );
        assert_eq!(ContourTable::parse(&text), Ok(table));
        let error = ContourTable::parse(&text.replace("concave,23", "concave,24")).unwrap_err();
        assert_eq!(error.text, "large crosses and discs,cross,concave,24,1");
        assert_eq!(ContourTable::parse("a,b\n").unwrap_err().line, 1);
    }

    #[test]
    fn the_learned_table_knows_every_group_kind_and_feature() {
        for of_group in &ContourTable::learned().frequencies {
            for features in of_group {
                let sums = features.map(|frequencies| frequencies.iter().sum::<f64>());
                assert!(sums[0] > 1000.0 && sums.iter().all(|sum| *sum == sums[0]), "{sums:?}");
            }
        }
    }
}
