//! The sums of Förstner's normal equations over one window.

use calibench_model::Image;
use multiversion::multiversion;

/// Columns that are summed side by side. Fixed, so that every instruction set adds in the same order and gives the same bits.
const LANES: usize = 4;
/// The largest window with its ring, rounded up to whole lanes, with the ring of the last lane.
const STRIDE: usize = 31_usize.next_multiple_of(LANES) + 2;

/// Sums over the window, with coordinates (x, y) from its centre and `t = gx x + gy y`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Sum of gx^2.
    pub(super) gxx: f64,
    /// Sum of gx gy.
    pub(super) gxy: f64,
    /// Sum of gy^2.
    pub(super) gyy: f64,
    /// Sum of gx t.
    pub(super) bx: f64,
    /// Sum of gy t.
    pub(super) by: f64,
    /// Sum of t^2.
    pub(super) c: f64,
}

/// Sums over the window of `window` px whose ring of one pixel starts at (`left`, `top`); window and ring are inside the image.
#[multiversion(targets("x86_64+avx2", "x86_64+avx512f+avx512vl"))]
pub(super) fn sums(image: &Image, left: usize, top: usize, window: usize) -> Sums {
    let side = window + 2;
    let mut rows = [[0.0_f64; STRIDE]; 33];
    for (y, row) in rows[..side].iter_mut().enumerate() {
        for (to, from) in row[..side].iter_mut().zip(&image.row(top + y)[left..left + side]) {
            *to = f64::from(*from);
        }
    }
    let half = (window / 2) as f64;
    let mut total = Sums::default();
    for first in (0..window).step_by(LANES) {
        let mut x = [0.0; LANES];
        let mut inside = [0.0; LANES];
        for lane in 0..LANES {
            x[lane] = (first + lane) as f64 - half;
            inside[lane] = if first + lane < window { 1.0 } else { 0.0 };
        }
        add(&mut total, &column_sums(&rows[..side], first, &x, &inside, half));
    }
    total
}

type Lanes = [f64; LANES];

struct LaneSums {
    gxx: Lanes,
    gxy: Lanes,
    gyy: Lanes,
    bx: Lanes,
    by: Lanes,
    c: Lanes,
}

#[inline(always)]
fn column_sums(rows: &[[f64; STRIDE]], first: usize, x: &Lanes, inside: &Lanes, half: f64) -> LaneSums {
    let zero = [0.0; LANES];
    let mut s = LaneSums { gxx: zero, gxy: zero, gyy: zero, bx: zero, by: zero, c: zero };
    for (index, three) in rows.windows(3).enumerate() {
        let y = index as f64 - half;
        let columns = first..first + LANES + 2;
        let (above, middle, below) = (&three[0][columns.clone()], &three[1][columns.clone()], &three[2][columns]);
        let mut smooth = [0.0; LANES + 2];
        let mut slope = [0.0; LANES + 2];
        for i in 0..LANES + 2 {
            smooth[i] = above[i] + 2.0 * middle[i] + below[i];
            slope[i] = below[i] - above[i];
        }
        for i in 0..LANES {
            let gx = (smooth[i + 2] - smooth[i]) * inside[i];
            let gy = (slope[i] + 2.0 * slope[i + 1] + slope[i + 2]) * inside[i];
            let t = gx * x[i] + gy * y;
            s.gxx[i] += gx * gx;
            s.gxy[i] += gx * gy;
            s.gyy[i] += gy * gy;
            s.bx[i] += gx * t;
            s.by[i] += gy * t;
            s.c[i] += t * t;
        }
    }
    s
}

#[inline(always)]
fn add(total: &mut Sums, lanes: &LaneSums) {
    total.gxx += lanes.gxx.iter().sum::<f64>();
    total.gxy += lanes.gxy.iter().sum::<f64>();
    total.gyy += lanes.gyy.iter().sum::<f64>();
    total.bx += lanes.bx.iter().sum::<f64>();
    total.by += lanes.by.iter().sum::<f64>();
    total.c += lanes.c.iter().sum::<f64>();
}
