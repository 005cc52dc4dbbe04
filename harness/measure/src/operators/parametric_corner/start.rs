//! Where a chess corner is and how it is turned, to begin with: from the image alone.

use calibench_model::Image;
use nalgebra::Complex;

/// Half the widest kernel, px.
const WIDEST: usize = 5;
/// Half the widest field of places, px.
const FIELD: usize = 12;

/// Strengths of saddles, row by row.
type Field = [[f64; 2 * FIELD + 1]; 2 * FIELD + 1];

/// The start: position (px, in the image), directions of the normals (rad), mean of the two grey values and half their difference.
pub(super) struct Guess {
    pub(super) position: [f64; 2],
    pub(super) normals: [f64; 2],
    pub(super) mean: f64,
    pub(super) half: f64,
}

/// Gaussian derivatives of order 0, 1 and 2, sampled.
struct Kernels {
    reach: usize,
    taps: [[f64; 2 * WIDEST + 1]; 3],
}

impl Kernels {
    /// With a standard deviation of `reach / 2.5` px.
    fn new(reach: usize) -> Self {
        let sigma = reach as f64 / 2.5;
        let mut taps = [[0.0; 2 * WIDEST + 1]; 3];
        let [value, slope, bend] = &mut taps;
        for i in 0..=2 * reach {
            let t = (i as f64 - reach as f64) / sigma;
            let bell = (-0.5 * t * t).exp();
            (value[i], slope[i], bend[i]) = (bell, t * bell, (t * t - 1.0) * bell);
        }
        // Truncated and sampled, the second derivative must still not see a constant.
        let excess = bend.iter().sum::<f64>() / value.iter().sum::<f64>();
        for (bend, value) in bend.iter_mut().zip(value) {
            *bend -= excess * *value;
        }
        Self { reach, taps }
    }
}

/// Of the saddles within `search` px of a pixel along each axis the nearest that is at least half as strong as the strongest, refined by a parabola an axis. `reach` is half the kernel.
///
/// Its strength is minus the determinant of the second derivatives: positive on saddles alone, zero along straight edges. `None` when
/// there is no saddle. The image holds `reach` px around the pixel; places nearer to its border are left out.
pub(super) fn saddle(image: &Image, (x, y): (i64, i64), search: usize, reach: usize) -> Option<[f64; 2]> {
    let kernels = Kernels::new(reach.min(WIDEST));
    let side = 2 * search + 1;
    let mut strengths: Field = [[0.0; 2 * FIELD + 1]; 2 * FIELD + 1];
    let [left, top] = [x, y].map(|c| c - search as i64);
    let mut columns = Columns { filtered: [[0.0; 2 * (FIELD + WIDEST) + 1]; 3], inside: (1, 0) };
    let (mut best, mut at) = (0.0, None);
    for (row, line) in strengths.iter_mut().take(side).enumerate() {
        let cy = top + row as i64;
        columns.fill(image, &kernels, left, cy, side);
        for (column, strength) in line.iter_mut().take(side).enumerate() {
            *strength = columns.strength(&kernels, column);
            if *strength > best {
                (best, at) = (*strength, Some((column, row)));
            }
        }
    }
    let (column, row) = nearest(&strengths, side, best, at?);
    let best = strengths[row][column];
    let peak = |low: f64, high: f64| {
        let (slope, bend) = (0.5 * (high - low), 2.0 * best - low - high);
        if bend > 0.0 && low > 0.0 && high > 0.0 { (slope / bend).clamp(-0.5, 0.5) } else { 0.0 }
    };
    let value = |c: usize, r: usize| if c < side && r < side { strengths[r][c] } else { 0.0 };
    let dx = peak(value(column.wrapping_sub(1), row), value(column + 1, row));
    let dy = peak(value(column, row.wrapping_sub(1)), value(column, row + 1));
    Some([left as f64 + column as f64 + dx, top as f64 + row as f64 + dy])
}

/// Of the maxima of half of the strength `best` or more the one nearest to the middle: on a board of small squares the next corner may be the stronger.
fn nearest(strengths: &Field, side: usize, best: f64, strongest: (usize, usize)) -> (usize, usize) {
    let is_maximum = |column: usize, row: usize| {
        let around = |place: usize| place.saturating_sub(1)..(place + 2).min(side);
        around(row).all(|r| around(column).all(|c| strengths[r][c] <= strengths[row][column]))
    };
    let off = |(column, row): (usize, usize)| [column, row].map(|place| (place as i64 - side as i64 / 2).pow(2)).iter().sum::<i64>();
    let places = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
    let strong = places.filter(|&(column, row)| strengths[row][column] >= 0.5 * best && is_maximum(column, row));
    strong.chain([strongest]).min_by_key(|place| off(*place)).unwrap_or(strongest)
}

/// Columns of the image around one row, filtered downwards by each kernel.
struct Columns {
    filtered: [[f64; 2 * (FIELD + WIDEST) + 1]; 3],
    /// The first and the last place whose kernel is inside the image.
    inside: (usize, usize),
}

impl Columns {
    fn fill(&mut self, image: &Image, kernels: &Kernels, left: i64, cy: i64, side: usize) {
        let reach = kernels.reach as i64;
        self.inside = (1, 0);
        if cy < reach || cy + reach >= image.height() as i64 {
            return;
        }
        // Places that are left out on either side.
        let first = (reach - left).max(0) as usize;
        let last = (image.width() as i64 - 1 - reach - left).min(side as i64 - 1);
        if last < first as i64 {
            return;
        }
        self.inside = (first, last as usize);
        let span = first..last as usize + 2 * kernels.reach + 1;
        self.filtered = [[0.0; 2 * (FIELD + WIDEST) + 1]; 3];
        for (tap, y) in (cy - reach..=cy + reach).enumerate() {
            let from = (left - reach + first as i64) as usize;
            let grey = &image.row(y as usize)[from..from + span.len()];
            for (filtered, taps) in self.filtered.iter_mut().zip(&kernels.taps) {
                for (sum, grey) in filtered[span.clone()].iter_mut().zip(grey) {
                    *sum += taps[tap] * f64::from(*grey);
                }
            }
        }
    }

    fn strength(&self, kernels: &Kernels, column: usize) -> f64 {
        if column < self.inside.0 || column > self.inside.1 {
            return 0.0;
        }
        let across = |order: usize, down: usize| -> f64 {
            let taps = &kernels.taps[order][..=2 * kernels.reach];
            taps.iter().zip(&self.filtered[down][column..]).map(|(tap, value)| tap * value).sum()
        };
        let (xx, xy, yy) = (across(2, 0), across(1, 1), across(0, 2));
        xy * xy - xx * yy
    }
}

/// Whether the grey values of the window of half-width `half` px around `position` correlate with those opposite it. Around a crossing of edges they do, by 1
/// less the noise; beside a straight edge by -1, around the corner of one area of 90 degrees by -1/3. The window is in the image.
pub(super) fn is_like_its_opposite(image: &Image, position: [f64; 2], half: i64) -> bool {
    let [x, y] = position.map(|p| p.round() as i64);
    let [twice_x, twice_y] = position.map(|p| (2.0 * p).round() as i64);
    // Columns and rows whose opposites are in the window as well.
    let both = |middle: i64, twice: i64| (middle - half).max(twice - middle - half)..=(middle + half).min(twice - middle + half);
    let (mut count, mut sum, mut products, mut squares) = (0.0, 0.0, 0.0, 0.0);
    let zero = f64::from(image.row(y as usize)[x as usize]);
    for row in both(y, twice_y) {
        let (here, there) = (image.row(row as usize), image.row((twice_y - row) as usize));
        for column in both(x, twice_x) {
            let a = f64::from(here[column as usize]) - zero;
            let b = f64::from(there[(twice_x - column) as usize]) - zero;
            count += 1.0;
            sum += a;
            squares += a * a;
            products += a * b;
        }
    }
    let square = sum * sum / count;
    // Of constant grey values nothing can be said.
    products - square > 0.0 || squares <= square
}

/// The two edges and grey values seen around `position`, in the disc of `half` px around it.
///
/// Around a chess corner the grey value jumps four times: of its Fourier coefficients by direction the second is `(2/pi) sin b` and the fourth `(1/pi) sin 2b`
/// in units of half the contrast, with b the width of a light sector, and their phases are two and four times the direction of its middle.
/// `None` when all grey values are the same to rounding.
pub(super) fn directions(image: &Image, position: [f64; 2], half: i64) -> Option<Guess> {
    let centre = position.map(|p| p.round() as i64);
    let (mut weights, mut mean) = (0.0, 0.0);
    let (mut waves, mut lattice) = ([Complex::new(0.0, 0.0); 2], [Complex::new(0.0, 0.0); 2]);
    for (row, grey) in image.rows_around(centre[0], centre[1], half)?.enumerate() {
        for (column, grey) in grey.iter().enumerate() {
            let at = [column, row].map(|index| index as i64 - half);
            let z = Complex::new((centre[0] + at[0]) as f64 - position[0], (centre[1] + at[1]) as f64 - position[1]);
            let r2 = z.norm_sqr() / (half * half) as f64;
            if r2 <= 1.0 {
                // Next to the corner blur hides the edges, and a disc without a sharp rim hides the lattice.
                let weight = r2 * (1.0 - r2);
                let double = if r2 > 0.0 { z.conj() * z.conj() / z.norm_sqr() } else { z };
                let terms = [double, double * double];
                for k in 0..2 {
                    waves[k] += terms[k] * (weight * f64::from(*grey));
                    lattice[k] += terms[k] * weight;
                }
                weights += weight;
                mean += weight * f64::from(*grey);
            }
        }
    }
    mean /= weights;
    let [second, fourth] = [0, 1].map(|k| (waves[k] - lattice[k] * mean) / weights);
    let size = second.norm();
    let middle = -0.5 * second.arg();
    let cosine = ((fourth * Complex::from_polar(1.0, 4.0 * middle)).re / size).clamp(-0.8, 0.8);
    let width = cosine.acos();
    let quarter = std::f64::consts::FRAC_PI_2;
    let normals = [middle + 0.5 * width - quarter, middle - 0.5 * width + quarter];
    let contrast = size * quarter / width.sin();
    // The light sectors cover width / 90 degrees of the mean.
    let mean = mean - contrast * (width / quarter - 1.0);
    // Grey values have 24 bits.
    (contrast.is_finite() && contrast > 1e-6 * mean.abs()).then_some(Guess { position, normals, mean, half: contrast })
}
