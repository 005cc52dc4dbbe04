//! The Cramér-Rao bound: how well the position of a target can be found in an image at best, whatever the operator.
//!
//! With `J` the derivatives of the noise-free grey values of a window by the unknowns and `S` the covariance of the grey values, no unbiased operator
//! has a smaller covariance than `(J^T S^-1 J)^-1`. What an operator has to estimate beside the position (directions and sizes, grey levels, sharpness)
//! widens the bound of the position.

use calibench_model::{Covariance, Gradient, Levels, PixelPoint, Unknowns};
use nalgebra::{DMatrix, Matrix2, Vector2};

use crate::optics::{Optics, OpticsError};
use crate::raster::{COLUMNS, Derivatives, Extent, Flow, LANES, MARGIN, Outlined, Picture, Piece, Renderer, Square, join_left, stride};

/// Steps of the differences where there is no blur, and grey values have kinks: px of a shift, and of a deformation at the window's edge.
const STEP: f64 = 0.05;
/// The group of the grey levels.
const LEVELS: usize = 3;
/// The group of the grey values of areas.
const AREAS: usize = 6;
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
}

impl Bounds {
    /// For windows of `window` x `window` px (odd) in pictures of `width` x `height` px through `optics`.
    ///
    /// # Errors
    /// Optics that are out of range.
    pub fn new(optics: &Optics, width: usize, height: usize, window: usize) -> Result<Self, OpticsError> {
        let renderer = Renderer::new(optics, width, height)?;
        Ok(Self { half: (window / 2) as i64, flow: Flow::new(&renderer), renderer })
    }

    /// What the grey values of the window around `at` tell; `None` if it leaves the image.
    pub fn window(&self, outlined: &Outlined<'_>, at: PixelPoint) -> Option<Window<'_>> {
        let picture = outlined.picture;
        let corner = [at.x.round() as i64 - self.half, at.y.round() as i64 - self.half];
        let side = 2 * self.half + 1;
        let inside =
            corner.iter().all(|&c| c >= 0) && corner[0] + side <= picture.width as i64 && corner[1] + side <= picture.height as i64;
        inside.then(|| Window { bounds: self, near: self.near(outlined, at, corner), at, square: Square { corner, side: side as usize } })
    }

    /// The picture with only those pieces that can matter to a window, moved by a step of any parameter or not.
    fn near(&self, outlined: &Outlined<'_>, at: PixelPoint, [left, top]: [i64; 2]) -> Picture {
        let [reach_x, reach_y] = self.renderer.reach();
        let (low, high) = (top as f64 - reach_y - 2.0, (top + 2 * self.half) as f64 + reach_y + 3.0);
        let right = (left + 2 * self.half) as f64 + reach_x + 3.0;
        // A deformation moves what is further off the further.
        let rate = STEP / self.half.max(1) as f64;
        let moved = |extent: &Extent| STEP + rate * extent.farthest([at.x, at.y]);
        let is_left = |extent: &Extent| extent.columns[1] + moved(extent) < left as f64 - reach_x - 2.0;
        let kept = |extent: &Extent| {
            let (moved, rows) = (moved(extent), extent.rows);
            rows[1] + moved > low && rows[0] - moved < high && extent.columns[0] - moved < right
        };
        // What is true of an outline is so of each of its pieces, which move no further.
        let pieces = join_left(outlined.pieces(is_left, kept), |piece| is_left(&Extent::of(piece)), |piece| kept(&Extent::of(piece)));
        Picture { pieces, ..*outlined.picture }
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

/// Memory that bounds are computed in, one after the other.
#[derive(Clone, Debug, Default)]
pub struct Work(Derivatives);

/// How many columns of the Jacobian there are of everything that somebody may have to estimate: position, shape, blur, levels, a gradient that is added, one that
/// multiplies, and the grey value of each area.
type Groups = [usize; 7];

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
        work: &mut Work,
    ) -> Vec<Option<Covariance>> {
        let Some((groups, normal)) = self.normal(sets, mean, variance, work) else { return vec![None; sets.len()] };
        let part = |set| {
            let (chosen, shared) = chosen(groups, set);
            let covariance = position(&normal.select_rows(&chosen).select_columns(&chosen), &shared)?;
            // A window that holds no edge tells of the position that it is somewhere about.
            (covariance.sxx + covariance.syy < self.square.side.pow(2) as f64).then_some(covariance)
        };
        sets.iter().map(|&set| part(set)).collect()
    }

    /// The normal equations of all that one of `sets` needs.
    fn normal(
        &self,
        sets: &[Unknowns],
        mean: impl Fn(f64) -> Option<f64>,
        variance: impl Fn(f64) -> Option<f64>,
        Work(derivatives): &mut Work,
    ) -> Option<(Groups, DMatrix<f64>)> {
        let wanted = |of: fn(&Unknowns) -> bool| sets.iter().any(of);
        let (shape, side) = (wanted(|set| set.shape), self.square.side);
        let dark = mean(0.0)?;
        let gain = mean(1.0)? - dark;
        let light = self.light(self.near.background, |piece| *piece);
        let blur = match &self.bounds.flow {
            Some(flow) => {
                flow.window(&self.bounds.renderer, &self.near, [self.at.x, self.at.y], self.square, derivatives);
                wanted(|set| set.blur)
            }
            None => {
                self.differences(shape, derivatives);
                false
            }
        };
        let areas = if wanted(|set| set.levels == Levels::Areas) { self.areas(&light) } else { Vec::new() };
        let groups = [2, if shape { 4 } else { 0 }, usize::from(blur), 2, 2, 2, areas.len()];
        let is_wanted = [true, true, shape, shape, shape, shape, blur];
        let moving: Vec<usize> = (0..COLUMNS).filter(|column| is_wanted[*column]).collect();
        let mut sums = Sums::new(groups.iter().sum(), side);
        for (y, light) in light.chunks_exact(side).enumerate() {
            let mut rows = sums.rows.chunks_exact_mut(stride(side));
            let mut next = || rows.next().unwrap_or_default();
            for &column in &moving {
                next().iter_mut().zip(derivatives.row(y, column)).for_each(|(to, from)| *to = gain * from);
            }
            let grey = |x: usize| dark + gain * light[x];
            let middle = self.bounds.half as f64;
            let (across, down) = (|x: usize| x as f64 - middle, y as f64 - middle);
            fill(next(), side, |_| 1.0);
            fill(next(), side, grey);
            fill(next(), side, across);
            fill(next(), side, |_| down);
            // As operators take it: grey values are zero without light. A black level would be one more plane.
            fill(next(), side, |x| across(x) * grey(x));
            fill(next(), side, |x| down * grey(x));
            for area in &areas {
                fill(next(), side, |x| gain * area[y * side + x]);
            }
            for (weight, x) in sums.weights[MARGIN..].iter_mut().zip(0..side) {
                *weight = 1.0 / variance(grey(x)).filter(|variance| *variance > 0.0)?;
            }
            sums.add();
        }
        Some((groups, sums.normal()))
    }

    /// The derivatives by position and shape as differences, without a blur.
    fn differences(&self, shape: bool, found: &mut Derivatives) {
        let side = self.square.side;
        found.clear(side);
        let mut put = |column: usize, by: &dyn Fn([f64; 2], f64) -> [f64; 2], step: f64| {
            let [high, low] = [0.5, -0.5].map(|half| {
                self.light(self.near.background, |piece| Piece { points: piece.points.map(|point| by(point, half * step)), ..*piece })
            });
            for (y, (high, low)) in high.chunks_exact(side).zip(low.chunks_exact(side)).enumerate() {
                fill(found.row_mut(y, column), side, |x| (high[x] - low[x]) / step);
            }
        };
        put(0, &|[x, y], h| [x + h, y], STEP);
        put(1, &|[x, y], h| [x, y + h], STEP);
        if shape {
            let (x0, y0) = (self.at.x, self.at.y);
            let step = STEP / self.bounds.half.max(1) as f64;
            put(2, &|[x, y], h| [x + h * (x - x0), y], step);
            put(3, &|[x, y], h| [x + h * (y - y0), y], step);
            put(4, &|[x, y], h| [x, y + h * (x - x0)], step);
            put(5, &|[x, y], h| [x, y + h * (y - y0)], step);
        }
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

/// Fills the pixels of a row between its margins.
fn fill(row: &mut [f64], side: usize, value: impl Fn(usize) -> f64) {
    row[MARGIN..][..side].iter_mut().enumerate().for_each(|(x, pixel)| *pixel = value(x));
}

/// The sums of the products of every two columns of the Jacobian, weighted, a row of the window at a time.
struct Sums {
    n: usize,
    /// Of each two columns, in lanes.
    products: Vec<[f64; LANES]>,
    /// The row's part of every column, with margins.
    rows: Vec<f64>,
    /// Those of the row's pixels; zero in the margins.
    weights: Vec<f64>,
}

impl Sums {
    fn new(n: usize, side: usize) -> Self {
        let stride = stride(side);
        Self { n, products: vec![[0.0; LANES]; n * n], rows: vec![0.0; n * stride], weights: vec![0.0; stride] }
    }

    /// Adds the row.
    fn add(&mut self) {
        add_products(&mut self.products, &self.rows, &self.weights);
    }

    fn normal(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.n, self.n, |i, j| self.products[i.max(j) * self.n + i.min(j)].iter().sum())
    }
}

/// Adds the products of every column with itself and those before it.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn add_products(products: &mut [[f64; LANES]], rows: &[f64], weights: &[f64]) {
    let (n, stride) = (rows.len() / weights.len(), weights.len());
    let mut weighted = vec![0.0; stride];
    for i in 0..n {
        let column = &rows[i * stride..(i + 1) * stride];
        for ((weighted, value), weight) in weighted.iter_mut().zip(column).zip(weights) {
            *weighted = value * weight;
        }
        for (j, other) in rows.chunks_exact(stride).take(i + 1).enumerate() {
            let mut sum = products[i * n + j];
            for (weighted, other) in weighted.as_chunks::<LANES>().0.iter().zip(other.as_chunks::<LANES>().0) {
                for lane in 0..LANES {
                    sum[lane] += weighted[lane] * other[lane];
                }
            }
            products[i * n + j] = sum;
        }
    }
}

/// The places of a set's unknowns among all columns, and of each the place in the set from which those of its group are.
fn chosen(groups: Groups, set: Unknowns) -> (Vec<usize>, Vec<usize>) {
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
