//! Images that show the field in part, or not as it was drawn: what is labelled is right.

use calibench_model::camera::Photogrammetric;
use calibench_model::{Image, Testfield};

use crate::campaign::{Counts, Setting, Shot, paper_tilts, shots};
use crate::{BOTH, recogniser};

const TILTS: [(f64, [f64; 2]); 3] = [(0.0, [0.0, 0.0]), (30.0, [0.0, 30.0]), (45.0, [45.0, 0.0])];

/// Counts over images that are changed.
fn counted(setting: &Setting, tilts: &[(f64, [f64; 2])], rolls: &[f64], change: impl Fn(&Image<'static>) -> Image<'static>) -> [Counts; 2] {
    let field = setting.testfield();
    let mut counts = [Counts::default(), Counts::default()];
    let taken: Vec<Shot> =
        shots(setting, &field, tilts, rolls).into_iter().map(|shot| Shot { image: change(&shot.image), ..shot }).collect();
    for (classifier, counts) in BOTH.into_iter().zip(&mut counts) {
        let recogniser = recogniser(&field, classifier);
        taken.iter().for_each(|shot| counts.add(&field, shot, &recogniser.recognise(&shot.image)));
        counts.print(&format!("{classifier:?}"));
        assert_eq!(counts.wrong, 0, "{classifier:?}");
    }
    counts
}

/// Squares that a cover left of a column, px, leaves free are whole, others are not: lines are at most so far beyond a square's outermost targets.
fn uncovered(shot: &mut Shot, field: &Testfield, column: f64) {
    const BEYOND: f64 = 16.0;
    let square = |index: usize| field.targets[index].id.split('-').next().unwrap_or_default().to_owned();
    for index in 0..shot.whole.len() {
        let own = (0..shot.whole.len()).filter(|other| square(*other) == square(index));
        let left = own.map(|other| shot.truth[other].at.map_or(f64::MIN, |at| at.x)).fold(f64::MAX, f64::min);
        shot.whole[index] &= left > column + BEYOND;
    }
}

/// The grey value at a column and row.
type Cover<'a> = &'a dyn Fn(usize, usize) -> f32;

/// Grey, black, white or a texture over one half: the squares of the other half are recognised. (Of an upright field black would leave a single upright line.)
#[test]
fn half_covered() {
    let setting = Setting::paper(2401, 0.6, 46.0);
    let field = setting.testfield();
    let lattice = |x: usize, y: usize| 0.5 + 0.3 * (x as f32 * 0.7).sin() * (y as f32 * 0.45).cos();
    let cloth = |x: usize, y: usize| {
        let wave = |a: f32, b: f32| (a * x as f32 + b * y as f32).sin();
        0.5 + 0.15 * (wave(0.31, 0.17) + wave(-0.23, 0.29) * wave(0.11, 0.41))
    };
    // Lines of a lattice are as good as those of the field: the field may be missed, by name.
    let covers: [(&str, Cover<'_>, f64); 5] = [
        ("grey", &|_, _| 0.45, 0.9),
        ("black", &|_, _| 0.0, 0.9),
        ("white", &|_, _| 1.0, 0.9),
        ("cloth", &cloth, 0.9),
        ("lattice", &lattice, 0.0),
    ];
    for (name, cover, least) in covers {
        let mut counts = [Counts::default(), Counts::default()];
        for (number, mut shot) in shots(&setting, &field, &TILTS, &[8.0, 25.0]).into_iter().enumerate() {
            let at = [118, 131][number % 2];
            shot.image = Image::from_fn(240, 240, |x, y| if x < at { cover(x, y) } else { shot.image.at(x, y) });
            uncovered(&mut shot, &field, at as f64);
            for (classifier, counts) in BOTH.into_iter().zip(&mut counts) {
                counts.add(&field, &shot, &recogniser(&field, classifier).recognise(&shot.image));
            }
        }
        for (classifier, counts) in BOTH.into_iter().zip(&counts) {
            counts.print(&format!("{name}, {classifier:?}"));
            assert_eq!(counts.wrong, 0, "{name}, {classifier:?}");
            assert!(
                counts.targets > 250 && counts.right as f64 >= least * counts.targets as f64,
                "{name}, {classifier:?}: {}",
                counts.right
            );
        }
    }
}

/// A disc of paper, and one of ink, over the middle of the image.
#[test]
fn covered_in_the_middle() {
    let setting = Setting::paper(2402, 0.8, 30.0);
    for grey in [0.85, 0.05] {
        let inside = |x: usize, y: usize| (x as f32 - 120.0).hypot(y as f32 - 110.0) < 45.0;
        let change = |image: &Image| Image::from_fn(240, 240, |x, y| if inside(x, y) { grey } else { image.at(x, y) });
        for counts in counted(&setting, &TILTS, &[10.0], change) {
            assert!(counts.right * 2 > counts.targets, "{} of {}", counts.right, counts.targets);
        }
    }
}

/// The range of greys of a file of 16 bits that was exposed for a sixtieth, and light that falls off to a third.
#[test]
fn dark_images_and_uneven_light() {
    let setting = Setting::paper(2403, 0.6, 46.0);
    let dark = |image: &Image| Image::from_fn(240, 240, |x, y| (image.at(x, y) / 60.0 * 65535.0).round() / 65535.0);
    let slope = |image: &Image| Image::from_fn(240, 240, |x, y| image.at(x, y) * (1.0 - 0.66 * x as f32 / 239.0));
    let negative_free: [&dyn Fn(&Image<'static>) -> Image<'static>; 2] = [&dark, &slope];
    for change in negative_free {
        for counts in counted(&setting, &TILTS, &[0.0], change) {
            assert!(counts.not_recognised.is_empty(), "{:?}", counts.not_recognised);
            assert!(counts.right as f64 > 0.99 * counts.targets as f64, "{} of {}", counts.right, counts.targets);
        }
    }
}

/// Ink and paper exchanged is not the field.
#[test]
fn negatives_are_refused() {
    let setting = Setting::paper(2404, 0.6, 46.0);
    for counts in counted(&setting, &TILTS, &[0.0], |image| Image::from_fn(240, 240, |x, y| 1.0 - image.at(x, y))) {
        assert_eq!((counts.right, counts.beyond), (0, 0));
    }
}

/// Straight lines that a lens bends, by so many px at the corner of the image: right, or refused by name.
#[test]
fn lenses_that_bend_lines() {
    let paper = Setting::paper(2405, 0.6, 46.0);
    let reach = 169.7 * 0.027;
    let mut right = [0, 0];
    let mut all = 0;
    for share in [-0.16, -0.08, -0.03, 0.03, 0.08, 0.16] {
        let camera = Photogrammetric { k: [share / (reach * reach), 0.0, 0.0], ..paper.camera };
        let setting = Setting { camera, ..paper.clone() };
        let counts = counted(&setting, &paper_tilts()[..5], &[0.0, 15.0], Image::clone);
        println!("{share}: {:?}", counts.each_ref().map(|counts| (counts.right, counts.targets, counts.not_recognised.len())));
        all += counts[0].targets;
        for (right, counts) in right.iter_mut().zip(&counts) {
            *right += counts.right;
        }
    }
    assert!(right[0] as f64 > 0.99 * all as f64 && right[1] as f64 > 0.98 * all as f64, "{right:?} of {all}");
}
