//! The pixels of a target, for a fit that only wants to begin near by: a row of pixels is a word of bits.

use calibench_model::Rejection;

use super::profile::LANES;
use crate::lanes::side_by_side;

/// The largest window, px; a row fits into a word.
pub(super) const WIDEST: usize = 48;
/// Most thresholds that are tried, and the change, as a part of the range of grey values, that ends it.
const THRESHOLDS: (usize, f32) = (8, 0.01);
/// How far around the pixels beyond the threshold a blurred edge still shows, px.
const EDGE: usize = 2;

/// A window's grey values: rows of `side` pixels, padded with zeros to `stride`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grey<'a> {
    /// Pixels on a side.
    pub(super) side: usize,
    /// From row to row, whole [`LANES`].
    pub(super) stride: usize,
    /// The values.
    pub(super) values: &'a [f32],
    /// For each column of a row one, or zero where it is padded.
    pub(super) inside: &'a [f32],
}

/// The connected pixels of one target. Positions count from the window's first pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    /// Mean position, px, weighted by how far the grey values are from the ground's.
    pub(super) centre: [f64; 2],
    /// Second central moments xx, xy, yy of the pixels, px^2.
    pub(super) moments: [f64; 3],
}

type Words = [u64; WIDEST];

impl Grey<'_> {
    /// Calls `each` with `LANES` pixels at a time: row, first column, values, and ones where there are pixels.
    #[inline(always)]
    fn for_blocks(self, mut each: impl FnMut(usize, usize, &[f32; LANES], &[f32; LANES])) {
        for column in (0..self.stride).step_by(LANES) {
            let inside = side_by_side(self.inside, column);
            for row in 0..self.side {
                each(row, column, side_by_side(self.values, row * self.stride + column), inside);
            }
        }
    }
}

/// The lowest and the highest grey value.
///
/// # Errors
/// [`Rejection::NotFinite`]; [`Rejection::NoCorner`] if all values are the same.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
pub(super) fn range(grey: Grey<'_>) -> Result<(f32, f32), Rejection> {
    let (mut low, mut high, mut sum) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES], [0.0_f32; LANES]);
    grey.for_blocks(|_, _, values, inside| {
        for lane in 0..LANES {
            // Zero times what is not a finite number is none.
            sum[lane] += values[lane] * 0.0;
            let (value, pixel) = (values[lane], inside[lane] > 0.0);
            low[lane] = if pixel && value < low[lane] { value } else { low[lane] };
            high[lane] = if pixel && value > high[lane] { value } else { high[lane] };
        }
    });
    let low = low.into_iter().fold(f32::INFINITY, f32::min);
    let high = high.into_iter().fold(f32::NEG_INFINITY, f32::max);
    match sum.into_iter().all(|sum| sum == 0.0) {
        false => Err(Rejection::NotFinite),
        true if low < high => Ok((low, high)),
        true => Err(Rejection::NoCorner),
    }
}

/// The connected pixels at or next to (`x`, `y`) that are on the side of a threshold on which most of the window's border is not.
///
/// The threshold is midway between the means of the pixels on its two sides, as is Otsu's. `None` if there are fewer than `fewest` of these pixels or they
/// reach the window's border.
///
/// Source: Ridler & Calvard 1978 (threshold).
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
pub(super) fn of(grey: Grey<'_>, range: (f32, f32), start: [f64; 2], fewest: usize) -> Option<Area> {
    let side = grey.side;
    if side > WIDEST {
        return None;
    }
    let whole = u64::MAX >> (64 - side);
    let mut inside = light(grey, threshold(grey, range)?);
    choose(&mut inside[..side], whole);
    let (x, y) = nearest(&inside[..side], start)?;
    let members = connected(&inside, side, x, y);
    let sides = 1 | 1 << (side - 1);
    if members[0] != 0 || members[side - 1] != 0 || members[..side].iter().any(|row| row & sides != 0) {
        return None;
    }
    let (count, plain, moments) = shape(&members[..side]);
    let area = |centre| Area { centre, moments };
    (count >= fewest).then(|| area(weighted(grey, &inside, &members, plain, whole).unwrap_or(plain)))
}

#[inline(always)]
fn total(lanes: &[f32; LANES]) -> f32 {
    let halves: [f32; LANES / 2] = std::array::from_fn(|i| lanes[i] + lanes[i + LANES / 2]);
    let [a, b, c, d, e, f, g, h] = halves;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

#[inline(always)]
fn threshold(grey: Grey<'_>, (low, high): (f32, f32)) -> Option<f32> {
    let mut threshold = low + (high - low) / 2.0;
    for _ in 0..THRESHOLDS.0 {
        let [mut count, mut above, mut all] = [[0.0; LANES]; 3];
        grey.for_blocks(|_, _, values, inside| {
            for lane in 0..LANES {
                let one = if values[lane] > threshold { inside[lane] } else { 0.0 };
                count[lane] += one;
                above[lane] += one * values[lane];
                all[lane] += values[lane];
            }
        });
        let (count, above, rest) = (total(&count), total(&above), (grey.side * grey.side) as f32 - total(&count));
        if count == 0.0 || rest == 0.0 {
            return None;
        }
        let next = (above / count + (total(&all) - above) / rest) / 2.0;
        let change = (next - threshold).abs();
        threshold = next;
        if change <= THRESHOLDS.1 * (high - low) {
            break;
        }
    }
    Some(threshold)
}

/// The pixels above the threshold.
#[inline(always)]
fn light(grey: Grey<'_>, threshold: f32) -> Words {
    let mut light = [0; WIDEST];
    for (row, bits) in light[..grey.side].iter_mut().enumerate() {
        for column in (0..grey.stride).step_by(LANES) {
            let values: &[f32; LANES] = side_by_side(grey.values, row * grey.stride + column);
            let inside: &[f32; LANES] = side_by_side(grey.inside, column);
            let mut word = 0_u32;
            for lane in 0..LANES {
                word |= u32::from(inside[lane] > 0.0 && values[lane] > threshold) << lane;
            }
            *bits |= u64::from(word) << column;
        }
    }
    light
}

/// Keeps these pixels, or takes the others, if most of the border is of these.
#[inline(always)]
fn choose(rows: &mut [u64], whole: u64) {
    let last = rows.len() - 1;
    let sides = 1_u64 | 1 << last;
    let between: u32 = rows[1..last].iter().map(|row| (row & sides).count_ones()).sum();
    let on_border = rows[0].count_ones() + rows[last].count_ones() + between;
    if on_border as usize > 2 * last {
        rows.iter_mut().for_each(|row| *row = !*row & whole);
    }
}

/// The places of the bits that are set.
#[inline(always)]
fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = word.trailing_zeros() as usize;
        (word != 0).then(|| {
            word &= word - 1;
            place
        })
    })
}

#[inline(always)]
fn nearest(inside: &[u64], [x, y]: [f64; 2]) -> Option<(usize, usize)> {
    let (column, row) = ((x + 0.5) as usize, (y + 0.5) as usize);
    if inside.get(row).is_some_and(|word| column < 64 && word >> column & 1 == 1) {
        return Some((column, row));
    }
    let places = inside.iter().enumerate().flat_map(|(row, &word)| bits(word).map(move |column| (column, row)));
    let distance = |&(column, row): &(usize, usize)| (column as f64 - x).powi(2) + (row as f64 - y).powi(2);
    places.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// The pixels that four neighbours connect with (`x`, `y`).
#[inline(always)]
fn connected(inside: &Words, side: usize, x: usize, y: usize) -> Words {
    let mut members = [0; WIDEST];
    members[y] = 1 << x;
    let (mut top, mut bottom, mut down) = (y, y, true);
    // Down and up, until a whole way back and forth finds nothing more.
    let mut idle = 0;
    while idle < 2 {
        let (first, last) = (top.saturating_sub(1), (bottom + 1).min(side - 1));
        let (mut grew, mut row) = (false, if down { first } else { last });
        loop {
            let above = if row > 0 { members[row - 1] } else { 0 };
            let below = if row + 1 < side { members[row + 1] } else { 0 };
            let word = spread((members[row] | above | below) & inside[row], inside[row]);
            if word != members[row] {
                (members[row], grew, top, bottom) = (word, true, top.min(row), bottom.max(row));
            }
            let end = if down { (bottom + 1).min(side - 1) } else { top.saturating_sub(1) };
            if row == end {
                break;
            }
            row = if down { row + 1 } else { row - 1 };
        }
        idle = if grew { 0 } else { idle + 1 };
        down = !down;
    }
    members
}

/// The runs of `inside` that hold a bit of `word`.
#[inline(always)]
fn spread(mut word: u64, inside: u64) -> u64 {
    loop {
        let wider = (word | word << 1 | word >> 1) & inside;
        if wider == word {
            return word;
        }
        word = wider;
    }
}

/// Number, mean position and second central moments.
#[inline(always)]
fn shape(members: &[u64]) -> (usize, [f64; 2], [f64; 3]) {
    let (mut n, mut sx, mut sy, mut xx, mut xy, mut yy) = (0, 0, 0, 0, 0, 0);
    for (y, &row) in members.iter().enumerate().filter(|(_, row)| **row != 0) {
        let (mut x1, mut x2) = (0, 0);
        for x in bits(row) {
            (x1, x2) = (x1 + x, x2 + x * x);
        }
        let count = row.count_ones() as usize;
        (n, sx, sy) = (n + count, sx + x1, sy + y * count);
        (xx, xy, yy) = (xx + x2, xy + y * x1, yy + y * y * count);
    }
    let mean = |sum: usize| sum as f64 / n as f64;
    let (x, y) = (mean(sx), mean(sy));
    (n, [x, y], [mean(xx) - x * x, mean(xy) - x * y, mean(yy) - y * y])
}

/// The mean position of `members` and their blurred edge, weighted by the difference from the ground; `None` if it lies elsewhere than the pixels or no
/// ground is seen.
#[inline(always)]
fn weighted(grey: Grey<'_>, inside: &Words, members: &Words, plain: [f64; 2], whole: u64) -> Option<[f64; 2]> {
    let (mut others, target) = (widened(inside, grey.side, whole), widened(members, grey.side, whole));
    others[..grey.side].iter_mut().for_each(|row| *row = !*row & whole);
    let (count, [ground, _, _]) = sums(grey, &others, 0.0);
    let (_, [sum, x, y]) = sums(grey, &target, ground / count);
    let centre = [f64::from(x / sum), f64::from(y / sum)];
    // Written so that what is not a number is refused.
    ((centre[0] - plain[0]).abs() < 1.0 && (centre[1] - plain[1]).abs() < 1.0).then_some(centre)
}

/// With the pixels up to [`EDGE`] away along each axis.
#[inline(always)]
fn widened(words: &Words, side: usize, whole: u64) -> Words {
    let mut across = [0; WIDEST];
    for (to, word) in across[..side].iter_mut().zip(words) {
        *to = (1..=EDGE).fold(*word, |sum, by| sum | word << by | word >> by) & whole;
    }
    let mut wide = [0; WIDEST];
    for (row, to) in wide[..side].iter_mut().enumerate() {
        let rows = row.saturating_sub(EDGE)..(row + EDGE + 1).min(side);
        *to = across[rows].iter().fold(0, |sum, word| sum | word);
    }
    wide
}

/// The number of pixels, and the sums of their grey values less `ground`, alone and times column and row.
#[inline(always)]
fn sums(grey: Grey<'_>, words: &Words, ground: f32) -> (f32, [f32; 3]) {
    let [mut count, mut sum, mut x, mut y] = [[0.0; LANES]; 4];
    grey.for_blocks(|row, column, values, _| {
        let word = (words[row] >> column) as u32;
        for lane in 0..LANES {
            let one = if word >> lane & 1 == 1 { 1.0 } else { 0.0 };
            let weight = one * (values[lane] - ground);
            count[lane] += one;
            sum[lane] += weight;
            x[lane] += weight * (column + lane) as f32;
            y[lane] += weight * row as f32;
        }
    });
    (total(&count), [total(&sum), total(&x), total(&y)])
}

#[cfg(test)]
mod tests {
    use calibench_model::{Image, PixelPoint};

    use super::*;
    use crate::blob::{Polarity, Segmentation};
    use crate::lsm::planes::Planes;

    fn area(image: &Image, (x, y): (i64, i64), half: i64, start: [f64; 2]) -> Option<Area> {
        let mut planes = Planes::new(2 * half as usize + 1);
        planes.observe(image.rows_around(x, y, half).unwrap());
        let grey = planes.grey();
        of(grey, range(grey).ok()?, [start[0] - (x - half) as f64, start[1] - (y - half) as f64], 8)
    }

    #[test]
    fn it_is_the_middle_of_the_blob() {
        for (light, half) in [(false, 11), (true, 11), (false, 7), (true, 16)] {
            // A ring with a gap, so that rows are entered from both sides, and a second target to be left out.
            let ring = |x: i32, y: i32| (4..=25).contains(&(x * x + y * y)) && !(x > 0 && y == 1);
            let dark = |x: i32, y: i32| ring(x - 21, y - 19) || ((x - 31).abs() < 2 && (y - 29).abs() < 2);
            let image = Image::from_fn(41, 41, |x, y| if dark(x as i32, y as i32) == light { 0.9 } else { 0.2 } + 0.001 * (x % 3) as f32);
            let (centre, start) = ((21, 20), [20.3, 19.2]);
            let by_sorting = Segmentation { threshold: None, polarity: Polarity::FromWindow, enlarge: 1 };
            let blob = by_sorting.target(&image, centre, half, PixelPoint::new(start[0], start[1])).unwrap();
            assert!(!blob.cut);
            let found = area(&image, centre, half, start).unwrap();
            let middle = blob.centre();
            // The differences of the ground's own grey values count, too.
            let off = (found.centre[0] + (21 - half) as f64 - middle.x).hypot(found.centre[1] + (20 - half) as f64 - middle.y);
            assert!(off < 0.02, "{off}");
            assert!(found.moments.iter().zip(blob.moments()).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} {:?}", blob.moments());
        }
    }

    #[test]
    fn what_reaches_the_border_has_no_middle() {
        let image = Image::from_fn(31, 31, |x, _| if x < 13 { 0.1 } else { 0.8 });
        assert!(area(&image, (15, 15), 7, [10.0, 15.0]).is_none());
        assert!(area(&Image::new(31, 31, vec![0.3; 961]), (15, 15), 7, [15.0, 15.0]).is_none());
    }

    #[test]
    fn ranges_are_of_pixels_and_numbers() {
        let values = |bad: f32| {
            let mut values = vec![0.0; 5 * LANES];
            (0..25).for_each(|i| values[i / 5 * LANES + i % 5] = 0.3 + 0.01 * i as f32);
            values[2 * LANES + 3] = bad;
            values
        };
        let inside: [f32; LANES] = std::array::from_fn(|lane| if lane < 5 { 1.0 } else { 0.0 });
        let found = |values: &[f32]| range(Grey { side: 5, stride: LANES, values, inside: &inside });
        assert_eq!(found(&values(0.4)), Ok((0.3, 0.3 + 0.01 * 24.0)));
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(found(&values(bad)), Err(Rejection::NotFinite));
        }
    }
}
