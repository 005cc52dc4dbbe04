//! The Cramér-Rao bound: how well the position of a target can be found in an image at best, whatever the operator.
//!
//! With `J` the derivatives of the noise-free grey values of a window by the unknowns and `S` the covariance of the grey values, no unbiased operator
//! has a smaller covariance than `(J^T S^-1 J)^-1`. What an operator has to estimate beside the position (directions and sizes, grey levels, sharpness)
//! widens the bound of the position.

use calibench_model::{Covariance, Gradient, PixelPoint, Unknowns};
use nalgebra::{DMatrix, Matrix2, Vector2};

use crate::optics::{Optics, OpticsError};
use crate::raster::{Picture, Piece, Renderer, join_left};

/// Steps of the differences: px of a shift, and of a deformation at the window's edge.
const STEP: f64 = 0.05;
/// The relative change of the blur.
const BLUR_STEP: f64 = 0.02;
/// The group of the grey levels.
const LEVELS: usize = 3;
/// Combinations of unknowns with less than this share of the information are not determined by the window: a disc's rotation, a straight edge's length. The
/// differences leave such a combination some 1e-9; what is determined has more than 1e-4.
const SINGULAR: f64 = 1e-6;

/// Bounds of targets in pictures that are rendered through one lens.
pub struct Bounds {
    /// Half the width of the window, px.
    half: i64,
    renderer: Renderer,
    /// A little sharper and a little softer, where there is a blur; and the step between the two, px.
    blurred: Option<(Renderer, Renderer, f64)>,
}

impl Bounds {
    /// For windows of `window` x `window` px (odd) in pictures of `width` x `height` px through `optics`.
    ///
    /// # Errors
    /// Optics that are out of range.
    pub fn new(optics: &Optics, width: usize, height: usize, window: usize) -> Result<Self, OpticsError> {
        let scaled = |factor: f64| {
            let corner_blur = optics.corner_blur.map(|blur| blur * factor);
            Renderer::new(&Optics { blur: optics.blur * factor, corner_blur, ..*optics }, width, height)
        };
        let blurred = if optics.blur > 0.0 {
            // Near the least blur that can be rendered the step goes one way.
            let (low, high) = if scaled(1.0 - BLUR_STEP).is_ok() { (1.0 - BLUR_STEP, 1.0 + BLUR_STEP) } else { (1.0, 1.0 + BLUR_STEP) };
            Some((scaled(low)?, scaled(high)?, optics.blur * (high - low)))
        } else {
            None
        };
        Ok(Self { half: (window / 2) as i64, renderer: scaled(1.0)?, blurred })
    }

    /// What the grey values of the window around `at` tell; `None` if it leaves the image.
    pub fn window<'a>(&'a self, picture: &'a Picture, at: PixelPoint) -> Option<Window<'a>> {
        let corner = [at.x.round() as i64 - self.half, at.y.round() as i64 - self.half];
        let side = 2 * self.half + 1;
        let inside =
            corner.iter().all(|&c| c >= 0) && corner[0] + side <= picture.width as i64 && corner[1] + side <= picture.height as i64;
        inside.then(|| Window { bounds: self, near: self.near(picture, at, corner), at, corner, side: side as usize })
    }

    /// The picture with only those pieces that can matter to a window, moved by a step of any parameter or not.
    fn near(&self, picture: &Picture, at: PixelPoint, [left, top]: [i64; 2]) -> Picture {
        let reach = [&self.renderer].into_iter().chain(self.blurred.iter().flat_map(|(low, high, _)| [low, high]));
        let [reach_x, reach_y] = reach.map(Renderer::reach).fold([0.0_f64; 2], |[x, y], [rx, ry]| [x.max(rx), y.max(ry)]);
        let (low, high) = (top as f64 - reach_y - 2.0, (top + 2 * self.half) as f64 + reach_y + 3.0);
        let right = (left + 2 * self.half) as f64 + reach_x + 3.0;
        // A deformation moves what is further off the further.
        let rate = STEP / self.half.max(1) as f64;
        let moved = |piece: &Piece| {
            let far = |[low, high]: [f64; 2], middle: f64| (low - middle).abs().max((high - middle).abs());
            STEP + rate * far(piece.rows(), at.y).max(far(piece.columns(), at.x))
        };
        let pieces = join_left(&picture.pieces, |piece| piece.columns()[1] + moved(piece) < left as f64 - reach_x - 2.0);
        let kept = |piece: &Piece| {
            let (moved, rows) = (moved(piece), piece.rows());
            rows[1] + moved > low && rows[0] - moved < high && piece.columns()[0] - moved < right
        };
        Picture { pieces: pieces.into_iter().filter(kept).collect(), ..*picture }
    }
}

/// The window around a target.
pub struct Window<'a> {
    bounds: &'a Bounds,
    /// What matters to the window.
    near: Picture,
    at: PixelPoint,
    /// Left and top pixel.
    corner: [i64; 2],
    side: usize,
}

/// The grey values' derivatives by everything that somebody may have to estimate, in groups: position, shape, blur, levels, a gradient that is added and one that multiplies.
type Columns = [Vec<Vec<f64>>; 6];

impl Window<'_> {
    /// The bounds of the position, px^2, beside each of `sets`. `mean` is what the sensor makes of light (fraction of full scale) and `variance` the
    /// variance of that grey value (fraction of full scale, squared), `None` where the chain has none.
    ///
    /// A bound is `None` also where the window does not determine the position.
    pub fn bounds(
        &self,
        sets: &[Unknowns],
        mean: impl Fn(f64) -> Option<f64>,
        variance: impl Fn(f64) -> Option<f64>,
    ) -> Vec<Option<Covariance>> {
        let normal = || {
            let grey = self.grey_of(&self.bounds.renderer, |p| p).into_iter().map(&mean).collect::<Option<Vec<f64>>>()?;
            let weights = grey.iter().map(|&grey| variance(grey).filter(|v| *v > 0.0).map(|v| 1.0 / v)).collect::<Option<Vec<f64>>>()?;
            let columns = self.columns(sets, &grey, &mean)?;
            let groups = columns.each_ref().map(Vec::len);
            let columns: Vec<&Vec<f64>> = columns.iter().flatten().collect();
            let product = |i: usize, j: usize| columns[i].iter().zip(columns[j]).zip(&weights).map(|((a, b), w)| a * b * w).sum::<f64>();
            Some((groups, DMatrix::from_fn(columns.len(), columns.len(), product)))
        };
        let Some((groups, normal)) = normal() else { return vec![None; sets.len()] };
        let part = |set| {
            let (chosen, shared) = chosen(groups, set);
            position(&normal.select_rows(&chosen).select_columns(&chosen), &shared)
        };
        sets.iter().map(|&set| part(set)).collect()
    }

    /// The derivatives that one of `sets` needs. They are differences of what the sensor makes of light: its curve counts.
    fn columns(&self, sets: &[Unknowns], grey: &[f64], mean: &impl Fn(f64) -> Option<f64>) -> Option<Columns> {
        let wanted = |of: fn(&Unknowns) -> bool| sets.iter().any(of);
        let renderer = &self.bounds.renderer;
        let moved = |by: &dyn Fn([f64; 2], f64) -> [f64; 2], step: f64| {
            let [high, low] = [0.5, -0.5].map(|half| self.grey_of(renderer, |p| by(p, half * step)));
            slope(&high, &low, step, mean)
        };
        let (x0, y0) = (self.at.x, self.at.y);
        let shift = [moved(&|[x, y], h| [x + h, y], STEP)?, moved(&|[x, y], h| [x, y + h], STEP)?];
        let mut columns: Columns = [shift.into(), Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new()];
        if wanted(|set| set.shape) {
            let step = STEP / self.bounds.half.max(1) as f64;
            let [across, along] = [moved(&|[x, y], h| [x + h * (x - x0), y], step)?, moved(&|[x, y], h| [x + h * (y - y0), y], step)?];
            let [rising, up] = [moved(&|[x, y], h| [x, y + h * (x - x0)], step)?, moved(&|[x, y], h| [x, y + h * (y - y0)], step)?];
            columns[1] = vec![across, along, rising, up];
        }
        if let Some((sharper, softer, step)) = self.bounds.blurred.as_ref().filter(|_| wanted(|set| set.blur)) {
            columns[2] = vec![slope(&self.grey_of(softer, |p| p), &self.grey_of(sharper, |p| p), *step, mean)?];
        }
        columns[3] = vec![vec![1.0; grey.len()], grey.to_vec()];
        let middle = self.bounds.half as f64;
        let ramp = |of: fn(usize, usize) -> usize| (0..grey.len()).map(|i| of(i, self.side) as f64 - middle).collect::<Vec<f64>>();
        columns[4] = vec![ramp(|i, side| i % side), ramp(|i, side| i / side)];
        // As operators take it: grey values are zero without light. A black level would be one more plane.
        columns[5] = columns[4].iter().map(|ramp| ramp.iter().zip(grey).map(|(d, grey)| d * grey).collect()).collect();
        Some(columns)
    }

    fn grey_of(&self, renderer: &Renderer, moved: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<f64> {
        let move_piece = |piece: &Piece| Piece { points: piece.points.map(&moved), ..*piece };
        renderer.render_window(&self.near, move_piece, self.corner, self.side)
    }
}

/// The slope between two windows that lie `step` apart, of what the sensor makes of their light.
fn slope(high: &[f64], low: &[f64], step: f64, mean: &impl Fn(f64) -> Option<f64>) -> Option<Vec<f64>> {
    high.iter().zip(low).map(|(&high, &low)| Some((mean(high)? - mean(low)?) / step)).collect()
}

/// The places of a set's unknowns among all columns, and of each the place in the set from which those of its group are.
fn chosen(groups: [usize; 6], set: Unknowns) -> (Vec<usize>, Vec<usize>) {
    let added = matches!(set.gradient, Gradient::Added | Gradient::Both);
    let light = matches!(set.gradient, Gradient::Light | Gradient::Both);
    let members = [true, set.shape, set.blur, set.levels, added, light];
    let mut first = 0;
    let (mut chosen, mut shared) = (Vec::new(), Vec::new());
    for (group, (count, member)) in groups.into_iter().zip(members).enumerate() {
        if member {
            let from = chosen.len();
            // A grey level of 1 and a contrast are no two of a kind.
            shared.extend((0..count).map(|k| if group == LEVELS { from + k } else { from }));
            chosen.extend(first..first + count);
        }
        first += count;
    }
    (chosen, shared)
}

/// The position's part of the inverse of the normal equations: what is left of its information when the other unknowns have taken theirs.
///
/// `shared` are groups of unknowns of one unit. Each is scaled to a diagonal of 1 at most, so that units do not decide what is singular. Were each unknown scaled
/// by itself, a deformation that moves nothing, as one along the edges of an upright corner, would count with its rounding as much as one that moves all.
fn position(normal: &DMatrix<f64>, shared: &[usize]) -> Option<Covariance> {
    let n = normal.nrows();
    let most = |group: usize| (0..n).filter(|&i| shared[i] == group).map(|i| normal[(i, i)]).fold(0.0, f64::max);
    let scale: Vec<f64> = shared.iter().map(|&group| if most(group) > 0.0 { 1.0 / most(group).sqrt() } else { 0.0 }).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| normal[(i, j)] * scale[i] * scale[j]);
    let information = Matrix2::new(scaled[(0, 0)], scaled[(0, 1)], scaled[(1, 0)], scaled[(1, 1)]) - taken(&scaled);
    let covariance = information.try_inverse()?;
    let sxx = covariance[(0, 0)] * scale[0] * scale[0];
    let (sxy, syy) = (covariance[(0, 1)] * scale[0] * scale[1], covariance[(1, 1)] * scale[1] * scale[1]);
    // A direction of which the window tells nothing, but for rounding, leaves a bound without bounds.
    let (sum, product) = (sxx + syy, sxx * syy - sxy * sxy);
    let determined = sxx > 0.0 && syy > 0.0 && product > 1e-7 * sum * sum;
    determined.then_some(Covariance { sxx, sxy, syy }).filter(Covariance::is_valid)
}

/// The position's information that the other unknowns take.
fn taken(scaled: &DMatrix<f64>) -> Matrix2<f64> {
    let others = scaled.nrows() - 2;
    let mut taken = Matrix2::zeros();
    if others == 0 {
        return taken;
    }
    let eigen = scaled.view((2, 2), (others, others)).into_owned().symmetric_eigen();
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > SINGULAR {
            let along = Vector2::from([0, 1].map(|row| (0..others).map(|k| scaled[(row, k + 2)] * vector[k]).sum::<f64>()));
            taken += along * along.transpose() / *value;
        }
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::{Polygon, Scene};

    const SIGMA: f64 = 0.02;

    fn scene(polygons: &[&[(f64, f64)]]) -> Picture {
        let polygon = |vertices: &&[(f64, f64)]| Polygon {
            id: String::new(),
            grey: 0.1,
            vertices: vertices.iter().map(|&(x, y)| PixelPoint::new(x, y)).collect(),
        };
        Picture::from(&Scene {
            width: 41,
            height: 41,
            background: 0.9,
            polygons: polygons.iter().map(polygon).collect(),
            targets: Vec::new(),
        })
    }

    fn bound(picture: &Picture, blur: f64, window: usize, unknowns: Unknowns) -> Option<Covariance> {
        let bounds = Bounds::new(&Optics { blur, ..Optics::default() }, 41, 41, window).unwrap();
        let window = bounds.window(picture, PixelPoint::new(20.2, 19.9)).unwrap();
        window.bounds(&[unknowns], Some, |_| Some(SIGMA * SIGMA))[0]
    }

    fn chess() -> Picture {
        scene(&[&[(-9.0, -9.0), (20.2, -9.0), (20.2, 19.9), (-9.0, 19.9)], &[(20.2, 19.9), (60.0, 19.9), (60.0, 60.0), (20.2, 60.0)]])
    }

    #[test]
    fn an_upright_chess_corner_has_its_closed_form() {
        // Far from the centre a row crosses one edge: the information of x is the number of rows times the integral of the squared slope, except where the
        // other edge turns the contrast over. There it is (2 Phi - 1)^2.
        let (blur, window) = (1.5, 15);
        let found = bound(&chess(), blur, window, Unknowns::default()).unwrap();
        // By sums over the pixels of products of one-dimensional profiles.
        let phi = |s: f64| 0.5 * libm::erfc(-s * std::f64::consts::FRAC_1_SQRT_2);
        let once = |u: f64| u * phi(u / blur) + blur * (-0.5 * (u / blur).powi(2)).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let profile = |u: f64| once(u + 0.5) - once(u - 0.5);
        let slope = |u: f64| phi((u + 0.5) / blur) - phi((u - 0.5) / blur);
        let information = |of_x: bool| -> f64 {
            let pixels = (13..=27).flat_map(|y| (13..=27).map(move |x| (f64::from(x) - 20.2, f64::from(y) - 19.9)));
            let slopes =
                pixels.map(|(x, y)| 0.8 * if of_x { slope(x) * (2.0 * profile(y) - 1.0) } else { slope(y) * (2.0 * profile(x) - 1.0) });
            slopes.map(|s| s * s).sum::<f64>() / (SIGMA * SIGMA)
        };
        assert!((found.sxx * information(true) - 1.0).abs() < 2e-3, "{found:?} {}", 1.0 / information(true));
        assert!((found.syy * information(false) - 1.0).abs() < 2e-3);
        assert!(found.sxy.abs() < 0.02 * found.sxx);
    }

    /// The bound by differences of products of one-dimensional profiles, with all unknowns but the shape, for grey values of 0.1 and 0.9.
    #[test]
    fn gradients_take_what_they_take_of_closed_forms() {
        let phi = |s: f64| 0.5 * libm::erfc(-s * std::f64::consts::FRAC_1_SQRT_2);
        // Unknowns: x, y, blur, mean, half, an added slope (2), the light's slope (2).
        let grey = |u: &[f64], column: usize, row: usize| {
            let once = |d: f64| d * phi(d / u[2]) + u[2] * (-0.5 * (d / u[2]).powi(2)).exp() / (2.0 * std::f64::consts::PI).sqrt();
            let profile = |d: f64| 2.0 * (once(d + 0.5) - once(d - 0.5)) - 1.0;
            let (dx, dy) = (column as f64 - u[0], row as f64 - u[1]);
            let even = u[3] - u[4] * profile(dx) * profile(dy);
            even * (1.0 + u[7] * dx + u[8] * dy) + u[5] * dx + u[6] * dy
        };
        let at = [7.2, 6.9, 0.8, 0.5, 0.4, 0.0, 0.0, 0.0, 0.0];
        let column = |unknown: usize| -> Vec<f64> {
            let moved = |h: f64| {
                let mut u = at;
                u[unknown] += h;
                u
            };
            let (high, low) = (moved(1e-4), moved(-1e-4));
            (0..225).map(|i| (grey(&high, i % 15, i / 15) - grey(&low, i % 15, i / 15)) / 2e-4).collect()
        };
        let columns: Vec<Vec<f64>> = (0..9).map(column).collect();
        for (gradient, slopes) in
            [(Gradient::None, vec![]), (Gradient::Added, vec![5, 6]), (Gradient::Light, vec![7, 8]), (Gradient::Both, vec![5, 6, 7, 8])]
        {
            let unknowns: Vec<usize> = (0..5).chain(slopes).collect();
            let product = |i: usize, j: usize| columns[unknowns[i]].iter().zip(&columns[unknowns[j]]).map(|(a, b)| a * b).sum::<f64>();
            let inverse = DMatrix::from_fn(unknowns.len(), unknowns.len(), product).try_inverse().unwrap();
            let expected = (inverse[(0, 0)] + inverse[(1, 1)]) * SIGMA * SIGMA;
            let found = bound(&chess(), 0.8, 15, Unknowns { levels: true, blur: true, gradient, shape: false }).unwrap();
            let ratio = (found.sxx + found.syy) / expected;
            assert!((ratio - 1.0).abs() < 2e-3, "{gradient:?}: {ratio}");
        }
    }

    #[test]
    fn unknowns_widen_the_bound_and_never_narrow_it() {
        let trace = |unknowns| bound(&chess(), 0.7, 15, unknowns).map(|c| c.sxx + c.syy).unwrap();
        let alone = trace(Unknowns::default());
        let shape = trace(Unknowns { shape: true, ..Unknowns::default() });
        let all = Unknowns { shape: true, levels: true, blur: true, gradient: Gradient::Both };
        assert!(alone <= shape && shape <= trace(all), "{alone} {shape} {}", trace(all));
        let even = trace(Unknowns { gradient: Gradient::None, ..all });
        for gradient in [Gradient::Added, Gradient::Light] {
            let part = trace(Unknowns { gradient, ..all });
            assert!(even <= part && part <= trace(all), "{even} {part} {gradient:?}");
        }
        assert!(even < 1.15 * alone, "nearly point-symmetric in its window, so little is lost: {even} {alone}");
        // A triangle is not: up to sqrt 2 wider.
        let triangle = scene(&[&[(20.2, 12.9), (26.26, 23.4), (14.14, 23.4)]]);
        let trace = |unknowns| bound(&triangle, 0.7, 21, unknowns).map(|c| c.sxx + c.syy).unwrap();
        let ratio = (trace(Unknowns { shape: true, levels: true, ..Unknowns::default() }) / trace(Unknowns::default())).sqrt();
        assert!(ratio > 1.02 && ratio < 1.6, "{ratio}");
    }

    #[test]
    fn the_rotation_of_a_disc_takes_nothing() {
        let vertex = |i: i32| {
            let (s, c) = (f64::from(i) * std::f64::consts::TAU / 512.0).sin_cos();
            (20.2 + 6.0 * c, 19.9 + 6.0 * s)
        };
        let vertices: Vec<_> = (0..512).map(vertex).collect();
        let disc = scene(&[&vertices]);
        let trace = |unknowns| bound(&disc, 0.7, 21, unknowns).map(|c| c.sxx + c.syy).unwrap();
        let ratio = trace(Unknowns { shape: true, levels: true, blur: true, gradient: Gradient::None }) / trace(Unknowns::default());
        assert!((1.0..1.02).contains(&ratio), "{ratio}");
    }

    /// Squares left of the window, wholly or in part, whose rows it shares: their light is the same in all of it, or none.
    #[test]
    fn what_is_far_left_of_the_window_takes_nothing() {
        let square = |x: f64, y: f64| vec![(x, y), (x + 2.0, y), (x + 2.0, y + 2.5), (x, y + 2.5)];
        let target = square(18.2, 18.4);
        let others: Vec<_> = (0..5).map(|i| square(-1.0 + f64::from(i % 2), 3.0 * f64::from(i) + 12.1)).collect();
        let unknowns = Unknowns { shape: true, levels: true, blur: true, gradient: Gradient::None };
        let alone = bound(&scene(&[&target]), 0.6, 11, unknowns).unwrap();
        let crowd: Vec<&[(f64, f64)]> = others.iter().chain([&target]).map(Vec::as_slice).collect();
        let crowded = bound(&scene(&crowd), 0.6, 11, unknowns).unwrap();
        for (a, b) in [(alone.sxx, crowded.sxx), (alone.sxy, crowded.sxy), (alone.syy, crowded.syy)] {
            assert!((a - b).abs() < 1e-7 * (alone.sxx + alone.syy), "{alone:?} {crowded:?}");
        }
        // A wide bar from far left to behind the window does count.
        let bar = vec![(-5.0, 14.0), (30.0, 14.0), (30.0, 16.0), (-5.0, 16.0)];
        let barred = bound(&scene(&[&bar, &target]), 0.6, 11, unknowns).unwrap();
        assert!((barred.syy / alone.syy - 1.0).abs() > 1e-3, "{barred:?} {alone:?}");
    }

    #[test]
    fn an_edge_or_nothing_has_no_bound() {
        let edge = scene(&[&[(-9.0, -9.0), (20.2, -9.0), (20.2, 60.0), (-9.0, 60.0)]]);
        assert_eq!(bound(&edge, 0.7, 15, Unknowns::default()), None);
        assert_eq!(bound(&scene(&[]), 0.7, 15, Unknowns::default()), None);
        let bounds = Bounds::new(&Optics::default(), 41, 41, 15).unwrap();
        let picture = chess();
        assert!(bounds.window(&picture, PixelPoint::new(3.0, 20.0)).is_none(), "the window leaves the image");
        let window = bounds.window(&picture, PixelPoint::new(20.2, 19.9)).unwrap();
        assert_eq!(window.bounds(&[Unknowns::default()], Some, |_| None), [None], "a chain without a variance");
        assert!(
            window.bounds(&[Unknowns { blur: true, ..Unknowns::default() }], Some, |_| Some(1e-4))[0].is_some(),
            "no blur to be estimated"
        );
    }

    /// A square window holds longer parts of the edges of a corner that is turned by 45 degrees, by 10 degrees hardly. Along its edges an upright corner is deformed without
    /// a trace, and that is to take nothing, however soft it is.
    #[test]
    fn a_corner_has_about_one_bound_at_any_roll() {
        let all = Unknowns { shape: true, levels: true, blur: true, gradient: Gradient::None };
        for blur in [0.7, 1.5, 3.0] {
            let sigma = |roll: f64| {
                let (sin, cos) = roll.to_radians().sin_cos();
                let turned = |(x, y): (f64, f64)| (20.2 + 70.0 * (cos * x - sin * y), 19.9 + 70.0 * (sin * x + cos * y));
                let quarters = [1.0, -1.0].map(|s| [(0.0, 0.0), (s, 0.0), (s, s), (0.0, s)].map(turned));
                let found = bound(&scene(&[&quarters[0], &quarters[1]]), blur, 15, all).unwrap();
                (found.sxx + found.syy).sqrt()
            };
            let upright = sigma(0.0);
            for roll in [0.5, 3.0, 10.0] {
                let ratio = sigma(roll) / upright;
                println!("blur {blur}, roll {roll}: {ratio:.4} of {upright:.5} px");
                assert!((0.97..1.03).contains(&ratio), "blur {blur}, roll {roll}: {ratio}");
            }
        }
    }
}
