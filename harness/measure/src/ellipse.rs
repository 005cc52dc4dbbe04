//! The ellipse that a disc is pictured as, and where to look for it.

use calibench_model::{Affine, Image, PixelPoint, Rejection, Start};

/// The points `position + A (cos t, sin t)` with A symmetric and positive definite: no orientation, and so none that a circle leaves undetermined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// The centre, px.
    pub position: [f64; 2],
    /// `axx, axy, ayy` of A, px: its eigenvalues are the semi-axes.
    pub shape: [f64; 3],
}

impl Ellipse {
    /// The ellipse of half second moments: A is twice the root of the `moments` (xx, xy, yy) of an evenly filled ellipse.
    pub(crate) fn from_moments(position: [f64; 2], [xx, xy, yy]: [f64; 3]) -> Self {
        let root = (xx * yy - xy * xy).max(0.0).sqrt();
        let scale = 2.0 / (xx + yy + 2.0 * root).sqrt();
        Self { position, shape: [scale * (xx + root), scale * xy, scale * (yy + root)] }
    }

    /// The picture of a disc of diameter one under `affine`.
    fn from_affine(position: [f64; 2], affine: &Affine) -> Self {
        let Affine { axx, axy, ayx, ayy } = *affine;
        // The second moments of a disc of radius r are r^2 / 4.
        let moments = [axx * axx + axy * axy, axx * ayx + axy * ayy, ayx * ayx + ayy * ayy];
        Self::from_moments(position, moments.map(|m| m / 16.0))
    }

    /// The larger and the smaller semi-axis, px.
    pub fn semi_axes(&self) -> [f64; 2] {
        let [a, b, c] = self.shape;
        let (mean, half) = (0.5 * (a + c), (0.5 * (a - c)).hypot(b));
        [mean + half, mean - half]
    }

    /// Half the height and the width, px, whichever is more.
    pub(crate) fn extent(&self) -> f64 {
        let [a, b, c] = self.shape;
        a.hypot(b).max(b.hypot(c))
    }
}

/// A disc's picture, roughly.
pub(crate) struct Guess {
    pub(crate) ellipse: Ellipse,
    pub(crate) inside: f64,
    pub(crate) outside: f64,
}

/// Half-widths of the windows in which a disc is sought, px, until one holds it whole.
const HALVES: [i64; 7] = [7, 10, 15, 22, 33, 49, 73];
/// Fewer pixels than these are no disc.
const FEWEST: usize = 4;

/// The disc nearest to the start: what is connected and on the other side of Otsu's threshold than most of its window's border.
///
/// The start's affinity, if it has one, says how large the disc is.
///
/// # Errors
/// [`Rejection::Border`], [`Rejection::NotFinite`], [`Rejection::NoCorner`] when no window holds such an area whole.
pub(crate) fn seek(image: &Image, start: &Start) -> Result<Guess, Rejection> {
    let centre = start.position.nearest_pixel().ok_or(Rejection::NotFinite)?;
    let (mut why, smallest) = (Rejection::Border, start.affine.map_or(0.0, |a| Ellipse::from_affine([0.0; 2], &a).extent() + 2.0));
    for half in HALVES.into_iter().filter(|half| *half as f64 >= smallest) {
        if !image.holds(centre.0, centre.1, half) {
            return Err(why);
        }
        let patch = Patch::new(image, centre, half);
        if !patch.grey.iter().all(|grey| grey.is_finite()) {
            return Err(Rejection::NotFinite);
        }
        if let Some(guess) = patch.disc(start.position) {
            return Ok(guess);
        }
        why = Rejection::NoCorner;
    }
    Err(why)
}

/// A smoothed window.
struct Patch {
    first: [i64; 2],
    side: usize,
    grey: Vec<f64>,
}

impl Patch {
    /// Grey values smoothed by (1, 2, 1) along each axis, which leaves a third of white noise. The outermost pixels are left out.
    fn new(image: &Image, centre: (i64, i64), half: i64) -> Self {
        let side = (2 * half - 1) as usize;
        let first = [centre.0 - half + 1, centre.1 - half + 1];
        let rows: Vec<&[f32]> = image.rows_around(centre.0, centre.1, half).map(Iterator::collect).unwrap_or_default();
        let row = |y: usize, x: usize| f64::from(rows[y][x]) + 2.0 * f64::from(rows[y][x + 1]) + f64::from(rows[y][x + 2]);
        let grey = (0..side * side).map(|i| (i % side, i / side)).map(|(x, y)| (row(y, x) + 2.0 * row(y + 1, x) + row(y + 2, x)) / 16.0);
        Self { first, side, grey: grey.collect() }
    }

    fn disc(&self, start: PixelPoint) -> Option<Guess> {
        let threshold = otsu(&self.grey)?;
        let edge = |i: usize| [i % self.side, i / self.side].iter().any(|c| *c == 0 || c + 1 == self.side);
        let border = (0..self.grey.len()).filter(|i| edge(*i));
        let (light, all) = border.fold((0, 0), |(light, all), i| (light + usize::from(self.grey[i] > threshold), all + 1));
        let is_target = |i: usize| (self.grey[i] > threshold) != (2 * light > all);
        let position = |i: usize| [(i % self.side) as f64 + self.first[0] as f64, (i / self.side) as f64 + self.first[1] as f64];
        let distance = |i: usize| (position(i)[0] - start.x).hypot(position(i)[1] - start.y);
        let nearest = (0..self.grey.len()).filter(|i| is_target(*i)).min_by(|a, b| distance(*a).total_cmp(&distance(*b)))?;
        let pixels = self.connected(nearest, is_target);
        if pixels.len() < FEWEST || pixels.iter().any(|i| edge(*i)) {
            return None;
        }
        let count = pixels.len() as f64;
        let mean = |f: &dyn Fn([f64; 2]) -> f64| pixels.iter().map(|i| f(position(*i))).sum::<f64>() / count;
        let centre = [mean(&|p| p[0]), mean(&|p| p[1])];
        let moment = |a: usize, b: usize| mean(&|p| (p[a] - centre[a]) * (p[b] - centre[b])) + if a == b { 1.0 / 12.0 } else { 0.0 };
        let ellipse = Ellipse::from_moments(centre, [moment(0, 0), moment(0, 1), moment(1, 1)]);
        let level = |target: bool| {
            let (sum, n) =
                (0..self.grey.len()).filter(|i| is_target(*i) == target).fold((0.0, 0.0), |(s, n), i| (s + self.grey[i], n + 1.0));
            sum / n
        };
        Some(Guess { ellipse, inside: level(true), outside: level(false) })
    }

    /// The pixels connected with `seed` by their four neighbours.
    fn connected(&self, seed: usize, is_target: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut seen = vec![false; self.grey.len()];
        let mut pixels = vec![seed];
        seen[seed] = true;
        let mut next = 0;
        while let Some(&i) = pixels.get(next) {
            let (x, y) = (i % self.side, i / self.side);
            let neighbours = [
                (x > 0).then(|| i - 1),
                (x + 1 < self.side).then(|| i + 1),
                (y > 0).then(|| i - self.side),
                (y + 1 < self.side).then(|| i + self.side),
            ];
            for j in neighbours.into_iter().flatten() {
                if !seen[j] && is_target(j) {
                    seen[j] = true;
                    pixels.push(j);
                }
            }
            next += 1;
        }
        pixels
    }
}

/// The threshold between two classes that parts them best, from 64 steps of the range; `None` for one grey value.
///
/// Source: Otsu 1979.
fn otsu(grey: &[f64]) -> Option<f64> {
    const STEPS: usize = 64;
    let (low, high) = grey.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), g| (low.min(*g), high.max(*g)));
    let range = high - low;
    // Grey values have 24 bits.
    if range.is_nan() || range <= 1e-6 * low.abs().max(high.abs()) {
        return None;
    }
    let (mut counts, mut sums) = ([0.0; STEPS], [0.0; STEPS]);
    for g in grey {
        let step = (((g - low) / range * STEPS as f64) as usize).min(STEPS - 1);
        counts[step] += 1.0;
        sums[step] += g - low;
    }
    let (all, total) = (grey.len() as f64, sums.iter().sum::<f64>());
    let (mut below, mut sum, mut best, mut at) = (0.0, 0.0, -1.0, 0.0);
    for step in 0..STEPS - 1 {
        below += counts[step];
        sum += sums[step];
        let between = (total * below - sum * all).powi(2) / (below * (all - below));
        if between > best {
            (best, at) = (between, 0.5 * (sum / below + (total - sum) / (all - below)));
        }
    }
    (best > 0.0).then_some(low + at)
}
