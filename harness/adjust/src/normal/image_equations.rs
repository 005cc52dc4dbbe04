//! The observation equations of one image.

use calibench_model::{PixelPoint, Pose};
use nalgebra::Matrix3;

use super::gram::{BLOCK, LANES, Tile, gram};
use super::projection::{Optics, POSE, Pictured};
use super::robust::Loss;
use crate::network::{ImageObservation, Sight};

/// An image point that the values do not picture: its place among the sights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Lost(pub(crate) usize);

/// White rows `A dx = w` of an image and their normal equations. Columns: pose, unknown parameters of the camera, misclosure `w = observed - computed`,
/// and, to make their number even, one of zeros.
#[derive(Default)]
pub(super) struct View {
    points: Vec<[f64; 3]>,
    behind: Vec<bool>,
    pictured: Pictured,
    rows: Vec<f64>,
    /// Columns of the camera's derivatives that are wanted.
    places: Vec<usize>,
    /// `R^T R`, row by row, lower triangle.
    products: Vec<f64>,
    tiles: Vec<Tile>,
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
    /// As given.
    pub(super) observations: &'a [ImageObservation],
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
        self.picture(setting, sights, points)?;
        self.places.clear();
        self.places.extend((0..POSE).chain(setting.free.iter().map(|i| POSE + i)));
        self.columns = (POSE + setting.free.len() + 1).next_multiple_of(2);
        self.rows.resize(sights.len().div_ceil(LANES) * self.columns * BLOCK, 0.0);
        self.cost = 0.0;
        let pixels = self.pictured.pixels.chunks(LANES);
        let blocks = self.rows.chunks_exact_mut(self.columns * BLOCK).zip(self.pictured.blocks());
        for ((((rows, from), pixels), sights), residuals) in blocks.zip(pixels).zip(sights.chunks(LANES)).zip(residuals.chunks_mut(LANES)) {
            let misclosed = misclosures(setting, sights, pixels, residuals);
            self.cost += misclosed.cost;
            whiten(&misclosed, &self.places, from, rows);
        }
        Ok(())
    }

    /// Pixels and derivatives.
    pub(super) fn picture(&mut self, setting: Setting, sights: &[Sight], points: &[nalgebra::Point3<f64>]) -> Result<(), Lost> {
        self.points.clear();
        self.points.extend(sights.iter().map(|sight| <[f64; 3]>::from(points[sight.point()].coords)));
        self.behind.clear();
        if matches!(setting.optics, Optics::Single(_)) {
            self.behind.extend(sights.iter().map(|sight| sight.observed(setting.observations).behind));
        }
        setting.optics.picture(setting.pose, &self.points, &self.behind, &mut self.pictured);
        self.pictured.pixels.iter().position(|pixel| !pixel.is_finite()).map_or(Ok(()), |i| Err(Lost(i)))
    }

    /// Residuals of what was pictured last; their weights stay.
    pub(super) fn subtract(&self, sights: &[Sight], observations: &[ImageObservation], residuals: &mut [Residual]) {
        for ((residual, sight), pixel) in residuals.iter_mut().zip(sights).zip(&self.pictured.pixels) {
            let observed = sight.observed(observations).position;
            residual.px = [pixel.x - observed.x, pixel.y - observed.y];
        }
    }

    /// Sums the products of the columns.
    pub(super) fn sum(&mut self) {
        self.products.resize(self.columns * self.columns, 0.0);
        gram(&self.rows, self.columns, &mut self.tiles, &mut self.products);
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

/// Of a block of sights: what makes their rows white, `(a x, b x + c y)`, and white misclosures; zero in lanes without a sight.
struct Misclosed {
    white: [[f64; LANES]; 3],
    misclosures: [[f64; LANES]; 2],
    cost: f64,
}

#[inline]
fn misclosures(
    Setting { loss, observations, .. }: Setting,
    sights: &[Sight],
    pixels: &[PixelPoint],
    residuals: &mut [Residual],
) -> Misclosed {
    let (mut white, mut misclosures, mut cost) = ([[0.0; LANES]; 3], [[0.0; LANES]; 2], 0.0);
    for (lane, ((sight, pixel), residual)) in sights.iter().zip(pixels).zip(residuals).enumerate().take(LANES) {
        let ImageObservation { position, precision, .. } = sight.observed(observations);
        let px = [pixel.x - position.x, pixel.y - position.y];
        let [a, b, c] = precision.whitening();
        let v = [a * px[0], b * px[0] + c * px[1]];
        let square = v[0] * v[0] + v[1] * v[1];
        let (mut weight, mut root) = (1.0, 1.0);
        if loss == Loss::Squares {
            cost += square;
        } else {
            let (robust, found) = loss.of(square);
            cost += robust;
            (weight, root) = (found, found.sqrt());
        }
        *residual = Residual { px, weight };
        (white[0][lane], white[1][lane], white[2][lane]) = (a * root, b * root, c * root);
        (misclosures[0][lane], misclosures[1][lane]) = (-v[0] * root, -v[1] * root);
    }
    Misclosed { white, misclosures, cost }
}

/// Copies the columns `places` of a block, made white, then misclosures and, where the number of columns wants one, zeros.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn whiten(misclosed: &Misclosed, places: &[usize], from: &[f64], into: &mut [f64]) {
    let ((from, _), (into, _)) = (from.as_chunks::<BLOCK>(), into.as_chunks_mut::<BLOCK>());
    let [a, b, c] = &misclosed.white;
    let (columns, last) = into.split_at_mut(places.len());
    for (into, place) in columns.iter_mut().zip(places) {
        let from = &from[*place];
        for lane in 0..LANES {
            into[lane] = a[lane] * from[lane];
            into[LANES + lane] = b[lane] * from[lane] + c[lane] * from[LANES + lane];
        }
    }
    last.fill([0.0; BLOCK]);
    if let Some(last) = last.first_mut() {
        last.copy_from_slice(misclosed.misclosures.as_flattened());
    }
}
