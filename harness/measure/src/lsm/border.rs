//! Line integrals along the border of a mask.
//!
//! With K the profile of a blurred pixel in two dimensions, W its integral in x, and p running along the border: the coverage of the pixel is the
//! integral of `W k(y) dy` (Green's theorem); its derivative by a parameter that moves the border by `q` is the integral of `K (q x dp)`; its derivative
//! by the blur, as K obeys the equation of heat, is `sigma` times the integral of `grad K x dp`.
//!
//! Along one curve, whatever an affine map's parameters do to the border is a combination of a few functions: 1 and t on a line; on an arc cosine, sine
//! and their products. The integrals of K times these are added up in registers, a row of pixels at a time over the whole border, and combined there.

use calibench_model::{Affine, Curve};
use multiversion::multiversion;

use super::mask::{Mask, Panel, map};
use super::planes::{BLUR, COVERAGE, Derivatives, Pose, Window};
use super::profile::{LANES, Profile, Samples, Wanted};

/// Affine parameters and the position: planes 0 to 5.
const MOVING: usize = 6;

/// The most functions of which a curve's movements are combined.
const FUNCTIONS: usize = 5;

/// Samples at the nodes of a border. Its memory is used again for the next.
#[derive(Clone, Debug)]
pub(super) struct Bank {
    rows: Axis,
    columns: Axis,
    nodes: Vec<Node>,
    panels: Vec<Stretch>,
}

/// A point of the border.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// The first and the last row that see it.
    seen: (usize, usize),
    /// Weighted step dx, dy, px.
    step: [f32; 2],
    /// Weighted functions of which the curve's movements are combined.
    functions: [f32; FUNCTIONS],
}

/// The nodes of one panel, and how the derivatives come of their functions.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    first: usize,
    end: usize,
    expansion: Expansion,
}

/// Factors of the functions, for each of the [`MOVING`] parameters.
#[derive(Clone, Copy, Debug)]
enum Expansion {
    Line([[f32; 2]; MOVING]),
    Arc([[f32; 5]; MOVING]),
}

/// Samples of all nodes along one axis.
#[derive(Clone, Debug)]
struct Axis {
    stride: usize,
    integral: Vec<f32>,
    value: Vec<f32>,
    slope: Vec<f32>,
}

impl Axis {
    fn new(pixels: usize) -> Self {
        Self { stride: pixels.next_multiple_of(LANES), integral: Vec::new(), value: Vec::new(), slope: Vec::new() }
    }

    #[inline(always)]
    fn sample(&mut self, node: usize, profile: &Profile, at: f64, wanted: Wanted) -> (usize, usize) {
        let span = node * self.stride..(node + 1) * self.stride;
        if span.end > self.value.len() {
            [&mut self.integral, &mut self.value, &mut self.slope].into_iter().for_each(|samples| samples.resize(2 * span.end, 0.0));
        }
        let (integral, value, slope) = (&mut self.integral[span.clone()], &mut self.value[span.clone()], &mut self.slope[span]);
        profile.sample(at, &mut Samples { integral, value, slope }, wanted)
    }
}

impl Bank {
    /// For a window of `pixels`, whose rows are `stride` apart.
    pub(super) fn new(pixels: usize, stride: usize) -> Self {
        Self { rows: Axis::new(pixels), columns: Axis::new(stride), nodes: Vec::new(), panels: Vec::new() }
    }
}

/// Coverage and derivatives of a mask, written to their planes.
pub(super) fn draw(window: Window<'_>, bank: &mut Bank, mask: &Mask, pose: &Pose, profile: &Profile, derivatives: Derivatives) {
    match derivatives {
        Derivatives::None => integrate::<false, false>(window, bank, mask, pose, profile),
        Derivatives::Pose => integrate::<true, false>(window, bank, mask, pose, profile),
        Derivatives::PoseAndBlur => integrate::<true, true>(window, bank, mask, pose, profile),
    }
}

#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
fn integrate<const MOVED: bool, const BLURRED: bool>(window: Window<'_>, bank: &mut Bank, mask: &Mask, pose: &Pose, profile: &Profile) {
    let a = &pose.affine;
    // Where the affine reflects, the border runs the other way round.
    let sense = if a.axx * a.ayy - a.axy * a.ayx < 0.0 { -1.0 } else { 1.0 };
    let rows = (-profile.reach(), window.pixels as f64 - 1.0 + profile.reach());
    bank.nodes.clear();
    bank.panels.clear();
    for curve in mask.curves() {
        for panel in Panel::of(curve, a, pose.at[1], profile.sigma(), rows) {
            match *curve {
                Curve::Line { from, to } => {
                    let line = Line::new(a, from, to, sense);
                    let expansion = Expansion::Line(line.expansion.map(|factors| factors.map(|f| f as f32)));
                    fill::<2, MOVED, BLURRED>(bank, panel, profile, pose.at, expansion, |t| (line.at(t), [1.0, t]));
                }
                Curve::Arc { centre, radius, start, sweep } => {
                    let arc = Arc::new(a, centre, radius, sweep, sense);
                    let expansion = Expansion::Arc(arc.expansion.map(|factors| factors.map(|f| f as f32)));
                    fill::<5, MOVED, BLURRED>(bank, panel, profile, pose.at, expansion, |t| {
                        let (sine, cosine) = (start + t * sweep).sin_cos();
                        (arc.at(a, (sine, cosine)), [cosine, sine, cosine * cosine, cosine * sine, sine * sine])
                    });
                }
            }
        }
    }
    sweep::<MOVED, BLURRED>(window, bank, profile.sigma() as f32);
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

/// Samples at the nodes of a panel; `place` gives where a parameter is, from the reference point, its step, and the functions there.
#[inline(always)]
fn fill<const B: usize, const MOVED: bool, const BLURRED: bool>(
    bank: &mut Bank,
    panel: Panel,
    profile: &Profile,
    [x, y]: [f64; 2],
    expansion: Expansion,
    place: impl Fn(f64) -> (([f64; 2], [f64; 2]), [f64; B]),
) {
    let first = bank.nodes.len();
    for (t, weight) in panel.nodes() {
        let (([px, py], step), values) = place(t);
        let node = bank.nodes.len();
        bank.columns.sample(node, profile, x + px, Wanted { integral: true, value: MOVED, slope: BLURRED });
        let seen = bank.rows.sample(node, profile, y + py, Wanted { integral: false, value: true, slope: BLURRED });
        let mut functions = [0.0; FUNCTIONS];
        functions.iter_mut().zip(values).for_each(|(to, value)| *to = (value * weight) as f32);
        bank.nodes.push(Node { seen, step: step.map(|s| (s * weight) as f32), functions });
    }
    bank.panels.push(Stretch { first, end: bank.nodes.len(), expansion });
}

/// A row of `LANES` pixels: coverage, its derivatives by position and shape, and by the blur.
struct Sums {
    coverage: [f32; LANES],
    moving: [[f32; LANES]; MOVING],
    blur: [f32; LANES],
}

/// The planes, row by row.
#[expect(clippy::needless_pass_by_value, reason = "it holds what is written to")]
#[inline(always)]
fn sweep<const MOVED: bool, const BLURRED: bool>(window: Window<'_>, bank: &Bank, sigma: f32) {
    let area = window.pixels * window.stride;
    for row in 0..window.pixels {
        for column in (0..window.stride).step_by(LANES) {
            let mut sums = Sums { coverage: [0.0; LANES], moving: [[0.0; LANES]; MOVING], blur: [0.0; LANES] };
            for panel in &bank.panels {
                let nodes = &bank.nodes[panel.first..panel.end];
                let sees = |node: &Node| node.seen.0 <= row && row < node.seen.1;
                let Some(first) = nodes.iter().position(sees) else { continue };
                let last = nodes.iter().rposition(sees).unwrap_or(first);
                let seen = (panel.first + first, panel.first + last + 1);
                match &panel.expansion {
                    Expansion::Line(factors) => add::<2, MOVED, BLURRED>(&mut sums, bank, seen, (row, column), factors),
                    Expansion::Arc(factors) => add::<5, MOVED, BLURRED>(&mut sums, bank, seen, (row, column), factors),
                }
            }
            // Nothing lies behind the window's last column.
            let mut inside = [0.0; LANES];
            inside[..LANES.min(window.pixels - column)].fill(1.0);
            let start = row * window.stride + column;
            put(&mut window.values[COVERAGE * area + start..], &sums.coverage, &inside);
            if MOVED {
                for (plane, lanes) in sums.moving.iter().enumerate() {
                    put(&mut window.values[plane * area + start..], lanes, &inside);
                }
            }
            if BLURRED {
                put(&mut window.values[BLUR * area + start..], &sums.blur, &inside.map(|one| one * sigma));
            }
        }
    }
}

#[inline(always)]
fn put(to: &mut [f32], lanes: &[f32; LANES], factors: &[f32; LANES]) {
    let to: &mut [f32; LANES] = (&mut to[..LANES]).try_into().expect("a slice of that length");
    for lane in 0..LANES {
        to[lane] = lanes[lane] * factors[lane];
    }
}

/// Adds the integrals over the nodes `first..end` of one panel at the pixels from (`row`, `column`) on.
#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "many arrays side by side")]
fn add<const B: usize, const MOVED: bool, const BLURRED: bool>(
    sums: &mut Sums,
    bank: &Bank,
    (first, end): (usize, usize),
    (row, column): (usize, usize),
    expansion: &[[f32; B]; MOVING],
) {
    let mut moments = [[0.0; LANES]; B];
    let mut coverage = sums.coverage;
    for (index, node) in bank.nodes[first..end].iter().enumerate() {
        let (across, down) = ((first + index) * bank.columns.stride + column, (first + index) * bank.rows.stride + row);
        let lanes = |values: &[f32]| -> [f32; LANES] { values[across..across + LANES].try_into().expect("a slice of that length") };
        let ([dx, dy], k) = (node.step, bank.rows.value[down]);
        let integral = lanes(&bank.columns.integral);
        let weight = k * dy;
        for lane in 0..LANES {
            coverage[lane] += weight * integral[lane];
        }
        if MOVED {
            let value = lanes(&bank.columns.value);
            for function in 0..B {
                let factor = node.functions[function] * k;
                for lane in 0..LANES {
                    moments[function][lane] += value[lane] * factor;
                }
            }
            if BLURRED {
                let (slope, sideways) = (lanes(&bank.columns.slope), bank.rows.slope[down] * dx);
                for lane in 0..LANES {
                    sums.blur[lane] += weight * slope[lane] - sideways * value[lane];
                }
            }
        }
    }
    sums.coverage = coverage;
    if MOVED {
        // One by one: in a loop they would be worked out across the planes, with gathered numbers.
        let [x, y, axx, axy, ayx, ayy] = &mut sums.moving;
        combine(x, &expansion[0], &moments);
        combine(y, &expansion[1], &moments);
        combine(axx, &expansion[2], &moments);
        combine(axy, &expansion[3], &moments);
        combine(ayx, &expansion[4], &moments);
        combine(ayy, &expansion[5], &moments);
    }
}

#[inline(always)]
fn combine<const B: usize>(to: &mut [f32; LANES], factors: &[f32; B], moments: &[[f32; LANES]; B]) {
    let mut sum = *to;
    for function in 0..B {
        for lane in 0..LANES {
            sum[lane] += factors[function] * moments[function][lane];
        }
    }
    *to = sum;
}
