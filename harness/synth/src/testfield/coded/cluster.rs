//! The sixteen targets of one square: their places and what tells them apart.

use std::f64::consts::TAU;

use calibench_model::coded::code;
use calibench_model::testfield::PlatePoint;
use rand::seq::SliceRandom;
use rand::{Rng, RngExt};

use super::{Coded, SHAPES};

/// Pairs of equal targets: four shapes in two sizes, the small ones first.
const PAIRS: usize = 8;
/// By how much, as a fraction of a target's cell, what tells targets apart must be clear.
const CLEAR: f64 = 0.15;
/// How far from the border of its cell, as a fraction of the cell, a target stays if it is small enough: targets and lines must not run together.
const APART: f64 = 0.1;
/// Arrangements that are tried.
const TRIES: usize = 1_000_000;

/// A target of a square.
#[derive(Clone, Copy, Debug)]
pub(super) struct Printed {
    /// Its place, from the square's middle.
    pub at: PlatePoint,
    /// Its turn, radians.
    pub turn: f64,
    /// Its pair, 0 to 7.
    pub pair: usize,
    /// Which of the two, 1 or 2.
    pub number: usize,
}

impl Printed {
    pub fn name(&self) -> String {
        format!("{}-{}-{}", ["small", "large"][self.pair / 4], SHAPES[self.pair % 4].kind(), self.number)
    }
}

/// The targets of a square, pair by pair.
pub(super) struct Cluster {
    pub targets: Vec<Printed>,
}

impl Cluster {
    /// A random arrangement with this code, in which nothing that tells targets apart is a close call. `None` if none was found.
    pub fn arranged(field: &Coded, wanted: u8, rng: &mut impl Rng) -> Option<Self> {
        let cell = field.cell();
        // Anywhere in its cell from where no turn brings it near the border, or in the middle.
        let slacks: [f64; PAIRS] =
            std::array::from_fn(|pair| (0.5 * cell - SHAPES[pair % 4].reach(field.size(pair)) - APART * cell).max(0.0));
        let mut slots: Vec<usize> = (0..2 * PAIRS).collect();
        for _ in 0..TRIES {
            slots.shuffle(rng);
            let mut places = [[[0.0; 2]; 2]; PAIRS];
            for (i, &slot) in slots.iter().enumerate() {
                let (pair, which) = (i / 2, i % 2);
                let mut place = |k: usize| (k as f64 - 1.5) * cell + (2.0 * rng.random::<f64>() - 1.0) * slacks[pair];
                places[pair][which] = [place(slot % 4), place(slot / 4)];
            }
            let large = [places[4], places[5], places[6], places[7]];
            if clear_code(&large, CLEAR * cell) == Some(wanted) && order(&mut places, CLEAR * cell) {
                return Some(Self::turned(&places, rng));
            }
        }
        None
    }

    fn turned(places: &[[PlatePoint; 2]; PAIRS], rng: &mut impl Rng) -> Self {
        let of = (0..2 * PAIRS).map(|i| (i / 2, i % 2));
        let targets = of.map(|(pair, which)| Printed { at: places[pair][which], turn: rng.random::<f64>() * TAU, pair, number: which + 1 });
        Self { targets: targets.collect() }
    }
}

/// Puts the target nearer to the middle of the pair of its shape and the other size first; false if one of these is not clear.
fn order(places: &mut [[PlatePoint; 2]; PAIRS], clear: f64) -> bool {
    let middles = places.map(|[a, b]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
    for (pair, both) in places.iter_mut().enumerate() {
        let [first, second] = both.map(|at| distance(at, middles[(pair + 4) % PAIRS]));
        if (first - second).abs() < clear {
            return false;
        }
        if first > second {
            both.swap(0, 1);
        }
    }
    true
}

/// The code, if no segment passes nearer than `clear` to an end of another.
fn clear_code(large: &[[PlatePoint; 2]; 4], clear: f64) -> Option<u8> {
    let near = |a: usize, b: usize| large[b].iter().any(|&end| from_segment(end, large[a]) < clear * clear);
    let close = (0..4).any(|a| (0..4).any(|b| a != b && near(a, b)));
    (!close).then(|| code(large))
}

fn distance(a: PlatePoint, b: PlatePoint) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The square of the distance: most arrangements are refused here, and a root is what that takes.
fn from_segment(p: PlatePoint, [a, b]: [PlatePoint; 2]) -> f64 {
    let (u, v) = (b[0] - a[0], b[1] - a[1]);
    let t = (((p[0] - a[0]) * u + (p[1] - a[1]) * v) / (u * u + v * v)).clamp(0.0, 1.0);
    (p[0] - a[0] - t * u).powi(2) + (p[1] - a[1] - t * v).powi(2)
}
