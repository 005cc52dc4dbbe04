//! The same view as it is made with OpenCV: a texture four times as fine, looked up through a map for each pixel, blurred, spoiled.

use calibench_model::PixelPoint;
use calibench_model::camera::CameraModel;
use opencv::core::{BORDER_REPLICATE, Mat, Scalar, Size};
use opencv::prelude::*;
use opencv::{core, imgproc};

use crate::{render, timed};

const WIDTH: i32 = 4272;
const HEIGHT: i32 = 2848;
/// Pixels of the texture per pixel of the image, along each side.
const FINER: f64 = 4.0;
/// Pixels of the image per mm of the board, about.
const SCALE: f64 = 14.0;

/// Times of the stages of one view, s.
struct Stages {
    maps: f64,
    remap: f64,
    reduce: f64,
    noise: f64,
}

pub(crate) fn run() {
    println!("\nThe same chessboard by warping a texture four times as fine (OpenCV), one thread:");
    let one_thread = core::set_num_threads(1).is_ok();
    match stages() {
        Ok(stages) => {
            let pixels = f64::from(WIDTH * HEIGHT) / 1e6;
            let named = [
                ("where each sample lies on the board", stages.maps),
                ("remap of the texture at 4 x 4 samples", stages.remap),
                ("blur and reduction to pixels", stages.reduce),
                ("noise and 8 bit", stages.noise),
            ];
            for (name, seconds) in named {
                println!("  {name:<42} {:>8.1} ms {:>9.1} Mpx/s", seconds * 1e3, pixels / seconds);
            }
            let all: f64 = named.iter().map(|(_, seconds)| seconds).sum();
            let kept = all - stages.maps;
            println!("  {:<42} {:>8.1} ms {:>9.1} Mpx/s", "together, with the maps kept", kept * 1e3, pixels / kept);
            println!("  {:<42} {:>8.1} ms {:>9.1} Mpx/s  (held to one thread: {one_thread})", "together", all * 1e3, pixels / all);
        }
        Err(error) => println!("  not available: {error}"),
    }
}

/// The board's texture: columns and rows along u and v from its lower left corner.
fn texture() -> opencv::Result<Mat> {
    let rate = SCALE * FINER;
    let (width, height) = ((280.0 * rate) as i32, (190.0 * rate) as i32);
    let mut texture = Mat::new_rows_cols_with_default(height, width, core::CV_8UC1, Scalar::all(204.0))?;
    for i in (0..70).filter(|i| (i % 10 + i / 10) % 2 == 0) {
        let place = |mm: f64| (mm * rate) as i32;
        let (u, v) = (f64::from(i % 10 - 5) * 25.0 + 140.0, f64::from(i / 10) * 25.0 - 87.5 + 95.0);
        let square = core::Rect::new(place(u), place(v), place(25.0), place(25.0));
        imgproc::rectangle(&mut texture, square, Scalar::all(26.0), imgproc::FILLED, imgproc::LINE_8, 0)?;
    }
    Ok(texture)
}

/// Where the samples of a band of rows lie in the texture.
fn maps(first: i32, rows: i32) -> opencv::Result<(Mat, Mat)> {
    let (camera, pose) = (render::camera(WIDTH as u32, HEIGHT as u32), render::pose());
    let (columns, samples) = (WIDTH * FINER as i32, rows * FINER as i32);
    let mut xs = Mat::new_rows_cols_with_default(samples, columns, core::CV_32FC1, Scalar::all(-1.0))?;
    let mut ys = xs.try_clone()?;
    // Unprojected at every fourth sample; between them the map is as good as linear.
    for row in 0..samples {
        let y = f64::from(first) + (f64::from(row) + 0.5) / FINER - 0.5;
        let place = |x: f64| {
            let ray = pose.world_from_ray(camera.unproject(PixelPoint::new(x, y)).ok()?);
            let along = -pose.centre.z / ray.z;
            Some([(pose.centre.x + along * ray.x + 140.0) * SCALE * FINER, (pose.centre.y + along * ray.y + 95.0) * SCALE * FINER])
        };
        let (line_x, line_y) = (xs.at_row_mut::<f32>(row)?, ys.at_row_mut::<f32>(row)?);
        for pixel in 0..WIDTH {
            let (from, to) = (place(f64::from(pixel) - 0.5), place(f64::from(pixel) + 0.5));
            let (Some(from), Some(to)) = (from, to) else { continue };
            for sample in 0..FINER as i32 {
                let t = (f64::from(sample) + 0.5) / FINER;
                let index = (pixel * FINER as i32 + sample) as usize;
                line_x[index] = (from[0] + t * (to[0] - from[0])) as f32;
                line_y[index] = (from[1] + t * (to[1] - from[1])) as f32;
            }
        }
    }
    Ok((xs, ys))
}

/// One view in bands of rows, so that the maps fit into memory.
fn stages() -> opencv::Result<Stages> {
    let texture = texture()?;
    let (mut stages, mut failed) = (Stages { maps: 0.0, remap: 0.0, reduce: 0.0, noise: 0.0 }, None);
    let band = 356;
    let mut run = |time: &mut f64, work: &mut dyn FnMut() -> opencv::Result<()>| {
        *time += timed(&mut || {
            if let Err(error) = work() {
                failed = Some(error);
            }
        });
    };
    for first in (0..HEIGHT).step_by(band as usize) {
        let (mut xs, mut ys, mut warped) = (Mat::default(), Mat::default(), Mat::default());
        run(&mut stages.maps, &mut || {
            (xs, ys) = maps(first, band)?;
            Ok(())
        });
        run(&mut stages.remap, &mut || {
            imgproc::remap(&texture, &mut warped, &xs, &ys, imgproc::INTER_LINEAR, core::BORDER_CONSTANT, Scalar::all(102.0))
        });
        let mut small = Mat::default();
        run(&mut stages.reduce, &mut || {
            let mut blurred = Mat::default();
            imgproc::gaussian_blur(&warped, &mut blurred, Size::new(0, 0), 0.7 * FINER, 0.7 * FINER, BORDER_REPLICATE)?;
            imgproc::resize(&blurred, &mut small, Size::new(WIDTH, band), 0.0, 0.0, imgproc::INTER_AREA)
        });
        run(&mut stages.noise, &mut || {
            let mut noise = Mat::new_rows_cols_with_default(band, WIDTH, core::CV_32FC1, Scalar::all(0.0))?;
            core::randn(&mut noise, &Scalar::all(0.0), &Scalar::all(2.0))?;
            let mut sum = Mat::default();
            core::add(&small, &noise, &mut sum, &core::no_array(), core::CV_8UC1)
        });
    }
    failed.map_or(Ok(stages), Err)
}
