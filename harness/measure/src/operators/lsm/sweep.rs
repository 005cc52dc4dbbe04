//! Line integrals for every pixel, row by row, from the samples at a border's nodes.

use super::bank::{Bank, Stretch};
use super::curves::{self, Expansion, MOVING};
use super::planes::{BLUR, COVERAGE, GROUND, Window};
use super::profile::LANES;

/// A row of `LANES` pixels: coverage, its derivatives by position and shape, and by the blur.
struct Sums {
    coverage: [f32; LANES],
    moving: [[f32; LANES]; MOVING],
    blur: [f32; LANES],
}

/// The planes, row by row. A line's node has `LINE` numbers, an arc's `ARC`.
#[inline(always)]
pub(super) fn sweep<const LINE: usize, const ARC: usize, const MOVED: bool, const BLURRED: bool>(
    mut window: Window<'_>,
    bank: &Bank,
    sigma: f32,
) {
    // Pairs of rows: each sum alone would wait for its own additions.
    for row in (0..window.pixels).step_by(2) {
        for column in (0..window.stride).step_by(LANES) {
            let none = |row: usize| Sums { coverage: [bank.beyond[row]; LANES], moving: [[0.0; LANES]; MOVING], blur: [0.0; LANES] };
            let mut sums = [none(row), none(row + 1)];
            for (index, panel) in bank.panels.iter().enumerate() {
                let place = index * bank.padded + row;
                let first = bank.first[place].min(bank.first[place + 1]);
                let end = bank.end[place].max(bank.end[place + 1]);
                if first >= end {
                    continue;
                }
                let seen = (usize::from(first), usize::from(end));
                match &panel.expansion {
                    Expansion::Line(line) => {
                        let moments = add::<2, LINE, MOVED, BLURRED>(&mut sums, bank, panel, seen, (row, column));
                        if MOVED {
                            line.expand(&moments[0], &mut sums[0].moving);
                            line.expand(&moments[1], &mut sums[1].moving);
                        }
                    }
                    Expansion::Arc(factors) => {
                        let moments = add::<5, ARC, MOVED, BLURRED>(&mut sums, bank, panel, seen, (row, column));
                        if MOVED {
                            curves::expand(factors, &moments[0], &mut sums[0].moving);
                            curves::expand(factors, &moments[1], &mut sums[1].moving);
                        }
                    }
                }
            }
            store::<MOVED, BLURRED>(&mut window, &sums[0], (row, column), sigma);
            if row + 1 < window.pixels {
                store::<MOVED, BLURRED>(&mut window, &sums[1], (row + 1, column), sigma);
            }
        }
    }
}

/// Writes the sums of a row to their planes.
#[inline(always)]
fn store<const MOVED: bool, const BLURRED: bool>(window: &mut Window<'_>, sums: &Sums, (row, column): (usize, usize), sigma: f32) {
    let area = window.pixels * window.stride;
    let start = row * window.stride + column;
    // What does not count is left out, as is what lies behind the window's last column.
    let inside: [f32; LANES] = window.values[GROUND * area + start..][..LANES].try_into().expect("a slice of that length");
    put(&mut window.values[COVERAGE * area + start..], &sums.coverage, &inside);
    if MOVED {
        for (plane, lanes) in sums.moving.iter().enumerate() {
            put(&mut window.values[plane * area + start..], lanes, &inside);
        }
    }
    if BLURRED {
        let mut scaled = [0.0; LANES];
        for lane in 0..LANES {
            scaled[lane] = inside[lane] * sigma;
        }
        put(&mut window.values[BLUR * area + start..], &sums.blur, &scaled);
    }
}

#[inline(always)]
fn put(to: &mut [f32], lanes: &[f32; LANES], factors: &[f32; LANES]) {
    let to: &mut [f32; LANES] = (&mut to[..LANES]).try_into().expect("a slice of that length");
    for lane in 0..LANES {
        to[lane] = lanes[lane] * factors[lane];
    }
}

/// Integrals over the nodes `first..end` of a panel at the pixels from (`row`, `column`) on and at those of the next row: adds coverage and blur, returns
/// those of `K` times the curve's functions.
#[inline(always)]
fn add<const B: usize, const NUMBERS: usize, const MOVED: bool, const BLURRED: bool>(
    sums: &mut [Sums; 2],
    bank: &Bank,
    panel: &Stretch,
    (first, end): (usize, usize),
    (row, column): (usize, usize),
) -> [[[f32; LANES]; B]; 2] {
    let [mut upper, mut lower] = [[[0.0; LANES]; B]; 2];
    let [mut coverage, mut below] = [sums[0].coverage, sums[1].coverage];
    let mut blur = [sums[0].blur, sums[1].blur];
    let blocks = bank.padded / LANES;
    let across = bank.across[panel.across..].as_chunks::<NUMBERS>().0;
    for node in first..end {
        let (numbers, down) = (&across[node * blocks + column / LANES], (panel.nodes + node) * bank.padded + row);
        let [k, next] = [bank.values[down], bank.values[down + 1]];
        coverage = plus(&coverage, k, &numbers[0].0);
        below = plus(&below, next, &numbers[0].0);
        if MOVED {
            for function in 0..B {
                upper[function] = plus(&upper[function], k, &numbers[1 + function].0);
                lower[function] = plus(&lower[function], next, &numbers[1 + function].0);
            }
        }
        if BLURRED {
            for (lane, (blur, k)) in blur.iter_mut().zip([k, next]).enumerate() {
                *blur = plus(blur, k, &numbers[NUMBERS - 2].0);
                *blur = plus(blur, -bank.slopes[down + lane], &numbers[NUMBERS - 1].0);
            }
        }
    }
    (sums[0].coverage, sums[1].coverage) = (coverage, below);
    [sums[0].blur, sums[1].blur] = blur;
    [upper, lower]
}

/// A whole new array: sums that are changed in place get torn into pieces of several lengths.
#[inline(always)]
fn plus(sum: &[f32; LANES], factor: f32, lanes: &[f32; LANES]) -> [f32; LANES] {
    let mut more = [0.0; LANES];
    for lane in 0..LANES {
        more[lane] = sum[lane] + factor * lanes[lane];
    }
    more
}
