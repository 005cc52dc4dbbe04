//! Where edges meet, to begin with: from the gradient of the grey values alone.

use calibench_model::Image;

/// Half the kernel and half the window of a place, px.
const KERNEL: i64 = 2;
const REACH: usize = 3;
/// A maximum of at least this part of the strongest may be the point.
const RIVAL: f64 = 0.5;
/// What is found lies within so many px of its window's middle.
const FAR: f64 = 4.0;

/// Products of the gradient xx, xy, yy, and those with the place from the field's corner.
const PRODUCTS: usize = 5;
/// Sums of these over a window.
type Sums = [f64; PRODUCTS];

/// The products at all places of a square field, row by row.
struct Field {
    side: usize,
    products: [Vec<f64>; PRODUCTS],
}

/// The Gaussian of a pixel, and its slope.
const TAPS: usize = 2 * KERNEL as usize + 1;
type Taps = [[f64; 2]; TAPS];

impl Field {
    /// Around a pixel, `reach` px along each axis; where the kernel leaves the image there is no gradient.
    fn new(image: &Image, (x, y): (i64, i64), reach: usize) -> Self {
        let (side, reach) = (2 * reach + 1, reach as i64);
        let mut field = Self { side, products: [(); PRODUCTS].map(|()| vec![0.0; side * side]) };
        let taps: Taps = std::array::from_fn(|i| {
            let t = i as f64 - KERNEL as f64;
            let bell = (-0.5 * t * t).exp();
            [bell, t * bell]
        });
        let wide = side + 2 * KERNEL as usize;
        let left = x - reach - KERNEL;
        let (first, last) = ((-left).max(0) as usize, (image.width() as i64 - left).min(wide as i64) as usize);
        let mut down = [(); 2].map(|()| vec![0.0; wide]);
        for row in 0..side {
            let cy = y - reach + row as i64;
            if cy < KERNEL || cy + KERNEL >= image.height() as i64 {
                continue;
            }
            let from = (left + first as i64) as usize;
            let lines = std::array::from_fn(|tap| &image.row((cy - KERNEL) as usize + tap)[from..][..last - first]);
            smooth_down(lines, &taps, down.each_mut().map(|down| &mut down[first..last]));
            let products = field.products.each_mut().map(|products| &mut products[row * side..][..side]);
            multiply(down.each_ref().map(Vec::as_slice), &taps, (first, (last - TAPS + 1).min(side)), (products, row as f64));
        }
        field
    }

    /// The sums over squares of half-width [`REACH`] around the places that are so far from the rim, row by row.
    fn over_squares(&self) -> [Vec<f64>; PRODUCTS] {
        let (side, inner) = (self.side, self.side - 2 * REACH);
        let mut across = vec![0.0; side * inner];
        self.products.each_ref().map(|products| {
            let mut sums = vec![0.0; inner * inner];
            add_squares(products, (side, inner), (&mut across, &mut sums));
            sums
        })
    }
}

/// Smooths along columns, and differentiates.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn smooth_down(lines: [&[f32]; TAPS], taps: &Taps, [smooth, slope]: [&mut [f64]; 2]) {
    smooth.fill(0.0);
    slope.fill(0.0);
    for (line, [bell, steep]) in lines.iter().zip(taps) {
        for ((smooth, slope), grey) in smooth.iter_mut().zip(&mut *slope).zip(*line) {
            *smooth += bell * f64::from(*grey);
            *slope += steep * f64::from(*grey);
        }
    }
}

/// The products of a row: of what is smoothed along columns and what is differentiated, from the `first` column to before the `last`.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn multiply(
    [smooth, slope]: [&[f64]; 2],
    taps: &Taps,
    (first, last): (usize, usize),
    ([xx, xy, yy, bx, by], row): ([&mut [f64]; PRODUCTS], f64),
) {
    for column in first..last.max(first) {
        let (smooth, slope) = (&smooth[column..][..TAPS], &slope[column..][..TAPS]);
        let [mut gx, mut gy] = [0.0; 2];
        for ((smooth, slope), [bell, steep]) in smooth.iter().zip(slope).zip(taps) {
            gx += steep * smooth;
            gy += bell * slope;
        }
        let along = gx * column as f64 + gy * row;
        (xx[column], xy[column], yy[column]) = (gx * gx, gx * gy, gy * gy);
        (bx[column], by[column]) = (gx * along, gy * along);
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn add_squares(products: &[f64], (side, inner): (usize, usize), (across, sums): (&mut [f64], &mut [f64])) {
    let width = 2 * REACH + 1;
    across.fill(0.0);
    for (line, across) in products.chunks_exact(side).zip(across.chunks_exact_mut(inner)) {
        for from in 0..width {
            across.iter_mut().zip(&line[from..]).for_each(|(sum, more)| *sum += more);
        }
    }
    for (row, sums) in sums.chunks_exact_mut(inner).enumerate() {
        for line in across[row * inner..][..width * inner].chunks_exact(inner) {
            sums.iter_mut().zip(line).for_each(|(sum, more)| *sum += more);
        }
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
    let of_place = |index: usize| -> Sums { std::array::from_fn(|product| sums[product][index]) };
    let strengths: Vec<f64> = (0..side * side).map(|index| strength(&of_place(index))).collect();
    let best = strengths.iter().copied().fold(0.0, f64::max);
    let is_maximum = |column: usize, row: usize| {
        let around = |place: usize| place.saturating_sub(1)..(place + 2).min(side);
        around(row).all(|r| around(column).all(|c| strengths[r * side + c] <= strengths[row * side + column]))
    };
    let off = |place: usize| (place as i64 - search as i64).pow(2);
    let strong = (0..side * side).filter(|&index| strengths[index] >= RIVAL * best && is_maximum(index % side, index / side));
    let index = strong.min_by_key(|index| off(index % side) + off(index / side)).filter(|_| best > 0.0)?;
    let [xx, xy, yy, bx, by] = of_place(index);
    let determinant = xx * yy - xy * xy;
    let middle = [index % side + REACH, index / side + REACH].map(|place| place as f64);
    let point = [(yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant];
    let inside = |i: usize| middle[i] + (point[i] - middle[i]).clamp(-FAR, FAR);
    let corner = [x, y].map(|place| (place - reach as i64) as f64);
    let found = [corner[0] + inside(0), corner[1] + inside(1)];
    found.iter().all(|place| place.is_finite()).then_some(found)
}
