//! Milliseconds of the processor to make an undistorted picture of 12 megapixels on one thread, by kernel, channels and depth: the figures that `benches/remap.py` compares.

use std::time::Instant;
use std::{fs, io};

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, ImageSize, OpenCv};
use calibench_undistort::{Frame, Kernel, Level, Map, Picture, Target, View, framed, resample};

const SIZE: ImageSize = ImageSize { width: 4000, height: 3000 };
const AGAIN: usize = 3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let mut distortion = [0.0; 14];
    distortion[..4].copy_from_slice(&[-0.2, 0.08, 0.0005, -0.0003]);
    let camera: Camera = OpenCv { size: SIZE, fx: 3000.0, fy: 3000.0, cx: 1990.0, cy: 1510.0, distortion, coefficients: 5 }.into();
    let to = framed(&View::Camera(camera), Target::Pinhole, Frame::Keep, 1.0)?;
    let begin = seconds();
    let map = Map::between(&View::Camera(camera), &to);
    println!("map,,,{:.1}", (seconds() - begin) * 1e3);
    assert!(map.place(100, 100).is_none_or(|at| at.distance(PixelPoint::new(100.0, 100.0)) < 500.0));
    for channels in [1, 3] {
        let levels = |i: usize| (i as u32).wrapping_mul(2_654_435_761) >> 8;
        let count = 12_000_000 * channels;
        timed::<u8>(&map, channels, &(0..count).map(|i| levels(i) as u8).collect::<Vec<u8>>(), 8)?;
        timed::<u16>(&map, channels, &(0..count).map(|i| levels(i) as u16).collect::<Vec<u16>>(), 16)?;
    }
    Ok(())
}

fn timed<T: Level>(map: &Map, channels: usize, samples: &[T], bits: u32) -> Result<(), Box<dyn std::error::Error>> {
    let picture = Picture::new(SIZE, channels, 0, samples)?;
    let mut into = vec![T::default(); samples.len()];
    for kernel in Kernel::ALL {
        let mut best = f64::INFINITY;
        for _ in 0..AGAIN {
            let begin = seconds();
            resample(map, kernel, &picture, 0..SIZE.height as usize, &mut into)?;
            best = best.min(seconds() - begin);
        }
        println!("{kernel},{channels},{bits},{:.1}", best * 1e3);
    }
    Ok(())
}

/// What the threads of this process took of the processor, where the system says it, so that others on the machine do not count; else the time of the day.
fn seconds() -> f64 {
    let taken = || -> io::Result<f64> {
        let mut sum = 0.0;
        for task in fs::read_dir("/proc/self/task")? {
            let text = fs::read_to_string(task?.path().join("schedstat"))?;
            sum += text.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(0.0) / 1e9;
        }
        Ok(sum)
    };
    taken().unwrap_or_else(|_| {
        static BEGIN: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
        BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64()
    })
}
