//! A grey-value image.

use std::borrow::Cow;

/// Grey values, row by row, as fractions of full scale: 0 is black, 1 is white.
///
/// f32 tells all levels of a 16-bit image apart. Pixel (column, row) has its centre at [`crate::PixelPoint`] (column, row). An image owns its grey values,
/// or borrows them from whoever has them: one that is `'static` is its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Image<'a> {
    width: usize,
    height: usize,
    grey: Cow<'a, [f32]>,
}

impl<'a> Image<'a> {
    /// An image of `width` x `height` px whose grey values are somebody else's; `None` if there are not `width * height` of them.
    pub fn borrowed(width: usize, height: usize, grey: &'a [f32]) -> Option<Self> {
        (width.checked_mul(height) == Some(grey.len())).then_some(Self { width, height, grey: Cow::Borrowed(grey) })
    }
}

impl Image<'static> {
    /// An image of `width` x `height` px.
    ///
    /// # Panics
    /// If `grey` does not hold `width * height` values: a mistake of the caller's.
    pub fn new(width: usize, height: usize, grey: Vec<f32>) -> Self {
        assert_eq!(grey.len(), width * height, "an image of {width} x {height} px");
        Self { width, height, grey: Cow::Owned(grey) }
    }

    /// An image of `width` x `height` px whose grey value (fraction of full scale) at (column, row) is `grey(column, row)`.
    pub fn from_fn(width: usize, height: usize, mut grey: impl FnMut(usize, usize) -> f32) -> Self {
        let values = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| grey(x, y)).collect();
        Self::new(width, height, values)
    }
}

impl Image<'_> {
    /// The same image, without a copy.
    pub fn lent(&self) -> Image<'_> {
        Image { width: self.width, height: self.height, grey: Cow::Borrowed(&self.grey) }
    }

    /// Columns, px.
    #[inline]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows, px.
    #[inline]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All grey values, row by row, fractions of full scale.
    #[inline]
    pub fn grey(&self) -> &[f32] {
        &self.grey
    }

    /// All grey values, row by row, fractions of full scale, out of the image; copied where they are borrowed.
    pub fn into_grey(self) -> Vec<f32> {
        self.grey.into_owned()
    }

    /// All grey values, row by row, fractions of full scale, to be changed; copied first where they are borrowed.
    pub fn grey_mut(&mut self) -> &mut [f32] {
        self.grey.to_mut()
    }

    /// The grey values of row `y`, fractions of full scale.
    ///
    /// # Panics
    /// If there is no such row.
    #[inline]
    pub fn row(&self, y: usize) -> &[f32] {
        &self.grey[y * self.width..(y + 1) * self.width]
    }

    /// The grey value of pixel (`x`, `y`), fraction of full scale.
    ///
    /// # Panics
    /// If there is no such pixel.
    #[inline]
    pub fn at(&self, x: usize, y: usize) -> f32 {
        self.row(y)[x]
    }

    /// Whether the square of half-width `reach` px around pixel (`x`, `y`) lies inside the image.
    #[inline]
    pub fn holds(&self, x: i64, y: i64, reach: i64) -> bool {
        // On the side of the size, where nothing overflows: a start may lie anywhere.
        x >= reach && y >= reach && x < self.width as i64 - reach && y < self.height as i64 - reach
    }

    /// The square of half-width `reach` px around pixel (`x`, `y`): `2 reach + 1` rows of as many grey values; `None` if it leaves the image.
    pub fn rows_around(&self, x: i64, y: i64, reach: i64) -> Option<impl Iterator<Item = &[f32]>> {
        if !self.holds(x, y, reach) {
            return None;
        }
        let columns = (x - reach) as usize..=(x + reach) as usize;
        Some(((y - reach) as usize..=(y + reach) as usize).map(move |row| &self.row(row)[columns.clone()]))
    }

    /// 8-bit grey values from 0 (black) to 255 (white), row by row, rounded and clipped. NaN becomes black.
    pub fn to_u8(&self) -> Vec<u8> {
        let mut levels = vec![0; self.grey.len()];
        levels_of(&self.grey, &mut levels);
        levels
    }

    /// The image `factor` times smaller: means of whole squares of `factor` px; what is left over at the right and at the bottom is not used.
    #[must_use]
    pub fn reduced(&self, factor: usize) -> Image<'static> {
        let (width, height) = (self.width() / factor, self.height() / factor);
        let share = 1.0 / (factor * factor) as f32;
        let mut grey = vec![0.0_f32; width * height];
        for y in 0..height * factor {
            let sums = &mut grey[(y / factor) * width..(y / factor + 1) * width];
            for (sum, block) in sums.iter_mut().zip(self.row(y).chunks_exact(factor)) {
                *sum += share * block.iter().sum::<f32>();
            }
        }
        Image::new(width, height, grey)
    }
}

/// As [`Image::to_u8`], of as many grey values as there is room for.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2")))]
pub fn levels_of(grey: &[f32], levels: &mut [u8]) {
    for (to, &grey) in levels.iter_mut().zip(grey) {
        *to = level(grey, 255) as u8;
    }
}

/// From it on numbers of single precision are whole.
const WHOLE: f32 = 8_388_608.0;

/// The level nearest to a grey value (fraction of full scale), of 0 (black) to `top` (white); halves go up, what lies outside is clipped, NaN becomes black.
#[inline(always)]
pub fn level(grey: f32, top: u16) -> u16 {
    // Written so that NaN is black.
    let inside = if grey > 0.0 { grey.min(1.0) } else { 0.0 };
    let scaled = inside * f32::from(top);
    // The lowest bits of the sum are the nearest whole number, halves to even; the difference from it is exact. `round` is a call of the library for each
    // pixel, and a cast is taken apart into those of single numbers.
    let shifted = scaled + WHOLE;
    let up = scaled - (shifted - WHOLE) >= 0.5;
    shifted.to_bits() as u16 + u16::from(up)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_rounded_as_numbers_are() {
        for top in [255, 4095, 65535] {
            let rounded = |grey: f32| (grey.clamp(0.0, 1.0) * f32::from(top)).round() as u16;
            // Around every half, by the last digit of a number too.
            let halves = (0..top).map(|i| (f32::from(i) + 0.5) / f32::from(top)).flat_map(|g| [g.next_down(), g, g.next_up()]);
            let odd = [-1.0, -0.0, 0.0, 1.0, 1.5, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, f32::MIN_POSITIVE];
            halves.chain(odd).for_each(|grey| assert_eq!(level(grey, top), rounded(grey), "{grey} of {top}"));
        }
    }

    #[test]
    fn borrowed_grey_values_are_not_copied_until_they_are_changed() {
        let grey = [0.0, 0.25, 0.5, 0.75, 1.0, 0.125];
        let mut image = Image::borrowed(3, 2, &grey).unwrap();
        assert!(std::ptr::eq(image.grey().as_ptr(), grey.as_ptr()));
        assert_eq!(image, Image::new(3, 2, grey.to_vec()));
        image.grey_mut()[4] = 0.5;
        assert_eq!((image.at(1, 1), grey[4]), (0.5, 1.0));
        assert!(Image::borrowed(2, 2, &grey).is_none() && Image::borrowed(usize::MAX, 2, &grey).is_none());
    }

    #[test]
    fn rows_around_stop_at_the_border() {
        let image = Image::from_fn(5, 4, |x, y| (10 * y + x) as f32);
        assert!(image.rows_around(0, 1, 1).is_none());
        assert!(image.rows_around(3, 3, 1).is_none());
        let rows: Vec<_> = image.rows_around(3, 2, 1).unwrap().collect();
        assert_eq!(rows, [[12.0, 13.0, 14.0], [22.0, 23.0, 24.0], [32.0, 33.0, 34.0]]);
    }

    #[test]
    fn reduced_pixels_are_means_of_their_squares() {
        let reduced = Image::from_fn(7, 5, |x, y| (10 * y + x) as f32).reduced(2);
        assert_eq!((reduced.width(), reduced.height()), (3, 2));
        assert_eq!(reduced.grey(), [5.5, 7.5, 9.5, 25.5, 27.5, 29.5]);
    }
}
