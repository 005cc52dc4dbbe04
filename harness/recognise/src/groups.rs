//! Size groups of a square, and decisions within them.

use crate::blobs::Area;
use crate::design::IN_SQUARE;
use crate::found::SizeGroup;

/// The size group of each of sixteen areas: four by four by their size. `None` unless there are sixteen.
///
/// Source: Vosselman & Förstner 1988, table 3.
pub(crate) fn groups(areas: &[Area]) -> Option<[SizeGroup; IN_SQUARE]> {
    if areas.len() != IN_SQUARE {
        return None;
    }
    let mut order: Vec<usize> = (0..IN_SQUARE).collect();
    order.sort_by_key(|&index| (areas[index].size, index));
    let mut groups = [SizeGroup::SmallAngular; IN_SQUARE];
    for (rank, index) in order.into_iter().enumerate() {
        groups[index] = SizeGroup::ALL[rank / 4];
    }
    Some(groups)
}

/// Which two of four are of the first kind, the other two being of the second: the combination of the greatest likelihood, which is the product of those of
/// the single ones. `gains` are, for each, the logarithm of the likelihood of the first kind less that of the second.
///
/// Source: Vosselman & Förstner 1988, section 3.3.
pub(crate) fn joint(gains: [f64; 4]) -> [bool; 4] {
    const COMBINATIONS: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    let gain = |[i, j]: [usize; 2]| gains[i] + gains[j];
    let mut best = COMBINATIONS[0];
    for combination in COMBINATIONS {
        if gain(combination) > gain(best) {
            best = combination;
        }
    }
    [0, 1, 2, 3].map(|index| best.contains(&index))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_by_four_by_size() {
        let sizes = [50, 10, 30, 20, 51, 11, 31, 21, 52, 12, 32, 22, 53, 13, 33, 23];
        let area = |size: usize| Area { label: 1, size, centre: [0.0; 2], first: [0; 2] };
        let areas: Vec<Area> = sizes.into_iter().map(area).collect();
        let expected = [SizeGroup::LargeRound, SizeGroup::SmallAngular, SizeGroup::LargeAngular, SizeGroup::SmallRound];
        let found = groups(&areas).unwrap();
        assert!((0..16).all(|index| found[index] == expected[index % 4]));
        assert!(groups(&areas[..15]).is_none());
    }

    #[test]
    fn the_best_of_six_overrules_single_decisions() {
        assert_eq!(joint([1.0, 2.0, 3.0, -4.0]), [false, true, true, false]);
        assert_eq!(joint([-1.0, -2.0, -3.0, -4.0]), [true, true, false, false]);
        assert_eq!(joint([-5.0, 0.1, -5.0, 7.0]), [false, true, false, true]);
    }
}
