//! The blurred step at the left-hand rims of pixels, for many nodes together.

use crate::blurred_step::{DENSITY, step};
use crate::lanes::{LANES, Real};

/// As many are worked out together: enough that none waits for another.
const TOGETHER: usize = 4 * LANES;

/// So many rims are no surprise.
const USUAL: usize = 1024;

/// Steps, bells and integrals of steps at rims, one list for all nodes.
pub(super) struct Rims<T> {
    side: f64,
    /// The inverse of the blur, and how far a node is seen, px.
    inverse: f64,
    reach: f64,
    at: Vec<T>,
    used: usize,
    edge: Vec<T>,
    bell: Vec<T>,
    area: Vec<T>,
}

/// The pixels of a row or column that see a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) first: usize,
    pub(super) count: usize,
    /// Where its rims start: one more than pixels.
    start: usize,
}

impl<T: Real> Rims<T> {
    pub(super) fn new() -> Self {
        let [at, edge, bell, area] = [(); 4].map(|()| Vec::with_capacity(USUAL));
        Self { side: 0.0, inverse: 0.0, reach: 0.0, at, used: 0, edge, bell, area }
    }

    pub(super) fn start(&mut self, side: usize, blur: f64, reach: f64) {
        (self.side, self.inverse, self.reach, self.used) = (side as f64, 1.0 / blur, reach, 0);
    }

    /// Notes the rims of the pixels that see a node at `at`.
    #[inline(always)]
    pub(super) fn seen(&mut self, at: f64) -> Seen {
        let end = ((at + self.reach).floor() + 1.0).clamp(0.0, self.side);
        let first = (at - self.reach).ceil().max(0.0).min(end);
        let (count, start) = ((end - first) as usize, self.used);
        self.used += count + 1;
        let filled = start + (count + 1).next_multiple_of(LANES);
        if self.at.len() < filled {
            self.at.resize(filled, T::of(0.0));
        }
        let (x, by) = (T::of((first - 0.5 - at) * self.inverse), T::of(self.inverse));
        for (chunk, at) in self.at[start..filled].chunks_exact_mut(LANES).enumerate() {
            for (i, at) in at.iter_mut().enumerate() {
                *at = x + T::of((chunk * LANES + i) as f64) * by;
            }
        }
        Seen { first: first as usize, count, start }
    }

    /// Works out all that was noted.
    #[inline(always)]
    pub(super) fn work_out(&mut self) {
        let filled = self.used.next_multiple_of(TOGETHER);
        for values in [&mut self.at, &mut self.edge, &mut self.bell, &mut self.area] {
            if values.len() < filled {
                values.resize(filled, T::of(0.0));
            }
        }
        for from in (0..filled).step_by(TOGETHER) {
            let x: &[T; TOGETHER] = self.at[from..].first_chunk().expect("filled");
            let (edge, bell) = step(x);
            self.edge[from..][..TOGETHER].copy_from_slice(&edge);
            self.bell[from..][..TOGETHER].copy_from_slice(&bell);
            for (i, area) in self.area[from..][..TOGETHER].iter_mut().enumerate() {
                *area = T::of(0.5) * x[i] * edge[i] + T::of(DENSITY) * bell[i];
            }
        }
    }

    /// Steps, bells and integrals at a node's rims.
    #[inline(always)]
    pub(super) fn of(&self, seen: &Seen) -> (&[T], &[T], &[T]) {
        let (start, rims) = (seen.start, seen.count + 1);
        (&self.edge[start..][..rims], &self.bell[start..][..rims], &self.area[start..][..rims])
    }
}
