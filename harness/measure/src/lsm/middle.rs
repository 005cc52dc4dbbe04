//! The middle of a target's pixels, for a fit that knows the shape and only wants to begin near by: a row of pixels is a word of bits.

use calibench_model::{Image, PixelPoint};

/// Classes of grey values among which the threshold is sought.
const CLASSES: usize = 64;
/// The largest window, px: a row fits into a word.
const WIDEST: usize = 64;

/// The mean position of the connected pixels beyond Otsu's threshold at or next to `start`, in the window of half-width `half` around `centre`;
/// `None` if these are fewer than `fewest` or reach the window's border, or the window leaves the image.
///
/// It differs from [`crate::blob::Segmentation`] in that the threshold is that of a histogram.
pub(super) fn of(image: &Image, centre: (i64, i64), half: i64, start: PixelPoint, fewest: usize) -> Option<PixelPoint> {
    let side = (2 * half + 1) as usize;
    let (inside, side) = (side <= WIDEST).then(|| beyond_threshold(image, centre, half, side).map(|rows| (rows, side)))??;
    let (left, top) = ((centre.0 - half) as f64, (centre.1 - half) as f64);
    let (x, y) = nearest(&inside[..side], start.x - left, start.y - top)?;
    let members = connected(&inside, side, x, y);
    let sides = 1_u64 | 1 << (side - 1);
    if members[0] != 0 || members[side - 1] != 0 || members[..side].iter().any(|row| row & sides != 0) {
        return None;
    }
    let (mut count, mut sx, mut sy) = (0, 0, 0);
    for (y, &row) in members[..side].iter().enumerate() {
        count += row.count_ones() as usize;
        sy += y * row.count_ones() as usize;
        sx += bits(row).sum::<usize>();
    }
    let mean = |sum: usize, first: f64| first + sum as f64 / count as f64;
    (count >= fewest).then(|| PixelPoint::new(mean(sx, left), mean(sy, top)))
}

/// The places of the bits that are set.
fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = word.trailing_zeros() as usize;
        (word != 0).then(|| {
            word &= word - 1;
            place
        })
    })
}

/// The pixels on the side of the threshold on which most of the border is not.
fn beyond_threshold(image: &Image, (x, y): (i64, i64), half: i64, side: usize) -> Option<[u64; WIDEST]> {
    let rows = || image.rows_around(x, y, half);
    let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
    rows()?.for_each(|row| row.iter().for_each(|&grey| (low, high) = (low.min(grey), high.max(grey))));
    let scale = CLASSES as f32 / (high - low);
    let class = |grey: f32| (((grey - low) * scale) as usize).min(CLASSES - 1);
    let mut histogram = [0_u32; CLASSES];
    rows()?.for_each(|row| row.iter().for_each(|&grey| histogram[class(grey)] += 1));
    let threshold = low + otsu(&histogram)? as f32 / scale;
    let mut light = [0_u64; WIDEST];
    for (word, row) in light.iter_mut().zip(rows()?) {
        *word = row.iter().rev().fold(0, |bits, &grey| bits << 1 | u64::from(grey > threshold));
    }
    let whole = u64::MAX >> (WIDEST - side);
    let sides = 1_u64 | 1 << (side - 1);
    let middle: u32 = light[1..side - 1].iter().map(|row| (row & sides).count_ones()).sum();
    let on_border = light[0].count_ones() + light[side - 1].count_ones() + middle;
    if 2 * on_border as usize > 4 * (side - 1) {
        light[..side].iter_mut().for_each(|row| *row = !*row & whole);
    }
    Some(light)
}

/// The first class above Otsu's threshold; `None` if all are in one.
fn otsu(histogram: &[u32; CLASSES]) -> Option<usize> {
    let number = |i: usize| f64::from(histogram[i]);
    let (n, total) = (0..CLASSES).fold((0.0, 0.0), |(n, total), i| (n + number(i), total + number(i) * i as f64));
    let (mut below, mut sum, mut best, mut found) = (0.0, 0.0, 0.0, None);
    for i in 0..CLASSES - 1 {
        (below, sum) = (below + number(i), sum + number(i) * i as f64);
        // The variance between the classes, times n^2: (n sum - below total)^2 / (below (n - below)).
        let (difference, product) = (n * sum - below * total, below * (n - below));
        if product > 0.0 && difference * difference > best * product {
            (best, found) = (difference * difference / product, Some(i + 1));
        }
    }
    found
}

fn nearest(inside: &[u64], x: f64, y: f64) -> Option<(usize, usize)> {
    let places = inside.iter().enumerate().flat_map(|(row, &word)| bits(word).map(move |column| (column, row)));
    let distance = |&(column, row): &(usize, usize)| (column as f64 - x).powi(2) + (row as f64 - y).powi(2);
    places.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// The pixels that four neighbours connect with (`x`, `y`).
fn connected(inside: &[u64; WIDEST], side: usize, x: usize, y: usize) -> [u64; WIDEST] {
    let mut members = [0; WIDEST];
    members[y] = 1 << x;
    loop {
        let mut grew = false;
        for row in (0..side).chain((0..side).rev()) {
            let above = if row > 0 { members[row - 1] } else { 0 };
            let below = if row + 1 < side { members[row + 1] } else { 0 };
            let mut word = (members[row] | above | below) & inside[row];
            loop {
                let wider = (word | word << 1 | word >> 1) & inside[row];
                if wider == word {
                    break;
                }
                word = wider;
            }
            grew |= word != members[row];
            members[row] = word;
        }
        if !grew {
            return members;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blob::{Polarity, Segmentation};

    #[test]
    fn it_is_the_middle_of_the_blob() {
        for light in [false, true] {
            // A ring with a gap, so that rows are entered from both sides, and a second target to be left out.
            let ring = |x: i32, y: i32| (4..=36).contains(&(x * x + y * y)) && !(x > 0 && y == 1);
            let dark = |x: i32, y: i32| ring(x - 21, y - 19) || ((x - 29).abs() < 2 && (y - 27).abs() < 2);
            let image = Image::from_fn(41, 41, |x, y| if dark(x as i32, y as i32) == light { 0.9 } else { 0.2 } + 0.001 * (x % 3) as f32);
            let (centre, half, start) = ((21, 20), 11, PixelPoint::new(20.3, 19.2));
            let by_sorting = Segmentation { threshold: None, polarity: Polarity::FromWindow, enlarge: 1 };
            let blob = by_sorting.target(&image, centre, half, start).unwrap();
            assert!(!blob.cut);
            assert!(of(&image, centre, half, start, 8).unwrap().distance(blob.centre()) < 1e-12);
        }
    }

    #[test]
    fn what_reaches_the_border_has_no_middle() {
        let image = Image::from_fn(31, 31, |x, _| if x < 13 { 0.1 } else { 0.8 });
        assert!(of(&image, (15, 15), 7, PixelPoint::new(10.0, 15.0), 8).is_none());
        assert!(of(&Image::new(31, 31, vec![0.3; 961]), (15, 15), 7, PixelPoint::new(15.0, 15.0), 8).is_none());
    }
}
