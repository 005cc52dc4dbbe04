//! Images in closed form for the tests: shapes under a pixel and a Gaussian, integrated column by column (no operator works this way).

use std::f64::consts::PI;
use std::sync::LazyLock;

use calibench_model::quadrature::gauss_legendre;
use calibench_model::{Affine, Image, TargetKind};

/// The Gauss-Legendre rule of five points on [0, 1].
static RULE: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| gauss_legendre(5));

/// A target in an image: its own plane mapped by `affine`, at `at`; blur `sigma` px; grey values `ground` and `ground + contrast`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture {
    pub(crate) kind: TargetKind,
    pub(crate) at: [f64; 2],
    pub(crate) affine: Affine,
    pub(crate) sigma: f64,
    pub(crate) ground: f64,
    pub(crate) contrast: f64,
}

/// Convex pieces in the target's own plane, written down anew here.
fn pieces(kind: TargetKind) -> Vec<Vec<[f64; 2]>> {
    let rectangle = |u0: f64, v0: f64, u1: f64, v1: f64| vec![[u0, v0], [u1, v0], [u1, v1], [u0, v1]];
    let sixth = 1.0 / 6.0;
    match kind {
        TargetKind::Square => vec![rectangle(-0.5, -0.5, 0.5, 0.5)],
        TargetKind::Triangle => vec![
            (0..3).map(|i| (f64::from(i) * 120.0 - 90.0).to_radians()).map(|a| [a.cos() / 3_f64.sqrt(), a.sin() / 3_f64.sqrt()]).collect(),
        ],
        TargetKind::Cross => {
            vec![rectangle(-0.5, -sixth, 0.5, sixth), rectangle(-sixth, sixth, sixth, 0.5), rectangle(-sixth, -0.5, sixth, -sixth)]
        }
        TargetKind::Corner => vec![rectangle(0.0, 0.0, 1.0, 1.0)],
        TargetKind::ChessCorner => vec![rectangle(0.0, 0.0, 1.0, 1.0), rectangle(-1.0, -1.0, 0.0, 0.0)],
        TargetKind::Disc | TargetKind::Junction => Vec::new(),
    }
}

fn normal(u: f64) -> (f64, f64) {
    ((-0.5 * u * u).exp() / (2.0 * PI).sqrt(), 0.5 * (1.0 + libm::erf(u / 2_f64.sqrt())))
}

impl Picture {
    fn map(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let a = &self.affine;
        [self.at[0] + a.axx * u + a.axy * v, self.at[1] + a.ayx * u + a.ayy * v]
    }

    /// Part of the Gaussian in the pixel at distance `t`.
    fn seen(&self, t: f64) -> f64 {
        normal((t + 0.5) / self.sigma).1 - normal((t - 0.5) / self.sigma).1
    }

    /// The integral of [`Self::seen`] up to `t`.
    fn below(&self, t: f64) -> f64 {
        let g = |t: f64| {
            let (density, below) = normal(t / self.sigma);
            t * below + self.sigma * density
        };
        g(t + 0.5) - g(t - 0.5)
    }

    /// Abscissae with weights, and the ordinates between which the shape lies there.
    fn columns(&self, side: usize) -> Vec<(f64, f64, f64, f64)> {
        let mut columns = Vec::new();
        let seen = (-1.0 - 6.0 * self.sigma, side as f64 + 6.0 * self.sigma);
        for piece in pieces(self.kind) {
            let corners: Vec<[f64; 2]> = piece.into_iter().map(|corner| self.map(corner)).collect();
            let mut breaks: Vec<f64> = corners.iter().map(|c| c[0].clamp(seen.0, seen.1)).collect();
            breaks.sort_by(f64::total_cmp);
            for pair in breaks.windows(2).filter(|pair| pair[1] > pair[0]) {
                // A steep edge runs through many rows between two abscissae: as many panels as its length asks for.
                let longest =
                    1.5 * (self.affine.axx.hypot(self.affine.ayx) + self.affine.axy.hypot(self.affine.ayy)).min(3.0 * side as f64);
                self.panels(pair[0], pair[1], longest, |x, weight| {
                    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
                    let crossed = edges.filter(|(a, b)| (a[0] <= x) != (b[0] <= x));
                    let ys: Vec<f64> = crossed.map(|(a, b)| a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1])).collect();
                    columns.push((x, weight, ys[0].min(ys[1]), ys[0].max(ys[1])));
                });
            }
        }
        if self.kind == TargetKind::Disc {
            self.ellipse(&mut columns);
        }
        columns
    }

    fn panels(&self, from: f64, to: f64, longest: f64, mut visit: impl FnMut(f64, f64)) {
        let count = (longest / (0.5 * self.sigma)).ceil().max(1.0) as usize;
        let width = (to - from) / count as f64;
        for panel in 0..count {
            RULE.iter().for_each(|&(node, weight)| visit(from + (panel as f64 + node) * width, weight * width));
        }
    }

    /// The disc's picture: with E = A A^T / 4 it spans `|x| <= sqrt(Exx)`, and there `y = Exy/Exx x +- sqrt(det E / Exx (1 - x^2/Exx))`.
    fn ellipse(&self, columns: &mut Vec<(f64, f64, f64, f64)>) {
        let a = &self.affine;
        let (xx, xy, yy) =
            ((a.axx * a.axx + a.axy * a.axy) / 4.0, (a.axx * a.ayx + a.axy * a.ayy) / 4.0, (a.ayx * a.ayx + a.ayy * a.ayy) / 4.0);
        let count = 80;
        for panel in 0..count {
            for &(node, weight) in RULE.iter() {
                let angle = PI * ((f64::from(panel) + node) / f64::from(count) - 0.5);
                let (x, step) = (xx.sqrt() * angle.sin(), xx.sqrt() * angle.cos() * weight * PI / f64::from(count));
                let height = ((xx * yy - xy * xy) / xx).sqrt() * angle.cos();
                let y = self.at[1] + xy / xx * x;
                columns.push((self.at[0] + x, step, y - height, y + height));
            }
        }
    }

    /// Grey values of a square image, full precision.
    pub(crate) fn grey(&self, side: usize) -> Vec<f64> {
        let mut grey = vec![self.ground; side * side];
        for (x, weight, low, high) in self.columns(side) {
            let across: Vec<f64> = (0..side).map(|column| self.seen(x - column as f64)).collect();
            for row in 0..side {
                let down = self.contrast * weight * (self.below(high - row as f64) - self.below(low - row as f64));
                for (value, across) in grey[row * side..].iter_mut().zip(&across) {
                    *value += down * across;
                }
            }
        }
        grey
    }

    /// The image of [`Self::grey`].
    pub(crate) fn image(&self, side: usize) -> Image<'static> {
        Image::new(side, side, self.grey(side).into_iter().map(|g| g as f32).collect())
    }
}

/// Normal random numbers, the same for the same seed: Box and Muller over SplitMix64.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    pub(crate) fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }

    /// `image` with noise of standard deviation `sigma`.
    pub(crate) fn on(&mut self, image: &Image, sigma: f64) -> Image<'static> {
        let grey = image.grey().iter().map(|&g| g + (sigma * self.normal()) as f32).collect();
        Image::new(image.width(), image.height(), grey)
    }
}

#[test]
fn the_picture_of_an_upright_square_is_a_product() {
    let affine = Affine { axx: 7.3, axy: 0.0, ayx: 0.0, ayy: 5.1 };
    let picture = Picture { kind: TargetKind::Square, at: [9.7, 10.2], affine, sigma: 0.6, ground: 0.1, contrast: 0.7 };
    let grey = picture.grey(21);
    for (x, y) in (0..21).flat_map(|y| (0..21).map(move |x| (x, y))) {
        let along = |t: f64, middle: f64, side: f64| picture.below(middle + side / 2.0 - t) - picture.below(middle - side / 2.0 - t);
        let expected = 0.1 + 0.7 * along(f64::from(x), 9.7, 7.3) * along(f64::from(y), 10.2, 5.1);
        assert!((grey[(y * 21 + x) as usize] - expected).abs() < 1e-12);
    }
}
