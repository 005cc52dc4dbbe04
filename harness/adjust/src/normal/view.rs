//! The observation equations of one image.

use calibench_model::Pose;
use multiversion::multiversion;
use nalgebra::Matrix3;

use super::gram::{BLOCK, LANES, gram};
use super::optics::{Optics, POSE, Pictured};
use super::robust::Loss;
use crate::network::Sight;

/// An image point that the values do not picture: its place among the sights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Lost(pub(crate) usize);

/// White rows `A dx = w` of an image and their normal equations. Columns: pose, unknown parameters of the camera, misclosure `w = observed - computed`,
/// and, to make their number even, one of zeros.
#[derive(Default)]
pub(super) struct View {
    points: Vec<[f64; 3]>,
    pictured: Pictured,
    rows: Vec<f64>,
    /// Columns of the camera's derivatives that are wanted.
    places: Vec<usize>,
    /// `R^T R`, row by row, lower triangle.
    products: Vec<f64>,
    pub(super) columns: usize,
    pub(super) cost: f64,
}

/// What a view is linearised with.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a> {
    pub(super) optics: &'a Optics,
    pub(super) pose: &'a Pose,
    /// Unknown parameters.
    pub(super) free: &'a [usize],
    pub(super) loss: Loss,
}

/// Of what a sight is made here: its residuals (computed - observed, px) and its robust weight.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Residual {
    pub(crate) px: [f64; 2],
    pub(crate) weight: f64,
}

impl View {
    pub(super) fn linearise(
        &mut self,
        setting: Setting,
        sights: &[Sight],
        points: &[nalgebra::Point3<f64>],
        residuals: &mut [Residual],
    ) -> Result<(), Lost> {
        self.points.clear();
        self.points.extend(sights.iter().map(|sight| <[f64; 3]>::from(points[sight.point].coords)));
        setting.optics.picture(setting.pose, &self.points, &mut self.pictured);
        if let Some(i) = self.pictured.pixels.iter().position(|pixel| !pixel.is_finite()) {
            return Err(Lost(i));
        }
        self.places.clear();
        self.places.extend((0..POSE).chain(setting.free.iter().map(|i| POSE + i)));
        self.columns = (POSE + setting.free.len() + 1).next_multiple_of(2);
        self.rows.clear();
        self.rows.resize(sights.len().div_ceil(LANES) * self.columns * BLOCK, 0.0);
        self.cost = 0.0;
        let pixels = self.pictured.pixels.chunks(LANES);
        let blocks = self.rows.chunks_exact_mut(self.columns * BLOCK).zip(self.pictured.blocks());
        for ((((rows, from), pixels), sights), residuals) in blocks.zip(pixels).zip(sights.chunks(LANES)).zip(residuals.chunks_mut(LANES)) {
            let mut white = [[0.0; LANES]; 3];
            for (lane, ((sight, pixel), residual)) in sights.iter().zip(pixels).zip(residuals).enumerate() {
                residual.px = [pixel.x - sight.at[0], pixel.y - sight.at[1]];
                let [a, b, c] = sight.whiten;
                let v = [a * residual.px[0], b * residual.px[0] + c * residual.px[1]];
                let (cost, weight) = setting.loss.of(v[0] * v[0] + v[1] * v[1]);
                residual.weight = weight;
                self.cost += cost;
                let root = weight.sqrt();
                (white[0][lane], white[1][lane], white[2][lane]) = (a * root, b * root, c * root);
                let last = (POSE + setting.free.len()) * BLOCK + lane;
                (rows[last], rows[last + LANES]) = (-v[0] * root, -v[1] * root);
            }
            whiten(&white, &self.places, from, rows);
        }
        Ok(())
    }

    /// Sums the products of the columns.
    pub(super) fn sum(&mut self) {
        self.products.resize(self.columns * self.columns, 0.0);
        gram(&self.rows, self.columns, &mut self.products);
    }

    /// The product of two columns.
    pub(super) fn product(&self, i: usize, j: usize) -> f64 {
        let (high, low) = (i.max(j), i.min(j));
        self.products[high * self.columns + low]
    }

    /// White derivatives of a sight by its point, zero along what may not change; the rows must be those of `rotation`.
    #[inline]
    pub(super) fn by_point(&self, sight: usize, rotation: &Matrix3<f64>, free: [bool; 3]) -> [[f64; 2]; 3] {
        // d N = M dX: what a shift along the camera's axes does, turned.
        let shift: [[f64; 2]; 3] = std::array::from_fn(|column| self.at(sight, 3 + column));
        std::array::from_fn(|axis| {
            let along = |row: usize| (0..3).map(|k| shift[k][row] * rotation[(k, axis)]).sum();
            if free[axis] { [along(0), along(1)] } else { [0.0; 2] }
        })
    }

    /// White derivatives of a sight by a column: x and y.
    #[inline]
    pub(super) fn at(&self, sight: usize, column: usize) -> [f64; 2] {
        let first = (sight / LANES * self.columns + column) * BLOCK + sight % LANES;
        [self.rows[first], self.rows[first + LANES]]
    }
}

/// Copies the columns `places` of a block, made white.
#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
fn whiten([a, b, c]: &[[f64; LANES]; 3], places: &[usize], from: &[f64], into: &mut [f64]) {
    let ((from, _), (into, _)) = (from.as_chunks::<BLOCK>(), into.as_chunks_mut::<BLOCK>());
    for (into, place) in into.iter_mut().zip(places) {
        let from = &from[*place];
        for lane in 0..LANES {
            into[lane] = a[lane] * from[lane];
            into[LANES + lane] = b[lane] * from[lane] + c[lane] * from[LANES + lane];
        }
    }
}
