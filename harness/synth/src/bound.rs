//! The Cramér-Rao bound: how well the position of a target can be found in an image at best, whatever the operator.
//!
//! With `J` the derivatives of the noise-free grey values of a window by the unknowns and `S` the covariance of the grey values, no unbiased operator
//! has a smaller covariance than `(J^T S^-1 J)^-1`. What an operator has to estimate beside the position (directions and sizes, grey levels, sharpness)
//! widens the bound of the position.

use calibench_model::{Covariance, Gradient, Levels, PixelPoint, Unknowns};
use multiversion::multiversion;
use nalgebra::{DMatrix, Matrix2, Vector2};

use crate::optics::{Optics, OpticsError};
use crate::raster::{Flow, Picture, Piece, Renderer, Square, join_left};

/// Steps of the differences where there is no blur, and grey values have kinks: px of a shift, and of a deformation at the window's edge.
const STEP: f64 = 0.05;
/// The group of the grey levels.
const LEVELS: usize = 3;
/// The group of the grey values of areas.
const AREAS: usize = 6;
/// Products that are added side by side.
const LANES: usize = 8;
/// Rows of the derivatives that are multiplied with each other before the next ones.
const BLOCK: usize = 128;
/// Combinations of unknowns with less than this share of the information are not determined by the window: a disc's rotation, a straight edge's length. The
/// differences leave such a combination some 1e-9; what is determined has more than 1e-4.
const SINGULAR: f64 = 1e-6;

/// Bounds of targets in pictures that are rendered through one lens.
pub struct Bounds {
    /// Half the width of the window, px.
    half: i64,
    renderer: Renderer,
    /// The derivatives, where there is a blur.
    flow: Option<Flow>,
    /// Standard deviation of the blur in the middle of the frame, px.
    blur: f64,
}

impl Bounds {
    /// For windows of `window` x `window` px (odd) in pictures of `width` x `height` px through `optics`.
    ///
    /// # Errors
    /// Optics that are out of range.
    pub fn new(optics: &Optics, width: usize, height: usize, window: usize) -> Result<Self, OpticsError> {
        let renderer = Renderer::new(optics, width, height)?;
        Ok(Self { half: (window / 2) as i64, flow: Flow::new(&renderer), renderer, blur: optics.blur })
    }

    /// What the grey values of the window around `at` tell; `None` if it leaves the image.
    pub fn window<'a>(&'a self, picture: &'a Picture, at: PixelPoint) -> Option<Window<'a>> {
        let corner = [at.x.round() as i64 - self.half, at.y.round() as i64 - self.half];
        let side = 2 * self.half + 1;
        let inside =
            corner.iter().all(|&c| c >= 0) && corner[0] + side <= picture.width as i64 && corner[1] + side <= picture.height as i64;
        inside.then(|| Window { bounds: self, near: self.near(picture, at, corner), at, square: Square { corner, side: side as usize } })
    }

    /// The picture with only those pieces that can matter to a window, moved by a step of any parameter or not.
    fn near(&self, picture: &Picture, at: PixelPoint, [left, top]: [i64; 2]) -> Picture {
        let [reach_x, reach_y] = self.renderer.reach();
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
    square: Square,
}

/// The grey values' derivatives by everything that somebody may have to estimate, in groups: position, shape, blur, levels, a gradient that is added, one that
/// multiplies, and the grey value of each area.
type Columns = [Vec<Vec<f64>>; 7];

impl Window<'_> {
    /// The bounds of the position, px^2, beside each of `sets`. `mean` is what the sensor makes of light (fraction of full scale), which is linear, and `variance` the
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
            let dark = mean(0.0)?;
            let gain = mean(1.0)? - dark;
            let light = self.light(self.near.background, |piece| *piece);
            let grey: Vec<f64> = light.iter().map(|light| dark + gain * light).collect();
            let weights = grey.iter().map(|&grey| variance(grey).filter(|v| *v > 0.0).map(|v| 1.0 / v)).collect::<Option<Vec<f64>>>()?;
            let columns = self.columns(sets, &light, &grey, gain);
            let groups = columns.each_ref().map(Vec::len);
            let columns: Vec<&Vec<f64>> = columns.iter().flatten().collect();
            Some((groups, normal_equations(&columns, &weights)))
        };
        let Some((groups, normal)) = normal() else { return vec![None; sets.len()] };
        let part = |set| {
            let (chosen, shared) = chosen(groups, set);
            let covariance = position(&normal.select_rows(&chosen).select_columns(&chosen), &shared)?;
            // A window that holds no edge tells of the position that it is somewhere about.
            (covariance.sxx + covariance.syy < self.square.side.pow(2) as f64).then_some(covariance)
        };
        sets.iter().map(|&set| part(set)).collect()
    }

    /// The derivatives that one of `sets` needs, of grey values that grow by `gain` with the light.
    fn columns(&self, sets: &[Unknowns], light: &[f64], grey: &[f64], gain: f64) -> Columns {
        let wanted = |of: fn(&Unknowns) -> bool| sets.iter().any(of);
        let scaled = |column: Vec<f64>| column.into_iter().map(|derivative| gain * derivative).collect::<Vec<f64>>();
        let (shape, blur) = (wanted(|set| set.shape), wanted(|set| set.blur));
        let mut columns: Columns = Default::default();
        [columns[0], columns[1], columns[2]] = match &self.bounds.flow {
            Some(flow) => self.flow(flow, shape, blur),
            None => self.differences(shape),
        }
        .map(|group| group.into_iter().map(scaled).collect());
        columns[LEVELS] = vec![vec![1.0; grey.len()], grey.to_vec()];
        let (middle, side) = (self.bounds.half as f64, self.square.side);
        let ramp = |of: fn(usize, usize) -> usize| (0..grey.len()).map(|i| of(i, side) as f64 - middle).collect::<Vec<f64>>();
        columns[4] = vec![ramp(|i, side| i % side), ramp(|i, side| i / side)];
        // As operators take it: grey values are zero without light. A black level would be one more plane.
        columns[5] = columns[4].iter().map(|ramp| ramp.iter().zip(grey).map(|(d, grey)| d * grey).collect()).collect();
        if wanted(|set| set.levels == Levels::Areas) {
            columns[AREAS] = self.areas(light).into_iter().map(scaled).collect();
        }
        columns
    }

    /// The light's derivatives by the position, the shape and the blur.
    fn flow(&self, flow: &Flow, shape: bool, blur: bool) -> [Vec<Vec<f64>>; 3] {
        let [x, y, across, along, rising, up, softer] = flow.window(&self.bounds.renderer, &self.near, [self.at.x, self.at.y], self.square);
        let softer = softer.into_iter().map(|derivative| derivative / self.bounds.blur).collect();
        let group = |wanted: bool, of: Vec<Vec<f64>>| if wanted { of } else { Vec::new() };
        [vec![x, y], group(shape, vec![across, along, rising, up]), group(blur, vec![softer])]
    }

    /// The same as differences, without a blur.
    fn differences(&self, shape: bool) -> [Vec<Vec<f64>>; 3] {
        let moved = |by: &dyn Fn([f64; 2], f64) -> [f64; 2], step: f64| {
            let [high, low] = [0.5, -0.5].map(|half| {
                self.light(self.near.background, |piece| Piece { points: piece.points.map(|point| by(point, half * step)), ..*piece })
            });
            high.iter().zip(&low).map(|(high, low)| (high - low) / step).collect::<Vec<f64>>()
        };
        let (x0, y0) = (self.at.x, self.at.y);
        let shift = vec![moved(&|[x, y], h| [x + h, y], STEP), moved(&|[x, y], h| [x, y + h], STEP)];
        if !shape {
            return [shift, Vec::new(), Vec::new()];
        }
        let step = STEP / self.bounds.half.max(1) as f64;
        let [across, along] = [moved(&|[x, y], h| [x + h * (x - x0), y], step), moved(&|[x, y], h| [x + h * (y - y0), y], step)];
        let [rising, up] = [moved(&|[x, y], h| [x, y + h * (x - x0)], step), moved(&|[x, y], h| [x, y + h * (y - y0)], step)];
        [shift, vec![across, along, rising, up], Vec::new()]
    }

    /// The light's derivatives by the contrast of each area with what it lies on, relative to it: what the area adds. Areas of one contrast count as one.
    fn areas(&self, light: &[f64]) -> Vec<Vec<f64>> {
        let mut contrasts: Vec<f64> =
            self.near.pieces.iter().map(|piece| piece.contrast.abs()).filter(|contrast| *contrast > 0.0).collect();
        contrasts.sort_by(f64::total_cmp);
        contrasts.dedup();
        let Some((_, others)) = contrasts.split_last() else { return Vec::new() };
        let alone =
            |area: f64, piece: &Piece| Piece { contrast: if piece.contrast.abs() == area { piece.contrast } else { 0.0 }, ..*piece };
        let mut columns: Vec<Vec<f64>> = others.iter().map(|&area| self.light(0.0, |piece| alone(area, piece))).collect();
        // The last has what is left.
        let rest = |i: usize| light[i] - self.near.background - columns.iter().map(|column| column[i]).sum::<f64>();
        columns.push((0..light.len()).map(rest).collect());
        columns
    }

    /// The light of the window, with pieces as `changed` makes them.
    fn light(&self, background: f64, changed: impl Fn(&Piece) -> Piece) -> Vec<f64> {
        self.bounds.renderer.render_window(&self.near, background, changed, self.square)
    }
}

/// The sums of the products of every two columns, weighted row by row.
fn normal_equations(columns: &[&Vec<f64>], weights: &[f64]) -> DMatrix<f64> {
    let n = columns.len();
    let mut sums = vec![[0.0; LANES]; n * n];
    add_products(&mut sums, columns, weights);
    DMatrix::from_fn(n, n, |i, j| sums[i.max(j) * n + i.min(j)].iter().sum())
}

/// Adds the products of every column with itself and those before it, a block of rows at a time, which stays at hand.
#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
fn add_products(sums: &mut [[f64; LANES]], columns: &[&Vec<f64>], weights: &[f64]) {
    let n = columns.len();
    for (block, weights) in weights.chunks(BLOCK).enumerate() {
        let rows = block * BLOCK..block * BLOCK + weights.len();
        for i in 0..n {
            let mut weighted = [0.0; BLOCK];
            for ((weighted, value), weight) in weighted.iter_mut().zip(&columns[i][rows.clone()]).zip(weights) {
                *weighted = value * weight;
            }
            for j in 0..=i {
                let mut sum = sums[i * n + j];
                let (whole, rest) = columns[j][rows.clone()].as_chunks::<LANES>();
                for (weighted, other) in weighted.as_chunks::<LANES>().0.iter().zip(whole) {
                    for lane in 0..LANES {
                        sum[lane] += weighted[lane] * other[lane];
                    }
                }
                for (lane, other) in rest.iter().enumerate() {
                    sum[lane] += weighted[whole.len() * LANES + lane] * other;
                }
                sums[i * n + j] = sum;
            }
        }
    }
}

/// The places of a set's unknowns among all columns, and of each the place in the set from which those of its group are.
fn chosen(groups: [usize; 7], set: Unknowns) -> (Vec<usize>, Vec<usize>) {
    let added = matches!(set.gradient, Gradient::Added | Gradient::Both);
    let light = matches!(set.gradient, Gradient::Light | Gradient::Both);
    let members = [true, set.shape, set.blur, set.levels != Levels::None, added, light, set.levels == Levels::Areas];
    let mut first = 0;
    let (mut chosen, mut shared) = (Vec::new(), Vec::new());
    for (group, (count, member)) in groups.into_iter().zip(members).enumerate() {
        if member {
            let from = chosen.len();
            // A grey level of 1 and a contrast are no two of a kind.
            shared.extend((0..count).map(|k| if [LEVELS, AREAS].contains(&group) { from + k } else { from }));
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
mod tests;
