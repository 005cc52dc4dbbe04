//! The normal equations of a junction over one window.
//!
//! They are those of a model that takes the photosite's area for one Gaussian. What that leaves out is worked out once in a while and taken from the grey
//! values: see [`Laid::correct`].

use calibench_model::Image;
use multiversion::multiversion;
use nalgebra::SVector;

use super::arms::{Field, MOST, Model};
use super::gram::{Columns, Gram};
use super::lists::{ALONG, AREAS, Chunk, Lists, NEAR};
use super::unknowns::{Levels, Unknowns, WIDEST};
use crate::following::Laid;
use crate::gradient::{EACH, EVEN, LIGHT};
use crate::grey_window::GreyWindow;
use crate::lanes::{WIDE, Wide};
use crate::marquardt::{Normal, Problem};
use crate::photosite::Fidelity;
use crate::residuals::Residuals;

/// How often the normal equations of one junction are set up at most.
const EVALUATIONS: usize = 80;
/// What single precision leaves of a residual, in units of half the contrast.
const PRECISION: f64 = 2e-7;

/// One window of an image, as the least-squares problem of `P` unknowns.
pub(super) struct Window<'a, const P: usize> {
    unknowns: Unknowns,
    photosite: f64,
    /// Grey values, corrected.
    greys: GreyWindow<'a>,
    lists: Lists,
    /// How often the normal equations may still be set up.
    patience: usize,
}

impl<'a, const P: usize> Window<'a, P> {
    /// Of `side` px; `mean` and `half` are about the mean of the grey values and half their difference.
    pub(super) fn new(image: &'a Image, side: usize, unknowns: Unknowns, photosite: f64, [mean, half]: [f64; 2]) -> Self {
        debug_assert_eq!(unknowns.count(), P);
        Self { unknowns, photosite, greys: GreyWindow::new(image, side, mean, half), lists: Lists::new(side), patience: EVALUATIONS }
    }

    fn model(&self, x: &SVector<f64, P>, fidelity: Fidelity) -> Option<Model<f32>> {
        Model::new(&self.unknowns.shape(x.as_slice(), self.photosite), fidelity)
    }

    fn levels(&self, x: &SVector<f64, P>) -> Levels {
        self.unknowns.levels(x.as_slice(), -self.greys.mean / self.greys.half)
    }

    /// The range of the window's grey values.
    pub(super) fn range(&self) -> f64 {
        let ends = self.greys.grey.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], grey| [low.min(*grey), high.max(*grey)]);
        f64::from(ends[1] - ends[0])
    }

    /// The residuals of the corrected grey values at `x`, in units of half of `contrast`. `None` where the model has no meaning.
    pub(super) fn residuals(&mut self, x: &SVector<f64, P>, contrast: f64) -> Option<Residuals> {
        let model = self.model(x, Fidelity::Rough)?;
        let (levels, side) = (self.levels(x), self.greys.side);
        let mut grey = vec![0.0; side * side];
        leave(&model, &levels, [x[0] as f32, x[1] as f32], (&self.greys.grey, &mut grey, side), &mut self.lists);
        grey.iter_mut().for_each(|r| *r /= (0.5 * contrast) as f32);
        Some(Residuals { grey, side })
    }
}

impl<const P: usize> Laid<P> for Window<'_, P> {
    fn centre_on(&mut self, pixel: (i64, i64)) {
        self.greys.centre_on(pixel);
    }

    fn correct(&mut self, x: &SVector<f64, P>) -> Option<()> {
        let models = [self.model(x, Fidelity::Rough)?, self.model(x, Fidelity::Full)?];
        self.greys.read();
        let (levels, side) = (self.levels(x), self.greys.side);
        correct(&models, &levels, [x[0] as f32, x[1] as f32], (&mut self.greys.grey, side), &mut self.lists);
        Some(())
    }
}

impl<const P: usize> Problem<P> for Window<'_, P> {
    fn normal(&mut self, x: &SVector<f64, P>) -> Option<Normal<P>> {
        self.patience = self.patience.checked_sub(1)?;
        let limit = self.greys.side as f64;
        let inside = x.as_slice()[..2].iter().all(|p| p.abs() < limit) && x[self.unknowns.variance()] < limit * limit;
        if !(inside && x.iter().all(|value| value.is_finite())) {
            return None;
        }
        let model = self.model(x, Fidelity::Rough)?;
        let (levels, mut gram) = (self.levels(x), Gram::new(P));
        add(&model, &levels, [x[0] as f32, x[1] as f32], (&self.greys.grey, self.greys.side), &mut self.lists, &mut gram);
        Some(gram.normal())
    }

    fn lowest(&self, unknown: usize) -> f64 {
        if unknown == self.unknowns.variance() { 0.0 } else { f64::NEG_INFINITY }
    }

    fn redundancy(&self) -> f64 {
        (self.greys.side * self.greys.side - P) as f64
    }

    fn same(&self, omega: f64) -> f64 {
        let pixels = (self.greys.side * self.greys.side) as f64;
        omega + 4.0 * PRECISION * omega.sqrt() + pixels * PRECISION * PRECISION
    }
}

#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
fn correct([rough, full]: &[Model<f32>; 2], levels: &Levels, centre: [f32; 2], (grey, side): (&mut [f32], usize), lists: &mut Lists) {
    // As far as the mixture of Gaussians reaches.
    lists.sort(if full.reach > rough.reach { full } else { rough }, (grey, side), centre);
    for kind in [NEAR, ALONG] {
        for (chunk, count) in lists.chunks(kind) {
            let (there, here) = if kind == NEAR {
                (full.shares::<WIDE, true>(&chunk.x, &chunk.y), rough.shares::<WIDE, true>(&chunk.x, &chunk.y))
            } else {
                (full.shares::<WIDE, false>(&chunk.x, &chunk.y), rough.shares::<WIDE, false>(&chunk.x, &chunk.y))
            };
            let mut left_out = [0.0; WIDE];
            for sector in 0..rough.count {
                for i in 0..WIDE {
                    let (x, y) = (chunk.x[i], chunk.y[i]);
                    let level = levels.of_sector(sector, x, y) * (1.0 + levels.common(x, y).1);
                    left_out[i] += level * (there[sector][i] - here[sector][i]);
                }
            }
            for (index, left_out) in chunk.index.iter().zip(&left_out).take(count) {
                grey[usize::from(*index)] -= left_out;
            }
        }
    }
}

#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
fn leave(model: &Model<f32>, levels: &Levels, centre: [f32; 2], (grey, into, side): (&[f32], &mut [f32], usize), lists: &mut Lists) {
    lists.sort(model, (grey, side), centre);
    for kind in [NEAR, ALONG, AREAS] {
        for (chunk, count) in lists.chunks(kind) {
            let shares =
                if kind == NEAR { model.shares::<WIDE, true>(&chunk.x, &chunk.y) } else { model.shares::<WIDE, false>(&chunk.x, &chunk.y) };
            let value = value(levels, chunk, &shares);
            for i in 0..count {
                into[usize::from(chunk.index[i])] = chunk.grey[i] - value[i];
            }
        }
    }
}

/// The grey values of a chunk.
#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "many arrays side by side")]
fn value(levels: &Levels, chunk: &Chunk, shares: &[Wide; MOST]) -> Wide {
    let mut value = [0.0; WIDE];
    for (sector, share) in shares.iter().enumerate().take(levels.unknowns.arms) {
        for i in 0..WIDE {
            value[i] += levels.of_sector(sector, chunk.x[i], chunk.y[i]) * share[i];
        }
    }
    for i in 0..WIDE {
        let (added, brighter) = levels.common(chunk.x[i], chunk.y[i]);
        value[i] += (value[i] - levels.black) * brighter + added;
    }
    value
}

#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
fn add(model: &Model<f32>, levels: &Levels, centre: [f32; 2], window: (&[f32], usize), lists: &mut Lists, gram: &mut Gram) {
    lists.sort(model, window, centre);
    let first = if levels.unknowns.gradient == EVEN { levels.unknowns.grey(0) } else { 0 };
    for (chunk, count) in lists.chunks(NEAR) {
        rows(model, levels, (chunk, count), &model.field::<WIDE, true>(&chunk.x, &chunk.y), (gram, 0));
    }
    for (kind, first) in [(ALONG, 0), (AREAS, first)] {
        for (chunk, count) in lists.chunks(kind) {
            rows(model, levels, (chunk, count), &model.field::<WIDE, false>(&chunk.x, &chunk.y), (gram, first));
        }
    }
}

/// The observation equations of a chunk.
#[inline(always)]
fn rows(model: &Model<f32>, levels: &Levels, (chunk, count): (&Chunk, usize), field: &Field<f32, WIDE>, (gram, first): (&mut Gram, usize)) {
    let unknowns = levels.unknowns;
    let mut j: Columns = [[0.0; WIDE]; WIDEST];
    let (mut weight, mut gain) = ([0.0; WIDE], [0.0; WIDE]);
    for i in 0..WIDE {
        weight[i] = if i < count { 1.0 } else { 0.0 };
        gain[i] = weight[i] * (1.0 + levels.common(chunk.x[i], chunk.y[i]).1);
    }
    if first == 0 {
        let by_variance = -0.5 / model.variance();
        let (mut by_x, mut by_y, mut soft) = ([0.0; WIDE], [0.0; WIDE], [0.0; WIDE]);
        for (k, arm) in model.arms().iter().enumerate() {
            let before = if k == 0 { model.count - 1 } else { k - 1 };
            let direction = &mut j[unknowns.direction(k)];
            let (slopes, turns, across) = (&field.slopes[k], &field.turns[k], &field.across[k]);
            for i in 0..WIDE {
                let (x, y) = (chunk.x[i], chunk.y[i]);
                let jump = gain[i] * (levels.of_sector(k, x, y) - levels.of_sector(before, x, y));
                let slope = jump * slopes[i];
                by_x[i] += slope * arm.y;
                by_y[i] -= slope * arm.x;
                soft[i] += by_variance * slope * across[i];
                direction[i] -= jump * turns[i];
            }
        }
        (j[0], j[1], j[unknowns.variance()]) = (by_x, by_y, soft);
    }
    for sector in 0..unknowns.arms {
        for i in 0..WIDE {
            j[unknowns.grey(sector)][i] = gain[i] * field.shares[sector][i];
        }
    }
    let value = value(levels, chunk, &field.shares);
    if unknowns.gradient != EVEN {
        change(levels, (chunk, &weight), (&value, &field.shares), &mut j);
    }
    let mut r = [0.0; WIDE];
    for i in 0..WIDE {
        r[i] = weight[i] * (chunk.grey[i] - value[i]);
    }
    gram.add(&j, &r, first);
}

/// The derivatives by what changes linearly, and by the position what it does through that.
#[inline(always)]
fn change(levels: &Levels, (chunk, weight): (&Chunk, &Wide), (value, shares): (&Wide, &[Wide; MOST]), j: &mut Columns) {
    let unknowns = levels.unknowns;
    for (axis, place) in [&chunk.x, &chunk.y].into_iter().enumerate() {
        if unknowns.gradient == EACH {
            for sector in 0..unknowns.arms {
                for i in 0..WIDE {
                    let share = weight[i] * shares[sector][i];
                    j[axis][i] -= share * levels.slopes[sector][axis];
                    j[unknowns.slope() + 2 * sector + axis][i] = share * place[i];
                }
            }
        } else {
            for i in 0..WIDE {
                let light = 1.0 + levels.common(chunk.x[i], chunk.y[i]).1;
                // The grey value above black, in the light at the point.
                let scale = if unknowns.gradient == LIGHT { (value[i] - levels.black) / light } else { 1.0 };
                j[axis][i] -= weight[i] * scale * levels.common[axis];
                j[unknowns.slope() + axis][i] = weight[i] * scale * place[i];
            }
        }
    }
}
