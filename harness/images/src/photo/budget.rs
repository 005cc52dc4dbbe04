//! Memory that photographs may take while they are decoded.

use std::sync::{Condvar, Mutex, PoisonError};

use image::{ColorType, ImageDecoder, Limits};

/// Memory for all photographs that are being decoded at a time, bytes: one of 268 megapixels in RGB with 16 bits, or two of 134; a PNG that comes row by row
/// takes that of its grey values alone, 4 bytes a pixel.
pub const MOST_BYTES: u64 = 4 << 30;

/// What is in use.
static IN_USE: Mutex<u64> = Mutex::new(0);
static FREED: Condvar = Condvar::new();

/// A part of the memory, given back when dropped.
pub(crate) struct Share(u64);

impl Drop for Share {
    fn drop(&mut self) {
        *IN_USE.lock().unwrap_or_else(PoisonError::into_inner) -= self.0;
        FREED.notify_all();
    }
}

/// Waits until `bytes` are free; `None` if there are never as many.
pub(super) fn share(bytes: u64) -> Option<Share> {
    if bytes > MOST_BYTES {
        return None;
    }
    let in_use = IN_USE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut in_use = FREED.wait_while(in_use, |in_use| *in_use + bytes > MOST_BYTES).unwrap_or_else(PoisonError::into_inner);
    *in_use += bytes;
    Some(Share(bytes))
}

/// What decoding takes, bytes: the pixels, the decoder's own copy (of a progressive JPEG its coefficients, twice as large), and the grey values.
pub(super) fn needed(decoder: &dyn ImageDecoder) -> u64 {
    let (width, height) = decoder.dimensions();
    let pixels = u64::from(width) * u64::from(height);
    let copies = if matches!(decoder.color_type(), ColorType::L8 | ColorType::Rgb8) { 3 } else { 2 };
    let decoded = pixels.saturating_mul(u64::from(decoder.color_type().bytes_per_pixel()));
    decoded.saturating_mul(copies).saturating_add(pixels.saturating_mul(size_of::<f32>() as u64))
}

/// What decoding takes where only grey values are ever there as a whole, bytes.
pub(super) fn needed_in_rows(decoder: &dyn ImageDecoder) -> u64 {
    let (width, height) = decoder.dimensions();
    (u64::from(width) * u64::from(height)).saturating_mul(size_of::<f32>() as u64)
}

/// Limits of a decoder.
pub(crate) fn limits(bytes: u64) -> Limits {
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(bytes);
    limits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_in_use_is_waited_for() {
        assert!(share(MOST_BYTES + 1).is_none());
        let first = share(MOST_BYTES - 10).unwrap();
        let waiting = std::thread::spawn(|| share(MOST_BYTES).is_some());
        std::thread::sleep(std::time::Duration::from_millis(50));
        assert!(!waiting.is_finished());
        drop(first);
        assert!(waiting.join().unwrap());
    }
}
