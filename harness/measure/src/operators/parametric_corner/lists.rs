//! The pixels of a window by what can be seen from them.

use super::model::Model;
use crate::lanes::{WIDE, Wide};

/// From a pixel both edges can be seen, ...
pub(super) const CORNER: usize = 0;
/// ... or one of them, ...
pub(super) const EDGES: [usize; 2] = [2, 1];
/// ... or neither.
pub(super) const AREAS: usize = 3;

/// Pixels side by side: coordinates from the window's centre, grey value, and the sign of the other edge's side (in an area, that of both).
#[derive(Clone, Copy)]
pub(super) struct Chunk {
    pub(super) x: Wide,
    pub(super) y: Wide,
    pub(super) grey: Wide,
    pub(super) side: Wide,
}

/// Pixels of one kind.
pub(super) struct List {
    chunks: Vec<Chunk>,
    pub(super) count: usize,
}

impl List {
    /// With room for every pixel of the window, and for a last chunk that is not full.
    fn new(side: usize) -> Self {
        let zero = Chunk { x: [0.0; WIDE], y: [0.0; WIDE], grey: [0.0; WIDE], side: [0.0; WIDE] };
        Self { chunks: vec![zero; (side * side).div_ceil(WIDE)], count: 0 }
    }

    /// Every chunk, and how many of its pixels count: beyond the last lies what an earlier, longer list has left.
    #[inline(always)]
    pub(super) fn chunks(&self) -> impl Iterator<Item = (&Chunk, usize)> {
        let count = self.count;
        self.chunks[..count.div_ceil(WIDE)].iter().enumerate().map(move |(index, chunk)| (chunk, (count - index * WIDE).min(WIDE)))
    }
}

/// All pixels of a window, in four lists.
pub(super) struct Lists([List; 4]);

impl Lists {
    pub(super) fn new(side: usize) -> Self {
        Self([(); 4].map(|()| List::new(side)))
    }

    #[inline(always)]
    pub(super) fn list(&self, kind: usize) -> &List {
        &self.0[kind]
    }

    /// Sorts the pixels of a window of `side` px with these grey values; the corner lies at `(cx, cy)` from its centre.
    #[inline(always)]
    pub(super) fn sort(&mut self, model: &Model<f32>, (grey, side): (&[f32], usize), [cx, cy]: [f32; 2]) {
        let mut counts = [0; 4];
        let half = (side / 2) as f32;
        for (row, line) in grey.chunks_exact(side).enumerate() {
            let y = row as f32 - half;
            for (column, grey) in line.iter().enumerate() {
                let x = column as f32 - half;
                let [u, v] = [model.edges[0].distance(x - cx, y - cy), model.edges[1].distance(x - cx, y - cy)];
                let (past_first, past_second) = (u.abs() >= model.reach, v.abs() >= model.reach);
                let kind = usize::from(past_first) + 2 * usize::from(past_second);
                let sign = if past_first { u } else { 1.0 } * if past_second { v } else { 1.0 };
                let (chunk, i) = (&mut self.0[kind].chunks[counts[kind] / WIDE], counts[kind] % WIDE);
                (chunk.x[i], chunk.y[i], chunk.grey[i], chunk.side[i]) = (x, y, *grey, 1_f32.copysign(sign));
                counts[kind] += 1;
            }
        }
        for (list, count) in self.0.iter_mut().zip(counts) {
            list.count = count;
        }
    }
}
