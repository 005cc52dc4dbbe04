//! What a PNG file holds of a row: its levels less what is known of them from what is left of and above them.

use std::ops::Range;

use calibench_model::Image;
use calibench_model::image::{level, levels_of};

/// The numbers of the filters in the PNG standard: less what is left, less what is above, less the mean of the two.
pub(super) const LEFT: u8 = 1;
pub(super) const ABOVE: u8 = 2;
pub(super) const AVERAGE: u8 = 3;

/// The levels of an image's rows as bytes, the high one of two first.
pub(super) struct Rows<'a> {
    image: &'a Image<'a>,
    /// Bytes of a pixel: one or two.
    pub(super) width: usize,
}

impl<'a> Rows<'a> {
    pub(super) fn of(image: &'a Image<'_>, sixteen_bits: bool) -> Self {
        Self { image, width: if sixteen_bits { 2 } else { 1 } }
    }

    /// How many.
    pub(super) fn count(&self) -> usize {
        self.image.height()
    }

    /// Bytes of a row.
    pub(super) fn stride(&self) -> usize {
        self.image.width() * self.width
    }

    /// Bytes of a row behind the number of its filter.
    pub(super) fn filtered_stride(&self) -> usize {
        self.stride() + 1
    }

    /// Calls `take` with the levels of each of the `rows` and of the one above it, of zeros above the first.
    pub(super) fn each<E>(&self, rows: Range<usize>, mut take: impl FnMut(&[u8], &[u8]) -> Result<(), E>) -> Result<(), E> {
        let (mut above, mut here) = (vec![0; self.stride()], vec![0; self.stride()]);
        if rows.start > 0 {
            self.read(rows.start - 1, &mut above);
        }
        for row in rows {
            self.read(row, &mut here);
            take(&here, &above)?;
            std::mem::swap(&mut above, &mut here);
        }
        Ok(())
    }

    fn read(&self, row: usize, into: &mut [u8]) {
        let grey = self.image.row(row);
        if self.width == 1 {
            return levels_of(grey, into);
        }
        for (bytes, grey) in into.chunks_exact_mut(2).zip(grey) {
            bytes.copy_from_slice(&level(*grey, u16::MAX).to_be_bytes());
        }
    }
}

/// Filters a row of bytes, of which `width` are a pixel, into as many.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2")))]
pub(super) fn filter<const FILTER: u8>(here: &[u8], above: &[u8], width: usize, into: &mut [u8]) {
    let count = here.len();
    let (above, into) = (&above[..count], &mut into[..count]);
    for i in 0..width.min(count) {
        into[i] = less::<FILTER>(here[i], 0, above[i]);
    }
    if count > width {
        let (left, here, above, into) = (&here[..count - width], &here[width..], &above[width..], &mut into[width..]);
        for i in 0..left.len() {
            into[i] = less::<FILTER>(here[i], left[i], above[i]);
        }
    }
}

#[inline(always)]
fn less<const FILTER: u8>(byte: u8, left: u8, above: u8) -> u8 {
    byte.wrapping_sub(match FILTER {
        LEFT => left,
        ABOVE => above,
        _ => left.midpoint(above),
    })
}

/// How large the differences are in all, taken as numbers from -128 to 127.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2")))]
pub(super) fn size(differences: &[u8]) -> u64 {
    let mut sum = 0_u64;
    for part in differences.chunks(1 << 16) {
        let mut of_part = 0_u32;
        for byte in part {
            of_part += u32::from(byte.cast_signed().unsigned_abs());
        }
        sum += u64::from(of_part);
    }
    sum
}
