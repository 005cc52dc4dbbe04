//! The table of likelihoods of contours, learned from images of known fields.

use std::sync::OnceLock;

use crate::contour::Features;
use crate::found::SizeGroup;

/// Numbers of a feature that the table tells apart; more are counted as the last.
pub(crate) const COUNTS: usize = 24;
/// Features.
const FEATURES: usize = 3;
/// Their names in the file.
pub(crate) const NAMES: [&str; FEATURES] = ["sharp", "right", "concave"];
/// Added to every frequency: what was not seen is not impossible.
const UNSEEN: f64 = 0.5;

/// How often each number of each feature was counted: by size group, which of its two kinds, feature and number.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Table {
    frequencies: [[[[f64; COUNTS]; FEATURES]; 2]; 4],
}

impl Table {
    /// The table of the repository: `data/contours.csv`, made by the example `learn`.
    pub fn learned() -> &'static Self {
        static TABLE: OnceLock<Table> = OnceLock::new();
        TABLE.get_or_init(|| Self::parse(include_str!("../data/contours.csv")))
    }

    /// Lines of group, kind, feature, number and frequency; a line that is not so is not counted.
    fn parse(text: &str) -> Self {
        let mut table = Self { frequencies: [[[[0.0; COUNTS]; FEATURES]; 2]; 4] };
        for line in text.lines().skip(1) {
            let mut cells = line.split(',');
            let group = cells.next().and_then(|name| SizeGroup::ALL.into_iter().position(|group| group.name() == name));
            let kind =
                group.zip(cells.next()).and_then(|(group, name)| SizeGroup::ALL[group].kinds().iter().position(|kind| kind.name() == name));
            let feature = cells.next().and_then(|name| NAMES.iter().position(|known| *known == name));
            let number = cells.next().and_then(|cell| cell.parse::<usize>().ok()).filter(|number| *number < COUNTS);
            let frequency = cells.next().and_then(|cell| cell.parse::<f64>().ok());
            if let (Some(group), Some(kind), Some(feature), Some(number), Some(frequency)) = (group, kind, feature, number, frequency) {
                table.frequencies[group][kind][feature][number] = frequency;
            }
        }
        table
    }

    /// The logarithm of the likelihood of the first kind of the group less that of the second; features are taken as independent.
    pub fn gain(&self, group: SizeGroup, features: Features) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn likelihoods_are_products_of_frequencies() {
        let text = "size_group,kind,feature,number,frequency\nsmall squares and triangles,square,sharp,2,30\nsmall squares and triangles,triangle,sharp,2,10\n\
                    small squares and triangles,triangle,sharp,7,20\n";
        let table = Table::parse(text);
        let equal = table.gain(SizeGroup::SmallAngular, [2, 0, 0]);
        assert!((equal - ((30.5_f64 / 42.0) / (10.5 / 42.0)).ln()).abs() < 1e-12, "{equal}");
        assert!((table.gain(SizeGroup::SmallAngular, [7, 0, 0]) - (0.5_f64 / 20.5).ln()).abs() < 1e-12);
        assert!(table.gain(SizeGroup::LargeRound, [2, 0, 0]).abs() < 1e-12, "nothing known of it");
    }

    #[test]
    fn the_learned_table_knows_every_group_kind_and_feature() {
        for of_group in &Table::learned().frequencies {
            for features in of_group {
                let sums = features.map(|frequencies| frequencies.iter().sum::<f64>());
                assert!(sums[0] > 1000.0 && sums.iter().all(|sum| *sum == sums[0]), "{sums:?}");
            }
        }
    }
}
