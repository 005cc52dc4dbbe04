//! Line integrals along the border of a mask.
//!
//! With K the profile of a blurred pixel in two dimensions, W its integral in x, and p running along the border: the coverage of the pixel is the
//! integral of `W k(y) dy` (Green's theorem); its derivative by a parameter that moves the border by `q` is the integral of `K (q x dp)`; its derivative
//! by the blur, as K obeys the equation of heat, is `sigma` times the integral of `grad K x dp`.
//!
//! Along one curve, whatever an affine map's parameters do to the border is a combination of a few functions: 1 and t on a line; on an arc cosine, sine
//! and their products. The integrals of K times these are added up in registers, pixel by pixel, and combined at the end.

use calibench_model::{Affine, Curve};
use multiversion::multiversion;

use super::mask::{LONGEST, Mask, Panel, map};
use super::planes::{BLUR, COVERAGE, Pose, Window};
use super::profile::{LANES, Profile, Samples};

/// Affine parameters and the position: planes 0 to 5.
const MOVING: usize = 6;

/// Samples at the nodes of one panel.
#[derive(Clone, Debug)]
pub(super) struct Bank {
    rows: Axis,
    columns: Axis,
    /// Of each node: the first and the last row that see it.
    seen: Vec<(usize, usize)>,
    /// Weighted steps dx, dy of each node, px.
    steps: Vec<[f64; 2]>,
    /// Weights of each node.
    weights: Vec<f64>,
    /// Parameter of each node.
    at: Vec<f64>,
}

/// Samples of all nodes along one axis.
#[derive(Clone, Debug)]
struct Axis {
    stride: usize,
    integral: Vec<f64>,
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl Axis {
    fn new(pixels: usize) -> Self {
        let stride = pixels + LANES;
        let [integral, value, slope] = [(); 3].map(|()| vec![0.0; LONGEST * stride]);
        Self { stride, integral, value, slope }
    }

    #[inline(always)]
    fn sample<const INTEGRAL: bool>(&mut self, node: usize, profile: &Profile, at: f64, blur: bool) -> (usize, usize) {
        let span = node * self.stride..(node + 1) * self.stride;
        let (integral, value, slope) = (&mut self.integral[span.clone()], &mut self.value[span.clone()], &mut self.slope[span]);
        profile.sample::<INTEGRAL>(at, self.stride - LANES, &mut Samples { integral, value, slope }, blur)
    }
}

impl Bank {
    /// For a window of `pixels`, whose rows are `stride` apart.
    pub(super) fn new(pixels: usize, stride: usize) -> Self {
        let (rows, columns) = (Axis::new(pixels), Axis::new(stride));
        let [weights, at] = [(); 2].map(|()| Vec::with_capacity(LONGEST));
        Self { rows, columns, seen: Vec::with_capacity(LONGEST), steps: Vec::with_capacity(LONGEST), weights, at }
    }

    fn clear(&mut self) {
        self.seen.clear();
        self.steps.clear();
        self.weights.clear();
        self.at.clear();
    }
}

/// Adds coverage and derivatives of a mask to the planes.
#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
pub(super) fn integrate(mut window: Window<'_>, bank: &mut Bank, mask: &Mask, pose: &Pose, profile: &Profile, blur: bool) {
    let a = &pose.affine;
    // Where the affine reflects, the border runs the other way round.
    let sense = if a.axx * a.ayy - a.axy * a.ayx < 0.0 { -1.0 } else { 1.0 };
    let rows = (-profile.reach(), window.pixels as f64 - 1.0 + profile.reach());
    for curve in mask.curves() {
        for panel in Panel::of(curve, a, pose.at[1], profile.sigma(), rows) {
            match *curve {
                Curve::Line { from, to } => {
                    let line = Line::new(a, from, to, sense);
                    fill(bank, panel, profile, pose.at, blur, |t| line.at(t));
                    add::<2>(&mut window, bank, &line.expansion, |t| [1.0, t], profile.sigma(), blur);
                }
                Curve::Arc { centre, radius, start, sweep } => {
                    let arc = Arc::new(a, centre, radius, sweep, sense);
                    let angle = |t: f64| (start + t * sweep).sin_cos();
                    fill(bank, panel, profile, pose.at, blur, |t| arc.at(a, angle(t)));
                    let functions = |t: f64| {
                        let (sine, cosine) = angle(t);
                        [cosine, sine, cosine * cosine, cosine * sine, sine * sine]
                    };
                    add::<5>(&mut window, bank, &arc.expansion, functions, profile.sigma(), blur);
                }
            }
        }
    }
}

/// A line in the image.
struct Line {
    from: [f64; 2],
    along: [f64; 2],
    step: [f64; 2],
    expansion: [[f64; 2]; MOVING],
}

impl Line {
    #[inline(always)]
    fn new(a: &Affine, from: [f64; 2], to: [f64; 2], sense: f64) -> Self {
        let (u, v) = ([from[0], to[0] - from[0]], [from[1], to[1] - from[1]]);
        let along = map(a, [u[1], v[1]]);
        let [dx, dy] = along.map(|d| d * sense);
        let expansion = [[dy, 0.0], [-dx, 0.0], u.map(|u| u * dy), v.map(|v| v * dy), u.map(|u| -u * dx), v.map(|v| -v * dx)];
        Self { from: map(a, from), along, step: [dx, dy], expansion }
    }

    #[inline(always)]
    fn at(&self, t: f64) -> ([f64; 2], [f64; 2]) {
        ([self.from[0] + t * self.along[0], self.from[1] + t * self.along[1]], self.step)
    }
}

/// An arc in the image; its steps are combinations of cosine and sine.
struct Arc {
    centre: [f64; 2],
    radius: f64,
    step: [[f64; 2]; 2],
    expansion: [[f64; 5]; MOVING],
}

impl Arc {
    #[inline(always)]
    fn new(a: &Affine, centre: [f64; 2], radius: f64, sweep: f64, sense: f64) -> Self {
        let scale = radius * sweep * sense;
        let (dx, dy) = ([a.axy * scale, -a.axx * scale], [a.ayy * scale, -a.ayx * scale]);
        // The centre's coordinate plus the radius times cosine (of u) or sine (of v), times a step.
        let u = |[c, s]: [f64; 2]| [centre[0] * c, centre[0] * s, radius * c, radius * s, 0.0];
        let v = |[c, s]: [f64; 2]| [centre[1] * c, centre[1] * s, 0.0, radius * c, radius * s];
        let only = |[c, s]: [f64; 2]| [c, s, 0.0, 0.0, 0.0];
        let back = dx.map(|d| -d);
        Self { centre, radius, step: [dx, dy], expansion: [only(dy), only(back), u(dy), v(dy), u(back), v(back)] }
    }

    #[inline(always)]
    fn at(&self, a: &Affine, (sine, cosine): (f64, f64)) -> ([f64; 2], [f64; 2]) {
        let mask = [self.centre[0] + self.radius * cosine, self.centre[1] + self.radius * sine];
        (map(a, mask), self.step.map(|[c, s]| c * cosine + s * sine))
    }
}

/// Samples at the nodes of a panel; `place` gives where a parameter is, from the reference point, and its step.
#[inline(always)]
fn fill(bank: &mut Bank, panel: Panel, profile: &Profile, [x, y]: [f64; 2], blur: bool, place: impl Fn(f64) -> ([f64; 2], [f64; 2])) {
    bank.clear();
    for (t, weight) in panel.nodes() {
        let ([px, py], step) = place(t);
        let node = bank.at.len();
        bank.columns.sample::<true>(node, profile, x + px, blur);
        let seen = bank.rows.sample::<false>(node, profile, y + py, blur);
        bank.seen.push(seen);
        bank.steps.push(step.map(|s| s * weight));
        bank.weights.push(weight);
        bank.at.push(t);
    }
}

/// Adds the integrals of a panel; `functions` are what the border's movements are combined from, by `expansion`.
#[inline(always)]
fn add<const B: usize>(
    window: &mut Window<'_>,
    bank: &Bank,
    expansion: &[[f64; B]; MOVING],
    functions: impl Fn(f64) -> [f64; B],
    sigma: f64,
    blur: bool,
) {
    let mut values = [[0.0; B]; LONGEST];
    for (value, (&t, &weight)) in values.iter_mut().zip(bank.at.iter().zip(&bank.weights)) {
        *value = functions(t).map(|f| f * weight);
    }
    let area = window.pixels * window.stride;
    for row in 0..window.pixels {
        let sees = |&(low, high): &(usize, usize)| low <= row && row < high;
        let Some(first) = bank.seen.iter().position(sees) else { continue };
        let end = bank.seen.iter().rposition(sees).map_or(first, |last| last + 1);
        for column in (0..window.stride).step_by(LANES) {
            let sums = sum(bank, &values, row, column, first..end, blur);
            let start = row * window.stride + column;
            let mut put = |plane: usize, lanes: [f64; LANES]| {
                let to = &mut window.values[plane * area + start..][..LANES];
                for lane in 0..LANES {
                    to[lane] += lanes[lane];
                }
            };
            put(COVERAGE, sums.coverage);
            for (plane, factors) in expansion.iter().enumerate() {
                let mut combined = [0.0; LANES];
                for (factor, moment) in factors.iter().zip(&sums.moments) {
                    for (to, moment) in combined.iter_mut().zip(moment) {
                        *to += factor * moment;
                    }
                }
                put(plane, combined);
            }
            if blur {
                put(BLUR, sums.blur.map(|s| s * sigma));
            }
        }
    }
}

/// Integrals over a panel at `LANES` pixels.
struct Sums<const B: usize> {
    coverage: [f64; LANES],
    moments: [[f64; LANES]; B],
    blur: [f64; LANES],
}

#[inline(always)]
fn sum<const B: usize>(
    bank: &Bank,
    values: &[[f64; B]; LONGEST],
    row: usize,
    column: usize,
    nodes: std::ops::Range<usize>,
    blur: bool,
) -> Sums<B> {
    let mut sums = Sums { coverage: [0.0; LANES], moments: [[0.0; LANES]; B], blur: [0.0; LANES] };
    for node in nodes {
        let (across, down) = (node * bank.columns.stride + column, node * bank.rows.stride + row);
        let lanes = |values: &[f64]| -> [f64; LANES] { values[across..across + LANES].try_into().expect("a slice of that length") };
        let ([dx, dy], k) = (bank.steps[node], bank.rows.value[down]);
        let (integral, value) = (lanes(&bank.columns.integral), lanes(&bank.columns.value));
        let weight = k * dy;
        for (to, integral) in sums.coverage.iter_mut().zip(&integral) {
            *to += weight * integral;
        }
        let factors = values[node].map(|value| value * k);
        for (moment, factor) in sums.moments.iter_mut().zip(&factors) {
            for (to, value) in moment.iter_mut().zip(&value) {
                *to += value * factor;
            }
        }
        if blur {
            let (slope, sideways) = (lanes(&bank.columns.slope), bank.rows.slope[down] * dx);
            for lane in 0..LANES {
                sums.blur[lane] += weight * slope[lane] - sideways * value[lane];
            }
        }
    }
    sums
}
