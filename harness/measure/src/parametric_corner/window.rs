//! The normal equations of a chess corner over one window.
//!
//! They are those of a model that takes the pixel's area for one Gaussian. What that leaves out is worked out once in a while and taken from the grey
//! values: see [`Window::correct`].

use calibench_model::Image;
use multiversion::multiversion;
use nalgebra::SVector;

use super::model::{BASE, Fidelity, Field, Model, Shape};
use super::single::WIDE;
use crate::lanes::{LANES, Lanes};
use crate::marquardt::{Normal, Problem, Sums};

/// The widest window, px.
pub(super) const WIDEST: usize = 41;
/// How often the normal equations of one corner are set up at most. Where the model fits, three to thirteen times were needed; without any blur, more.
const EVALUATIONS: usize = 60;

/// One window of an image, as the least-squares problem of `P` unknowns: the [`BASE`], a grey gradient if `GRADIENT`, a curvature an edge if `CURVED`.
pub(super) struct Window<'a, const P: usize, const GRADIENT: bool, const CURVED: bool> {
    image: &'a Image,
    /// First pixel.
    left: usize,
    top: usize,
    side: usize,
    /// The window's grey values, corrected.
    grey: Vec<f64>,
    pixels: Lists,
    /// How often the normal equations may still be set up.
    pub(super) patience: usize,
}

/// Pixels, by what can be seen in them.
struct Lists {
    corner: List,
    edges: [List; 2],
    areas: List,
}

/// Coordinates from the window's centre, grey value, sign of the other edge's side (of both, in an area).
struct List {
    entries: Vec<[f64; 4]>,
    count: usize,
}

impl List {
    /// With room for every pixel of the window, and for a last chunk that is not full.
    fn new(side: usize) -> Self {
        Self { entries: vec![[0.0; 4]; side * side + LANES], count: 0 }
    }

    #[inline(always)]
    fn push_if(&mut self, condition: bool, entry: [f64; 4]) {
        self.entries[self.count] = entry;
        self.count += usize::from(condition);
    }
}

impl<'a, const P: usize, const GRADIENT: bool, const CURVED: bool> Window<'a, P, GRADIENT, CURVED> {
    pub(super) fn new(image: &'a Image, side: usize) -> Self {
        let list = || List::new(side);
        let pixels = Lists { corner: list(), edges: [list(), list()], areas: list() };
        Self { image, left: 0, top: 0, side, grey: vec![0.0; side * side], pixels, patience: EVALUATIONS }
    }

    /// Lays the window around a pixel from which `side / 2` px are in the image.
    pub(super) fn centre_on(&mut self, (x, y): (i64, i64)) {
        let half = self.side as i64 / 2;
        (self.left, self.top) = ((x - half) as usize, (y - half) as usize);
        self.read();
    }

    fn read(&mut self) {
        let (image, left, side) = (self.image, self.left, self.side);
        for (row, grey) in self.grey.chunks_exact_mut(side).enumerate() {
            let from = &image.row(self.top + row)[left..left + side];
            grey.iter_mut().zip(from).for_each(|(grey, from)| *grey = f64::from(*from));
        }
    }

    /// Takes from the grey values what the model leaves out of the pixel's area, as it is at `x`. `None` where the model has no meaning.
    ///
    /// It is at most a few hundredths of the contrast and hardly changes with the unknowns: a fit, a correction anew, and so on come to the same
    /// place as a fit of the whole model.
    pub(super) fn correct(&mut self, x: &SVector<f64, P>) -> Option<()> {
        let shape = shape::<P, GRADIENT, CURVED>(x);
        let (rough, full) = (Model::new(&shape, Fidelity::Rough)?, Model::new(&shape, Fidelity::Full)?);
        self.read();
        correct::<CURVED>(&rough, &full, (&mut self.grey, self.side), x.as_slice(), &mut self.pixels);
        Some(())
    }
}

/// The shape among the unknowns.
pub(super) fn shape<const P: usize, const GRADIENT: bool, const CURVED: bool>(x: &SVector<f64, P>) -> Shape {
    let curvature = if CURVED { [x[P - 2], x[P - 1]] } else { [0.0; 2] };
    Shape { position: [x[0], x[1]], normals: [x[2], x[3]], variance: x[4], curvature }
}

impl<const P: usize, const GRADIENT: bool, const CURVED: bool> Problem<P> for Window<'_, P, GRADIENT, CURVED> {
    fn normal(&mut self, x: &SVector<f64, P>) -> Option<Normal<P>> {
        self.patience = self.patience.checked_sub(1)?;
        let shape = shape::<P, GRADIENT, CURVED>(x);
        let limit = self.side as f64;
        if !(x.iter().all(|value| value.is_finite()) && shape.position.iter().all(|p| p.abs() < limit) && shape.variance < limit * limit) {
            return None;
        }
        let model = Model::new(&shape, Fidelity::Rough)?;
        let view = View { grey: &self.grey, side: self.side };
        let mut sums = Sums::<P>::new();
        add::<P, GRADIENT, CURVED>(&model, view, x.as_slice(), &mut self.pixels, &mut sums);
        Some(sums.normal())
    }

    fn lowest(&self, unknown: usize) -> f64 {
        if unknown == 4 { 0.0 } else { f64::NEG_INFINITY }
    }

    fn redundancy(&self) -> f64 {
        (self.side * self.side - P) as f64
    }
}

/// Grey values of a window.
#[derive(Clone, Copy)]
struct View<'a> {
    grey: &'a [f64],
    side: usize,
}

#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
fn correct<const CURVED: bool>(rough: &Model, full: &Model, (grey, side): (&mut [f64], usize), unknowns: &[f64], lists: &mut Lists) {
    let centre = [unknowns[0], unknowns[1]];
    sort(rough, View { grey, side }, centre, lists);
    let Lists { corner, edges, .. } = lists;
    let lists = [(&*corner, None), (&edges[0], Some(0)), (&edges[1], Some(1))];
    let half = (side / 2) as f64;
    for (list, only) in lists {
        for chunk in list.entries[..list.count].chunks(WIDE) {
            let (mut x, mut y) = ([0.0; WIDE], [0.0; WIDE]);
            for (i, [px, py, ..]) in chunk.iter().enumerate() {
                (x[i], y[i]) = ((px - centre[0]) as f32, (py - centre[1]) as f32);
            }
            let (there, here) = (full.seen(&x, &y), rough.seen(&x, &y));
            let [there, here] = match only {
                None => [full.corner_value::<CURVED>(&there), rough.corner_value::<CURVED>(&here)],
                Some(edge) => [full.edge_value::<CURVED>(edge, &there), rough.edge_value::<CURVED>(edge, &here)],
            };
            for (i, [x, y, _, sign]) in chunk.iter().enumerate() {
                let index = (y + half) as usize * side + (x + half) as usize;
                grey[index] -= unknowns[6] * sign * f64::from(there[i] - here[i]);
            }
        }
    }
}

// In this order: with the wider lanes of double precision it takes three times as long.
#[multiversion(targets("x86_64+avx2", "x86_64+avx512f+avx512vl"))]
fn add<const P: usize, const GRADIENT: bool, const CURVED: bool>(
    model: &Model,
    view: View<'_>,
    unknowns: &[f64],
    lists: &mut Lists,
    sums: &mut Sums<P>,
) {
    sort(model, view, [unknowns[0], unknowns[1]], lists);
    let chunks = Chunks::<P, GRADIENT> { unknowns };
    chunks.add(&lists.corner, sums, |x, y, _| model.corner::<CURVED>(x, y));
    chunks.add(&lists.edges[0], sums, |x, y, side| model.edge::<CURVED>(0, side, x, y));
    chunks.add(&lists.edges[1], sums, |x, y, side| model.edge::<CURVED>(1, side, x, y));
    if GRADIENT {
        chunks.add(&lists.areas, sums, |_, _, side| Field { value: *side, ..Field::default() });
    } else {
        chunks.add_areas(&lists.areas, sums);
    }
}

#[inline(always)]
fn sort(model: &Model, view: View<'_>, [cx, cy]: [f64; 2], lists: &mut Lists) {
    let Lists { corner, edges: [first, second], areas } = lists;
    (corner.count, first.count, second.count, areas.count) = (0, 0, 0, 0);
    let half = (view.side / 2) as f64;
    for row in 0..view.side {
        let grey = &view.grey[row * view.side..(row + 1) * view.side];
        let y = row as f64 - half;
        for (column, grey) in grey.iter().enumerate() {
            let x = column as f64 - half;
            let [u, v] = [model.edges[0].distance(x - cx, y - cy), model.edges[1].distance(x - cx, y - cy)];
            let (by_first, by_second) = (u.abs() < model.reach, v.abs() < model.reach);
            let entry = |side: f64| [x, y, *grey, 1_f64.copysign(side)];
            corner.push_if(by_first && by_second, entry(1.0));
            first.push_if(by_first && !by_second, entry(v));
            second.push_if(!by_first && by_second, entry(u));
            areas.push_if(!by_first && !by_second, entry(1_f64.copysign(u) * v));
        }
    }
}

/// The grey values of all unknowns, chunk by chunk.
struct Chunks<'a, const P: usize, const GRADIENT: bool> {
    unknowns: &'a [f64],
}

impl<const P: usize, const GRADIENT: bool> Chunks<'_, P, GRADIENT> {
    /// Pixels that tell of the two grey values only.
    #[inline(always)]
    fn add_areas(&self, list: &List, sums: &mut Sums<P>) {
        let [mean, half] = [5, 6].map(|i| self.unknowns[i]);
        for first in (0..list.count).step_by(LANES) {
            let (mut one, mut side, mut r) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for i in 0..LANES {
                let [_, _, grey, sign] = list.entries[first + i];
                one[i] = if first + i < list.count { 1.0 } else { 0.0 };
                side[i] = one[i] * sign;
                r[i] = one[i] * (grey - (mean + half * sign));
            }
            sums.add_pair([5, 6], &one, &side, &r);
        }
    }

    #[inline(always)]
    fn add(&self, list: &List, sums: &mut Sums<P>, field: impl Fn(&Lanes, &Lanes, &Lanes) -> Field) {
        let [cx, cy, mean, half] = [0, 1, 5, 6].map(|i| self.unknowns[i]);
        let mut first = 0;
        while first < list.count {
            let (mut x, mut y, mut grey, mut side, mut weight) = ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for i in 0..LANES {
                let [px, py, value, sign] = list.entries[first + i];
                (x[i], y[i], grey[i], side[i]) = (px - cx, py - cy, value, sign);
                // Beyond the list's end lies what an earlier, longer list has left.
                weight[i] = if first + i < list.count { 1.0 } else { 0.0 };
            }
            let field = field(&x, &y, &side);
            let (mut j, mut r) = ([[0.0; LANES]; P], [0.0; LANES]);
            for i in 0..LANES {
                let scale = weight[i] * half;
                for axis in 0..2 {
                    j[axis][i] = scale * field.position[axis][i];
                    j[2 + axis][i] = scale * field.normals[axis][i];
                    // The curvatures are last; without them this is overwritten.
                    j[P - 2 + axis][i] = scale * field.curvature[axis][i];
                }
                j[4][i] = scale * field.variance[i];
                j[5][i] = weight[i];
                j[6][i] = weight[i] * field.value[i];
                let mut model = mean + half * field.value[i];
                if GRADIENT {
                    let slope = [self.unknowns[BASE], self.unknowns[BASE + 1]];
                    j[BASE][i] = weight[i] * x[i];
                    j[BASE + 1][i] = weight[i] * y[i];
                    j[0][i] -= weight[i] * slope[0];
                    j[1][i] -= weight[i] * slope[1];
                    model += slope[0] * x[i] + slope[1] * y[i];
                }
                r[i] = weight[i] * (grey[i] - model);
            }
            sums.add(&j, &r);
            first += LANES;
        }
    }
}
