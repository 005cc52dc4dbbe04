//! The profile's samples at the nodes of a border.

use super::curves::Expansion;
use super::profile::{LANES, Profile};

/// So many nodes and panels have room from the start: as many as a small target has in a small window. More take more memory when they come.
const NODES: usize = 128;
const PANELS: usize = 8;
/// The most numbers of a node of a line.
const NUMBERS: usize = 5;

/// Samples at the nodes of a border. Its memory is used again for the next.
#[derive(Clone, Debug)]
pub(super) struct Bank {
    /// Pixels in a column and in a row.
    pixels: usize,
    /// These in whole lanes.
    pub(super) padded: usize,
    /// For each node, for each row: `k`, and its derivative if the blur is wanted.
    pub(super) values: Vec<f32>,
    pub(super) slopes: Vec<f32>,
    /// For each node, for each `LANES` columns: weighted samples by which the rows' values are multiplied: `W dy`, then `K` times each of the curve's
    /// functions, then for the blur `dK/dx dy` and `K dx`.
    pub(super) across: Vec<Row>,
    /// For each panel, for each row: the first node that the row sees, and one more than the last.
    pub(super) first: Vec<u8>,
    pub(super) end: Vec<u8>,
    /// For each row: what lies to the right of the window gives to every pixel's coverage.
    pub(super) beyond: Vec<f32>,
    pub(super) panels: Vec<Stretch>,
}

/// Numbers side by side, in one line of the cache: otherwise each is read from two.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Row(pub(super) [f32; LANES]);

/// The nodes of one panel, and how the derivatives come of their functions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    /// Its first node.
    pub(super) nodes: usize,
    /// Where its columns begin.
    pub(super) across: usize,
    pub(super) expansion: Expansion,
}

impl Bank {
    /// For a window of `pixels`, whose rows are `stride` apart.
    pub(super) fn new(pixels: usize, stride: usize) -> Self {
        Self {
            pixels,
            padded: stride,
            values: Vec::with_capacity(NODES * stride),
            slopes: Vec::with_capacity(NODES * stride),
            across: Vec::with_capacity(NODES * NUMBERS * stride / LANES),
            first: Vec::with_capacity(PANELS * stride),
            end: Vec::with_capacity(PANELS * stride),
            beyond: vec![0.0; stride],
            panels: Vec::with_capacity(PANELS),
        }
    }

    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.values.clear();
        self.slopes.clear();
        self.across.clear();
        self.first.clear();
        self.end.clear();
        self.panels.clear();
        self.beyond.fill(0.0);
    }

    /// The border runs from one row to another to the right of all pixels: these see all of what is to its left.
    #[inline(always)]
    pub(super) fn add_beyond(&mut self, (from, to): (f64, f64), profile: &Profile, sense: f64) {
        let [from, to] = [from, to].map(|row| profile.around(row));
        for start in (0..self.padded).step_by(LANES) {
            let (from, to) = (from.block(start).integral(), to.block(start).integral());
            for (lane, row) in self.beyond[start..start + LANES].iter_mut().enumerate() {
                *row += (to[lane] - from[lane]) * sense as f32;
            }
        }
    }

    /// A new panel, of which there are no nodes yet.
    #[inline(always)]
    pub(super) fn begin(&mut self, expansion: Expansion) {
        self.panels.push(Stretch { nodes: self.values.len() / self.padded, across: self.across.len(), expansion });
        self.first.resize(self.first.len() + self.padded, u8::MAX);
        self.end.resize(self.end.len() + self.padded, 0);
    }

    /// A node of the last panel: where it is, its step, the curve's functions there, its weight. What no pixel sees is left out.
    #[inline(always)]
    pub(super) fn push<const B: usize, const NUMBERS: usize, const MOVED: bool, const BLURRED: bool>(
        &mut self,
        profile: &Profile,
        [x, y]: [f64; 2],
        step: [f64; 2],
        functions: [f64; B],
        weight: f64,
    ) {
        let (across, down) = (profile.around(x), profile.around(y));
        let (low, high) = down.seen(self.pixels);
        if low == high || across.is_before() {
            return;
        }
        self.see(low, high);
        let [dx, dy] = [(step[0] * weight) as f32, (step[1] * weight) as f32];
        for start in (0..self.padded).step_by(LANES) {
            let block = down.block(start);
            self.values.extend_from_slice(&block.value());
            if BLURRED {
                self.slopes.extend_from_slice(&block.slope());
            }
        }
        for start in (0..self.padded).step_by(LANES) {
            let block = across.block(start);
            let mut numbers = [[0.0; LANES]; NUMBERS];
            numbers[0] = scaled(&block.integral(), dy);
            if MOVED {
                let value = block.value();
                for (function, to) in functions.iter().zip(&mut numbers[1..]) {
                    *to = scaled(&value, (function * weight) as f32);
                }
                if BLURRED {
                    numbers[NUMBERS - 2] = scaled(&block.slope(), dy);
                    numbers[NUMBERS - 1] = scaled(&value, dx);
                }
            }
            self.across.extend_from_slice(&numbers.map(Row));
        }
    }

    /// The rows `low..high` see the node that comes next.
    #[inline(always)]
    fn see(&mut self, low: usize, high: usize) {
        let Some(panel) = self.panels.last() else { return };
        let node = (self.values.len() / self.padded - panel.nodes) as u8;
        let begin = self.first.len() - self.padded;
        for (row, (first, end)) in self.first[begin..].iter_mut().zip(&mut self.end[begin..]).enumerate() {
            let inside = low as u8 <= row as u8 && (row as u8) < high as u8;
            *first = (*first).min(if inside { node } else { u8::MAX });
            *end = if inside { node + 1 } else { *end };
        }
    }
}

#[inline(always)]
fn scaled(lanes: &[f32; LANES], factor: f32) -> [f32; LANES] {
    let mut scaled = [0.0; LANES];
    for lane in 0..LANES {
        scaled[lane] = lanes[lane] * factor;
    }
    scaled
}
