//! What else a grid of circles is than the board that was asked for.

use calibench_model::Affine;
use calibench_model::boards::{Board, Circles, Form, Mark, Marks};

use crate::{Doubt, FoundPoint};

use super::dots::Dots;
use super::placing::{self, Placed};
use super::unmarked;

/// Circles are alike whose diameters differ from the median by this factor at most.
const ALIKE: f64 = 1.22;
/// Of so many circles one may be unlike the others; at least one may.
const FEW: usize = 5;

/// The circles of a board that are unlike its others: by place, with the size beside that of the others and whether it is a hole that makes them so.
pub(super) struct Unlike(Vec<([usize; 2], Form)>);

/// The circles that are unlike most of the others, with diameters beside theirs.
pub(super) fn unlike(dots: &Dots, placed: &Placed) -> Unlike {
    let with_hole = placed.iter().filter(|(_, place)| dots.is_ring(*place)).count();
    let rings = 2 * with_hole > placed.seen.len();
    let form = |place: [i32; 2]| {
        let size = dots.sizes.get(&place).copied().unwrap_or(1.0);
        let is_other_size = !(ALIKE.recip()..ALIKE).contains(&size);
        let is_ring = dots.is_ring(place);
        if dots.is_other(place) {
            Some(Form::Gap)
        } else if is_ring && !rings {
            Some(Form::Ring(if is_other_size { size } else { 1.0 }, 0.5))
        } else {
            (is_other_size || is_ring != rings).then_some(Form::Disc(size))
        }
    };
    Unlike(placed.iter().filter_map(|(on, place)| Some((on, form(place)?))).collect())
}

impl Unlike {
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn are_many(&self, dots: &Dots) -> bool {
        self.len() > (dots.grid.len() / FEW).max(1)
    }

    /// Gives points that are larger or smaller than the others their own size: operators look as far.
    pub(super) fn resize(&self, points: &mut [FoundPoint], circles: &Circles) {
        for ([column, row], form) in &self.0 {
            let (Form::Disc(times) | Form::Ring(times, _)) = *form else { continue };
            let index = row * circles.columns + column;
            for point in points.iter_mut().filter(|point| point.index == index) {
                let Affine { axx, axy, ayx, ayy } = point.affine;
                point.affine = Affine { axx: times * axx, axy: times * axy, ayx: times * ayx, ayy: times * ayy };
            }
        }
    }

    /// That there are such, and how the board would be described with them.
    pub(super) fn doubt(&self, circles: &Circles) -> Option<Doubt> {
        let ([column, row], _) = self.0.first()?;
        let sized = |times: f64| {
            // Two digits: they are seen no better.
            let diameter = times * circles.diameter;
            let unit = 10_f64.powf(diameter.log10().floor() - 1.0);
            (diameter / unit).round() * unit
        };
        let form = |form: Form| match form {
            Form::Disc(times) => Form::Disc(sized(times)),
            Form::Ring(times, hole) => Form::Ring(sized(times), sized(times * hole)),
            Form::Gap => Form::Gap,
        };
        let marks: Vec<Mark> = self.0.iter().map(|(place, own)| Mark { place: *place, form: form(*own) }).collect();
        let board = Marks::new(&marks).map(|marks| Board::Circles(Circles { marks, ..*circles }));
        let instead = board.filter(|board| board.layout().is_ok()).map(|board| board.to_string());
        Some(Doubt::Unlike { first: format!("r{}c{}", row + 1, column + 1), circles: self.len(), instead })
    }
}

/// Kind and counts of the grid of circles that a grid is, the larger number of a symmetric one first; `None` if it is no whole one, or the board's own.
pub(super) fn other(dots: &Dots, circles: &Circles) -> Option<String> {
    let count = dots.grid.len();
    let counts = |asymmetric: bool| {
        let rows = 2..=count / 2;
        let all = rows.filter(|rows| count.is_multiple_of(*rows)).map(move |rows| (count / rows, rows));
        all.filter(move |(columns, rows)| asymmetric || columns >= rows).map(move |(columns, rows)| Circles {
            columns,
            rows,
            asymmetric,
            ..unmarked(circles)
        })
    };
    let is_whole = |one: &Circles| {
        let has_layout = Board::Circles(*one).layout().is_ok();
        has_layout && dots.is_smooth() && placing::whole(dots, one, false).is_ok()
    };
    let whole = counts(false).chain(counts(true)).find(is_whole)?;
    Some(format!("{}:{}x{}", Board::Circles(whole).kind(), whole.columns, whole.rows))
}
