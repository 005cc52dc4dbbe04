//! Points per second of our OpenCV camera beside OpenCV's own functions. `cargo bench --workspace --bench cameras`.
//!
//! Rounds are interleaved (A B A B ...), so that a machine that is slower for a while is so for both; medians are printed.

mod theirs;

use std::hint::black_box;
use std::time::Instant;

use calibench_images::st_map::{Direction, Overscan, StMap, Undistorted};
use calibench_model::PixelPoint;
use calibench_model::camera::opencv::{CameraFromWorld, Jacobian};
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};

use theirs::Theirs;

const POINTS: usize = 1_000_000;
const ROUNDS: usize = 7;
/// What an undistorted point may be off, px.
const ACCURACY: f64 = 1e-9;

fn main() -> opencv::Result<()> {
    // Cargo asks for a list or a test run in some of its commands.
    if std::env::args().any(|argument| argument == "--list" || argument == "--test") {
        return Ok(());
    }
    opencv::core::set_num_threads(1)?;
    println!(
        "{POINTS} points, five coefficients, one thread, medians of {ROUNDS} interleaved rounds, OpenCV {}",
        calibench_opencv::version()
    );
    println!("{:<28} {:>14} {:>14} {:>8} {:>8}   largest deviation, px: ours, OpenCV's", "", "ours", "OpenCV", "ratio", "wanted");
    let camera = camera();
    let (pose, objects) = scene(&camera);
    undistortion(&camera)?;
    projection(&camera, &pose, &objects)?;
    derivatives(&camera, &pose, &objects)?;
    made_ready(&camera);
    maps(&camera)
}

/// Microseconds to learn where a camera is one to one, once for all points of an adjustment's step; OpenCV does not ask.
fn made_ready(camera: &OpenCv) {
    let with = |coefficients: usize, changed: &[(usize, f64)]| {
        let mut camera = OpenCv { coefficients, ..*camera };
        changed.iter().for_each(|&(place, value)| camera.distortion[place] = value);
        camera
    };
    // k1; k1; k1 and the denominator; s1 to s4; then the tilt, under which places are searched.
    let folding = (0, -0.6);
    let rational = [folding, (5, 0.2), (6, -0.1), (7, 0.03)];
    let prism = [folding, (8, 1e-3), (9, -4e-4), (10, -8e-4), (11, 3e-4)];
    for (name, camera) in [
        ("does not fold", *camera),
        ("folds inside the frame", with(5, &[folding])),
        ("rational, folds too", with(8, &rational)),
        ("thin prism, folds too", with(12, &prism)),
        ("tilted, folds too", with(14, &[folding, (12, 0.02), (13, -0.03)])),
    ] {
        let mut seconds = Vec::new();
        for _ in 0..ROUNDS {
            let clock = Instant::now();
            for _ in 0..200 {
                black_box(black_box(&camera).prepared());
            }
            seconds.push(clock.elapsed().as_secs_f64() / 200.0);
        }
        seconds.sort_by(f64::total_cmp);
        println!("ready, {name:<28} {:>11.1} us", 1e6 * seconds[ROUNDS / 2]);
    }
}

fn camera() -> OpenCv {
    let mut distortion = [0.0; 14];
    distortion[..5].copy_from_slice(&[-0.12, 0.09, 8e-4, -1.7e-3, -0.02]);
    let size = ImageSize { width: 4000, height: 3000 };
    OpenCv { size, fx: 3100.0, fy: 3110.0, cx: 2010.3, cy: 1490.8, distortion, coefficients: 5 }
}

fn places(camera: &OpenCv) -> Vec<PixelPoint> {
    let along = |i: usize, step: f64, length: u32| (i as f64 * step).fract() * f64::from(length - 1);
    (0..POINTS).map(|i| PixelPoint::new(along(i, 0.754_877_666, camera.size.width), along(i, 0.569_840_291, camera.size.height))).collect()
}

/// Object points that fill the frame of a turned and shifted camera.
fn scene(camera: &OpenCv) -> (CameraFromWorld, Vec<[f64; 3]>) {
    let (sin, cos) = 0.3_f64.sin_cos();
    let pose = CameraFromWorld { rotation: [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]], translation: [0.1, -0.2, -5.0] };
    let places = places(camera);
    let mut tangents = vec![[0.0; 2]; places.len()];
    camera.undistort_all(&places, &mut tangents);
    let object = |(i, [x, y]): (usize, [f64; 2])| {
        let depth = 4.5 + (i as f64 * 0.618_033_988_7).fract();
        let n = [x * depth - 0.1, -y * depth + 0.2, -depth + 5.0];
        [cos * n[0] - sin * n[1], sin * n[0] + cos * n[1], n[2]]
    };
    (pose, tangents.into_iter().enumerate().map(object).collect())
}

/// Points per second of both: medians of interleaved rounds, after one that warms up.
fn race(mut ours: impl FnMut(), mut theirs: impl FnMut() -> opencv::Result<()>) -> opencv::Result<[f64; 2]> {
    let mut times = [Vec::new(), Vec::new()];
    for round in 0..=ROUNDS {
        let clock = Instant::now();
        ours();
        let first = clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        theirs()?;
        if round > 0 {
            times[0].push(first);
            times[1].push(clock.elapsed().as_secs_f64());
        }
    }
    Ok(times.map(|mut seconds| {
        seconds.sort_by(f64::total_cmp);
        POINTS as f64 / seconds[seconds.len() / 2]
    }))
}

fn print(name: &str, [ours, theirs]: [f64; 2], wanted: Option<f64>, deviations: &str) {
    let wanted = wanted.map_or(String::new(), |wanted| format!("{wanted:.1}"));
    let (million, ratio) = (1e-6, ours / theirs);
    println!("{name:<28} {:>11.1} M/s {:>11.1} M/s {ratio:>8.1} {wanted:>8}   {deviations}", ours * million, theirs * million);
}

/// The largest distance between the images of `tangents` and `places`, px.
fn residual(camera: &OpenCv, places: &[PixelPoint], tangents: impl Iterator<Item = [f64; 2]>) -> f64 {
    let off = |(place, [x, y]): (&PixelPoint, [f64; 2])| {
        let pixel = camera.project(calibench_model::camera::Ray::from_tangent(x, -y));
        pixel.map_or(f64::INFINITY, |pixel| pixel.distance(*place))
    };
    places.iter().zip(tangents).map(off).fold(0.0, f64::max)
}

fn undistortion(camera: &OpenCv) -> opencv::Result<()> {
    let places = places(camera);
    let mut ours = vec![[0.0; 2]; places.len()];
    let mut theirs = Theirs::new(camera, &CameraFromWorld::IDENTITY, &[])?.with_places(&places);
    camera.undistort_all(&places, &mut ours);
    let own = residual(camera, &places, ours.iter().copied());
    theirs.undistort_to(ACCURACY)?;
    let reached = residual(camera, &places, theirs.tangents());
    let rates = race(|| camera.undistort_all(black_box(&places), &mut ours), || theirs.undistort_to(ACCURACY))?;
    print("undistortion to 1e-9 px", rates, Some(20.0), &format!("{own:.1e}, {reached:.1e}"));
    // The fewest iterations with which OpenCV is as good: what nobody knows beforehand.
    for iterations in [5, fewest(camera, &places, &mut theirs)?] {
        theirs.undistort(iterations)?;
        let reached = residual(camera, &places, theirs.tangents());
        let rates = race(|| camera.undistort_all(black_box(&places), &mut ours), || theirs.undistort(iterations))?;
        print(&format!("  OpenCV's with {iterations} iterations"), rates, None, &format!("{own:.1e}, {reached:.1e}"));
    }
    Ok(())
}

fn fewest(camera: &OpenCv, places: &[PixelPoint], theirs: &mut Theirs) -> opencv::Result<i32> {
    for iterations in 5..200 {
        theirs.undistort(iterations)?;
        if residual(camera, places, theirs.tangents()) <= ACCURACY {
            return Ok(iterations);
        }
    }
    Ok(200)
}

fn projection(camera: &OpenCv, pose: &CameraFromWorld, objects: &[[f64; 3]]) -> opencv::Result<()> {
    let mut ours = vec![PixelPoint::default(); objects.len()];
    let mut theirs = Theirs::new(camera, pose, objects)?;
    let rates = race(|| camera.project_all(pose, black_box(objects), &mut ours), || theirs.project())?;
    let off = ours.iter().zip(theirs.pixels()).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
    print("projection", rates, Some(3.0), &format!("{off:.1e} apart"));
    Ok(())
}

fn derivatives(camera: &OpenCv, pose: &CameraFromWorld, objects: &[[f64; 3]]) -> opencv::Result<()> {
    let (mut ours, mut jacobian) = (vec![PixelPoint::default(); objects.len()], Jacobian::default());
    let mut theirs = Theirs::new(camera, pose, objects)?;
    let rates = race(
        || camera.project_all_with_derivatives(pose, black_box(objects), &mut ours, &mut jacobian),
        || theirs.project_with_derivatives(),
    )?;
    // By fx to k3: the columns that mean the same.
    let mut off = 0.0_f64;
    for point in (0..objects.len()).step_by(997) {
        for column in 6..15 {
            let (a, b) = (jacobian.at(point, column), theirs.derivative(point, column)?);
            off = off.max((a[0] - b[0]).hypot(a[1] - b[1]) / (1.0 + a[0].hypot(a[1])));
        }
    }
    print("projection, derivatives", rates, Some(5.0), &format!("{off:.1e} apart, relative; {} columns each", jacobian.columns()));
    Ok(())
}

/// Pixels per second of ST-maps, 12 megapixels; of OpenCV's functions one gives the map that undistorts, none the other.
fn maps(camera: &OpenCv) -> opencv::Result<()> {
    let (any, pixels) = (Camera::from(*camera), f64::from(camera.size.width) * f64::from(camera.size.height));
    let Ok(picture) = Undistorted::of(&any, Overscan::Percent(0.0)) else { return Ok(()) };
    let mut theirs = Theirs::new(camera, &CameraFromWorld::IDENTITY, &[])?;
    let median = |work: &mut dyn FnMut() -> opencv::Result<()>| -> opencv::Result<f64> {
        let mut seconds = Vec::new();
        for _ in 0..ROUNDS {
            let clock = Instant::now();
            work()?;
            seconds.push(clock.elapsed().as_secs_f64());
        }
        seconds.sort_by(f64::total_cmp);
        Ok(1e-6 * pixels / seconds[seconds.len() / 2])
    };
    let opencv_s = median(&mut || theirs.map(camera.size))?;
    for (threads, name) in [(1, "one thread"), (0, "all")] {
        let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() else { continue };
        let rate = |direction| {
            median(&mut || {
                black_box(pool.install(|| StMap::new(&any, &picture, direction, false)));
                Ok(())
            })
        };
        let (undistort, redistort) = (rate(Direction::Undistort)?, rate(Direction::Redistort)?);
        println!(
            "ST-map, {name:<20} {undistort:>11.1} M/s {opencv_s:>11.1} M/s {:>8.1}            to redistort {redistort:.1} M/s",
            undistort / opencv_s
        );
    }
    Ok(())
}
