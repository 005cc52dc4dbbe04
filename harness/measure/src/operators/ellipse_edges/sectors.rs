//! Where the outline of a disc is, sector by sector.

use nalgebra::{Matrix3, SVector, Vector3};

use super::conic::UNKNOWNS;
use crate::blurred_ellipse::{self, Fineness, Picture, Planes, lanes};
use crate::disc_fit::{Grey, structure};
use crate::ellipse::Ellipse;
use crate::lanes::{LANES, Lanes, Real};
use crate::residuals::Structure;

/// Pixels nearer to the outline than this are taken, px.
const BAND: f64 = 4.0;
/// The length of a sector on the outline, px, and the fewest of them.
const LENGTH: f64 = 1.0;
const FEWEST: usize = 24;
/// A sector with less than this fraction of the others' weight has no edge point.
const WEIGHTLESS: f64 = 1e-4;

/// What is pictured: an ellipse of one grey value on ground of another, blurred.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    pub(super) ellipse: Ellipse,
    /// Variance of the blur, px^2.
    pub(super) variance: f64,
    pub(super) ground: f64,
    /// Grey value inside minus that of the ground.
    pub(super) contrast: f64,
}

/// A point of the edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgePoint {
    /// How it moves along its normal with the ellipse's position and shape: the first two are the normal.
    pub(super) moves: SVector<f64, 5>,
    /// How far outside the outline the edge is, along the normal, px.
    pub(super) offset: f64,
    /// The inverse of the variance of the offset, for grey values of unit variance, 1/px^2.
    pub(super) weight: f64,
    /// How much of it a unit of what all pixels have in common explains: variance of the blur, ground, contrast.
    pub(super) common: Vector3<f64>,
}

/// The pixels around a disc, each told which sector of the outline it belongs to.
pub(super) struct Window<T> {
    pub(super) side: usize,
    /// In rows as the planes' are.
    grey: Vec<f64>,
    /// 1 for pixels of the band, 0 for others.
    taken: Vec<f64>,
    sector: Vec<u16>,
    /// How much the grey value changes by a shift of the edge, 1/px.
    slope: Vec<f64>,
    sums: Vec<Sums>,
    planes: Planes<T>,
    fineness: Fineness,
}

/// Sums over the pixels of one sector: squared slope, and slope times derivatives by position, shape, common unknowns, and slope times residual.
type Sums = [f64; 10];
const RESIDUAL: usize = 9;

impl<T: Real> Window<T>
where
    Planes<T>: Picture,
    Self: Sectored,
{
    /// Of these grey values, with outlines followed so closely; pictured are these planes.
    pub(super) fn new(from: &Grey, planes: Planes<T>, fineness: Fineness) -> Self {
        let side = from.side;
        let mut grey = vec![0.0; side * planes.stride];
        for (line, row) in grey.chunks_exact_mut(planes.stride).zip(from.rows()) {
            line.iter_mut().zip(row).for_each(|(grey, from)| *grey = f64::from(*from));
        }
        let (taken, sector, slope) = (vec![0.0; grey.len()], vec![0; grey.len()], vec![0.0; grey.len()]);
        Self { side, grey, taken, sector, slope, sums: Vec::new(), planes, fineness }
    }

    /// Fills the planes for a disc whose position is taken from the window's first pixel.
    pub(super) fn picture(&mut self, disc: &Disc) {
        self.planes.fill(&disc.ellipse, disc.variance, self.fineness);
    }

    /// Fills the plane of what is covered alone: the derivatives are those of a disc near by.
    pub(super) fn cover(&mut self, disc: &Disc) {
        self.planes.cover(&disc.ellipse, disc.variance, self.fineness);
    }

    /// Tells every pixel whether it is taken, and its sector: by the direction in which the edge is steepest there.
    pub(super) fn part(&mut self, ellipse: &Ellipse) {
        let [large, small] = ellipse.semi_axes();
        // A multiple of eight: in an image that is turned or reflected the same pixels make a sector.
        let length = std::f64::consts::PI * (large + small) / LENGTH;
        let sectors = (8 * (length / 8.0).ceil() as usize).clamp(FEWEST, usize::from(u16::MAX) - 7);
        self.sums.clear();
        self.sums.resize(sectors, [0.0; RESIDUAL + 1]);
        self.sort(ellipse);
    }

    /// How many more pixels are taken than there are unknowns.
    pub(super) fn redundancy(&self) -> f64 {
        self.taken.iter().sum::<f64>() - UNKNOWNS as f64
    }

    /// The structure along the outline of what the disc that was pictured leaves of the grey values.
    pub(super) fn structure(&self, ground: f64, contrast: f64) -> Structure {
        let stride = self.planes.stride;
        let mut residuals = vec![0.0; self.grey.len()];
        let covered = self.planes.values[blurred_ellipse::COVERED].chunks_exact(stride);
        for ((to, grey), covered) in residuals.chunks_exact_mut(stride).zip(self.grey.chunks_exact(stride)).zip(covered) {
            for (to, (grey, covered)) in to[..self.side].iter_mut().zip(grey.iter().zip(covered)) {
                *to = (grey - ground - contrast * Into::<f64>::into(*covered)) as f32;
            }
        }
        structure(&self.planes, residuals, contrast)
    }

    /// The points of the edge of the disc that was pictured, and the normal equations of what they have in common.
    pub(super) fn edge(&mut self, disc: &Disc) -> (Vec<EdgePoint>, Common) {
        self.sums.iter_mut().for_each(|sums| *sums = [0.0; RESIDUAL + 1]);
        let common = self.add_up(disc);
        (self.points().collect(), common)
    }

    /// Where the edge of a disc is that is so near to the one that was pictured that all derivatives are those of that one: the right-hand side of the normal
    /// equations, and the sum of the squared residuals.
    pub(super) fn gradient(&mut self, disc: &Disc) -> (SVector<f64, UNKNOWNS>, f64) {
        self.cover(disc);
        self.sums.iter_mut().for_each(|sums| sums[RESIDUAL] = 0.0);
        let (common, omega) = self.shift(disc);
        let mut b = SVector::<f64, UNKNOWNS>::zeros();
        b.fixed_rows_mut::<3>(5).copy_from(&common);
        for point in self.points() {
            for row in 0..5 {
                b[row] += point.weight * point.offset * point.moves[row];
            }
        }
        (b, omega)
    }

    fn points(&self) -> impl Iterator<Item = EdgePoint> {
        let heaviest = self.sums.iter().map(|sums| sums[0]).fold(0.0, f64::max);
        self.sums.iter().filter(move |sums| sums[0] > WEIGHTLESS * heaviest).map(edge_point)
    }
}

/// The point to which the pixels of one sector say that the edge is shifted.
fn edge_point(sums: &Sums) -> EdgePoint {
    let by: &[f64; 8] = sums[1..RESIDUAL].try_into().expect("as many");
    // With the normal a unit vector the edge is shifted as far as the disc would be.
    let gain = (by[0] * by[0] + by[1] * by[1]).sqrt();
    let moves = SVector::from_fn(|i, _| by[i] / gain);
    EdgePoint { moves, offset: sums[RESIDUAL] / gain, weight: gain * gain / sums[0], common: Vector3::new(by[5], by[6], by[7]) / gain }
}

/// The normal equations of what all pixels have in common: variance of the blur, ground, contrast.
pub(super) struct Common {
    pub(super) n: Matrix3<f64>,
    pub(super) b: Vector3<f64>,
    /// The sum of the squared residuals.
    pub(super) omega: f64,
}

/// What is done pixel by pixel.
pub(super) trait Sectored {
    /// Tells every pixel its sector.
    fn sort(&mut self, ellipse: &Ellipse);
    /// Adds up the sectors' sums, and those of what all have in common.
    fn add_up(&mut self, disc: &Disc) -> Common;
    /// Adds up what residuals say of the edge; by what all have in common, and the sum of their squares.
    fn shift(&mut self, disc: &Disc) -> (Vector3<f64>, f64);
}

impl Sectored for Window<f32> {
    fn sort(&mut self, ellipse: &Ellipse) {
        sort_quick(self, ellipse);
    }

    fn add_up(&mut self, disc: &Disc) -> Common {
        add_up_quick(self, disc)
    }

    fn shift(&mut self, disc: &Disc) -> (Vector3<f64>, f64) {
        shift_quick(self, disc)
    }
}

impl Sectored for Window<f64> {
    fn sort(&mut self, ellipse: &Ellipse) {
        sort_exact(self, ellipse);
    }

    fn add_up(&mut self, disc: &Disc) -> Common {
        add_up_exact(self, disc)
    }

    fn shift(&mut self, disc: &Disc) -> (Vector3<f64>, f64) {
        shift_exact(self, disc)
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn sort_quick(window: &mut Window<f32>, ellipse: &Ellipse) {
    sort(window, ellipse);
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn sort_exact(window: &mut Window<f64>, ellipse: &Ellipse) {
    sort(window, ellipse);
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn add_up_quick(window: &mut Window<f32>, disc: &Disc) -> Common {
    add_up(window, disc)
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn shift_quick(window: &mut Window<f32>, disc: &Disc) -> (Vector3<f64>, f64) {
    shift(window, disc)
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn add_up_exact(window: &mut Window<f64>, disc: &Disc) -> Common {
    add_up(window, disc)
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn shift_exact(window: &mut Window<f64>, disc: &Disc) -> (Vector3<f64>, f64) {
    shift(window, disc)
}

#[inline(always)]
fn sort<T: Real>(window: &mut Window<T>, ellipse: &Ellipse) {
    let Window { side, taken, sector, sums, planes, .. } = window;
    let [a, b, c] = ellipse.shape;
    let inverse = 1.0 / (a * c - b * b);
    let (eighth, last) = (sums.len() as f64 / 8.0, sums.len() as u16 - 1);
    for row in 0..*side {
        let v = row as f64 - ellipse.position[1];
        for from in (0..*side).step_by(LANES) {
            let at = row * planes.stride + from;
            let (by_x, by_y) = (double(planes, blurred_ellipse::CENTRE[0], at), double(planes, blurred_ellipse::CENTRE[1], at));
            let (mut turns, mut near) = ([0.0; LANES], [0.0; LANES]);
            for i in 0..LANES {
                let u = (from + i) as f64 - ellipse.position[0];
                // In the frame where the ellipse is the unit circle; then its gradient, and the distance of first order.
                let (p, q) = ((c * u - b * v) * inverse, (a * v - b * u) * inverse);
                let radius = (p * p + q * q).sqrt();
                let (s, t) = ((c * p - b * q) * inverse, (a * q - b * p) * inverse);
                let is_near = (radius - 1.0).abs() * radius <= BAND * (s * s + t * t).sqrt();
                near[i] = if is_near && from + i < *side { 1.0 } else { 0.0 };
                turns[i] = octants(a * by_x[i] + b * by_y[i], b * by_x[i] + c * by_y[i]) * eighth;
            }
            taken[at..][..LANES].copy_from_slice(&near);
            for (sector, turn) in sector[at..][..LANES].iter_mut().zip(&turns) {
                *sector = (*turn as i32 as u16).min(last);
            }
        }
    }
}

/// The direction of (x, y) in eighths of a turn, to 0.005: near enough to part an outline.
#[inline(always)]
fn octants(x: f64, y: f64) -> f64 {
    let (u, v) = (x.abs(), y.abs());
    let ratio = u.min(v) / u.max(v).max(f64::MIN_POSITIVE);
    let octant = ratio * (1.3476 - 0.3476 * ratio);
    let quarter = if v > u { 2.0 - octant } else { octant };
    let half = if x < 0.0 { 4.0 - quarter } else { quarter };
    if y < 0.0 { 8.0 - half } else { half }
}

/// The lanes of a plane, in double precision.
#[inline(always)]
fn double<T: Real>(planes: &Planes<T>, plane: usize, at: usize) -> Lanes {
    let (from, mut to) = (planes.lanes(plane, at), [0.0; LANES]);
    for i in 0..LANES {
        to[i] = from[i].into();
    }
    to
}

#[inline(always)]
fn add_up<T: Real>(window: &mut Window<T>, disc: &Disc) -> Common {
    let Window { side, grey, taken, sector, slope: slopes, sums, planes, .. } = window;
    let mut all = [[0.0; LANES]; 10];
    for row in 0..*side {
        for from in (0..*side).step_by(LANES) {
            let at = row * planes.stride + from;
            let (covered, by_variance) = (double(planes, blurred_ellipse::COVERED, at), double(planes, blurred_ellipse::VARIANCE, at));
            let (by_x, by_y) = (double(planes, blurred_ellipse::CENTRE[0], at), double(planes, blurred_ellipse::CENTRE[1], at));
            let (taken, grey) = (lanes::<_, LANES>(taken, at), lanes::<_, LANES>(grey, at));
            let [a, b, c] = blurred_ellipse::SHAPE;
            let by_shape = [double(planes, a, at), double(planes, b, at), double(planes, c, at)];
            let mut terms = [[0.0; LANES]; RESIDUAL + 1];
            let (mut steep, mut of_edge) = (0.0, [0.0; LANES]);
            for i in 0..LANES {
                let square = taken[i] * (by_x[i] * by_x[i] + by_y[i] * by_y[i]);
                let (outline, contrast) = (square.sqrt(), disc.contrast);
                let slope = outline * contrast;
                let v = contrast * by_variance[i];
                let r = grey[i] - disc.ground - contrast * covered[i];
                let (one_v, one_c, one_r) = (taken[i] * v, taken[i] * covered[i], taken[i] * r);
                steep += square;
                of_edge[i] = slope;
                terms[0][i] = slope * slope;
                let geometric = slope * contrast;
                terms[1][i] = geometric * by_x[i];
                terms[2][i] = geometric * by_y[i];
                for (term, by) in terms[3..6].iter_mut().zip(&by_shape) {
                    term[i] = geometric * by[i];
                }
                terms[6][i] = slope * v;
                terms[7][i] = slope;
                terms[8][i] = slope * covered[i];
                terms[RESIDUAL][i] = slope * r;
                all[0][i] += one_v * v;
                all[1][i] += one_v;
                all[2][i] += one_v * covered[i];
                all[3][i] += taken[i];
                all[4][i] += one_c;
                all[5][i] += one_c * covered[i];
                all[6][i] += one_v * r;
                all[7][i] += one_r;
                all[8][i] += one_c * r;
                all[9][i] += one_r * r;
            }
            slopes[at..][..LANES].copy_from_slice(&of_edge);
            if steep > 0.0 {
                for (i, sector) in sector[at..][..LANES].iter().enumerate() {
                    let sums = &mut sums[usize::from(*sector)];
                    for (sum, term) in sums.iter_mut().zip(&terms) {
                        *sum += term[i];
                    }
                }
            }
        }
    }
    let [vv, v1, vc, n11, c1, cc, vr, r1, cr, omega] = all.map(|lanes| lanes.iter().sum::<f64>());
    Common { n: Matrix3::new(vv, v1, vc, v1, n11, c1, vc, c1, cc), b: Vector3::new(vr, r1, cr), omega }
}

#[inline(always)]
fn shift<T: Real>(window: &mut Window<T>, disc: &Disc) -> (Vector3<f64>, f64) {
    let Window { side, grey, taken, sector, slope, sums, planes, .. } = window;
    let mut all = [[0.0; LANES]; 4];
    for row in 0..*side {
        for from in (0..*side).step_by(LANES) {
            let at = row * planes.stride + from;
            let (covered, by_variance) = (double(planes, blurred_ellipse::COVERED, at), double(planes, blurred_ellipse::VARIANCE, at));
            let (taken, grey, slope) = (lanes::<_, LANES>(taken, at), lanes::<_, LANES>(grey, at), lanes::<_, LANES>(slope, at));
            let (mut of_edge, mut steep) = ([0.0; LANES], 0.0);
            for i in 0..LANES {
                let r = taken[i] * (grey[i] - disc.ground - disc.contrast * covered[i]);
                of_edge[i] = slope[i] * r;
                steep += slope[i];
                all[0][i] += r * disc.contrast * by_variance[i];
                all[1][i] += r;
                all[2][i] += r * covered[i];
                all[3][i] += r * r;
            }
            if steep > 0.0 {
                for (of_edge, sector) in of_edge.iter().zip(&sector[at..]) {
                    sums[usize::from(*sector)][RESIDUAL] += of_edge;
                }
            }
        }
    }
    let [vr, r1, cr, omega] = all.map(|lanes| lanes.iter().sum::<f64>());
    (Vector3::new(vr, r1, cr), omega)
}
