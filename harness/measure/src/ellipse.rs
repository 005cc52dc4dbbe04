//! The ellipse that a disc is pictured as, and where to look for it.

use calibench_model::{Affine, Image, PixelPoint, Rejection, Start};

/// The points `position + A (cos t, sin t)` with A symmetric and positive definite: no orientation, and so none that a circle leaves undetermined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// The centre (x, y), px as in [`PixelPoint`].
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
        let (mut grey, mut line) = (Vec::with_capacity(side * side), vec![0.0; side + 2]);
        for rows in rows.windows(3) {
            for (sum, ((above, here), below)) in line.iter_mut().zip(rows[0].iter().zip(rows[1]).zip(rows[2])) {
                *sum = (f64::from(*above) + 2.0 * f64::from(*here) + f64::from(*below)) / 16.0;
            }
            grey.extend(line.windows(3).map(|g| g[0] + 2.0 * g[1] + g[2]));
        }
        Self { first, side, grey }
    }

    fn disc(&self, start: PixelPoint) -> Option<Guess> {
        let threshold = otsu(&self.grey)?;
        let (light, border) = self.light_border(threshold);
        let dark_ground = 2 * light <= border;
        let is_target = |i: usize| (self.grey[i] > threshold) == dark_ground;
        let pixels = self.connected(self.nearest(start, is_target)?, is_target);
        let last = self.side - 1;
        let mut sums = [0.0; 5];
        for i in &pixels {
            let (x, y) = (i % self.side, i / self.side);
            if x == 0 || y == 0 || x == last || y == last {
                return None;
            }
            // From the window's middle: whole numbers, without rounding.
            let (x, y) = (x as f64 - (last / 2) as f64, y as f64 - (last / 2) as f64);
            sums = [sums[0] + x, sums[1] + y, sums[2] + x * x, sums[3] + x * y, sums[4] + y * y];
        }
        if pixels.len() < FEWEST {
            return None;
        }
        let [x, y, xx, xy, yy] = sums.map(|sum| sum / pixels.len() as f64);
        let moments = [xx - x * x + 1.0 / 12.0, xy - x * y, yy - y * y + 1.0 / 12.0];
        let centre = [0, 1].map(|axis| [x, y][axis] + (self.first[axis] + (last / 2) as i64) as f64);
        let (mut above, mut below) = ((0.0, 0.0), (0.0, 0.0));
        for grey in &self.grey {
            let class = if *grey > threshold { &mut above } else { &mut below };
            *class = (class.0 + grey, class.1 + 1.0);
        }
        let [above, below] = [above, below].map(|(sum, count)| sum / count);
        let (inside, outside) = if dark_ground { (above, below) } else { (below, above) };
        Some(Guess { ellipse: Ellipse::from_moments(centre, moments), inside, outside })
    }

    /// How many pixels of the border are above the threshold, and of how many.
    fn light_border(&self, threshold: f64) -> (usize, usize) {
        let (side, last) = (self.side, self.side - 1);
        let ends = self.grey[side..last * side].chunks_exact(side).flat_map(|row| [row[0], row[last]]);
        let border = self.grey[..side].iter().chain(&self.grey[last * side..]).copied().chain(ends);
        (border.filter(|grey| *grey > threshold).count(), 4 * last)
    }

    /// The pixel of the target that is nearest to the start, the first of several.
    fn nearest(&self, start: PixelPoint, is_target: impl Fn(usize) -> bool) -> Option<usize> {
        let (x, y) = (start.x - self.first[0] as f64, start.y - self.first[1] as f64);
        let (mut best, mut nearest) = (f64::INFINITY, None);
        for row in 0..self.side {
            let dy = row as f64 - y;
            for column in 0..self.side {
                let dx = column as f64 - x;
                let square = dx * dx + dy * dy;
                if square < best && is_target(row * self.side + column) {
                    (best, nearest) = (square, Some(row * self.side + column));
                }
            }
        }
        nearest
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
    let (mut counts, mut sums, scale) = ([0.0; STEPS], [0.0; STEPS], STEPS as f64 / range);
    for g in grey {
        let step = (((g - low) * scale) as u32 as usize).min(STEPS - 1);
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
