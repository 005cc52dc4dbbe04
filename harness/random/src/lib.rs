//! Random streams, keyed by what they are for and never by the order of calls.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// What a stream's numbers are used for. The number is part of the key: never reuse one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Purpose {
    /// The sub-pixel position of the scene in a trial.
    Phase = 1,
    /// The grey-value noise of an image.
    GreyNoise = 2,
    /// The hand that points at a target.
    Pointing = 3,
    /// A sensor's temporal noise: one normal number for each pixel.
    SensorNoise = 10,
    /// A sensor's electrons where they are counted one by one.
    Electrons = 11,
    /// Photo response non-uniformity, the camera's own.
    Prnu = 12,
    /// Dark signal non-uniformity, the camera's own.
    Dsnu = 13,
    /// A sensor's noise that is common to a row.
    RowNoise = 14,
    /// How far each row of an image is read out of its place.
    RowJitter = 15,
    /// The local distortion of a camera: how its pixels lie beside their grid.
    LocalDistortion = 16,
    /// Where a printed corner lies beside the one that was meant.
    PrintNoise = 32,
    /// The error of a target's surveyed position.
    Survey = 33,
    /// Where targets are put on a sheet, and how they are turned.
    Layout = 34,
    /// The depths and tilts of a wall's sheets.
    Relief = 35,
    /// The texture of a facade.
    Texture = 36,
    /// Where a station is put.
    Station = 37,
    /// Which photographs make the first half, and which are drawn again, when a calibration is judged.
    Split = 48,
    /// The error of an image point that is common to all methods.
    CommonError = 60,
    /// The error of a control point's coordinates, where every trial has a survey of its own.
    Control = 61,
    /// The error of an image coordinate that is drawn and not measured.
    DrawnPoint = 62,
    /// Which of an image's points a block leaves out.
    LeftOut = 63,
    /// The order in which points are shown to a method from outside.
    Shown = 64,
    /// Which image points are in gross error or exchanged, and by how much.
    Gross = 65,
}

/// Which stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key<'a> {
    /// The scenario's seed.
    pub seed: u64,
    /// For what they are drawn: scenarios of something else share no numbers under one seed.
    pub of: &'a str,
    /// Counted from 0.
    pub trial: u64,
    /// The image's name, or "" for what concerns all of them.
    pub view: &'a str,
    /// The target's name, or "" for what concerns the whole image.
    pub target: &'a str,
}

/// The stream of `key` for `purpose`: the same numbers whenever and on whatever thread it is opened.
pub fn stream(key: Key<'_>, purpose: Purpose) -> ChaCha8Rng {
    let mut hasher = blake3::Hasher::new();
    for number in [key.seed, key.trial, purpose as u64] {
        hasher.update(&number.to_le_bytes());
    }
    for text in [key.of, key.view, key.target] {
        // The length keeps ("ab", "c") apart from ("a", "bc").
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    }
    ChaCha8Rng::from_seed(*hasher.finalize().as_bytes())
}

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    const KEY: Key<'_> = Key { seed: 1, of: "s", trial: 2, view: "ab", target: "c" };

    fn first(key: Key<'_>, purpose: Purpose) -> u64 {
        stream(key, purpose).random()
    }

    #[test]
    fn a_stream_depends_on_every_part_of_its_key_and_on_nothing_else() {
        let reference = first(KEY, Purpose::Phase);
        assert_eq!(reference, first(KEY, Purpose::Phase));
        let others = [
            first(Key { seed: 2, ..KEY }, Purpose::Phase),
            first(Key { of: "t", ..KEY }, Purpose::Phase),
            first(Key { trial: 3, ..KEY }, Purpose::Phase),
            first(Key { view: "a", target: "bc", ..KEY }, Purpose::Phase),
            first(Key { target: "d", ..KEY }, Purpose::Phase),
            first(KEY, Purpose::Pointing),
        ];
        assert!(others.iter().all(|&other| other != reference));
    }
}
