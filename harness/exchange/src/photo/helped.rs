//! Decoded pixels to grey values, with the help of threads that have nothing else to do.

use std::sync::{Mutex, PoisonError, RwLock};

use calibench_model::Image;
use image::DynamicImage;

use super::grey;

/// Grey values that a thread takes at once.
const PIECE: usize = 1 << 18;

/// The grey values of a decoded image, of whose memory `share` tells, and which are both gone after it.
///
/// A thread that waits for others in the pool may begin with the next photograph meanwhile, and wait for the memory that this one holds. So this one waits
/// without other work until nobody reads the pixels, gives them back, and only then meets the others.
pub(super) fn grey_of<S: Send + Sync>(decoded: DynamicImage, share: S) -> Image<'static> {
    let (width, height) = (decoded.width() as usize, decoded.height() as usize);
    let mut grey = vec![0.0; width * height];
    let rows = (PIECE / width.max(1)).max(1);
    let pieces = Mutex::new(grey.chunks_mut((rows * width).max(1)).enumerate());
    let pixels = RwLock::new(Some((decoded, share)));
    let help = || {
        let pixels = pixels.read().unwrap_or_else(PoisonError::into_inner);
        let Some((decoded, _)) = &*pixels else { return };
        loop {
            let piece = pieces.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((place, into)) = piece else { return };
            grey::fill(decoded, place * rows, into);
        }
    };
    rayon::in_place_scope(|scope| {
        let helpers = (width * height / PIECE).min(rayon::current_num_threads() - 1);
        (0..helpers).for_each(|_| scope.spawn(|_| help()));
        help();
        let read = pixels.write().unwrap_or_else(PoisonError::into_inner).take();
        drop(read);
    });
    Image::new(width, height, grey)
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use image::{ImageBuffer, Luma, Rgb};

    use super::*;

    fn noisy(width: u32, height: u32) -> [DynamicImage; 2] {
        let chance = |x: u32, y: u32| (x.wrapping_mul(40_503) ^ y.wrapping_mul(52_361)) as u16;
        let grey = ImageBuffer::from_fn(width, height, |x, y| Luma([chance(x, y) as u8]));
        let colour = ImageBuffer::from_fn(width, height, |x, y| Rgb([chance(x, y), chance(y, x), chance(x, x)]));
        [DynamicImage::ImageLuma8(grey), DynamicImage::ImageRgb16(colour)]
    }

    #[test]
    fn every_piece_is_where_it_belongs() {
        for (width, height) in [(1, 1), (1001, 700), (PIECE as u32 + 1, 3), (3, PIECE as u32)] {
            for image in noisy(width, height) {
                let whole = grey::of_rows(&image, 0..height as usize);
                assert!(grey_of(image, ()) == whole, "{width} x {height}");
            }
        }
    }

    /// Says when it is dropped whether its thread has met the others: no helper is left to begin.
    struct Share(mpsc::Sender<bool>);

    impl Drop for Share {
        fn drop(&mut self) {
            let met = rayon::yield_local() != Some(rayon::Yield::Executed);
            self.0.send(met).unwrap();
        }
    }

    #[test]
    fn the_memory_is_given_back_before_others_are_waited_for() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let ((begun, begins), (end, ends), (said, says)) = (mpsc::channel(), mpsc::channel(), mpsc::channel());
        // The other thread has something to do, so that the helper is still to begin.
        pool.spawn(move || {
            begun.send(()).unwrap();
            ends.recv().unwrap();
        });
        begins.recv().unwrap();
        let [image, _] = noisy(1000, 1000);
        pool.install(|| grey_of(image, Share(said)));
        end.send(()).unwrap();
        assert!(!says.recv().unwrap());
    }
}
