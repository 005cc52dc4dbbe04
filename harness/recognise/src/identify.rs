//! Where the squares seen lie on the field.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use calibench_model::TargetKind;
use calibench_model::coded::code;

use crate::bank::KINDS;
use crate::design::{Design, IN_SQUARE, Printed};
use crate::error::NotRecognised;
use crate::mapping::Place;

/// How far from its place on the design a target may be, in squares: a pixel in images of 50 px a square.
pub(crate) const NEAR: f64 = 0.02;
/// And its area beside the design's. Large targets leave little room in their quarter of a row: by place alone every field has squares that look like another's
/// mirror image.
const ALIKE: RangeInclusive<f64> = 0.5..=1.6;
/// Targets of a square that are where the design has them: of so many it is explained, of so few contradicted.
const EXPLAINED: usize = 12;
const CONTRADICTED: usize = 7;
/// Cells of [`Places`] to a side.
const FINE: usize = 100;
/// Dark areas of a square that may be a coded one.
pub(crate) const FEWEST: usize = 8;

/// A square as it is seen, for the identification.
#[derive(Clone, Debug)]
pub(crate) struct Seen {
    /// Column and row on the grid.
    pub square: [i64; 2],
    /// The places of its dark areas, from its top left corner, squares.
    pub at: Vec<[f64; 2]>,
    /// Their areas, as fractions of the square's.
    pub areas: Vec<f64>,
    /// Its code, if a classifier reads one.
    pub code: Option<u8>,
}

/// Where the targets of a square of the design are: for each small cell the number of the target whose place is near.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    cells: Vec<u8>,
    /// Their areas, in squares.
    areas: [f64; IN_SQUARE],
    code: u8,
}

impl Places {
    pub fn of(design: &Design) -> Vec<Self> {
        let squares = (0..design.squares).flat_map(|row| (0..design.squares).map(move |column| (row, column)));
        squares.map(|(row, column)| Self::of_square(design.cell(row, column), [column as f64, row as f64])).collect()
    }

    fn of_square(targets: &[Printed; IN_SQUARE], corner: [f64; 2]) -> Self {
        let mut cells = vec![0; FINE * FINE];
        let middle = |i: usize| (i as f64 + 0.5) / FINE as f64;
        let around = |v: f64| ((v - NEAR) * FINE as f64).max(0.0) as usize..((v + NEAR) * FINE as f64 + 1.0).min(FINE as f64) as usize;
        for (number, printed) in targets.iter().enumerate() {
            let at = [printed.at[0] - corner[0], printed.at[1] - corner[1]];
            for (x, y) in around(at[1]).flat_map(|y| around(at[0]).map(move |x| (x, y))) {
                if (middle(x) - at[0]).powi(2) + (middle(y) - at[1]).powi(2) < NEAR * NEAR {
                    cells[y * FINE + x] = number as u8 + 1;
                }
            }
        }
        let pair = |kind: TargetKind| {
            let mut both = targets.iter().filter(|p| p.kind == kind && p.large).map(|p| p.at);
            [both.next().unwrap_or_default(), both.next().unwrap_or_default()]
        };
        Self { cells, areas: targets.each_ref().map(Printed::area), code: code(&KINDS.map(pair)) }
    }

    /// How many of its targets are seen at these cells, with these areas.
    fn matches(&self, at: &[usize], areas: &[f64]) -> usize {
        let of = |(&cell, area): (&usize, &f64)| match usize::from(self.cells[cell]) {
            0 => 0,
            number => u32::from(ALIKE.contains(&(area / self.areas[number - 1]))) << number,
        };
        at.iter().zip(areas).map(of).fold(0, |seen, one| seen | one).count_ones() as usize
    }
}

/// Where the grid lies on the field.
#[derive(Clone, Debug)]
pub(crate) struct Identified {
    pub place: Place,
    /// For each square seen, whether the design explains it: `None` outside the field.
    pub explained: Vec<Option<bool>>,
}

/// The cells of [`Places`] of places within a square that is turned.
fn turned(at: &[[f64; 2]], turns: usize, mirrored: bool) -> Vec<usize> {
    let place = Place { turns, mirrored, shift: [0, 0] };
    let cell = |[x, y]: &[f64; 2]| {
        let [x, y] = place.direction([x - 0.5, y - 0.5]).map(|v| (((v + 0.5) * FINE as f64) as usize).min(FINE - 1));
        y * FINE + x
    };
    at.iter().map(cell).collect()
}

/// The place that brings a square of the grid to one of the field (row, column), turned so.
fn place_of(square: [i64; 2], [row, column]: [i64; 2], turns: usize, mirrored: bool) -> Place {
    let place = Place { turns, mirrored, shift: [0, 0] };
    let [r, c] = place.square(square);
    Place { shift: [column - c, row - r], ..place }
}

/// What speaks for a place: squares that it explains, targets in them.
type Votes = BTreeMap<Place, (usize, usize)>;

/// Where the squares seen lie on the field, by the places of all their targets.
///
/// # Errors
/// No square with targets; none that the design explains; the mirror image; more than one place. Squares of another field may be explained by chance: what they hold is
/// to be held against the design.
pub(crate) fn identify(design: &Design, places: &[Places], seen: &[Seen], by_code: bool) -> Result<Identified, NotRecognised> {
    let with_targets: Vec<&Seen> = seen.iter().filter(|seen| seen.at.len() >= FEWEST).collect();
    if with_targets.is_empty() {
        return Err(NotRecognised::NoTargets { squares: seen.len() });
    }
    let mut votes = Votes::new();
    for seen in &with_targets {
        for (turns, mirrored) in (0..4).flat_map(|turns| [(turns, false), (turns, true)]) {
            let at = turned(&seen.at, turns, mirrored);
            for (index, of) in places.iter().enumerate() {
                if by_code && seen.code != Some(of.code) {
                    continue;
                }
                let matches = of.matches(&at, &seen.areas);
                if matches >= EXPLAINED {
                    let on_field = [index / design.squares, index % design.squares].map(|v| v as i64);
                    let vote = votes.entry(place_of(seen.square, on_field, turns, mirrored)).or_default();
                    *vote = (vote.0 + 1, vote.1 + matches);
                }
            }
        }
    }
    decide(design, places, seen, with_targets.len(), &votes)
}

fn decide(design: &Design, places: &[Places], seen: &[Seen], squares: usize, votes: &Votes) -> Result<Identified, NotRecognised> {
    let best = votes.iter().max_by_key(|(place, votes)| (**votes, std::cmp::Reverse(**place)));
    let Some((&place, &(explained, matches))) = best else { return Err(NotRecognised::OtherField { squares, explained: 0 }) };
    // A few squares of any field are like some of the design.
    let most = 2 * explained > squares;
    let alike = votes.values().filter(|vote| **vote == (explained, matches)).count();
    if !most && (alike > 1 || place.mirrored) {
        return Err(NotRecognised::OtherField { squares, explained: 0 });
    }
    if alike > 1 {
        return Err(NotRecognised::Ambiguous { places: alike, squares: explained });
    }
    if place.mirrored {
        return Err(NotRecognised::Mirrored { squares: explained });
    }
    let explains = |seen: &Seen| {
        let [row, column] = place.square(seen.square);
        let inside = |v: i64| usize::try_from(v).ok().filter(|v| *v < design.squares);
        let of = &places[inside(row)? * design.squares + inside(column)?];
        Some(of.matches(&turned(&seen.at, place.turns, false), &seen.areas) > CONTRADICTED || seen.at.len() < FEWEST)
    };
    Ok(Identified { place, explained: seen.iter().map(explains).collect() })
}
