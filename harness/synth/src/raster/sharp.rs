//! Pieces under a kernel that is the photosite alone: exact area, interval by interval.

use super::piece::{Piece, Quartic, at};
use super::strip::Strip;

/// The largest distance between a piece and the chords that stand for it, px.
const CHORD_ERROR: f64 = 1e-5;

/// Adds `piece` as photosites of width `aperture` see it. `jitter` is the shift of each row of the strip to the right, px.
pub(super) fn add(strip: &mut Strip, piece: &Piece, aperture: f64, jitter: Option<&[f64]>) {
    let [x, y] = piece.polynomial();
    // A chord over a part h of the parameter is at most h^2/8 times the second derivative off.
    let bend = |c: Quartic| 2.0 * c[2].abs() + 6.0 * c[3].abs() + 12.0 * c[4].abs();
    let chords = (bend(x).hypot(bend(y)) / (8.0 * CHORD_ERROR)).sqrt().ceil().max(1.0);
    let point = |t: f64| [at(x, t), at(y, t)];
    let [mut from, .., end] = piece.points;
    for chord in 1..=chords as usize {
        let to = if chord == chords as usize { end } else { point(chord as f64 / chords) };
        straight(strip, from, to, piece.contrast, aperture, jitter);
        from = to;
    }
}

fn straight(strip: &mut Strip, from: [f64; 2], to: [f64; 2], contrast: f64, aperture: f64, jitter: Option<&[f64]>) {
    if from[1] == to[1] {
        return;
    }
    let half = aperture / 2.0;
    let (low, high) = if from[1] < to[1] { (from[1], to[1]) } else { (to[1], from[1]) };
    let first = ((low - half).ceil() as i64).max(strip.top);
    let last = ((high + half).floor() as i64).min(strip.top + strip.rows as i64 - 1);
    let slope = (to[0] - from[0]) / (to[1] - from[1]);
    // From the nearer end, so that an edge ends exactly where its vertex is.
    let x_at = |y: f64| {
        if (y - from[1]).abs() < (y - to[1]).abs() { from[0] + (y - from[1]) * slope } else { to[0] + (y - to[1]) * slope }
    };
    for row in first..=last {
        let (y0, y1) = (low.max(row as f64 - half), high.min(row as f64 + half));
        if y1 <= y0 {
            continue;
        }
        let rise = contrast * (to[1] - from[1]).signum() * (y1 - y0) / aperture;
        let shift = jitter.map_or(0.0, |jitter| jitter[(row - strip.top) as usize]);
        within_row(strip, row, rise, x_at(y0) + shift, x_at(y1) + shift, half);
    }
}

/// A stretch inside one row of photosites that runs from `x0` to `x1` and crosses the signed height `rise`, in heights of a photosite.
fn within_row(strip: &mut Strip, row: i64, rise: f64, x0: f64, x1: f64, half: f64) {
    let (low, high) = if x0 < x1 { (x0, x1) } else { (x1, x0) };
    // The mean over the stretch of S(x - column), the covered part of the photosite right of the edge: for a straight stretch a difference of parabolas.
    let mean = |column: i64| {
        let centre = column as f64;
        if high - low < 1e-7 {
            return covered(0.5 * (low + high) - centre, half);
        }
        (area(high - centre, half) - area(low - centre, half)) / (high - low)
    };
    let first = ((low - half).floor() as i64).max(0);
    let Some(width) = strip.row_from(row, first).map(|row| row.len() as i64) else { return };
    let last = ((high + half).ceil() as i64).min(first + width - 1).max(first);
    let mut before = 1.0;
    let Some(differences) = strip.row_from(row, first) else { return };
    for (column, difference) in (first..=last).zip(differences) {
        let now = mean(column);
        *difference -= rise * (before - now);
        before = now;
    }
}

/// The integral of the box of half-width `half` up to `u`, from 0 to 1.
fn covered(u: f64, half: f64) -> f64 {
    ((u + half) / (2.0 * half)).clamp(0.0, 1.0)
}

/// The integral of [`covered`].
fn area(u: f64, half: f64) -> f64 {
    if u <= -half {
        0.0
    } else if u >= half {
        u
    } else {
        (u + half) * (u + half) / (4.0 * half)
    }
}
