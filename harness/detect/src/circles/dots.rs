//! The circles of a grid as their neighbours show them: which way its steps lie, how large each is, and whether it has a hole.

use std::collections::BTreeMap;

use calibench_model::boards::{Circles, Form};
use calibench_model::{Image, upper_median};

use crate::lattice::{Grid, bases};
use crate::plane::{Linear, Point, dot, length, minus};
use crate::round::{Round, TOLD};

/// How far a circle may be from where a linear map has it from its neighbour, in distances of neighbours.
const BEND: f64 = 0.35;
/// From here on a circle has a hole, as a share of the contrast; beside others without one from here on, and where it is lighter than they by so many times their scatter.
const HOLE: f64 = 0.4;
const LIGHTER: f64 = 0.12;
const SCATTER: f64 = 8.0;
/// What differs by this factor from every circle of a board with gaps stands in one.
const UNLIKE: f64 = 1.17;

/// From places of a grid to half steps or steps and rows of the board, without their origin.
pub(super) type Basis = [[i32; 2]; 2];

/// A grid of circles.
pub(super) struct Dots<'a> {
    pub grid: &'a Grid,
    pub areas: &'a [Round],
    /// The steps of the grid in the image at each place.
    steps: BTreeMap<[i32; 2], Linear>,
    /// How far circles stand from where their neighbours have them at most, in distances.
    pub bend: f64,
    /// Their diameters beside the median; none where sizes tell nothing.
    pub sizes: BTreeMap<[i32; 2], f64>,
    /// How light their middles are, from 0 to 1, if that was looked at.
    holes: BTreeMap<[i32; 2], f64>,
    /// From here on a hole tells a circle from the others.
    hole: f64,
}

impl<'a> Dots<'a> {
    /// `None` if it is no surface. Sizes are told from an image of dark areas, of lights that are too small for it they are not.
    pub(super) fn new(grid: &'a Grid, areas: &'a [Round], image: Option<&Image>) -> Option<Self> {
        let steps: BTreeMap<[i32; 2], Linear> = grid.keys().filter_map(|place| Some((*place, local(grid, areas, *place)?))).collect();
        let is_front = steps.values().filter(|linear| linear.determinant() > 0.0).count();
        if steps.len() < grid.len() || (is_front != 0 && is_front != steps.len()) {
            return None;
        }
        let mut dots = Self { grid, areas, steps, bend: 0.0, sizes: BTreeMap::new(), holes: BTreeMap::new(), hole: HOLE };
        dots.bend = dots.bent();
        if let Some(image) = image {
            let scaled = |(place, linear): (&[i32; 2], &Linear)| (*place, (areas[grid[place]].area / linear.determinant().abs()).sqrt());
            dots.sizes = dots.steps.iter().map(scaled).collect();
            let median = upper_median(dots.sizes.values().copied())?;
            dots.sizes.values_mut().for_each(|size| *size /= median);
            dots.holes = grid.iter().map(|(place, index)| (*place, areas[*index].hole(image))).collect();
            let median = upper_median(dots.holes.values().copied())?;
            let scatter = upper_median(dots.holes.values().map(|hole| (hole - median).abs()))?;
            dots.hole = HOLE.min(median + LIGHTER.max(SCATTER * scatter));
        }
        Some(dots)
    }

    /// Whether it is a surface that is bent but little from circle to circle.
    pub(super) fn is_smooth(&self) -> bool {
        self.bend < BEND
    }

    fn bent(&self) -> f64 {
        let off = |(place, linear): (&[i32; 2], &Linear)| {
            let own = self.at(*place)?;
            let beside = around(self.grid, *place, 1).filter_map(|step| {
                let seen = minus(self.at([place[0] + step[0], place[1] + step[1]])?, own);
                let meant = linear.of(step.map(f64::from));
                Some(length(minus(seen, meant)) / length(meant))
            });
            Some(beside.fold(0.0, f64::max))
        };
        self.steps.iter().filter_map(off).fold(0.0, f64::max)
    }

    fn at(&self, place: [i32; 2]) -> Option<Point> {
        self.grid.get(&place).map(|index| self.areas[*index].at)
    }

    /// Whether an area of another shape stands there.
    pub(super) fn is_other(&self, place: [i32; 2]) -> bool {
        let other = |area: &Round| !area.is_oval && !area.is_cut && area.area > TOLD;
        self.grid.get(&place).is_some_and(|index| other(&self.areas[*index]))
    }

    /// Whether the border of the image cuts it.
    pub(super) fn is_cut(&self, place: [i32; 2]) -> bool {
        self.grid.get(&place).is_some_and(|index| self.areas[*index].is_cut)
    }

    /// Whether a circle has a hole for all to see; of spots nothing is told.
    pub(super) fn is_ring(&self, place: [i32; 2]) -> bool {
        self.holes.get(&place).is_some_and(|hole| *hole > HOLE)
    }

    /// The circle of this board that one looks most like: `None` one of those that are alike.
    pub(super) fn form(&self, place: [i32; 2], circles: &Circles) -> Option<Form> {
        if self.is_other(place) {
            return Some(Form::Gap);
        }
        let size = *self.sizes.get(&place)?;
        let looks = |form: Option<Form>| match form {
            None => Some((circles.diameter, circles.hole.is_some())),
            Some(Form::Disc(diameter)) => Some((diameter, false)),
            Some(Form::Ring(diameter, _)) => Some((diameter, true)),
            Some(Form::Gap) => None,
        };
        let all: Vec<(Option<Form>, f64, bool)> = std::iter::once(None)
            .chain(circles.marks.iter().map(|mark| Some(mark.form)))
            .filter_map(|form| looks(form).map(|(diameter, hole)| (form, (size * circles.diameter / diameter).ln().abs(), hole)))
            .collect();
        let has_hole = self.holes.get(&place).is_some_and(|hole| *hole > self.hole);
        // Of circles that all have a hole, or none, holes tell nothing.
        let tells = all.iter().any(|(.., hole)| *hole == has_hole);
        let fitting = all.into_iter().filter(|(.., hole)| !tells || *hole == has_hole);
        let (form, off, _) = fitting.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let is_none = off > UNLIKE.ln() && circles.marks.iter().any(|mark| mark.form == Form::Gap);
        if is_none { Some(Form::Gap) } else { form }
    }

    /// The bases in which the board is seen from its front.
    pub(super) fn bases(&self, circles: &Circles) -> impl Iterator<Item = Basis> {
        let front = self.steps.values().next().map_or(0.0, |linear| linear.determinant());
        let asymmetric = circles.asymmetric;
        bases()
            .map(move |[[a, b], [c, d]]| if asymmetric { [[a + c, b + d], [a - c, b - d]] } else { [[a, b], [c, d]] })
            .filter(move |basis| front * f64::from(determinant(*basis)) > 0.0)
    }

    /// The map from the board to the image at a place, object units.
    pub(super) fn linear(&self, place: [i32; 2], basis: Basis, spacing: f64) -> Linear {
        let [[a, b], [c, d]] = basis.map(|row| row.map(f64::from));
        let scale = 1.0 / (spacing * (a * d - b * c));
        // Steps and rows to places of the grid, rows running against v.
        let back = [[d * scale, b * scale], [-c * scale, -a * scale]];
        let Linear(rows) = self.steps[&place];
        Linear(rows.map(|row| [0, 1].map(|j| row[0] * back[0][j] + row[1] * back[1][j])))
    }

    /// The basis in which the circles are seen as circles: the steps of a square grid are at right angles and as long as each other.
    pub(super) fn square(&self, circles: &Circles) -> Option<Basis> {
        let off = |basis: Basis| {
            let one = |place: &[i32; 2]| {
                let linear = self.linear(*place, basis, 1.0);
                let ellipse = Linear(self.areas[self.grid[place]].axes());
                let [u, v] = [[1.0, 0.0], [0.0, 1.0]].map(|step| ellipse.back(linear.of(step)));
                let (u, v) = (u?, v?);
                Some((length(u) / length(v)).ln().powi(2) + (dot(u, v) / (length(u) * length(v))).powi(2))
            };
            upper_median(self.grid.keys().filter_map(one)).unwrap_or(f64::INFINITY)
        };
        self.bases(circles).map(|basis| (off(basis), basis)).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, basis)| basis)
    }
}

pub(super) fn determinant([[a, b], [c, d]]: Basis) -> i32 {
    a * d - b * c
}

/// The steps to the places of the grid that are at most so many steps away in each direction.
fn around(grid: &Grid, [i, j]: [i32; 2], reach: i32) -> impl Iterator<Item = [i32; 2]> {
    let steps = (-reach..=reach).flat_map(move |u| (-reach..=reach).map(move |v| [u, v]));
    steps.filter(move |[u, v]| [*u, *v] != [0, 0] && grid.contains_key(&[i + u, j + v]))
}

/// The steps of the grid in the image at a place, by least squares over the places around; of wider ones where these stand in one line.
fn local(grid: &Grid, areas: &[Round], place: [i32; 2]) -> Option<Linear> {
    let own = areas[grid[&place]].at;
    let fitted = |reach: i32| {
        let (mut normal, mut right) = ([[0.0; 2]; 2], [[0.0; 2]; 2]);
        for step in around(grid, place, reach) {
            let seen = minus(areas[grid[&[place[0] + step[0], place[1] + step[1]]]].at, own);
            let step = step.map(f64::from);
            for (i, row) in normal.iter_mut().enumerate() {
                (0..2).for_each(|j| row[j] += step[i] * step[j]);
            }
            for (i, row) in right.iter_mut().enumerate() {
                (0..2).for_each(|j| row[j] += seen[i] * step[j]);
            }
        }
        // Whole numbers: a determinant of zero is one.
        let normal = Linear(normal);
        (normal.determinant() > 0.5).then(|| right.map(|row| normal.back(row)))
    };
    let [x, y] = fitted(1).or_else(|| fitted(3))?;
    Some(Linear([x?, y?]))
}
