//! Many pixels to ideal tangents at once.

use nalgebra::{SMatrix, SVector};

use super::jacobian::LANES;
use super::lens::{Five, Lens, Twelve};
use super::region::{self, Region};
use super::{OpenCv, tilt};
use crate::PixelPoint;
use crate::camera::{CameraModel, Ray};

/// Coefficients of the first guess.
const GUESS: usize = 6;
/// Product of the last two steps, px: the error left is a small multiple of it.
const CLOSED: f64 = 1e-11;

/// What the loop needs of a camera.
#[derive(Clone, Copy)]
struct Job<L> {
    lens: L,
    /// Pixel to distorted tangents: offset and scale.
    centre: [f64; 2],
    scale: [f64; 2],
    focal: f64,
    /// Undoes the tilt.
    untilt: Option<[[f64; 3]; 3]>,
    /// ideal = distorted * polynomial of distorted radius^2, without what is not radial.
    guess: [f64; GUESS],
    /// Square of the ideal radius within which the camera is one to one.
    safe: f64,
}

impl OpenCv {
    /// Ideal tangents (x right, **y down**) of pixels, to 1e-9 px: [`CameraModel::unproject`] for many points, vectorised.
    ///
    /// A pixel without a ray gives not-a-numbers; [`CameraModel::unproject`] says why. Any machine gives the same bits.
    ///
    /// # Panics
    /// If `tangents` is not as long as `points`.
    pub fn undistort_all(&self, points: &[PixelPoint], tangents: &mut [[f64; 2]]) {
        assert_eq!(points.len(), tangents.len(), "a tangent for every point");
        let region = region::of(self);
        if self.distortion[5..12].iter().all(|&more| more == 0.0) {
            five(&job(self, region), self, points, tangents);
        } else {
            twelve(&job(self, region), self, points, tangents);
        }
    }
}

fn job<L: Lens>(camera: &OpenCv, region: Region) -> Job<L> {
    let lens = L::of(camera);
    let untilt = camera.is_tilted().then(|| tilt::Tilt::new(camera.distortion[12], camera.distortion[13]).inverse_rows());
    Job {
        lens,
        centre: [camera.cx, camera.cy],
        scale: [1.0 / camera.fx, 1.0 / camera.fy],
        focal: camera.fx.abs().max(camera.fy.abs()),
        untilt,
        guess: guess(&lens, region.widest),
        safe: region.safe * region.safe,
    }
}

/// The polynomial that undoes the radial factor at nodes up to the ideal radius `widest`; zeros where there is none, and then no guess is any good.
fn guess<L: Lens>(lens: &L, widest: f64) -> [f64; GUESS] {
    let outer = widest * lens.factor(widest * widest);
    let node = |i: usize| 0.5 - 0.5 * (std::f64::consts::PI * (i as f64 + 0.5) / GUESS as f64).cos();
    let samples: [(f64, f64); GUESS] = std::array::from_fn(|i| {
        let ideal = widest * node(i).sqrt();
        let factor = lens.factor(ideal * ideal);
        ((ideal * factor / outer).powi(2), 1.0 / factor)
    });
    let powers = SMatrix::<f64, GUESS, GUESS>::from_fn(|row, column| samples[row].0.powi(column as i32));
    let values = SVector::<f64, GUESS>::from_fn(|row, _| samples[row].1);
    let of_relative: [f64; GUESS] = powers.lu().solve(&values).map_or([0.0; GUESS], Into::into);
    std::array::from_fn(|i| of_relative[i] / outer.powi(2 * i as i32))
}

// The first target that the machine has is taken: the widest comes first.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn five(job: &Job<Five>, camera: &OpenCv, points: &[PixelPoint], tangents: &mut [[f64; 2]]) {
    all(job, camera, points, tangents);
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn twelve(job: &Job<Twelve>, camera: &OpenCv, points: &[PixelPoint], tangents: &mut [[f64; 2]]) {
    all(job, camera, points, tangents);
}

#[inline(always)]
fn all<L: Lens>(job: &Job<L>, camera: &OpenCv, points: &[PixelPoint], tangents: &mut [[f64; 2]]) {
    let (blocks, last_points) = points.as_chunks::<LANES>();
    let (places, last_tangents) = tangents.as_chunks_mut::<LANES>();
    for (points, tangents) in blocks.iter().zip(places) {
        block(job, camera, points, tangents);
    }
    if let Some(last) = last_points.last() {
        let full: [PixelPoint; LANES] = std::array::from_fn(|i| *last_points.get(i).unwrap_or(last));
        let mut found = [[0.0; 2]; LANES];
        block(job, camera, &full, &mut found);
        last_tangents.copy_from_slice(&found[..last_points.len()]);
    }
}

#[inline(always)]
fn block<L: Lens>(job: &Job<L>, camera: &OpenCv, points: &[PixelPoint; LANES], tangents: &mut [[f64; 2]; LANES]) {
    let mut left = [0.0; LANES];
    if let Some(rows) = &job.untilt {
        for lane in 0..LANES {
            (tangents[lane], left[lane]) = solve(job, project(rows, distorted(job, &points[lane])));
        }
    } else {
        for lane in 0..LANES {
            (tangents[lane], left[lane]) = solve(job, distorted(job, &points[lane]));
        }
    }
    let mut closed = true;
    for left in left {
        closed &= left <= CLOSED;
    }
    if !closed {
        one_by_one(camera, points, tangents, &left);
    }
}

#[inline(always)]
fn distorted<L>(job: &Job<L>, point: &PixelPoint) -> [f64; 2] {
    [(point.x - job.centre[0]) * job.scale[0], (point.y - job.centre[1]) * job.scale[1]]
}

#[inline(always)]
fn project(rows: &[[f64; 3]; 3], [x, y]: [f64; 2]) -> [f64; 2] {
    let [u, v, w] = rows.map(|[a, b, c]| a * x + b * y + c);
    [u / w, v / w]
}

/// Ideal tangents of distorted ones, and about how far they may be off, px; infinite where the camera may fold. Newton's step, then a second one with
/// the same derivatives: after a good guess the error left is the product of both.
#[inline(always)]
fn solve<L: Lens>(job: &Job<L>, goal @ [gx, gy]: [f64; 2]) -> ([f64; 2], f64) {
    let [rx, ry] = job.lens.rest(radial(job, goal));
    let guess @ [x, y] = radial(job, [gx - rx, gy - ry]);
    let s = job.lens.slope(guess);
    let inverse = 1.0 / (s.by[0][0] * s.by[1][1] - s.by[0][1] * s.by[1][0]);
    let step = |value: [f64; 2]| {
        let (ex, ey) = (gx - value[0], gy - value[1]);
        [(s.by[1][1] * ex - s.by[0][1] * ey) * inverse, (s.by[0][0] * ey - s.by[1][0] * ex) * inverse]
    };
    let [dx, dy] = step(s.value);
    let (x, y) = (x + dx, y + dy);
    let [ex, ey] = step(job.lens.value([x, y]));
    let (x, y) = (x + ex, y + ey);
    let left = (dx.abs() + dy.abs()) * (ex.abs() + ey.abs()) * job.focal;
    ([x, y], if x * x + y * y <= job.safe { left } else { f64::INFINITY })
}

#[inline(always)]
fn radial<L>(job: &Job<L>, [x, y]: [f64; 2]) -> [f64; 2] {
    let t = x * x + y * y;
    let [a, b, c, d, e, f] = job.guess;
    let t2 = t * t;
    let t4 = t2 * t2;
    let factor = (a + b * t + (c + d * t) * t2) + (e + f * t) * t4;
    [x * factor, y * factor]
}

/// The points of a chunk that the loop could not settle.
#[inline(never)]
fn one_by_one(camera: &OpenCv, points: &[PixelPoint], tangents: &mut [[f64; 2]], left: &[f64]) {
    for ((point, tangent), left) in points.iter().zip(tangents).zip(left) {
        // Not a number is not settled either.
        let settled = *left <= CLOSED;
        if !settled {
            *tangent = camera.unproject(*point).ok().and_then(Ray::tangent).map_or([f64::NAN; 2], |(x, y)| [x, -y]);
        }
    }
}
