//! Decoded pixels to grey values, with the help of threads that have nothing else to do.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::ops::Range;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use calibench_model::Image;
use image::DynamicImage;

use super::grey;

/// Grey values that a thread takes at once.
const PIECE: usize = 1 << 18;
/// Pieces that a helper has before it, at most: what is more, whoever has it does at once.
const AHEAD: usize = 2;

/// The grey values of a decoded image, of whose memory `share` tells, and which are both gone after it.
pub(super) fn grey_of(decoded: DynamicImage, share: impl Send) -> Image<'static> {
    let size = (decoded.width() as usize, decoded.height() as usize);
    let decoded = Arc::new(decoded);
    let Ok(image) = grey_while(size, share, move |rows| Ok::<_, Infallible>(Pixels { decoded: decoded.clone(), first: rows.start }));
    image
}

/// The grey values of an image of `width` x `height` px whose pixels come rows by rows, of whose memory `share` tells, and which are all gone after it.
///
/// A thread that waits for others in the pool may begin with the next photograph meanwhile, and wait for the memory that this one holds. So this one waits
/// without other work until nobody reads the pixels, gives them back, and only then meets the others.
///
/// # Errors
/// The first of `next`.
pub(super) fn grey_while<E>(
    (width, height): (usize, usize),
    share: impl Send,
    mut next: impl FnMut(Range<usize>) -> Result<Pixels, E>,
) -> Result<Image<'static>, E> {
    let mut grey = vec![0.0; width * height];
    let rows = (PIECE / width.max(1)).max(1);
    let line = Line::default();
    rayon::in_place_scope(|scope| {
        let helpers = (width * height / PIECE).min(rayon::current_num_threads() - 1);
        (0..helpers).for_each(|_| scope.spawn(|_| line.help()));
        let ending = Ending(&line);
        let given = grey.chunks_mut((rows * width).max(1)).enumerate().try_for_each(|(place, into)| {
            let first = place * rows;
            line.give(Piece { pixels: next(first..first + into.len() / width)?, into });
            Ok(())
        });
        drop(ending);
        drop((next, share));
        given
    })?;
    drop(line);
    Ok(Image::new(width, height, grey))
}

/// Decoded rows of which some are wanted: those from row `first` on.
pub(super) struct Pixels {
    pub(super) decoded: Arc<DynamicImage>,
    pub(super) first: usize,
}

/// Decoded rows, and where their grey values belong.
struct Piece<'g> {
    pixels: Pixels,
    into: &'g mut [f32],
}

impl Piece<'_> {
    fn fill(self) {
        grey::fill(&self.pixels.decoded, self.pixels.first, self.into);
    }
}

/// Pieces on their way to those who help.
#[derive(Default)]
struct Line<'g> {
    state: Mutex<State<'g>>,
    changed: Condvar,
}

#[derive(Default)]
struct State<'g> {
    waiting: VecDeque<Piece<'g>>,
    /// Those that wait, and those that are being filled.
    unfinished: usize,
    helpers: usize,
    ended: bool,
}

impl<'g> Line<'g> {
    /// Fills pieces until there are no more.
    fn help(&self) {
        self.state().helpers += 1;
        while let Some(piece) = self.next() {
            self.fill(piece);
        }
    }

    /// A helper's next piece, which is waited for; `None` after the last.
    fn next(&self) -> Option<Piece<'g>> {
        let none = |state: &mut State| state.waiting.is_empty() && !state.ended;
        self.changed.wait_while(self.state(), none).unwrap_or_else(PoisonError::into_inner).waiting.pop_front()
    }

    /// Leaves a piece to a helper, or fills it where none would begin with it soon.
    fn give(&self, piece: Piece<'g>) {
        let mut state = self.state();
        if state.unfinished >= AHEAD * state.helpers {
            drop(state);
            return piece.fill();
        }
        state.unfinished += 1;
        state.waiting.push_back(piece);
        self.changed.notify_all();
    }

    /// Fills what nobody has begun with, and waits for the rest.
    fn end(&self) {
        self.state().ended = true;
        self.changed.notify_all();
        while let Some(piece) = self.next() {
            self.fill(piece);
        }
        drop(self.changed.wait_while(self.state(), |state| state.unfinished > 0));
    }

    fn fill(&self, piece: Piece<'g>) {
        let _filled = Filled(self);
        piece.fill();
    }

    fn state(&self) -> MutexGuard<'_, State<'g>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Ends the line when it is dropped: also where `next` went wrong, as helpers would wait for ever.
struct Ending<'l, 'g>(&'l Line<'g>);

impl Drop for Ending<'_, '_> {
    fn drop(&mut self) {
        self.0.end();
    }
}

/// Says that a piece is filled when it is dropped: also where that went wrong, as whoever waits would wait for ever.
struct Filled<'l, 'g>(&'l Line<'g>);

impl Drop for Filled<'_, '_> {
    fn drop(&mut self) {
        self.0.state().unfinished -= 1;
        self.0.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;
    use std::time::Duration;

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
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            for (width, height) in [(1, 1), (1001, 700), (PIECE as u32 + 1, 3), (3, PIECE as u32), (3001, 1000)] {
                for image in noisy(width, height) {
                    let whole = grey::of_rows(&image, 0..height as usize);
                    assert!(pool.install(|| grey_of(image, ())) == whole, "{width} x {height}, {threads} threads");
                }
            }
        }
    }

    #[test]
    fn the_first_error_ends_it() {
        let [image, _] = noisy(PIECE as u32, 1);
        let decoded = Arc::new(image);
        let (mut asked, (said, says)) = (Vec::new(), mpsc::channel());
        let outcome = grey_while((PIECE, 9), Share(said), |rows: Range<usize>| {
            asked.push(rows.clone());
            if rows.start == 4 { Err("cut short") } else { Ok(Pixels { decoded: decoded.clone(), first: 0 }) }
        });
        assert_eq!((outcome.err(), asked), (Some("cut short"), (0..5).map(|row| row..row + 1).collect()));
        says.recv().unwrap();
    }

    #[test]
    fn a_panic_ends_it() {
        let (said, says) = mpsc::channel::<()>();
        std::thread::spawn(move || {
            let _said = said;
            let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
            pool.install(|| grey_while((PIECE, 9), (), |_| -> Result<Pixels, Infallible> { panic!("a decoder's own fault") }))
        });
        assert_eq!(says.recv_timeout(Duration::from_mins(1)), Err(mpsc::RecvTimeoutError::Disconnected));
    }

    /// Says when it is dropped whether its thread has met the others: no helper is left to begin.
    struct Share(mpsc::Sender<bool>);

    impl Drop for Share {
        fn drop(&mut self) {
            let met = rayon::yield_local() != Some(rayon::Yield::Executed);
            self.0.send(met).unwrap();
        }
    }

    /// Says when it is dropped how many still hold the pixels.
    struct Held(Arc<DynamicImage>, mpsc::Sender<usize>);

    impl Drop for Held {
        fn drop(&mut self) {
            self.1.send(Arc::strong_count(&self.0)).unwrap();
        }
    }

    #[test]
    fn the_memory_is_given_back_when_nobody_reads_the_pixels() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let [_, image] = noisy(PIECE as u32, 1);
        let decoded = Arc::new(image);
        let (said, says) = mpsc::channel();
        // A helper may have ended by chance.
        for _ in 0..50 {
            let given = decoded.clone();
            let next = move |_| Ok::<_, Infallible>(Pixels { decoded: given.clone(), first: 0 });
            pool.install(|| grey_while((PIECE, 9), Held(decoded.clone(), said.clone()), next)).unwrap();
            // The test's own and that of the share.
            assert_eq!(says.recv(), Ok(2));
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
