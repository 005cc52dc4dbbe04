//! The grey values of a blurred ellipse, averaged over pixels, with their derivatives: Green's theorem along the outline.
//!
//! With k the pixel's square blurred along one axis, T its integral and the outline (x(t), y(t)), the ellipse covers
//! `-integral of T(px - x) k(py - y) y' dt` of pixel (px, py). The integrand is periodic and as smooth as the blur: equal steps
//! shorter than the blur's standard deviation make the sum exact to 1e-7, however small or bent the ellipse.

use multiversion::multiversion;

use crate::ellipse::Ellipse;
use crate::lanes::{DENSITY, LANES, Lanes, step};

/// Steps of the outline in standard deviations of the blur: the error is `2 exp(-2 pi^2 / STEP^2)`.
const STEP: f64 = 1.1;
const FEWEST: usize = 24;
/// The blurred square ends here: half its side, and so many standard deviations.
const REACH: f64 = 6.0;

/// How much of each pixel is covered, and its derivatives by the centre (2), the shape (3) and the variance of the blur: seven planes of the window.
pub(super) struct Planes {
    pub(super) side: usize,
    pub(super) values: [Vec<f64>; 7],
    columns: Profile,
    rows: Profile,
}

/// The blurred square of one axis at the pixels from `first` on: its integral T, itself, and its slope.
#[derive(Default)]
struct Profile {
    first: usize,
    integral: Vec<f64>,
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl Planes {
    pub(super) fn new(side: usize) -> Self {
        let plane = || vec![0.0; side * side];
        let planes = std::array::from_fn(|_| plane());
        Self { side, values: planes, columns: Profile::default(), rows: Profile::default() }
    }

    /// Fills all planes for an `ellipse` whose position is taken from the window's first pixel, under a blur of `variance` px^2.
    pub(super) fn fill(&mut self, ellipse: &Ellipse, variance: f64) {
        let blur = variance.sqrt();
        let around = std::f64::consts::TAU;
        let nodes = ((around * ellipse.semi_axes()[0] / (STEP * blur)).ceil() as usize).max(FEWEST);
        self.values.iter_mut().for_each(|plane| plane.fill(0.0));
        for node in 0..nodes {
            add(self, ellipse, blur, around * node as f64 / nodes as f64, around / nodes as f64);
        }
    }
}

#[multiversion(targets("x86_64+avx2", "x86_64+avx512f+avx512vl"))]
fn add(to: &mut Planes, ellipse: &Ellipse, blur: f64, t: f64, dt: f64) {
    let (offset, tangent) = ellipse.point(t);
    let (sin, cos) = t.sin_cos();
    let (dx, dy) = (tangent.x * dt, tangent.y * dt);
    to.columns.lay(ellipse.position[0] + offset.x, blur, to.side);
    to.rows.lay(ellipse.position[1] + offset.y, blur, to.side);
    // How fast the outline moves outwards with each unknown.
    let speeds = [dy, -dx, cos * dy, sin * dy - cos * dx, -sin * dx];
    let Profile { first, integral, value, slope } = &to.columns;
    let beyond = first + integral.len();
    let [covered, unknowns @ .., variance] = &mut to.values;
    for (row, (down, down_slope)) in to.rows.value.iter().zip(&to.rows.slope).enumerate() {
        let start = (to.rows.first + row) * to.side;
        let line = start + first..start + beyond;
        let weight = -down * dy;
        for (sum, integral) in covered[line.clone()].iter_mut().zip(integral) {
            *sum += weight * integral;
        }
        for sum in &mut covered[start + beyond..start + to.side] {
            *sum += weight;
        }
        for (plane, speed) in unknowns.iter_mut().zip(speeds) {
            let weight = speed * down;
            for (sum, value) in plane[line.clone()].iter_mut().zip(value) {
                *sum += weight * value;
            }
        }
        let (along, across) = (0.5 * down_slope * dx, -0.5 * down * dy);
        for (sum, (value, slope)) in variance[line].iter_mut().zip(value.iter().zip(slope)) {
            *sum += along * value + across * slope;
        }
    }
}

impl Profile {
    /// Around `at`, px, as far as the window of `side` px and the blur go.
    #[inline(always)]
    fn lay(&mut self, at: f64, blur: f64, side: usize) {
        let reach = 0.5 + REACH * blur;
        let end = ((at + reach).floor() + 1.0).clamp(0.0, side as f64) as usize;
        self.first = ((at - reach).ceil().max(0.0) as usize).min(end);
        self.integral.clear();
        self.value.clear();
        self.slope.clear();
        let inverse = 1.0 / blur;
        // The right-hand rim of a pixel is the left-hand one of the next.
        let mut from = self.first;
        while from < end {
            let mut x: Lanes = [0.0; LANES];
            for (i, x) in x.iter_mut().enumerate() {
                *x = ((from + i) as f64 - 0.5 - at) * inverse;
            }
            let (edge, bell) = step(&x);
            for i in 0..(LANES - 1).min(end - from) {
                let area = |i: usize| 0.5 * x[i] * edge[i] + DENSITY * bell[i];
                self.integral.push(0.5 + blur * (area(i + 1) - area(i)));
                self.value.push(0.5 * (edge[i + 1] - edge[i]));
                self.slope.push(DENSITY * inverse * (bell[i + 1] - bell[i]));
            }
            from += LANES - 1;
        }
    }
}
