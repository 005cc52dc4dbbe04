//! A square of the grid: what lies in it, and what the classifier takes it for.

use calibench_model::TargetKind;
use calibench_model::coded::code;

use crate::bank::{Bank, KINDS};
use crate::blobs::Areas;
use crate::contour::{Features, features};
use crate::design::IN_SQUARE;
use crate::found::SizeGroup;
use crate::groups::{groups, joint};
use crate::normal::{Normal, SIDE, to_square};
use crate::recogniser::Classifier;
use crate::table::ContourTable;

/// A square and its dark areas.
#[derive(Clone, Debug)]
pub(crate) struct Square {
    /// Column and row on the grid.
    pub at: [i64; 2],
    pub normal: Normal,
    pub areas: Areas,
    /// What is known of the areas, if there are sixteen.
    pub decisions: Option<Decisions>,
}

/// The decisions about sixteen areas.
#[derive(Clone, Debug)]
pub(crate) struct Decisions {
    pub groups: [SizeGroup; IN_SQUARE],
    pub single: [TargetKind; IN_SQUARE],
    pub joint: [TargetKind; IN_SQUARE],
    pub features: [Features; IN_SQUARE],
    /// The code of the large pairs as decided jointly.
    pub code: u8,
}

impl Square {
    /// The places of its areas, from its top left corner, squares.
    pub fn places(&self) -> Vec<[f64; 2]> {
        self.areas.areas.iter().map(|area| area.centre.map(to_square)).collect()
    }

    /// The area of one of them, as a fraction of the square's.
    pub fn share(&self, index: usize) -> f64 {
        self.areas.areas[index].size as f64 / (SIDE * SIDE) as f64
    }

    /// Decides about its areas.
    pub fn decide(&mut self, classifier: Classifier, table: &ContourTable, bank: &Bank) {
        let Some(groups) = groups(&self.areas.areas) else { return };
        let features = std::array::from_fn(|index| features(&self.areas, index));
        let gain = |index: usize| match classifier {
            Classifier::Contours => table.gain(groups[index], features[index]),
            Classifier::Modern => {
                let large = matches!(groups[index], SizeGroup::LargeAngular | SizeGroup::LargeRound);
                let [first, second] = groups[index].kinds();
                let seen = bank.seen(&self.normal, self.areas.areas[index].centre, (first, large));
                let like = |kind: TargetKind| bank.likeness(&seen, (kind, large), None);
                like(first) - like(second)
            }
        };
        let gains: [f64; IN_SQUARE] = std::array::from_fn(gain);
        let kind = |index: usize, first: bool| groups[index].kinds()[usize::from(!first)];
        let single = std::array::from_fn(|index| kind(index, gains[index] > 0.0));
        let mut jointly = single;
        for group in SizeGroup::ALL {
            let of: Vec<usize> = (0..IN_SQUARE).filter(|&index| groups[index] == group).collect();
            let firsts = joint(std::array::from_fn(|i| gains[of[i]]));
            of.iter().zip(firsts).for_each(|(&index, first)| jointly[index] = kind(index, first));
        }
        let places = self.places();
        let pair = |kind: TargetKind| {
            let large = |&index: &usize| jointly[index] == kind && matches!(groups[index], SizeGroup::LargeAngular | SizeGroup::LargeRound);
            let mut both = (0..IN_SQUARE).filter(large).map(|index| places[index]);
            [both.next().unwrap_or_default(), both.next().unwrap_or_default()]
        };
        self.decisions = Some(Decisions { groups, single, joint: jointly, features, code: code(&KINDS.map(pair)) });
    }
}
