//! The normal equations of a chess corner over one window.
//!
//! They are those of a model that takes the photosite's area for one Gaussian. What that leaves out is worked out once in a while and taken from the grey
//! values: see [`Laid::correct`].

use calibench_model::{Image, Warp};
use nalgebra::SVector;

use super::area::Strip;
use super::fields::{corner, edge};
use super::levels::Levels;
use super::lists::{AREAS, CORNER, EDGES, List, Lists};
use super::model::{BASE, Fidelity, Field, Model, Shape};
use super::sums::Sums;
use crate::following::Laid;
use crate::gradient::{ADDED, EACH, EVEN, LIGHT};
use crate::grey_window::GreyWindow;
use crate::lanes::{BLOCK, Block, WIDE, half_of, less};
use crate::marquardt::{Normal, Problem};

/// The widest window, px.
pub(super) const WIDEST: usize = 41;
/// How often the normal equations of one corner are set up at most. Where the model fits, three to thirteen times were needed; without any blur, more.
const EVALUATIONS: usize = 60;
/// What single precision leaves of a residual, in units of half the contrast.
const PRECISION: f64 = 2e-7;

/// What is the same for every fit of an image: side of the window and of the photosites, px; grey values that are about the mean of the two and half their
/// difference; and what curves the edges where that is told and not estimated.
#[derive(Clone, Copy)]
pub(super) struct Setting {
    pub(super) side: usize,
    pub(super) photosite: f64,
    pub(super) mean: f64,
    pub(super) half: f64,
    pub(super) warp: Option<Warp>,
}

/// How many unknowns there are with this gradient and without curvatures.
pub(super) const fn straight_unknowns(gradient: u8) -> usize {
    match gradient {
        EVEN => BASE,
        ADDED | LIGHT => BASE + 2,
        _ => BASE + 4,
    }
}

/// One window of an image, as the least-squares problem of `P` unknowns: the [`BASE`], those of the `GRADIENT`, and a curvature an edge if there is room; else curvatures, if `CURVED`, are
/// those that are told.
pub(super) struct Window<'a, const P: usize, const GRADIENT: u8, const CURVED: bool> {
    pub(super) setting: Setting,
    /// Grey values, corrected.
    pub(super) greys: GreyWindow<'a>,
    pub(super) pixels: Lists,
    /// The unknowns for which they are sorted.
    pub(super) sorted: Option<SVector<f64, P>>,
    /// How often the normal equations may still be set up.
    pub(super) patience: usize,
}

impl<'a, const P: usize, const GRADIENT: u8, const CURVED: bool> Window<'a, P, GRADIENT, CURVED> {
    /// Whether curvatures are unknown.
    pub(super) const FREE: bool = CURVED && P > straight_unknowns(GRADIENT);

    pub(super) fn new(image: &'a Image, setting: Setting) -> Self {
        let Setting { side, mean, half, .. } = setting;
        Self { setting, greys: GreyWindow::new(image, side, mean, half), pixels: Lists::new(side), sorted: None, patience: EVALUATIONS }
    }

    /// The shape among the unknowns.
    pub(super) fn shape(&self, x: &SVector<f64, P>) -> Shape {
        let told = |warp: Warp| [x[2], x[3]].map(|normal| warp.curvature([normal.cos(), normal.sin()]));
        let curvature = if Self::FREE { [x[P - 2], x[P - 1]] } else { self.setting.warp.map_or([0.0; 2], told) };
        let photosite = self.setting.photosite;
        Shape { position: [x[0], x[1]], normals: [x[2], x[3]], variance: x[4], curvature, photosite }
    }

    pub(super) fn levels(&self, x: &SVector<f64, P>) -> Levels {
        Levels::of::<GRADIENT>(x.as_slice(), -self.setting.mean / self.setting.half)
    }
}

impl<const P: usize, const GRADIENT: u8, const CURVED: bool> Problem<P> for Window<'_, P, GRADIENT, CURVED> {
    fn normal(&mut self, x: &SVector<f64, P>) -> Option<Normal<P>> {
        self.patience = self.patience.checked_sub(1)?;
        let shape = self.shape(x);
        let limit = self.setting.side as f64;
        if !(x.iter().all(|value| value.is_finite()) && shape.position.iter().all(|p| p.abs() < limit) && shape.variance < limit * limit) {
            return None;
        }
        let model = Model::new(&shape, Fidelity::Rough)?;
        let (levels, centre) = (self.levels(x), shape.position.map(|p| p as f32));
        let unsorted = (self.sorted != Some(*x)).then_some(&self.greys.grey[..]);
        self.sorted = Some(*x);
        Some(normal::<P, GRADIENT, CURVED>(&model, &levels, centre, unsorted, &mut self.pixels))
    }

    fn lowest(&self, unknown: usize) -> f64 {
        if unknown == 4 { 0.0 } else { f64::NEG_INFINITY }
    }

    fn redundancy(&self) -> f64 {
        (self.setting.side * self.setting.side - P) as f64
    }

    fn same(&self, omega: f64) -> f64 {
        let pixels = (self.setting.side * self.setting.side) as f64;
        omega + 4.0 * PRECISION * omega.sqrt() + pixels * PRECISION * PRECISION
    }
}

impl<const P: usize, const GRADIENT: u8, const CURVED: bool> Laid<P> for Window<'_, P, GRADIENT, CURVED> {
    fn centre_on(&mut self, pixel: (i64, i64)) {
        self.greys.centre_on(pixel);
        self.sorted = None;
    }

    fn correct(&mut self, x: &SVector<f64, P>) -> Option<()> {
        let shape = self.shape(x);
        let models = [Model::new(&shape, Fidelity::Rough)?, Model::new(&shape, Fidelity::Full)?];
        self.greys.read();
        let levels = self.levels(x);
        let centre = shape.position.map(|p| p as f32);
        let strips = [Strip::of(&shape, 0), Strip::of(&shape, 1)];
        correct::<GRADIENT, CURVED>((&models, &strips), &levels, centre, (&mut self.greys.grey, self.setting.side), &mut self.pixels);
        self.sorted = Some(*x);
        Some(())
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn correct<const GRADIENT: u8, const CURVED: bool>(
    ([rough, full], strips): (&[Model<f32>; 2], &[Strip; 2]),
    levels: &Levels,
    [cx, cy]: [f32; 2],
    (grey, side): (&mut [f32], usize),
    lists: &mut Lists,
) {
    lists.sort(rough, grey, [cx, cy]);
    let half = (side / 2) as f32;
    for (kind, only) in [(CORNER, None), (EDGES[0], Some(0)), (EDGES[1], Some(1))] {
        for first in lists.firsts(kind) {
            let (chunk, count) = lists.chunk(kind, first);
            let (x, y) = (less(chunk.x, cx), less(chunk.y, cy));
            let (there, here) = (full.seen(&x, &y), rough.seen(&x, &y));
            let [there, here] = match only {
                None => [full.corner_value::<CURVED>(&there), rough.corner_value::<CURVED>(&here)],
                Some(edge) if CURVED => [full.edge_value::<true>(edge, &there), rough.edge_value::<true>(edge, &here)],
                Some(edge) => [strips[edge].value(&there.straight[edge]), rough.edge_value::<false>(edge, &here)],
            };
            let (places, mut left_out) = (chunk.places((half, side)), [0.0; BLOCK]);
            for i in 0..BLOCK {
                left_out[i] = levels.at::<GRADIENT>(x[i], y[i]).half * chunk.side[i] * (there[i] - here[i]);
            }
            for i in 0..count {
                grey[places[i] as usize] -= left_out[i];
            }
            lists.take(kind, first, &left_out);
        }
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn normal<const P: usize, const GRADIENT: u8, const CURVED: bool>(
    model: &Model<f32>,
    levels: &Levels,
    centre: [f32; 2],
    unsorted: Option<&[f32]>,
    lists: &mut Lists,
) -> Normal<P> {
    if let Some(grey) = unsorted {
        lists.sort(model, grey, centre);
    }
    let mut sums = Sums::<P>::new();
    let rows = Rows::<P, GRADIENT> { levels, centre };
    rows.add::<P, CURVED>(lists.list(CORNER), &mut sums, |x, y, _| corner::<CURVED>(model, x, y));
    rows.add::<3, CURVED>(lists.list(EDGES[0]), &mut sums, |x, y, side| edge::<CURVED>(model, 0, side, x, y));
    rows.add::<2, CURVED>(lists.list(EDGES[1]), &mut sums, |x, y, side| edge::<CURVED>(model, 1, side, x, y));
    if GRADIENT == EVEN {
        rows.add_areas(lists.list(AREAS), &mut sums);
    } else {
        rows.add::<P, CURVED>(lists.list(AREAS), &mut sums, |_, _, side| Field::constant(*side));
    }
    sums.normal()
}

/// The observation equations of pixels.
struct Rows<'a, const P: usize, const GRADIENT: u8> {
    levels: &'a Levels,
    centre: [f32; 2],
}

impl<const P: usize, const GRADIENT: u8> Rows<'_, P, GRADIENT> {
    /// Pixels that tell of the two grey values only.
    #[inline(always)]
    fn add_areas(&self, list: List<'_>, sums: &mut Sums<P>) {
        for (chunk, count) in list.chunks() {
            self.add_half_area::<0>((chunk.grey, chunk.side, count), sums);
            if count > WIDE {
                self.add_half_area::<WIDE>((chunk.grey, chunk.side, count), sums);
            }
        }
    }

    #[inline(always)]
    fn add_half_area<const BEGIN: usize>(&self, (grey, which, count): (&Block, &Block, usize), sums: &mut Sums<P>) {
        let (mut one, mut side, mut r) = ([0.0; WIDE], [0.0; WIDE], [0.0; WIDE]);
        for i in 0..WIDE {
            one[i] = if BEGIN + i < count { 1.0 } else { 0.0 };
            side[i] = one[i] * which[BEGIN + i];
            r[i] = one[i] * (grey[BEGIN + i] - (self.levels.mean + self.levels.half * which[BEGIN + i]));
        }
        sums.add_pair([5, 6], &one, &side, &r);
    }

    /// Pixels of one list, whose grey values do not tell of unknown `NONE`. `LOOPED`, the sums of all unknowns are compiled once for both halves of a chunk: a tenth slower, and
    /// built in half the time.
    #[inline(always)]
    fn add<const NONE: usize, const LOOPED: bool>(
        &self,
        list: List<'_>,
        sums: &mut Sums<P>,
        field: impl Fn(&Block, &Block, &Block) -> Field<f32, BLOCK>,
    ) {
        for (chunk, count) in list.chunks() {
            let [x, y] = [less(chunk.x, self.centre[0]), less(chunk.y, self.centre[1])];
            let field = field(&x, &y, chunk.side);
            if LOOPED {
                for half in 0..count.div_ceil(WIDE) {
                    let (x, y, grey) = (half_of(&x, half), half_of(&y, half), half_of(chunk.grey, half));
                    self.add_wide::<NONE, 0, WIDE>((x, y), (grey, count - half * WIDE), &field.half(half), sums);
                }
            } else {
                self.add_wide::<NONE, 0, BLOCK>((&x, &y), (chunk.grey, count), &field, sums);
                if count > WIDE {
                    self.add_wide::<NONE, WIDE, BLOCK>((&x, &y), (chunk.grey, count), &field, sums);
                }
            }
        }
    }

    /// [`WIDE`] pixels from `BEGIN` on, of which those below `count` take part, at (`x`, `y`) from the corner.
    #[inline(always)]
    fn add_wide<const NONE: usize, const BEGIN: usize, const N: usize>(
        &self,
        (x, y): (&[f32; N], &[f32; N]),
        (grey, count): (&[f32; N], usize),
        field: &Field<f32, N>,
        sums: &mut Sums<P>,
    ) {
        let levels = self.levels;
        let (mut j, mut r) = ([[0.0; WIDE]; P], [0.0; WIDE]);
        for i in 0..WIDE {
            let at = BEGIN + i;
            let weight = if at < count { 1.0 } else { 0.0 };
            let (value, level) = (field.value[at], levels.at::<GRADIENT>(x[at], y[at]));
            let scale = weight * level.half;
            for axis in 0..2 {
                j[axis][i] = scale * field.position[axis][at];
                j[2 + axis][i] = scale * field.normals[axis][at];
                // The curvatures are last; where they are not unknown this is overwritten.
                j[P - 2 + axis][i] = scale * field.curvature[axis][at];
            }
            j[4][i] = scale * field.variance[at];
            j[5][i] = weight * level.gain;
            j[6][i] = weight * level.gain * value;
            for (axis, d) in [x[at], y[at]].into_iter().enumerate() {
                if matches!(GRADIENT, ADDED | LIGHT | EACH) {
                    let [first, second] = levels.by_slopes::<GRADIENT>(d, value);
                    j[axis][i] += weight * levels.by_position::<GRADIENT>(axis, value);
                    j[BASE + axis][i] = weight * first;
                    if GRADIENT == EACH {
                        j[BASE + 2 + axis][i] = weight * second;
                    }
                }
            }
            r[i] = weight * (grey[at] - (level.mean + level.half * value));
        }
        sums.add::<NONE>(&j, &r);
    }
}
