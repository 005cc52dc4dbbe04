//! Coverage of every pixel by the mask, and its derivatives, by line integrals along the mask's border.

use calibench_model::{Affine, Warp};

use super::area::Grey;
use super::bank::Bank;
use super::border::{self, Bent};
use super::mask::{Mask, Rule};
use super::profile::{LANES, Profile};
use crate::residuals::Structure;

/// Unknowns of the model, in this order: x, y, axx, axy, ayx, ayy, grey value of the ground, contrast, blur.
pub(super) const UNKNOWNS: usize = 9;
/// Plane of ones, the derivative by the ground's grey value; zeros at pixels that do not count, as in all other planes.
pub(super) const GROUND: usize = 6;
/// Plane of coverages, the derivative by the contrast.
pub(super) const COVERAGE: usize = 7;
/// Plane of derivatives by the blur, present if that is unknown.
pub(super) const BLUR: usize = 8;
/// Plane of residuals.
const RESIDUAL: usize = 9;

/// Planes that are multiplied at a time; their number, with that of the blur, is a multiple.
const TILE: usize = 3;

/// Values of every pixel of a window, one plane after the other: derivatives of the coverage (by x to ayy and the blur), ones, coverage, residuals.
#[derive(Clone, Debug)]
pub(super) struct Planes {
    pixels: usize,
    /// From row to row: the window's columns and zeros up to whole lanes.
    stride: usize,
    values: Vec<f32>,
    grey: Vec<f32>,
    /// For each column of a row one, or zero where it is padded.
    inside: Vec<f32>,
    /// Pixels that count.
    counted: usize,
    /// 1 where the mask's place shows, and 0 elsewhere, as of the last question.
    shows: Vec<f32>,
    bank: Bank,
}

/// The planes as [`border`] fills them.
pub(super) struct Window<'a> {
    /// Pixels on a side.
    pub(super) pixels: usize,
    /// From row to row.
    pub(super) stride: usize,
    /// All planes.
    pub(super) values: &'a mut [f32],
}

/// What is worked out beside the coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Derivatives {
    /// Nothing.
    None,
    /// Derivatives by position and shape.
    Pose,
    /// Those and the one by the blur.
    PoseAndBlur,
}

/// What the mask is mapped and blurred by. Positions count from the window's first pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    /// The reference point.
    pub(super) at: [f64; 2],
    /// Mask to image.
    pub(super) affine: Affine,
}

impl Planes {
    /// For a window of `pixels` px on a side.
    pub(super) fn new(pixels: usize) -> Self {
        let stride = pixels.next_multiple_of(LANES);
        let mut inside = vec![0.0; stride];
        inside[..pixels].fill(1.0);
        let mut planes = Self {
            pixels,
            stride,
            values: vec![0.0; (RESIDUAL + 1) * pixels * stride],
            grey: vec![0.0; pixels * stride],
            inside,
            counted: 0,
            shows: vec![0.0; pixels * stride],
            bank: Bank::new(pixels, stride),
        };
        planes.count_all();
        planes
    }

    /// Pixels on a side of the window.
    pub(super) fn side(&self) -> usize {
        self.pixels
    }

    /// Pixels that count.
    pub(super) fn count(&self) -> usize {
        self.counted
    }

    /// All pixels of the window count.
    pub(super) fn count_all(&mut self) {
        if self.counted == self.pixels * self.pixels {
            return;
        }
        let ones = self.values[GROUND * self.pixels * self.stride..].chunks_exact_mut(self.stride).take(self.pixels);
        ones.for_each(|row| row.copy_from_slice(&self.inside));
        self.counted = self.pixels * self.pixels;
    }

    /// Only these pixels count, until others are chosen: for each row a word, from the lowest bit on. All planes are to be drawn anew.
    pub(super) fn count_only(&mut self, pixels: &[u64]) {
        let ones = self.values[GROUND * self.pixels * self.stride..].chunks_exact_mut(self.stride).take(self.pixels);
        for (row, word) in ones.zip(pixels) {
            for (column, one) in row[..self.pixels].iter_mut().enumerate() {
                *one = (word >> column & 1) as f32;
            }
        }
        self.counted = pixels.iter().take(self.pixels).map(|word| word.count_ones() as usize).sum();
    }

    /// Takes the window's grey values; all pixels count.
    pub(super) fn observe<'a>(&mut self, rows: impl Iterator<Item = &'a [f32]>) {
        self.count_all();
        for (row, line) in rows.zip(self.grey.chunks_exact_mut(self.stride)) {
            copy(line, row);
        }
    }

    /// The window's grey values.
    pub(super) fn grey(&self) -> Grey<'_> {
        Grey { side: self.pixels, stride: self.stride, values: &self.grey, inside: &self.inside }
    }

    fn area(&self) -> usize {
        self.pixels * self.stride
    }

    /// One plane, with its padding.
    fn plane(&self, index: usize) -> &[f32] {
        &self.values[index * self.area()..(index + 1) * self.area()]
    }

    /// Three planes from one on.
    #[inline(always)]
    fn tile(&self, first: usize) -> [&[f32]; TILE] {
        [self.plane(first), self.plane(first + 1), self.plane(first + 2)]
    }

    /// Coverage for a mask, and of its derivatives those that are asked for: the others keep what they were.
    pub(super) fn draw(&mut self, mask: &Mask, (pose, warp): (&Pose, Option<&Warp>), profile: &Profile, wanted: (Derivatives, Rule)) {
        let window = Window { pixels: self.pixels, stride: self.stride, values: &mut self.values };
        border::draw(window, &mut self.bank, mask, &Bent { pose, warp }, profile, wanted);
    }

    /// Ground and contrast that fit the coverages best; `None` if these do not differ.
    pub(super) fn levels(&self) -> Option<(f64, f64)> {
        let (ones, coverage, n) = (self.plane(GROUND), self.plane(COVERAGE), self.count() as f64);
        let (c, cc) = (dot(ones, coverage), dot(coverage, coverage));
        let (g, cg) = (dot(ones, &self.grey), dot(coverage, &self.grey));
        let determinant = n * cc - c * c;
        (determinant > 1e-9 * n * n).then(|| ((cc * g - c * cg) / determinant, (n * cg - c * g) / determinant))
    }

    /// Sum of squared residuals for these levels, and the residuals, ready for [`Self::right`].
    pub(super) fn compare(&mut self, ground: f64, contrast: f64) -> f64 {
        let area = self.area();
        let (before, residual) = self.values.split_at_mut(RESIDUAL * area);
        let (ones, coverage) = (&before[GROUND * area..(GROUND + 1) * area], &before[COVERAGE * area..(COVERAGE + 1) * area]);
        subtract(&mut residual[..area], [&self.grey, ones, coverage], [ground as f32, contrast as f32])
    }

    /// The structure of the residuals of the last comparison where the mask's place shows, in units of `unit`, a grey value: what stands apart from the
    /// mask's border does not move it.
    pub(super) fn structure(&mut self, unit: f64) -> Structure {
        let area = self.area();
        let (before, residual) = self.values.split_at_mut(RESIDUAL * area);
        let by = [0, 1].map(|plane| &before[plane * area..(plane + 1) * area]);
        Structure::of_outline(by, &mut residual[..area], &mut self.shows, (self.stride, 1.0 / unit))
    }

    /// Sums of products of two planes, before the contrast scales the derivatives, and of each with the residuals: of the first `unknowns`.
    pub(super) fn products(&self, unknowns: usize) -> ([[f64; UNKNOWNS]; UNKNOWNS], [f64; UNKNOWNS]) {
        products(self, unknowns)
    }

    /// The structure of all residuals of the last comparison.
    pub(super) fn structure_of_all(&self) -> Structure {
        Structure::of_all(self.plane(RESIDUAL), self.plane(GROUND), self.stride)
    }

    /// Row by row, the grey values and the coverages.
    pub(super) fn rows(&self) -> impl Iterator<Item = (&[f32], &[f32])> {
        let rows = self.grey.chunks_exact(self.stride).zip(self.plane(COVERAGE).chunks_exact(self.stride));
        rows.map(|(grey, coverage)| (&grey[..self.pixels], &coverage[..self.pixels]))
    }

    /// The value of `plane` at a pixel.
    #[cfg(test)]
    pub(super) fn at(&self, plane: usize, column: usize, row: usize) -> f64 {
        f64::from(self.plane(plane)[row * self.stride + column])
    }
}

/// Copies a row by pieces of a length that the compiler knows, the last of which may overlap: otherwise each row is a call.
fn copy(to: &mut [f32], row: &[f32]) {
    const PIECE: usize = 8;
    let Some(last) = row.len().checked_sub(PIECE) else { return to[..row.len()].copy_from_slice(row) };
    for start in (0..last).step_by(PIECE).chain([last]) {
        to[start..start + PIECE].copy_from_slice(&row[start..start + PIECE]);
    }
}

/// Residuals, and the sum of their squares.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn subtract(residual: &mut [f32], [grey, ones, coverage]: [&[f32]; 3], [ground, contrast]: [f32; 2]) -> f64 {
    for (((to, grey), one), c) in residual.iter_mut().zip(grey).zip(ones).zip(coverage) {
        *to = (grey - ground) * one - contrast * c;
    }
    dot(residual, residual)
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn products(planes: &Planes, unknowns: usize) -> ([[f64; UNKNOWNS]; UNKNOWNS], [f64; UNKNOWNS]) {
    let (mut products, mut right) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
    // By tiles whose sums stay in registers: one sum alone would wait for each of its additions.
    for i in (0..unknowns).step_by(TILE) {
        for j in (0..=i).step_by(TILE) {
            let other = planes.tile(j);
            let mut put = |row: usize, sums: [f64; TILE]| {
                for (column, sum) in (j..unknowns).zip(sums) {
                    (products[row][column], products[column][row]) = (sum, sum);
                }
            };
            if i + 2 == unknowns {
                let sums = tile([planes.plane(i), planes.plane(i + 1)], other);
                (i..).zip(sums).for_each(|(row, sums)| put(row, sums));
            } else {
                let sums = tile(planes.tile(i), other);
                (i..).zip(sums).for_each(|(row, sums)| put(row, sums));
            }
        }
        let [sums] = tile([planes.plane(RESIDUAL)], planes.tile(i));
        right[i..].iter_mut().zip(sums).for_each(|(right, sum)| *right = sum);
    }
    (products, right)
}

/// Sums of products of each of `one` with each of `other`.
#[inline(always)]
fn tile<const N: usize>(one: [&[f32]; N], other: [&[f32]; TILE]) -> [[f64; TILE]; N] {
    let mut sums = [[[0.0_f32; LANES]; TILE]; N];
    for start in (0..other[0].len()).step_by(LANES) {
        let lanes = |values: &[f32]| -> [f32; LANES] { values[start..start + LANES].try_into().expect("whole lanes") };
        let (one, other) = (one.map(lanes), other.map(lanes));
        for n in 0..N {
            for t in 0..TILE {
                for lane in 0..LANES {
                    sums[n][t][lane] += one[n][lane] * other[t][lane];
                }
            }
        }
    }
    sums.map(|sums| sums.map(|sums| total(&sums)))
}

#[inline(always)]
fn dot(a: &[f32], b: &[f32]) -> f64 {
    dots(a, [b])[0]
}

/// Of `a` with each of `others`: sums of `LANES` products side by side, which are added up in double precision.
#[inline(always)]
fn dots<const N: usize>(a: &[f32], others: [&[f32]; N]) -> [f64; N] {
    let mut sums = [[0.0_f32; LANES]; N];
    for start in (0..a.len()).step_by(LANES) {
        let lanes = |values: &[f32]| -> [f32; LANES] { values[start..start + LANES].try_into().expect("whole lanes") };
        let here = lanes(a);
        for n in 0..N {
            let there = lanes(others[n]);
            for lane in 0..LANES {
                sums[n][lane] += here[lane] * there[lane];
            }
        }
    }
    sums.map(|sums| total(&sums))
}

/// The lanes added up in double precision.
#[inline(always)]
fn total(sums: &[f32; LANES]) -> f64 {
    let mut halves = [0.0; LANES / 2];
    for (i, half) in halves.iter_mut().enumerate() {
        *half = f64::from(sums[i]) + f64::from(sums[i + LANES / 2]);
    }
    let [a, b, c, d, e, f, g, h] = halves;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}
