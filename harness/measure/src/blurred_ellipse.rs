//! The grey values of a blurred ellipse, averaged over pixels, with their derivatives: Green's theorem along the outline.
//!
//! With k the pixel's square blurred along one axis, T its integral and the outline (x(t), y(t)), the ellipse covers
//! `integral of k(px - x) T(py - y) x' dt` of pixel (px, py). The integrand is periodic and as smooth as the blur: equal steps
//! shorter than the blur's standard deviation make the sum exact to 1e-7, however small or bent the ellipse.

use multiversion::multiversion;

use crate::blurred_step::{DENSITY, step};
use crate::ellipse::Ellipse;
use crate::lanes::{LANES, Lanes};

/// Steps of the outline in standard deviations of the blur: the error is `2 exp(-2 pi^2 / STEP^2)`.
const STEP: f64 = 1.1;
const FEWEST: usize = 24;
/// The blurred square ends here: half its side, and so many standard deviations.
const REACH: f64 = 6.0;

/// From a disc's outline to the border of the window that pictures it, px.
pub(crate) const MARGIN: f64 = 5.0;
/// The variance of the blur is at least this, px^2.
pub(crate) const SHARPEST: f64 = 0.01;
/// The smallest semi-axis, px.
const SMALLEST: f64 = 0.3;

/// Whether a window of `side` px can picture such an ellipse under a blur of `variance` px^2; `false` for what is not a number.
pub(crate) fn is_pictured(ellipse: &Ellipse, variance: f64, side: usize) -> bool {
    let (side, [large, small]) = (side as f64, ellipse.semi_axes());
    ellipse.position.iter().all(|c| (-side..2.0 * side).contains(c)) && small >= SMALLEST && large <= side && variance <= side * side
}

/// How much of each pixel is covered.
pub(crate) const COVERED: usize = 0;
/// Its derivatives by the centre's x and y: a vector that points outwards.
pub(crate) const CENTRE: [usize; 2] = [1, 2];
/// That by the variance of the blur.
pub(crate) const VARIANCE: usize = 3;
/// Those by the shape.
pub(crate) const SHAPE: [usize; 3] = [4, 5, 6];
const PLANES: usize = 7;

/// How much of each pixel of a square window an ellipse covers, and the derivatives, in planes of rows that are filled up to whole [`LANES`].
pub(crate) struct Planes {
    pub(crate) side: usize,
    /// From one row to the next: what lies past the window's side is right, too, but not asked for.
    pub(crate) stride: usize,
    pub(crate) values: [Vec<f64>; PLANES],
    columns: Profile,
    rows: Profile,
}

/// The blurred square of one axis: its integral T, itself, and its slope at the pixels from `first` on, of which `seen` are reached and `filled` worked out.
struct Profile {
    first: usize,
    seen: usize,
    filled: usize,
    /// The blurred step and the bell at the left-hand rim of each pixel.
    edge: Vec<f64>,
    bell: Vec<f64>,
    integral: Vec<f64>,
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl Planes {
    /// Eight values of one plane from an index on.
    #[inline(always)]
    pub(crate) fn lanes(&self, plane: usize, at: usize) -> Lanes {
        eight(&self.values[plane], at)
    }

    pub(crate) fn new(side: usize) -> Self {
        let stride = side + LANES;
        Self { side, stride, values: Default::default(), columns: Profile::new(stride), rows: Profile::new(stride) }
    }

    /// Fills all planes for an `ellipse` whose position is taken from the window's first pixel, under a blur of `variance` px^2.
    pub(crate) fn fill(&mut self, ellipse: &Ellipse, variance: f64) {
        // One row more, for what lies below the window.
        let size = (self.side + 1) * self.stride;
        for plane in &mut self.values {
            plane.clear();
            plane.resize(size, 0.0);
        }
        fill(self, ellipse, variance);
    }
}

#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
fn fill(to: &mut Planes, ellipse: &Ellipse, variance: f64) {
    let blur = variance.sqrt();
    let nodes = ((std::f64::consts::TAU * ellipse.semi_axes()[0] / (STEP * blur)).ceil() as usize).max(FEWEST);
    let dt = std::f64::consts::TAU / nodes as f64;
    let (turn_sin, turn_cos) = dt.sin_cos();
    let (mut sin, mut cos) = (0.0, 1.0);
    for _ in 0..nodes {
        add(to, ellipse, blur, [sin, cos], dt);
        (sin, cos) = (sin * turn_cos + cos * turn_sin, cos * turn_cos - sin * turn_sin);
    }
    // What was added to one row is meant for all rows below it.
    let (stride, covered) = (to.stride, &mut to.values[COVERED]);
    for row in 1..to.side {
        let (above, below) = covered.split_at_mut(row * stride);
        for (sum, above) in below[..stride].iter_mut().zip(&above[(row - 1) * stride..]) {
            *sum += above;
        }
    }
}

/// What the outline between two nodes gives.
#[inline(always)]
fn add(to: &mut Planes, ellipse: &Ellipse, blur: f64, [sin, cos]: [f64; 2], dt: f64) {
    let [a, b, c] = ellipse.shape;
    let (dx, dy) = ((b * cos - a * sin) * dt, (c * cos - b * sin) * dt);
    to.columns.lay::<false>(ellipse.position[0] + a * cos + b * sin, blur, to.side);
    to.rows.lay::<true>(ellipse.position[1] + b * cos + c * sin, blur, to.side);
    // How fast the outline moves outwards with each of the shape.
    let speeds = [cos * dy, sin * dy - cos * dx, -sin * dx];
    let (first, seen) = (to.columns.first, to.columns.filled);
    let (value, slope) = (&to.columns.value[..seen], &to.columns.slope[..seen]);
    let [covered, by_x, by_y, by_variance, by_shape @ ..] = &mut to.values;
    let mut above = 0.0;
    for row in 0..to.rows.seen {
        let from = (to.rows.first + row) * to.stride + first;
        let (down, down_slope, integral) = (to.rows.value[row], to.rows.slope[row], to.rows.integral[row]);
        add_line(&mut covered[from..][..seen], value, (integral - above) * dx);
        add_line(&mut by_x[from..][..seen], value, down * dy);
        add_line(&mut by_y[from..][..seen], value, -down * dx);
        for (plane, speed) in by_shape.iter_mut().zip(speeds) {
            add_line(&mut plane[from..][..seen], value, speed * down);
        }
        let (along, across) = (0.5 * down_slope * dx, -0.5 * down * dy);
        for (sum, (value, slope)) in by_variance[from..][..seen].iter_mut().zip(value.iter().zip(slope)) {
            *sum += along * value + across * slope;
        }
        above = integral;
    }
    let from = (to.rows.first + to.rows.seen) * to.stride + first;
    add_line(&mut covered[from..][..seen], value, (1.0 - above) * dx);
}

/// Eight values from an index on.
#[inline(always)]
pub(crate) fn eight(values: &[f64], at: usize) -> Lanes {
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&values[at..at + LANES]);
    lanes
}

#[inline(always)]
fn add_line(sums: &mut [f64], values: &[f64], weight: f64) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

impl Profile {
    fn new(stride: usize) -> Self {
        let [edge, bell, integral, value, slope] = [(); 5].map(|()| vec![0.0; stride]);
        Self { first: 0, seen: 0, filled: 0, edge, bell, integral, value, slope }
    }

    /// Around `at`, px, as far as the window of `side` px and the blur go. `INTEGRAL`: T is wanted, too.
    #[inline(always)]
    fn lay<const INTEGRAL: bool>(&mut self, at: f64, blur: f64, side: usize) {
        let reach = 0.5 + REACH * blur;
        let end = ((at + reach).floor() + 1.0).clamp(0.0, side as f64) as usize;
        self.first = ((at - reach).ceil().max(0.0) as usize).min(end);
        self.seen = end - self.first;
        // The right-hand rim of a pixel is the left-hand one of the next: one rim more than pixels.
        self.filled = (self.seen + 1).next_multiple_of(LANES);
        let inverse = 1.0 / blur;
        let last = self.filled - 1;
        for from in (0..self.filled).step_by(LANES) {
            let mut x: Lanes = [0.0; LANES];
            for (i, x) in x.iter_mut().enumerate() {
                *x = ((self.first + from + i) as f64 - 0.5 - at) * inverse;
            }
            let (edge, bell) = step(&x);
            self.edge[from..][..LANES].copy_from_slice(&edge);
            self.bell[from..][..LANES].copy_from_slice(&bell);
            if INTEGRAL {
                let mut area = [0.0; LANES];
                for i in 0..LANES {
                    area[i] = 0.5 * x[i] * edge[i] + DENSITY * bell[i];
                }
                self.integral[from..][..LANES].copy_from_slice(&area);
            }
        }
        differences(&mut self.value[..last], &self.edge, 0.5);
        differences(&mut self.slope[..last], &self.bell, DENSITY * inverse);
        (self.value[last], self.slope[last]) = (0.0, 0.0);
        if INTEGRAL {
            for pixel in 0..last {
                self.integral[pixel] = 0.5 + blur * (self.integral[pixel + 1] - self.integral[pixel]);
            }
        }
    }
}

#[inline(always)]
fn differences(to: &mut [f64], rims: &[f64], factor: f64) {
    for (i, to) in to.iter_mut().enumerate() {
        *to = factor * (rims[i + 1] - rims[i]);
    }
}
