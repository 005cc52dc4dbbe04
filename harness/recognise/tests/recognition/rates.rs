//! How often targets of whole squares are recognised, on seeds that nothing was learned on.

use std::ops::RangeInclusive;

use calibench_recognise::{Classifier, ContourTable, SizeGroup, recognise_each};

use crate::campaign::{Counts, LEARNED, Lesson, Setting, learn, paper_tilts, shots};
use crate::{BOTH, recogniser};

const ROLLS: [f64; 4] = [0.0, 90.0, 180.0, 270.0];

/// Counts over the nine positions of a field for each seed.
fn counted(seeds: &[u64], (blur, decibel): (f64, f64), rolls: &[f64]) -> [Counts; 2] {
    assert!(seeds.iter().all(|seed| !LEARNED.contains(seed)));
    let mut counts = [Counts::default(), Counts::default()];
    for &seed in seeds {
        // Rolls of no learned image.
        let setting = Setting { roll: 7.0 * (seed % 5) as f64, ..Setting::paper(seed, blur, decibel) };
        let field = setting.testfield();
        let taken = shots(&setting, &field, &paper_tilts(), rolls);
        for (classifier, counts) in BOTH.into_iter().zip(&mut counts) {
            let recogniser = recogniser(&field, classifier);
            taken.iter().for_each(|shot| counts.add(&field, shot, &recogniser.recognise(&shot.image)));
        }
    }
    for (classifier, counts) in BOTH.into_iter().zip(&counts) {
        counts.print(&format!("{classifier:?}, blur {blur} px, {decibel} dB"));
    }
    counts
}

/// At least this share right, of all labels at most this share wrong; every grid found.
fn hold(counts: &Counts, right: f64, wrong: f64, what: &str) {
    let (all, labelled) = (counts.targets as f64, (counts.right + counts.wrong + counts.beyond) as f64);
    assert!(counts.targets > 1000, "{what}: {}", counts.targets);
    assert!(counts.not_recognised.is_empty(), "{what}: {:?}", counts.not_recognised);
    assert!(counts.right as f64 >= right * all, "{what}: {} of {} right", counts.right, counts.targets);
    assert!(counts.wrong as f64 <= wrong * labelled, "{what}: {} wrong of {labelled}", counts.wrong);
    assert!(counts.farthest < 1.0, "{what}: {} px off", counts.farthest);
    assert!(counts.affine < 0.02, "{what}: affine map wrong by {}", counts.affine);
}

/// At 0.6 px of blur nothing is lost and nothing wrong, also by contours.
fn check_sharp(seeds: &[u64], decibel: f64, rolls: &[f64]) {
    let [modern, contours] = counted(seeds, (0.6, decibel), rolls);
    hold(&modern, 0.999, 0.0, "modern");
    hold(&contours, 0.98, 0.0, "contours");
}

fn check_blurred(seeds: &[u64], rolls: &[f64]) {
    let [modern, contours] = counted(seeds, (1.0, 26.0), rolls);
    hold(&modern, 0.97, 0.005, "modern");
    hold(&contours, 0.8, 0.005, "contours");
}

#[test]
fn targets_of_whole_squares_are_recognised() {
    check_sharp(&[2001], 46.0, &ROLLS[..2]);
    check_sharp(&[2001], 26.0, &ROLLS[..2]);
    check_blurred(&[2001], &ROLLS[..2]);
}

/// Of 720 images.
const SEEDS: RangeInclusive<u64> = 3001..=3020;

#[test]
#[ignore = "minutes"]
fn at_46_db_in_720_images() {
    check_sharp(&SEEDS.collect::<Vec<_>>(), 46.0, &ROLLS);
}

#[test]
#[ignore = "minutes"]
fn at_26_db_in_720_images() {
    check_sharp(&SEEDS.collect::<Vec<_>>(), 26.0, &ROLLS);
}

#[test]
#[ignore = "minutes"]
fn blurred_in_720_images() {
    check_blurred(&SEEDS.collect::<Vec<_>>(), &ROLLS);
}

/// The joint decision does better than single ones, where these are wrong at all.
#[test]
fn the_best_of_six_makes_fewer_mistakes_than_single_decisions() {
    let [modern, contours] = counted(&[2002], (1.0, 26.0), &ROLLS[..1]);
    for counts in [&modern, &contours] {
        let sum = |which: usize| counts.decisions.iter().flatten().map(|of| of[which]).sum::<usize>();
        assert!(sum(0) > 1000);
        assert!(sum(2) < sum(1), "{} jointly, {} singly of {}", sum(2), sum(1), sum(0));
    }
    let wrong = |counts: &Counts| counts.decisions.iter().flatten().map(|of| of[2]).sum::<usize>();
    assert!(wrong(&modern) < wrong(&contours), "drawings tell more than contours");
}

/// The tables of the repository are what their command makes.
#[test]
fn tables_are_learned_from_their_images() {
    assert_eq!(learn(&LEARNED[..1], Lesson::Few), ContourTable::learned_on_few());
}

#[test]
#[ignore = "a minute"]
fn the_table_of_all_positions_is_learned_from_its_images() {
    assert_eq!(learn(&LEARNED, Lesson::All), ContourTable::learned());
}

/// A table of few images is the worse the more its squares are tilted; one classifier beside another changes nothing.
#[test]
fn a_table_of_three_frontal_images_fails_at_45_degrees() {
    let setting = Setting::paper(2003, 0.8, 30.0);
    let field = setting.testfield();
    let recognisers =
        [ContourTable::learned(), ContourTable::learned_on_few()].map(|table| recogniser(&field, Classifier::Contours).with_table(table));
    let mut counts = [Counts::default(), Counts::default()];
    for shot in shots(&setting, &field, &paper_tilts(), &ROLLS) {
        for ((found, recogniser), counts) in recognise_each(&recognisers, &shot.image).iter().zip(&recognisers).zip(&mut counts) {
            assert_eq!(*found, recogniser.recognise(&shot.image));
            counts.add(&field, &shot, found);
        }
    }
    let wrong = counts
        .map(|counts| counts.decisions.map(|of| of[SizeGroup::SmallAngular as usize]).map(|[all, _, wrong]| wrong as f64 / all as f64));
    let [[_, _, all], [front, middle, few]] = wrong;
    assert!(few > 1.5 * all && few > 1.5 * middle && middle > front, "{wrong:?}");
}
