//! The pixels of a window by what can be seen from them.

use super::arms::Model;
use crate::lanes::{WIDE, Wide};

/// From a pixel the point can be seen where arms meet, ...
pub(super) const NEAR: usize = 0;
/// ... or arms only, ...
pub(super) const ALONG: usize = 1;
/// ... or one sector.
pub(super) const AREAS: usize = 2;

/// Pixels side by side: coordinates from the point where arms meet, grey value, place in the window.
#[derive(Clone, Copy)]
pub(super) struct Chunk {
    pub(super) x: Wide,
    pub(super) y: Wide,
    pub(super) grey: Wide,
    pub(super) index: [u16; WIDE],
}

/// All pixels of a window, in three lists.
pub(super) struct Lists {
    chunks: [Vec<Chunk>; 3],
    counts: [usize; 3],
    kinds: Vec<u8>,
}

impl Lists {
    /// With room for every pixel of a window of `side` px, and for a last chunk that is not full.
    pub(super) fn new(side: usize) -> Self {
        let zero = Chunk { x: [1.0; WIDE], y: [1.0; WIDE], grey: [0.0; WIDE], index: [0; WIDE] };
        let chunks = [(); 3].map(|()| vec![zero; (side * side).div_ceil(WIDE)]);
        Self { chunks, counts: [0; 3], kinds: vec![0; side] }
    }

    /// Every chunk of a list, and how many of its pixels count: beyond the last lies what an earlier, longer list has left.
    #[inline(always)]
    pub(super) fn chunks(&self, kind: usize) -> impl Iterator<Item = (&Chunk, usize)> {
        let count = self.counts[kind];
        self.chunks[kind][..count.div_ceil(WIDE)].iter().enumerate().map(move |(index, chunk)| (chunk, (count - index * WIDE).min(WIDE)))
    }

    /// Sorts the pixels of a window of `side` px with these grey values; arms meet at `(cx, cy)` from its centre.
    #[inline(always)]
    #[expect(clippy::needless_bitwise_bool, reason = "without a branch it is done for many pixels at once")]
    pub(super) fn sort(&mut self, model: &Model<f32>, (grey, side): (&[f32], usize), [cx, cy]: [f32; 2]) {
        self.counts = [0; 3];
        let (half, reach) = ((side / 2) as f32, model.reach);
        // Exactly at the point directions have no meaning; a millionth of a pixel beside it they have.
        let beside = |from: f32| if from.abs() < 1e-6 { 1e-6 } else { from };
        for (row, line) in grey.chunks_exact(side).enumerate() {
            let y = beside(row as f32 - half - cy);
            self.kinds.fill(AREAS as u8);
            for arm in model.arms() {
                for (column, kind) in self.kinds.iter_mut().enumerate() {
                    let x = beside(column as f32 - half - cx);
                    let (across, along) = (arm.x * y - arm.y * x, arm.x * x + arm.y * y);
                    *kind = if (across.abs() < reach) & (along > 0.0) { ALONG as u8 } else { *kind };
                }
            }
            for (column, kind) in self.kinds.iter_mut().enumerate() {
                let x = beside(column as f32 - half - cx);
                *kind = if x * x + y * y < reach * reach { NEAR as u8 } else { *kind };
            }
            for (column, (grey, kind)) in line.iter().zip(&self.kinds).enumerate() {
                let kind = usize::from(*kind);
                let at = self.counts[kind];
                let (chunk, i) = (&mut self.chunks[kind][at / WIDE], at % WIDE);
                (chunk.x[i], chunk.y[i]) = (beside(column as f32 - half - cx), y);
                (chunk.grey[i], chunk.index[i]) = (*grey, (row * side + column) as u16);
                self.counts[kind] += 1;
            }
        }
    }
}
