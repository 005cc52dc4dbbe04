//! Gross errors by default: what is left out, what is kept, and what is said where an assumption does not hold.

use calibench_calibrate::{GrossErrors, calibrate, prepare};
use calibench_model::camera::{Camera, CameraModel};
use rayon::prelude::*;

use crate::broken::{BROKEN, GROSS, Given, SNOOPED, STRAINED, given, poor, with, without_gross};
use crate::planted::{Input, SOUND};

/// Draws of each kind.
const DRAWS: u64 = 4;
/// Of which each is to be doubted or refused: fisheyes as pinholes take seconds.
const SAID: u64 = 2;

/// How far cameras are off, RMS over all draws, px.
fn off<'g>(given: impl Iterator<Item = &'g Given>) -> f64 {
    (given.map(|given| given.off_px * given.off_px).sum::<f64>() / DRAWS as f64).sqrt()
}

/// Nine tenths and more of what is wrong are left out (an image of which nothing is right may have a pose that fits some), and told; the cameras are as good as those of
/// the right points alone.
#[test]
fn gross_errors_are_left_out_by_default_and_when_asked() {
    let [none, kinds @ ..] = GROSS;
    for (what, draw) in kinds {
        let of = |seed| {
            let (input, truth) = draw(seed);
            let (right, wrong) = without_gross(&input, &none.1(seed).0.0);
            let given = |input: &Input, gross| given(&with(input, gross), &truth).unwrap_or_else(|error| panic!("{what}, {seed}: {error}"));
            let found = [GrossErrors::Sought, SNOOPED].map(|gross| {
                let found = given(&input, gross);
                assert!(found.doubts.is_empty() && 10 * found.left_out >= 9 * wrong, "{what}, {gross:?} {seed}: {found:?} of {wrong}");
                found
            });
            assert!(found[0].left_out <= wrong + 1, "{what}, {seed}: {} of {wrong}", found[0].left_out);
            (found, given(&right, GrossErrors::Kept))
        };
        let all: Vec<([Given; 2], Given)> = (0..DRAWS).into_par_iter().map(of).collect();
        let least = off(all.iter().map(|(_, right)| right));
        // When asked, one of a thousand good coordinates goes too.
        for (k, most) in [1.1, 1.3].into_iter().enumerate() {
            let found = off(all.iter().map(|(found, _)| &found[k]));
            assert!(found < most * least, "{what}, {k}: {found} px, {least} px of the right points: {all:#?}");
        }
    }
}

/// The corners at the border are not wrong for themselves, few as their neighbours are: all stay, the lens is in doubt, and the camera is that of all points.
#[test]
fn a_lens_that_is_too_poor_loses_no_point() {
    for (seed, k3) in (0..4).flat_map(|seed| [-0.09, -0.045, 0.04, 0.09].map(|k3| (seed, k3))) {
        let (input, truth) = poor(seed, k3);
        let [all, sought] = [GrossErrors::Kept, GrossErrors::Sought].map(|gross| given(&with(&input, gross), &truth).unwrap());
        assert_eq!((sought.left_out, sought.off_px), (0, all.off_px), "{seed} {k3}: {sought:?}");
        assert!(sought.doubts.iter().any(|doubt| doubt.contains("lens")), "{seed} {k3}: {sought:?}");
    }
}

/// Nothing is left out, and the camera is that of all points to the bit.
#[test]
fn sound_sets_lose_nothing() {
    let sets: Vec<_> = (0..6).flat_map(|seed| SOUND.iter().map(move |(what, draw)| (seed, what, draw))).collect();
    sets.par_iter().for_each(|(seed, what, draw)| {
        let (points, control, settings) = draw(*seed);
        let values = |gross| {
            let prepared = prepare(points.clone(), &control, &with(&(points.clone(), control.clone(), settings.clone()), gross).2).unwrap();
            calibrate(&prepared, &[], |found| {
                assert!(found.found.is_empty(), "{what} {seed}: {:?}", found.found);
                found.camera(0).parameters().iter().map(|parameter| parameter.value).collect::<Vec<_>>()
            })
            .unwrap()
        };
        assert_eq!(values(GrossErrors::Sought), values(GrossErrors::Kept), "{what} {seed}");
    });
}

/// Draws in which a camera is doubted or refused, and such in which one is wrong without a word.
fn said(draw: fn(u64) -> (Input, Camera), gross: GrossErrors, draws: u64) -> (Vec<bool>, usize) {
    let one = |seed| {
        let (input, truth) = draw(seed);
        given(&with(&input, gross), &truth).map_or((true, false), |given| (!given.doubts.is_empty(), given.is_silent()))
    };
    let found: Vec<(bool, bool)> = (0..draws).into_par_iter().map(one).collect();
    (found.iter().map(|found| found.0).collect(), found.iter().filter(|found| found.1).count())
}

/// Where an assumption does not hold that is doubted or refused, and no camera is wrong without a word.
#[test]
fn what_is_assumed_and_does_not_hold_is_said() {
    for (what, draw) in BROKEN {
        let (said, silent) = said(draw, GrossErrors::Sought, SAID);
        assert!(!said.contains(&false) && silent == 0, "{what}: {said:?}, {silent} wrong without a word");
    }
}

/// What is doubted of all points is doubted by default.
#[test]
fn what_hardly_holds_is_not_cleaned_away() {
    for (what, draw) in STRAINED {
        let [all, sought] = [GrossErrors::Kept, GrossErrors::Sought].map(|gross| said(draw, gross, DRAWS));
        let away = all.0.iter().zip(&sought.0).filter(|(all, sought)| **all && !**sought).count();
        assert!(away == 0 && sought.1 == 0 && all.0.contains(&true), "{what}: {all:?} {sought:?}");
    }
}
