//! Dark areas of a square.

use crate::normal::{Normal, SIDE};

/// Ink, of what is between paper and ink.
const THRESHOLD: f32 = 0.5;

/// A dark area that is connected, in px of the normal image.
#[derive(Clone, Debug)]
pub(crate) struct Area {
    /// Its number in [`Areas::labels`].
    pub label: u16,
    /// Its pixels.
    pub size: usize,
    /// Its centre of gravity.
    pub centre: [f64; 2],
    /// Its first pixel, row by row.
    pub first: [usize; 2],
}

/// The dark areas of a square.
#[derive(Clone, Debug)]
pub(crate) struct Areas {
    /// For each pixel the number of its area; 0 is none.
    pub labels: Vec<u16>,
    pub areas: Vec<Area>,
}

impl Areas {
    /// Of at least `least` pixels, no pixel nearer than `inset` to the square's border.
    ///
    /// What only runs along the border is the rest of a line: it is not thicker than the square of its length would make it a target.
    pub fn of(normal: &Normal, inset: usize, least: f64) -> Self {
        let inside = |x: usize| (inset..SIDE - inset).contains(&x);
        let mut labels = vec![0_u16; SIDE * SIDE];
        let (mut areas, mut open) = (Vec::new(), Vec::new());
        let dark = |at: usize| normal.dark[at] > THRESHOLD && inside(at % SIDE) && inside(at / SIDE);
        let mut label = 0;
        for first in 0..SIDE * SIDE {
            if labels[first] != 0 || !dark(first) {
                continue;
            }
            label += 1;
            labels[first] = label;
            open.push(first);
            let (mut size, mut sum, mut low, mut high) = (0, [0.0; 2], [SIDE; 2], [0; 2]);
            while let Some(at) = open.pop() {
                let place = [at % SIDE, at / SIDE];
                size += 1;
                for i in 0..2 {
                    sum[i] += place[i] as f64;
                    low[i] = low[i].min(place[i]);
                    high[i] = high[i].max(place[i]);
                }
                for next in around(at) {
                    if labels[next] == 0 && dark(next) {
                        labels[next] = label;
                        open.push(next);
                    }
                }
            }
            let at_border = (0..2).any(|i| low[i] == inset || high[i] == SIDE - 1 - inset);
            let thin = (0..2).any(|i| high[i] - low[i] < 3);
            if f64::from(size) >= least && !(at_border && thin) {
                let centre = sum.map(|sum| sum / f64::from(size));
                areas.push(Area { label, size: size as usize, centre, first: [first % SIDE, first / SIDE] });
            }
        }
        Self { labels, areas }
    }
}

/// The eight neighbours; of a pixel that is not at the border.
fn around(at: usize) -> [usize; 8] {
    [at - SIDE - 1, at - SIDE, at - SIDE + 1, at - 1, at + 1, at + SIDE - 1, at + SIDE, at + SIDE + 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normal(dark: impl Fn(usize, usize) -> bool) -> Normal {
        Normal { dark: (0..SIDE * SIDE).map(|at| f32::from(u8::from(dark(at % SIDE, at / SIDE)))).collect(), contrast: 0.8 }
    }

    #[test]
    fn areas_have_their_size_and_centre_and_remains_of_lines_are_none() {
        let square = |x: usize, y: usize, left: usize, top: usize| (left..left + 9).contains(&x) && (top..top + 7).contains(&y);
        let normal = normal(|x, y| square(x, y, 20, 30) || square(x, y, 80, 50) || x < 5 || y < 2);
        let found = Areas::of(&normal, 3, 20.0);
        let of: Vec<_> = found.areas.iter().map(|area| (area.size, area.centre, area.first)).collect();
        assert_eq!(of, [(63, [24.0, 33.0], [20, 30]), (63, [84.0, 53.0], [80, 50])]);
    }

    #[test]
    fn corners_connect_and_specks_are_dropped() {
        let found = Areas::of(&normal(|x, y| (x == y && (40..60).contains(&x)) || (x, y) == (90, 90)), 3, 10.0);
        assert_eq!(found.areas.len(), 1);
        assert_eq!(found.areas[0].size, 20);
    }
}
