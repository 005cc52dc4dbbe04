//! The pixels of a window by what can be seen from them.

use super::model::Model;
use super::places::Places;
use crate::lanes::{BLOCK, Block, WIDE, Wide, side_by_side};

/// From a pixel both edges can be seen, ...
pub(super) const CORNER: usize = 0;
/// ... or one of them, ...
pub(super) const EDGES: [usize; 2] = [2, 1];
/// ... or neither.
pub(super) const AREAS: usize = 3;

/// Which column of a list holds the grey values.
const GREY: usize = 2;

/// Pixels side by side: coordinates from the window's centre, grey value, and the sign of the other edge's side (in an area, that of both).
#[derive(Clone, Copy)]
pub(super) struct Chunk<'a> {
    pub(super) x: &'a Block,
    pub(super) y: &'a Block,
    pub(super) grey: &'a Block,
    pub(super) side: &'a Block,
}

/// The first number in single precision from which on neighbours are 1 apart: adding it leaves a whole number in the lowest bits.
const WHOLE: f32 = 8_388_608.0;

impl Chunk<'_> {
    /// Where the pixels stand in the window, `half` px from whose centre its first row and column are, row by row of `stride`.
    #[inline(always)]
    pub(super) fn places(&self, (half, stride): (f32, usize)) -> [u32; BLOCK] {
        let mut places = [0; BLOCK];
        for (i, place) in places.iter_mut().enumerate() {
            let at = (self.y[i] + half) * stride as f32 + (self.x[i] + half);
            *place = (at + WHOLE).to_bits().wrapping_sub(WHOLE.to_bits());
        }
        places
    }
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
        (0..self.count).step_by(BLOCK).map(move |first| self.chunk(first))
    }

    #[inline(always)]
    fn chunk(self, first: usize) -> (Chunk<'a>, usize) {
        let column = |which: usize| side_by_side(self.columns[which], first);
        (Chunk { x: column(0), y: column(1), grey: column(GREY), side: column(3) }, (self.count - first).min(BLOCK))
    }
}

/// All pixels of a window, in four lists.
pub(super) struct Lists {
    /// List after list the columns of each, with `room` for every pixel of the window and for [`BLOCK`] more.
    values: Vec<f32>,
    room: usize,
    counts: [usize; 4],
    places: &'static Places,
}

impl Lists {
    pub(super) fn new(side: usize) -> Self {
        let room = side * side + BLOCK;
        Self { values: vec![0.0; 16 * room], room, counts: [0; 4], places: Places::of(side) }
    }

    #[inline(always)]
    pub(super) fn list(&self, kind: usize) -> List<'_> {
        let column = |which: usize| &self.values[(4 * kind + which) * self.room..][..self.room];
        List { columns: [column(0), column(1), column(2), column(3)], count: self.counts[kind] }
    }

    /// The first pixels of the chunks of one kind.
    #[inline(always)]
    pub(super) fn firsts(&self, kind: usize) -> impl Iterator<Item = usize> + use<> {
        (0..self.counts[kind]).step_by(BLOCK)
    }

    /// The chunk from a pixel on, and how many of its pixels count.
    #[inline(always)]
    pub(super) fn chunk(&self, kind: usize, first: usize) -> (Chunk<'_>, usize) {
        self.list(kind).chunk(first)
    }

    /// Takes something from the grey values of a chunk.
    #[inline(always)]
    pub(super) fn take(&mut self, kind: usize, first: usize, what: &Block) {
        let place = (4 * kind + GREY) * self.room + first;
        for (grey, what) in self.values[place..place + BLOCK].iter_mut().zip(what) {
            *grey -= what;
        }
    }

    /// Sorts the pixels of the window, whose grey values these are; the corner lies at `(cx, cy)` from its centre.
    #[inline(always)]
    pub(super) fn sort(&mut self, model: &Model<f32>, grey: &[f32], corner: [f32; 2]) {
        self.counts = [0; 4];
        let places = self.places;
        for first in (0..grey.len()).step_by(WIDE) {
            let count = (grey.len() - first).min(WIDE);
            let mut pixels = Pixels { x: [0.0; 2 * WIDE], y: [0.0; 2 * WIDE], grey: [0.0; 2 * WIDE], side: [0.0; 2 * WIDE] };
            pixels.x[..WIDE].copy_from_slice(side_by_side::<_, WIDE>(&places.x, first));
            pixels.y[..WIDE].copy_from_slice(side_by_side::<_, WIDE>(&places.y, first));
            if let Some(greys) = grey[first..].first_chunk::<WIDE>() {
                pixels.grey[..WIDE].copy_from_slice(greys);
            } else {
                pixels.grey[..count].copy_from_slice(&grey[first..]);
            }
            let seen = pixels.seen(model, corner);
            self.append(&pixels, seen, count);
        }
    }

    /// The first `count` pixels, from which both edges are as far as these bits say.
    #[inline(always)]
    fn append(&mut self, pixels: &Pixels, [past_first, past_second]: [u32; 2], count: usize) {
        // Those of one kind stand together and are taken at once: what is written beyond the last, the next of that kind replaces.
        let mut begins = ((past_first ^ (past_first << 1)) | (past_second ^ (past_second << 1)) | 1) & ((1 << count) - 1);
        while begins != 0 {
            let begin = begins.trailing_zeros() as usize;
            begins &= begins - 1;
            let end = if begins == 0 { count } else { begins.trailing_zeros() as usize };
            let kind = ((past_first >> begin) & 1) as usize + 2 * ((past_second >> begin) & 1) as usize;
            let place = 4 * kind * self.room + self.counts[kind];
            for (column, values) in [&pixels.x, &pixels.y, &pixels.grey, &pixels.side].into_iter().enumerate() {
                self.put(place + column * self.room, side_by_side(values, begin));
            }
            self.counts[kind] += end - begin;
        }
    }

    #[inline(always)]
    fn put(&mut self, place: usize, values: &Wide) {
        self.values[place..place + WIDE].copy_from_slice(values);
    }
}

/// Up to [`WIDE`] pixels, and room for as many behind them.
struct Pixels {
    x: [f32; 2 * WIDE],
    y: [f32; 2 * WIDE],
    grey: [f32; 2 * WIDE],
    side: [f32; 2 * WIDE],
}

impl Pixels {
    /// A bit for each pixel from which the first edge cannot be seen, and the second; on which side of these it lies is noted.
    #[inline(always)]
    fn seen(&mut self, model: &Model<f32>, [cx, cy]: [f32; 2]) -> [u32; 2] {
        let (mut past_first, mut past_second) = (0, 0);
        for i in 0..WIDE {
            let (x, y) = (self.x[i] - cx, self.y[i] - cy);
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

#[cfg(test)]
mod tests {
    use super::super::model::{Fidelity, Shape};
    use super::*;

    /// Kind, column, row and side of every pixel, one by one.
    fn one_by_one(model: &Model<f32>, side: usize, [cx, cy]: [f32; 2]) -> Vec<(usize, f32, f32, f32)> {
        let half = (side / 2) as f32;
        let pixels = (0..side).flat_map(|row| (0..side).map(move |column| (column as f32 - half, row as f32 - half)));
        let seen = |(x, y): (f32, f32)| {
            let far = [0, 1].map(|edge| model.edges[edge].distance(x - cx, y - cy)).map(|d| (d.abs() >= model.reach).then_some(d.signum()));
            let kind = match far {
                [None, None] => CORNER,
                [None, Some(_)] => EDGES[0],
                [Some(_), None] => EDGES[1],
                [Some(_), Some(_)] => AREAS,
            };
            (kind, x, y, far[0].unwrap_or(1.0) * far[1].unwrap_or(1.0))
        };
        pixels.map(seen).collect()
    }

    #[test]
    fn every_pixel_is_in_the_list_of_what_it_sees() {
        for (side, variance, photosite) in [(7, 0.1, 1.0), (15, 0.5, 1.0), (41, 0.3, 1.0), (41, 9.0, 1.0), (17, 0.0, 0.1), (33, 0.02, 0.3)]
        {
            for turn in (0..9).map(|i| f64::from(i) * 0.7) {
                let shape = Shape { position: [0.31, -0.24], normals: [turn, turn + 1.3], variance, curvature: [0.0; 2], photosite };
                let (model, corner) = (Model::<f32>::new(&shape, Fidelity::Rough).unwrap(), shape.position.map(|p| p as f32));
                let grey: Vec<f32> = (0..side * side).map(|i| i as f32).collect();
                let mut lists = Lists::new(side);
                // What an earlier window has left does not count.
                lists.sort(&model, &vec![-1.0; side * side], [2.0, 1.0]);
                lists.sort(&model, &grey, corner);
                let expected = one_by_one(&model, side, corner);
                for kind in [CORNER, EDGES[0], EDGES[1], AREAS] {
                    let chunks = lists.list(kind).chunks();
                    let found: Vec<_> = chunks
                        .flat_map(|(chunk, count)| (0..count).map(move |i| (chunk.grey[i] as usize, chunk.x[i], chunk.y[i], chunk.side[i])))
                        .collect();
                    let wanted = expected.iter().enumerate().filter(|(_, pixel)| pixel.0 == kind).map(|(i, &(_, x, y, s))| (i, x, y, s));
                    assert_eq!(found, wanted.collect::<Vec<_>>(), "{side} px, {turn} rad, list {kind}");
                }
            }
        }
    }
}
