//! The pixels of a window by what can be seen from them.

use super::model::Model;
use crate::lanes::{WIDE, Wide};

/// From a pixel both edges can be seen, ...
pub(super) const CORNER: usize = 0;
/// ... or one of them, ...
pub(super) const EDGES: [usize; 2] = [2, 1];
/// ... or neither.
pub(super) const AREAS: usize = 3;

/// 0, 1, 2, ...
const NUMBERS: Wide = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];

/// Pixels side by side: coordinates from the window's centre, grey value, and the sign of the other edge's side (in an area, that of both).
#[derive(Clone, Copy)]
pub(super) struct Chunk<'a> {
    pub(super) x: &'a Wide,
    pub(super) y: &'a Wide,
    pub(super) grey: &'a Wide,
    pub(super) side: &'a Wide,
}

/// Pixels of one kind.
#[derive(Clone, Copy)]
pub(super) struct List<'a> {
    /// Of a [`Chunk`], in its order: each as long as the others.
    columns: [&'a [f32]; 4],
    count: usize,
}

impl<'a> List<'a> {
    /// Every chunk, and how many of its pixels count: beyond the last lies what an earlier, longer list has left.
    #[inline(always)]
    pub(super) fn chunks(self) -> impl Iterator<Item = (Chunk<'a>, usize)> {
        (0..self.count).step_by(WIDE).map(move |first| {
            let column = |which: usize| lanes(self.columns[which], first);
            (Chunk { x: column(0), y: column(1), grey: column(2), side: column(3) }, (self.count - first).min(WIDE))
        })
    }
}

/// All pixels of a window, in four lists.
pub(super) struct Lists {
    /// List after list the columns of each, with `room` for every pixel of the window and for [`WIDE`] more.
    values: Vec<f32>,
    room: usize,
    counts: [usize; 4],
}

impl Lists {
    pub(super) fn new(side: usize) -> Self {
        let room = side * side + WIDE;
        Self { values: vec![0.0; 16 * room], room, counts: [0; 4] }
    }

    #[inline(always)]
    pub(super) fn list(&self, kind: usize) -> List<'_> {
        let column = |which: usize| &self.values[(4 * kind + which) * self.room..][..self.room];
        List { columns: [column(0), column(1), column(2), column(3)], count: self.counts[kind] }
    }

    /// Sorts the pixels of a window of `side` px with these grey values; the corner lies at `(cx, cy)` from its centre.
    #[inline(always)]
    pub(super) fn sort(&mut self, model: &Model<f32>, (grey, side): (&[f32], usize), corner: [f32; 2]) {
        self.counts = [0; 4];
        let (half, mut y) = ((side / 2) as f32, -((side / 2) as f32));
        for line in grey.chunks_exact(side) {
            let mut first = -half;
            for greys in line.chunks(WIDE) {
                let mut pixels = Row { x: [0.0; 2 * WIDE], y, grey: [0.0; 2 * WIDE], side: [0.0; 2 * WIDE] };
                pixels.grey[..greys.len()].copy_from_slice(greys);
                for (x, number) in pixels.x.iter_mut().zip(NUMBERS) {
                    *x = first + number;
                }
                first += WIDE as f32;
                let seen = pixels.seen(model, corner);
                self.append(&pixels, seen, greys.len());
            }
            y += 1.0;
        }
    }

    /// The first `count` pixels of a row, from which both edges are as far as these bits say.
    #[inline(always)]
    fn append(&mut self, pixels: &Row, [past_first, past_second]: [u32; 2], count: usize) {
        // Those of one kind stand together and are taken at once: what is written beyond the last, the next of that kind replaces.
        let mut begins = ((past_first ^ (past_first << 1)) | (past_second ^ (past_second << 1)) | 1) & ((1 << count) - 1);
        while begins != 0 {
            let begin = begins.trailing_zeros() as usize;
            begins &= begins - 1;
            let end = if begins == 0 { count } else { begins.trailing_zeros() as usize };
            let kind = ((past_first >> begin) & 1) as usize + 2 * ((past_second >> begin) & 1) as usize;
            let place = 4 * kind * self.room + self.counts[kind];
            self.put(place, lanes(&pixels.x, begin));
            self.put(place + self.room, &[pixels.y; WIDE]);
            self.put(place + 2 * self.room, lanes(&pixels.grey, begin));
            self.put(place + 3 * self.room, lanes(&pixels.side, begin));
            self.counts[kind] += end - begin;
        }
    }

    #[inline(always)]
    fn put(&mut self, place: usize, values: &Wide) {
        self.values[place..place + WIDE].copy_from_slice(values);
    }
}

/// Up to [`WIDE`] pixels of a row, and room for as many behind them.
struct Row {
    x: [f32; 2 * WIDE],
    y: f32,
    grey: [f32; 2 * WIDE],
    side: [f32; 2 * WIDE],
}

impl Row {
    /// A bit for each pixel from which the first edge cannot be seen, and the second; on which side of these it lies is noted.
    #[inline(always)]
    fn seen(&mut self, model: &Model<f32>, [cx, cy]: [f32; 2]) -> [u32; 2] {
        let (mut past_first, mut past_second) = (0, 0);
        let y = self.y - cy;
        for i in 0..WIDE {
            let x = self.x[i] - cx;
            let [u, v] = [model.edges[0].distance(x, y), model.edges[1].distance(x, y)];
            let past = [u.abs() >= model.reach, v.abs() >= model.reach];
            let sign = if past[0] { u } else { 1.0 } * if past[1] { v } else { 1.0 };
            self.side[i] = 1_f32.copysign(sign);
            past_first |= u32::from(past[0]) << i;
            past_second |= u32::from(past[1]) << i;
        }
        [past_first, past_second]
    }
}

#[inline(always)]
fn lanes(values: &[f32], first: usize) -> &Wide {
    values[first..first + WIDE].try_into().expect("a slice of that length")
}
