//! The pixels of a window by what can be seen from them.

use super::arms::{MOST, Model};
use crate::lanes::{WIDE, Wide};

/// From a pixel the point can be seen where arms meet, or several arms, ...
pub(super) const NEAR: usize = 0;
/// ... or one arm, ...
pub(super) const ALONG: usize = 1;
/// ... or one sector.
pub(super) const AREAS: usize = 2;
/// The lists hold for as long as nothing has moved by more than this, px.
const MARGIN: f32 = 0.12;
/// Of the side of the window: how far from the point an arm ends there, at most, while the point is near its middle.
const FARTHEST: f32 = 0.75;
/// They are made anew where they look so much further than needed, px.
const WASTEFUL: f32 = 0.75;

/// Pixels side by side: coordinates from the window's centre, grey value, place in the window, and which arm or sector is seen.
#[derive(Clone, Copy)]
pub(super) struct Chunk {
    pub(super) x: Wide,
    pub(super) y: Wide,
    pub(super) grey: Wide,
    pub(super) index: [u16; WIDE],
    pub(super) which: Wide,
}

/// Of the pixels that see one sector alone: how many there are, the sum of their grey values and of the squares.
#[derive(Clone, Copy, Default)]
pub(super) struct Plain {
    pub(super) count: f64,
    pub(super) sum: f64,
    pub(super) square: f64,
}

/// For which model a window was sorted.
#[derive(Clone, Copy)]
struct Sorted {
    centre: [f32; 2],
    arms: [[f32; 2]; MOST],
    reach: f32,
}

/// All pixels of a window, in three lists.
pub(super) struct Lists {
    chunks: [Vec<Chunk>; 3],
    counts: [usize; 3],
    pub(super) plain: [Plain; MOST],
    /// What [`codes_of_row`] tells of each pixel.
    codes: Vec<f32>,
    sorted: Option<Sorted>,
    /// Every other pixel is left out.
    pub(super) thin: bool,
}

impl Lists {
    /// With room for every pixel of a window of `side` px, and for a last chunk that is not full.
    pub(super) fn new(side: usize) -> Self {
        let zero = Chunk { x: [1.0; WIDE], y: [1.0; WIDE], grey: [0.0; WIDE], index: [0; WIDE], which: [0.0; WIDE] };
        let chunks = [(); 3].map(|()| vec![zero; (side * side).div_ceil(WIDE)]);
        Self { chunks, counts: [0; 3], plain: [Plain::default(); MOST], codes: vec![0.0; side * side], sorted: None, thin: false }
    }

    /// Every chunk of a list, and how many of its pixels count: beyond the last lies what an earlier, longer list has left.
    #[inline(always)]
    pub(super) fn chunks(&self, kind: usize) -> impl Iterator<Item = (&Chunk, usize)> {
        let count = self.counts[kind];
        self.chunks[kind][..count.div_ceil(WIDE)].iter().enumerate().map(move |(index, chunk)| (chunk, (count - index * WIDE).min(WIDE)))
    }

    /// The same, to be changed.
    #[inline(always)]
    pub(super) fn chunks_mut(&mut self, kind: usize) -> impl Iterator<Item = (&mut Chunk, usize)> {
        let count = self.counts[kind];
        let chunks = self.chunks[kind][..count.div_ceil(WIDE)].iter_mut().enumerate();
        chunks.map(move |(index, chunk)| (chunk, (count - index * WIDE).min(WIDE)))
    }

    /// The grey values are others.
    pub(super) fn forget(&mut self) {
        self.sorted = None;
    }

    /// Sorts the pixels of a window of `side` px with these grey values, unless they are; arms meet at `centre` from the window's, and are seen from `reach` px.
    #[inline(always)]
    pub(super) fn sort(&mut self, (model, reach): (&Model<f32>, f32), (grey, side): (&[f32], usize), centre: [f32; 2]) {
        if !self.holds(model, reach, (side, centre)) {
            sort(self, (model, reach + MARGIN), (grey, side), centre);
        }
    }

    /// Whether the lists are those of such a model still.
    fn holds(&self, model: &Model<f32>, reach: f32, (side, centre): (usize, [f32; 2])) -> bool {
        let Some(sorted) = &self.sorted else { return false };
        if self.counts[ALONG] + self.counts[AREAS] == 0 {
            return true;
        }
        let turned =
            model.arms().iter().zip(&sorted.arms).map(|(arm, was)| (arm.x - was[0]).abs() + (arm.y - was[1]).abs()).fold(0.0, f32::max);
        let moved = (centre[0] - sorted.centre[0]).abs() + (centre[1] - sorted.centre[1]).abs() + turned * FARTHEST * side as f32;
        let room = sorted.reach - reach - moved;
        moved <= MARGIN && (0.0..=WASTEFUL).contains(&room)
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn sort(lists: &mut Lists, (model, reach): (&Model<f32>, f32), (grey, side): (&[f32], usize), [cx, cy]: [f32; 2]) {
    let mut arms = [[0.0; 2]; MOST];
    arms.iter_mut().zip(model.arms()).for_each(|(to, arm)| *to = [arm.x, arm.y]);
    lists.sorted = Some(Sorted { centre: [cx, cy], arms, reach });
    lists.counts = [0; 3];
    let half = (side / 2) as f32;
    for (row, codes) in lists.codes.chunks_exact_mut(side).enumerate() {
        codes_of_row(codes, model, reach, [-half - cx, row as f32 - half - cy]);
    }
    let [near, along, areas] = &mut lists.chunks;
    let mut ends = [0; 3];
    for (row, (line, codes)) in grey.chunks_exact(side).zip(lists.codes.chunks_exact(side)).enumerate() {
        let y = row as f32 - half;
        let (first, by) = if lists.thin { (row % 2, 2) } else { (0, 1) };
        for (column, (grey, code)) in line.iter().zip(codes).enumerate().skip(first).step_by(by) {
            let code = *code as i32 as usize;
            let kind = code % 4;
            let at = ends[kind % 3];
            ends[kind % 3] += 1;
            let chunks = match kind {
                NEAR => &mut *near,
                ALONG => &mut *along,
                _ => &mut *areas,
            };
            let (chunk, i) = (&mut chunks[at / WIDE], at % WIDE);
            (chunk.x[i], chunk.y[i]) = (column as f32 - half, y);
            (chunk.grey[i], chunk.index[i], chunk.which[i]) = (*grey, (row * side + column) as u16, (code / 4) as f32);
        }
    }
    lists.counts = ends;
    add_areas(lists, model, [cx, cy]);
}

/// Tells the pixels that see one sector alone which one, and adds them up.
#[inline(always)]
fn add_areas(lists: &mut Lists, model: &Model<f32>, [cx, cy]: [f32; 2]) {
    let count = lists.counts[AREAS];
    let (mut counts, mut sums, mut squares) = ([[0.0_f32; WIDE]; MOST], [[0.0_f64; WIDE]; MOST], [[0.0_f64; WIDE]; MOST]);
    for (index, chunk) in lists.chunks[AREAS][..count.div_ceil(WIDE)].iter_mut().enumerate() {
        let (mut x, mut y) = (chunk.x, chunk.y);
        for i in 0..WIDE {
            (x[i], y[i]) = (x[i] - cx, y[i] - cy);
        }
        chunk.which = model.own_sector(&x, &y);
        let left = count - index * WIDE;
        for sector in 0..model.count {
            for i in 0..WIDE {
                let its = if chunk.which[i] == sector as f32 && i < left { 1.0 } else { 0.0 };
                let (one, grey) = (f64::from(its), f64::from(chunk.grey[i]));
                counts[sector][i] += its;
                sums[sector][i] += one * grey;
                squares[sector][i] += one * grey * grey;
            }
        }
    }
    for (sector, plain) in lists.plain.iter_mut().enumerate() {
        let [count, sum, square] = [counts[sector].map(f64::from), sums[sector], squares[sector]].map(|lanes| lanes.iter().sum());
        *plain = Plain { count, sum, square };
    }
}

/// The list of every pixel of a row, the first of which lies at (`left`, `y`) from the point where arms meet, and four times the arm that it sees.
#[inline(always)]
#[expect(clippy::needless_bitwise_bool, reason = "without a branch it is done for many pixels at once")]
fn codes_of_row(codes: &mut [f32], model: &Model<f32>, reach: f32, [left, y]: [f32; 2]) {
    let [near, along_one, areas] = [NEAR, ALONG, AREAS].map(|kind| kind as f32);
    codes.fill(areas);
    for (k, arm) in model.arms().iter().enumerate() {
        let its = along_one + 4.0 * k as f32;
        for (column, code) in codes.iter_mut().enumerate() {
            let x = left + column as f32;
            let (across, along) = ((arm.x * y - arm.y * x).abs(), arm.x * x + arm.y * y);
            let seen = (across < reach) & (along > -MARGIN);
            let kind = if (*code == areas) & (along > MARGIN) { its } else { near };
            *code = if seen { kind } else { *code };
        }
    }
    for (column, code) in codes.iter_mut().enumerate() {
        let x = left + column as f32;
        *code = if x * x + y * y < reach * reach { near } else { *code };
    }
}
