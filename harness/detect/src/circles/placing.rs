//! Which place of the board each circle of a grid has.

use std::collections::{BTreeMap, BTreeSet};

use calibench_model::Image;
use calibench_model::boards::{Circles, Form};

use super::dots::{Basis, Dots, determinant};
use super::fill::{around, beside};

/// So many of a hundred circles of a board that is seen whole may be missing, and of each side so many of two.
const MISSING: usize = 6;
/// So many of a hundred circles of a whole board may look like marks and be none, and of a part one beside so many marks.
const MISTAKEN: usize = 2;
const DOUBTED: usize = 3;
/// A part of the board has at least so many circles, in rows and columns as many as the second.
const FEWEST: usize = 12;
const ACROSS: usize = 3;
/// Circles that should be there and are not, or are there and should not be, per hundred of a part; beyond the board only where more than one mark tells.
const HIDDEN: usize = 25;
const BEYOND: usize = 2;
/// Another part is ruled out by so many more such circles, and so many of a hundred.
const RIVAL: usize = 3;

/// How a grid lies on the board.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    /// From places of the grid to half steps or steps and rows, which begin at the board's first circle with `first` taken off.
    pub basis: Basis,
    first: [i32; 2],
    /// The places of the board and those of the grid, in the order of the board.
    pub seen: BTreeMap<[usize; 2], [i32; 2]>,
    /// Circles that the board does not have.
    pub beyond: usize,
    /// Circles that the board has, in view and not seen.
    pub absent: usize,
    /// Its marks that look as they should.
    pub marks: usize,
    /// Circles that look like marks and are none.
    mistaken: usize,
}

/// Why a grid is not the board.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Misplaced {
    /// It has other rows and columns.
    Counts,
    /// Circles unlike the others stand elsewhere.
    Marks,
    /// Its marks leave more than one part of the board.
    Unsure,
}

fn key(place: [usize; 2]) -> [usize; 2] {
    [place[1], place[0]]
}

impl Placed {
    /// Which of the grid's circles have which place, whether or not they look so.
    fn at(dots: &Dots, circles: &Circles, basis: Basis, first: [i32; 2]) -> Self {
        let mut placed = Self { basis, first, seen: BTreeMap::new(), beyond: 0, absent: 0, marks: 0, mistaken: 0 };
        // What has another shape is none of the circles of a board that says which of them are unlike the others.
        let all = dots.grid.keys().filter(|place| circles.marks.is_empty() || !dots.is_other(**place));
        for place in all {
            match circles.place(placed.steps(*place)) {
                Some(on) => drop(placed.seen.insert(key(on), *place)),
                None => placed.beyond += 1,
            }
        }
        placed
    }

    /// The steps of a place of the grid from the board's first circle.
    fn steps(&self, place: [i32; 2]) -> [i32; 2] {
        let [x, y] = applied(self.basis, place);
        [x - self.first[0], y - self.first[1]]
    }

    /// Its circles by the board's places, column and row.
    pub(super) fn iter(&self) -> impl Iterator<Item = ([usize; 2], [i32; 2])> {
        self.seen.iter().map(|([row, column], place)| ([*column, *row], *place))
    }

    fn has(&self, place: [usize; 2]) -> bool {
        self.seen.contains_key(&key(place))
    }

    /// Whether all marks that are seen look as they should, and counts them, and those that look so and are none.
    fn has_marks(&mut self, dots: &Dots, circles: &Circles) -> bool {
        if circles.marks.is_empty() {
            return true;
        }
        for place in dots.grid.keys() {
            let expected = circles.place(self.steps(*place)).and_then(|on| circles.marks.at(on));
            let form = dots.form(*place, circles);
            match expected {
                Some(expected) if form == Some(expected) => self.marks += 1,
                Some(_) => return false,
                None => self.mistaken += usize::from(circles.marks.iter().any(|mark| Some(mark.form) == form)),
            }
        }
        let gap = |place: [usize; 2]| circles.marks.at(place) == Some(Form::Gap) && !self.has(place);
        let hollow = |place: &[i32; 2]| beside(dots.grid, *place) >= 3 && circles.place(self.steps(*place)).is_some_and(gap);
        let gaps = super::fill::empty(dots.grid).iter().filter(|place| hollow(place)).count();
        self.marks += gaps;
        true
    }

    /// Counts the board's circles that are not seen beside those that are, though they would be inside the image.
    fn count_absent(&mut self, dots: &Dots, circles: &Circles, image: &Image, expected: &BTreeMap<[i32; 2], [f64; 2]>) {
        let size = dots.areas[dots.grid.values().copied().next().unwrap_or(0)].area.sqrt();
        let margin = size.ceil() as i64 + 3;
        let is_absent = |(place, at): &(&[i32; 2], &[f64; 2])| {
            let on = circles.place(self.steps(**place)).filter(|on| !self.has(*on) && circles.marks.at(*on) != Some(Form::Gap));
            on.is_some() && image.holds(at[0].round() as i64, at[1].round() as i64, margin)
        };
        self.absent = expected.iter().filter(is_absent).count();
    }
}

fn applied(basis: Basis, [i, j]: [i32; 2]) -> [i32; 2] {
    basis.map(|[a, b]| a * i + b * j)
}

/// The ways in which the grid is the whole board, all that are alike to it; with `lenient` a few circles may be missing.
pub(super) fn whole(dots: &Dots, circles: &Circles, lenient: bool) -> Result<Vec<Placed>, Misplaced> {
    let places: Vec<[usize; 2]> = circles.places().filter(|place| circles.marks.at(*place) != Some(Form::Gap)).collect();
    let allowed = if lenient { MISSING * places.len() / 100 } else { 0 };
    let (mut ways, mut why) = (Vec::new(), Misplaced::Counts);
    for basis in dots.bases(circles) {
        let low = |axis: usize| dots.grid.keys().map(|place| applied(basis, *place)[axis]).min().unwrap_or(0);
        let mut placed = Placed::at(dots, circles, basis, [low(0), low(1)]);
        let missing = places.iter().filter(|place| !placed.has(**place)).count();
        if placed.beyond > 0 || missing > allowed || (missing > 0 && !has_sides(&placed, circles)) {
            continue;
        }
        if placed.has_marks(dots, circles) && 100 * placed.mistaken <= MISTAKEN * placed.seen.len() {
            placed.absent = missing;
            ways.push(placed);
        } else {
            why = Misplaced::Marks;
        }
    }
    // Where some see more marks, hidden ones have made room for the others.
    let most = ways.iter().map(|placed| placed.marks).max().unwrap_or(0);
    ways.retain(|placed| placed.marks == most);
    if ways.is_empty() { Err(why) } else { Ok(ways) }
}

/// Whether half of each side of the board is seen.
fn has_sides(placed: &Placed, circles: &Circles) -> bool {
    let half = |is_side: &dyn Fn([usize; 2]) -> bool| {
        let side: Vec<[usize; 2]> = circles.places().filter(|place| is_side(*place)).collect();
        2 * side.iter().filter(|place| placed.has(**place)).count() >= side.len()
    };
    let (right, below) = (circles.columns - 1, circles.rows - 1);
    half(&|[column, _]| column == 0) && half(&|[column, _]| column == right) && half(&|[_, row]| row == 0) && half(&|[_, row]| row == below)
}

/// The one way in which the grid is a part of the board, told by circles unlike the others.
///
/// # Errors
/// [`Misplaced::Marks`] where none of them is seen where the board has it, [`Misplaced::Unsure`] where another way is nearly as good or few rows are seen,
/// [`Misplaced::Counts`] of a few circles.
pub(super) fn part(dots: &Dots, circles: &Circles, image: &Image) -> Result<Placed, Misplaced> {
    if dots.grid.len() < FEWEST {
        return Err(Misplaced::Counts);
    }
    let square = dots.square(circles).ok_or(Misplaced::Counts)?;
    let expected = around(dots.grid, dots.areas);
    let mut ways: Vec<Placed> = Vec::new();
    let mut turned = square;
    for _ in 0..4 {
        for first in firsts(dots, circles, turned) {
            let mut placed = Placed::at(dots, circles, turned, first);
            if placed.has_marks(dots, circles) && placed.marks > 0 && DOUBTED * placed.mistaken <= placed.marks {
                placed.count_absent(dots, circles, image, &expected);
                ways.push(placed);
            }
        }
        let [x, y] = turned;
        turned = [y.map(|step| -step), x];
        debug_assert_eq!(determinant(turned), determinant(square));
    }
    let against = |placed: &Placed| placed.absent + placed.beyond;
    ways.sort_by_key(|placed| (std::cmp::Reverse(placed.marks), against(placed)));
    let mut best = ways.first().ok_or(Misplaced::Marks)?.clone();
    let count = best.seen.len();
    let rival = |other: &Placed| other.marks == best.marks && against(other) < against(&best) + RIVAL.max(RIVAL * count / 100);
    let spans = |axis: usize| best.seen.keys().map(|place| place[axis]).collect::<BTreeSet<_>>().len() >= ACROSS;
    let agrees = 100 * best.absent <= HIDDEN * count && (best.marks > 1 || 100 * best.beyond <= BEYOND * count);
    if !agrees {
        return Err(Misplaced::Marks);
    }
    // One that the border cuts tells a mark, not to a pixel where its middle is.
    if count >= FEWEST && spans(0) && spans(1) && !ways[1..].iter().any(rival) {
        best.seen.retain(|_, place| !dots.is_cut(*place));
        Ok(best)
    } else {
        Err(Misplaced::Unsure)
    }
}

/// Where the board's first circle can be in this basis: where a circle that looks like one of its marks is that mark.
fn firsts(dots: &Dots, circles: &Circles, basis: Basis) -> BTreeSet<[i32; 2]> {
    let seen = dots.grid.keys().filter_map(|place| Some((*place, dots.form(*place, circles)?)));
    let hollow = super::fill::empty(dots.grid).into_iter().filter(|place| beside(dots.grid, *place) == 4);
    let all: Vec<([i32; 2], Form)> = seen.chain(hollow.map(|place| (place, Form::Gap))).collect();
    let mut firsts = BTreeSet::new();
    for mark in circles.marks.iter() {
        let own = circles.steps(mark.place);
        for (place, _) in all.iter().filter(|(_, form)| *form == mark.form) {
            let [x, y] = applied(basis, *place);
            firsts.insert([x - own[0], y - own[1]]);
        }
    }
    firsts
}
