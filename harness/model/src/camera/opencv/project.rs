//! Many object points to pixels at once, with or without derivatives.

use super::jacobian::{CameraFromWorld, Jacobian, LANES};
use super::lens::{Five, Lens, Twelve};
use super::{OpenCv, region, tilt};
use crate::PixelPoint;
use crate::camera::{CameraModel, Ray};

const CHUNK: usize = 64;
/// Columns of the pose, and of focal lengths and principal point.
const POSE: usize = 6;
const MATRIX: usize = 4;

/// What the loops need of a camera.
#[derive(Clone, Copy)]
struct Job<L> {
    lens: L,
    pose: CameraFromWorld,
    focal: [f64; 2],
    centre: [f64; 2],
    /// The tilt, and its derivatives by both angles.
    tilt: Option<[[[f64; 3]; 3]; 3]>,
    /// Square of the ideal radius within which the camera is one to one.
    safe: f64,
}

impl OpenCv {
    /// Pixels of object points (X, Y, Z, in the unit of the pose's translation): [`CameraModel::project`] for many points, vectorised.
    ///
    /// A point without an image gives not-a-numbers; [`CameraModel::project`] says why. Any machine gives the same bits.
    ///
    /// # Panics
    /// If `pixels` is not as long as `points`.
    pub fn project_all(&self, pose: &CameraFromWorld, points: &[[f64; 3]], pixels: &mut [PixelPoint]) {
        self.prepared().project_all(pose, points, pixels);
    }

    /// [`Self::project_all`] with derivatives by the pose and by the parameters.
    ///
    /// # Panics
    /// If `pixels` is not as long as `points`.
    pub fn project_all_with_derivatives(
        &self,
        pose: &CameraFromWorld,
        points: &[[f64; 3]],
        pixels: &mut [PixelPoint],
        jacobian: &mut Jacobian,
    ) {
        assert_eq!(points.len(), pixels.len(), "a pixel for every point");
        self.prepared().project_all_with_derivatives(pose, points, pixels, jacobian);
    }

    /// The camera with what many calls for few points each would look for again: where it is surely one to one.
    pub fn prepared(&self) -> Prepared {
        Prepared { camera: *self, safe: region::of(self).safe }
    }

    fn has_five(&self) -> bool {
        self.distortion[5..12].iter().all(|&more| more == 0.0)
    }
}

/// A camera that is ready to picture many sets of points: [`OpenCv::prepared`].
#[derive(Clone, Copy, Debug)]
pub struct Prepared {
    camera: OpenCv,
    safe: f64,
}

impl Prepared {
    /// As [`OpenCv::project_all`].
    ///
    /// # Panics
    /// If `pixels` is not as long as `points`.
    pub fn project_all(&self, pose: &CameraFromWorld, points: &[[f64; 3]], pixels: &mut [PixelPoint]) {
        assert_eq!(points.len(), pixels.len(), "a pixel for every point");
        let (camera, safe) = (&self.camera, self.safe);
        if camera.has_five() {
            pixels_five(&job(camera, pose, safe), camera, points, pixels);
        } else {
            pixels_twelve(&job(camera, pose, safe), camera, points, pixels);
        }
    }

    /// As [`OpenCv::project_all_with_derivatives`].
    ///
    /// # Panics
    /// If `pixels` is not as long as `points`.
    pub fn project_all_with_derivatives(
        &self,
        pose: &CameraFromWorld,
        points: &[[f64; 3]],
        pixels: &mut [PixelPoint],
        jacobian: &mut Jacobian,
    ) {
        assert_eq!(points.len(), pixels.len(), "a pixel for every point");
        let (camera, safe) = (&self.camera, self.safe);
        let values = jacobian.fit(points.len(), POSE + MATRIX + camera.coefficients.min(14));
        match camera.coefficients {
            0 if camera.has_five() => slopes_0(&job(camera, pose, safe), camera, points, pixels, values),
            4 if camera.has_five() => slopes_4(&job(camera, pose, safe), camera, points, pixels, values),
            5 if camera.has_five() => slopes_5(&job(camera, pose, safe), camera, points, pixels, values),
            8 => slopes_8(&job(camera, pose, safe), camera, points, pixels, values),
            12 => slopes_12(&job(camera, pose, safe), camera, points, pixels, values),
            _ => slopes_14(&job(camera, pose, safe), camera, points, pixels, values),
        }
    }
}

fn job<L: Lens>(camera: &OpenCv, pose: &CameraFromWorld, safe: f64) -> Job<L> {
    // Without an angle, its derivatives are wanted all the same.
    let tilt =
        (camera.is_tilted() || camera.coefficients == 14).then(|| tilt::Tilt::new(camera.distortion[12], camera.distortion[13]).all_rows());
    let (focal, centre) = ([camera.fx, camera.fy], [camera.cx, camera.cy]);
    Job { lens: L::of(camera), pose: *pose, focal, centre, tilt, safe: safe * safe }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn pixels_five(job: &Job<Five>, camera: &OpenCv, points: &[[f64; 3]], pixels: &mut [PixelPoint]) {
    all_pixels(job, camera, points, pixels);
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn pixels_twelve(job: &Job<Twelve>, camera: &OpenCv, points: &[[f64; 3]], pixels: &mut [PixelPoint]) {
    all_pixels(job, camera, points, pixels);
}

macro_rules! slopes {
    ($($name:ident: $lens:ty, $coefficients:expr;)*) => {
        // AVX2 first: compiled for AVX-512 the derivatives were measured at half the speed, the plain projection at 1.4 times.
        $(#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx2", "x86_64+avx512f+avx512vl")))]
        fn $name(job: &Job<$lens>, camera: &OpenCv, points: &[[f64; 3]], pixels: &mut [PixelPoint], values: &mut [f64]) {
            all_slopes::<$lens, $coefficients, { 2 * (POSE + MATRIX + $coefficients) }>(job, camera, points, pixels, values);
        })*
    };
}

slopes! {
    slopes_0: Five, 0;
    slopes_4: Five, 4;
    slopes_5: Five, 5;
    slopes_8: Twelve, 8;
    slopes_12: Twelve, 12;
    slopes_14: Twelve, 14;
}

/// A point before the camera: N, ideal tangents (x right, y down), 1 / -Nz, and whether it is on the branch.
struct Seen {
    n: [f64; 3],
    ideal: [f64; 2],
    w: f64,
    good: bool,
}

#[inline(always)]
fn see<L>(job: &Job<L>, [x, y, z]: [f64; 3]) -> Seen {
    let (m, t) = (&job.pose.rotation, &job.pose.translation);
    let n: [f64; 3] = std::array::from_fn(|i| m[i][0] * x + m[i][1] * y + m[i][2] * z + t[i]);
    let w = -1.0 / n[2];
    let ideal = [n[0] * w, -n[1] * w];
    let mut good = ideal[0] * ideal[0] + ideal[1] * ideal[1] <= job.safe;
    // Not `&&`: a branch would stand in the way of lanes.
    good &= n[2] < 0.0;
    Seen { n, ideal, w, good }
}

#[inline(always)]
fn all_pixels<L: Lens>(job: &Job<L>, camera: &OpenCv, points: &[[f64; 3]], pixels: &mut [PixelPoint]) {
    for (points, pixels) in points.chunks(CHUNK).zip(pixels.chunks_mut(CHUNK)) {
        let mut open = 0_u64;
        for (point, pixel) in points.iter().zip(pixels.iter_mut()) {
            let seen = see(job, *point);
            let [x, y] = seen.ideal;
            let q = job.lens.factor(x * x + y * y);
            let [rx, ry] = job.lens.rest(seen.ideal);
            let (dx, dy) = (x * q + rx, y * q + ry);
            *pixel = PixelPoint::new(job.focal[0] * dx + job.centre[0], job.focal[1] * dy + job.centre[1]);
            open += u64::from(!seen.good);
        }
        if let Some([rows, ..]) = &job.tilt {
            for pixel in pixels.iter_mut() {
                let flat = [(pixel.x - job.centre[0]) / job.focal[0], (pixel.y - job.centre[1]) / job.focal[1]];
                let [u, v, w] = times(rows, flat);
                *pixel = PixelPoint::new(job.focal[0] * (u / w) + job.centre[0], job.focal[1] * (v / w) + job.centre[1]);
            }
        }
        if open > 0 {
            pixels_one_by_one(job, camera, points, pixels);
        }
    }
}

fn ray<L>(job: &Job<L>, point: [f64; 3]) -> Ray {
    let [x, y, z] = see(job, point).n;
    Ray { x, y, z }
}

#[inline(never)]
fn pixels_one_by_one<L>(job: &Job<L>, camera: &OpenCv, points: &[[f64; 3]], pixels: &mut [PixelPoint]) {
    for (point, pixel) in points.iter().zip(pixels) {
        if !see(job, *point).good {
            *pixel = camera.project(ray(job, *point)).unwrap_or(PixelPoint::new(f64::NAN, f64::NAN));
        }
    }
}

#[inline(always)]
fn times(rows: &[[f64; 3]; 3], [x, y]: [f64; 2]) -> [f64; 3] {
    rows.map(|[a, b, c]| a * x + b * y + c)
}

#[inline(always)]
fn all_slopes<L: Lens, const COEFFICIENTS: usize, const ROWS: usize>(
    job: &Job<L>,
    camera: &OpenCv,
    points: &[[f64; 3]],
    pixels: &mut [PixelPoint],
    values: &mut [f64],
) {
    let (blocks, _) = values.as_chunks_mut::<LANES>();
    let (blocks, _) = blocks.as_chunks_mut::<ROWS>();
    for ((points, pixels), block) in points.chunks(LANES).zip(pixels.chunks_mut(LANES)).zip(blocks) {
        // The last block is filled up with its last point.
        let full: [[f64; 3]; LANES] = std::array::from_fn(|i| points[i.min(points.len() - 1)]);
        let (mut found, mut open) = ([[0.0; 2]; LANES], 0_u64);
        for lane in 0..LANES {
            let seen = see(job, full[lane]);
            open += u64::from(!seen.good);
            found[lane] = slopes::<L, COEFFICIENTS, ROWS>(job, &seen, block, lane);
        }
        for (pixel, [x, y]) in pixels.iter_mut().zip(found) {
            *pixel = PixelPoint::new(x, y);
        }
        if open > 0 {
            slopes_one_by_one(job, camera, &full, pixels, block.as_flattened_mut());
        }
    }
}

/// One point's pixel; its derivatives go to `lane` of the block.
#[inline(always)]
fn slopes<L: Lens, const COEFFICIENTS: usize, const ROWS: usize>(
    job: &Job<L>,
    seen: &Seen,
    block: &mut [[f64; LANES]; ROWS],
    lane: usize,
) -> [f64; 2] {
    let [fx, fy] = job.focal;
    let mut put = |column: usize, [x, y]: [f64; 2]| (block[2 * column][lane], block[2 * column + 1][lane]) = (x, y);
    let lens = job.lens.slope(seen.ideal);
    let (distorted, tilt) = match &job.tilt {
        None => (lens.value, [[fx, 0.0], [0.0, fy]]),
        Some(rows) => {
            let [u, v, w] = times(&rows[0], lens.value);
            let (i, x, y) = (1.0 / w, u / w, v / w);
            let of = |row: usize, value: f64, f: f64| [0, 1].map(|k| f * (rows[0][row][k] - value * rows[0][2][k]) * i);
            for (column, by) in [(POSE + MATRIX + 12, &rows[1]), (POSE + MATRIX + 13, &rows[2])] {
                if COEFFICIENTS == 14 {
                    let [du, dv, dw] = times(by, lens.value);
                    put(column, [fx * (du - x * dw) * i, fy * (dv - y * dw) * i]);
                }
            }
            ([x, y], [of(0, x, fx), of(1, y, fy)])
        }
    };
    let through = |[x, y]: [f64; 2]| [tilt[0][0] * x + tilt[0][1] * y, tilt[1][0] * x + tilt[1][1] * y];
    let by_x = through([lens.by[0][0], lens.by[1][0]]);
    let by_y = through([lens.by[0][1], lens.by[1][1]]);
    // d(ideal)/dN: x = -Nx / Nz, y = Ny / Nz.
    let ([nx, ny, nz], [u, v], w) = (seen.n, seen.ideal, seen.w);
    let dx = [by_x[0] * w, by_x[1] * w];
    let dy = [-by_y[0] * w, -by_y[1] * w];
    let dz = [(by_x[0] * u + by_y[0] * v) * w, (by_x[1] * u + by_y[1] * v) * w];
    put(0, [ny * dz[0] - nz * dy[0], ny * dz[1] - nz * dy[1]]);
    put(1, [nz * dx[0] - nx * dz[0], nz * dx[1] - nx * dz[1]]);
    put(2, [nx * dy[0] - ny * dx[0], nx * dy[1] - ny * dx[1]]);
    put(3, dx);
    put(4, dy);
    put(5, dz);
    put(6, [distorted[0], 0.0]);
    put(7, [0.0, distorted[1]]);
    put(8, [1.0, 0.0]);
    put(9, [0.0, 1.0]);
    let coefficients = job.lens.by_coefficients(seen.ideal);
    for (i, by) in coefficients.into_iter().enumerate().take(COEFFICIENTS) {
        put(POSE + MATRIX + i, through(by));
    }
    [fx * distorted[0] + job.centre[0], fy * distorted[1] + job.centre[1]]
}

#[inline(never)]
fn slopes_one_by_one<L>(job: &Job<L>, camera: &OpenCv, full: &[[f64; 3]; LANES], pixels: &mut [PixelPoint], block: &mut [f64]) {
    let columns = block.len() / (2 * LANES);
    for (lane, point) in full.iter().enumerate().filter(|(_, point)| !see(job, **point).good) {
        let ray = ray(job, *point);
        let found = camera.derivatives(ray);
        let mut put = |column: usize, [x, y]: [f64; 2]| (block[2 * column * LANES + lane], block[(2 * column + 1) * LANES + lane]) = (x, y);
        let pixel = found.as_ref().map_or(PixelPoint::new(f64::NAN, f64::NAN), |found| found.point);
        if let Some(place) = pixels.get_mut(lane) {
            *place = pixel;
        }
        let Ok(found) = found else {
            (0..columns).for_each(|column| put(column, [f64::NAN; 2]));
            continue;
        };
        let [dx, dy, dz] = [0, 1, 2].map(|axis| [found.by_ray[0][axis], found.by_ray[1][axis]]);
        let cross = |a: f64, p: [f64; 2], b: f64, q: [f64; 2]| [a * p[0] - b * q[0], a * p[1] - b * q[1]];
        let pose = [cross(ray.y, dz, ray.z, dy), cross(ray.z, dx, ray.x, dz), cross(ray.x, dy, ray.y, dx), dx, dy, dz];
        for (column, by) in pose.into_iter().chain(found.by_parameters).enumerate() {
            put(column, by);
        }
    }
}
