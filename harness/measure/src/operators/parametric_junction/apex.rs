//! Where edges meet, to begin with: from the gradient of the grey values alone.

use calibench_model::Image;

/// Half the kernel and half the window of a place, px.
const KERNEL: i64 = 2;
const REACH: usize = 3;
/// A maximum of at least this part of the strongest may be the point.
const RIVAL: f64 = 0.5;
/// What is found lies within so many px of its window's middle.
const FAR: f64 = 4.0;

/// Sums over a window: of the products of the gradient xx, xy, yy, and of those with the place from the field's corner.
type Sums = [f64; 5];

/// The gradient's products at all places of a square field.
struct Field {
    side: usize,
    sums: Vec<Sums>,
}

impl Field {
    /// Around a pixel, `reach` px along each axis; where the kernel leaves the image there is no gradient.
    fn new(image: &Image, (x, y): (i64, i64), reach: usize) -> Self {
        let (side, reach) = (2 * reach + 1, reach as i64);
        let mut field = Self { side, sums: vec![[0.0; 5]; side * side] };
        let taps: [(f64, f64); 5] = std::array::from_fn(|i| {
            let t = i as f64 - KERNEL as f64;
            let bell = (-0.5 * t * t).exp();
            (bell, t * bell)
        });
        let wide = side + 2 * KERNEL as usize;
        let mut down = vec![[0.0; 2]; wide];
        for row in 0..side {
            let cy = y - reach + row as i64;
            if cy < KERNEL || cy + KERNEL >= image.height() as i64 {
                continue;
            }
            down.fill([0.0; 2]);
            let left = x - reach - KERNEL;
            let (first, last) = ((-left).max(0), (image.width() as i64 - left).min(wide as i64));
            for (tap, (bell, slope)) in taps.iter().enumerate() {
                let line = image.row((cy - KERNEL) as usize + tap);
                for column in first..last {
                    let grey = f64::from(line[(left + column) as usize]);
                    let at = &mut down[column as usize];
                    at[0] += bell * grey;
                    at[1] += slope * grey;
                }
            }
            for column in first.max(0)..(last - 2 * KERNEL).min(side as i64) {
                let column = column as usize;
                let around = &down[column..column + taps.len()];
                let [mut gx, mut gy] = [0.0; 2];
                for (down, (bell, slope)) in around.iter().zip(&taps) {
                    gx += slope * down[0];
                    gy += bell * down[1];
                }
                let (px, py) = (column as f64, row as f64);
                field.sums[row * side + column] = [gx * gx, gx * gy, gy * gy, gx * (gx * px + gy * py), gy * (gx * px + gy * py)];
            }
        }
        field
    }

    /// The sums over squares of half-width [`REACH`] around the places that are so far from the rim.
    fn over_squares(&self) -> Vec<Sums> {
        let (side, width) = (self.side, 2 * REACH + 1);
        let inner = side - 2 * REACH;
        let plus = |sum: &mut Sums, more: &Sums, sign: f64| sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += sign * more);
        let mut across = vec![[0.0; 5]; side * inner];
        for (line, across) in self.sums.chunks_exact(side).zip(across.chunks_exact_mut(inner)) {
            for (column, sum) in across.iter_mut().enumerate() {
                line[column..column + width].iter().for_each(|more| plus(sum, more, 1.0));
            }
        }
        let mut sums = vec![[0.0; 5]; inner * inner];
        for row in 0..inner {
            for line in row..row + width {
                for column in 0..inner {
                    plus(&mut sums[row * inner + column], &across[line * inner + column], 1.0);
                }
            }
        }
        sums
    }
}

/// The strength of a place: that of its weaker direction, the determinant by the trace.
fn strength([xx, xy, yy, ..]: &Sums) -> f64 {
    let (trace, determinant) = (xx + yy, xx * yy - xy * xy);
    if trace > 0.0 { determinant / trace } else { 0.0 }
}

/// Of the places within `search` px of a pixel along each axis the nearest that is at least half as strong as the strongest: the point to which its window's
/// edges lead (Förstner & Gülch 1987), px in the image. `None` where there are no two directions.
pub(super) fn apex(image: &Image, (x, y): (i64, i64), search: usize) -> Option<[f64; 2]> {
    let reach = search + REACH;
    let sums = Field::new(image, (x, y), reach).over_squares();
    let side = 2 * search + 1;
    let strengths: Vec<f64> = sums.iter().map(strength).collect();
    let best = strengths.iter().copied().fold(0.0, f64::max);
    let is_maximum = |column: usize, row: usize| {
        let around = |place: usize| place.saturating_sub(1)..(place + 2).min(side);
        around(row).all(|r| around(column).all(|c| strengths[r * side + c] <= strengths[row * side + column]))
    };
    let off = |place: usize| (place as i64 - search as i64).pow(2);
    let strong = (0..side * side).filter(|&index| strengths[index] >= RIVAL * best && is_maximum(index % side, index / side));
    let index = strong.min_by_key(|index| off(index % side) + off(index / side)).filter(|_| best > 0.0)?;
    let [xx, xy, yy, bx, by] = sums[index];
    let determinant = xx * yy - xy * xy;
    let middle = [index % side + REACH, index / side + REACH].map(|place| place as f64);
    let point = [(yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant];
    let inside = |i: usize| middle[i] + (point[i] - middle[i]).clamp(-FAR, FAR);
    let corner = [x, y].map(|place| (place - reach as i64) as f64);
    let found = [corner[0] + inside(0), corner[1] + inside(1)];
    found.iter().all(|place| place.is_finite()).then_some(found)
}
