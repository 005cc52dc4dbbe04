use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;

use super::*;

const SIZE: ImageSize = ImageSize { width: 97, height: 83 };

/// A map of a picture of 70 x 75 px that turns, shears and bends.
fn bent() -> Map {
    let place = |at: PixelPoint| {
        let (x, y) = (at.x - 30.0, at.y - 40.0);
        Some(PixelPoint::new(45.0 + 0.9 * x - 0.2 * y + 0.001 * x * y, 41.3 + 0.15 * x + 0.95 * y + 0.0007 * x * x))
    };
    Map::new(ImageSize { width: 70, height: 75 }, SIZE, place)
}

fn chance(i: usize) -> u32 {
    let mixed = (i as u32).wrapping_mul(0x9e37_79b9) ^ 0x85eb_ca6b;
    (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d) >> 8
}

fn all<T: Level>(map: &Map, kernel: Kernel, channels: usize, samples: &[T]) -> Vec<T> {
    let picture = Picture::new(map.source(), channels, 0, samples).unwrap();
    let (width, height) = (map.size().width as usize, map.size().height as usize);
    let mut into = vec![T::default(); width * height * channels];
    resample(map, kernel, &picture, 0..height, &mut into).unwrap();
    into
}

/// The plain sum of pixels by weights, in double precision.
fn reference(kernel: Kernel, at: PixelPoint, level: impl Fn(usize, usize) -> f64) -> f64 {
    let taps = kernel.taps() as i64;
    let (x, y) = (at.x.floor(), at.y.floor());
    let (across, down) = (kernel.weights(at.x - x), kernel.weights(at.y - y));
    let index = |whole: f64, tap: i64, count: u32| job::mirrored(whole as i64 + tap - (taps / 2 - 1), count as usize);
    let line = |row: usize| -> f64 { (0..taps).map(|tap| across[tap as usize] * level(index(x, tap, SIZE.width), row)).sum() };
    (0..taps).map(|tap| down[tap as usize] * line(index(y, tap, SIZE.height))).sum()
}

fn is_level<T: Level>(map: &Map, kernel: Kernel, channels: usize, samples: &[T]) {
    let found = all(map, kernel, channels, samples);
    let width = map.size().width as usize;
    let mut some = 0;
    for (i, found) in found.iter().enumerate() {
        let (pixel, channel) = (i / channels, i % channels);
        let Some(at) = map.place(pixel % width, pixel / width) else {
            assert!(found.to_f32() == 0.0, "{kernel} at {i}");
            continue;
        };
        some += 1;
        let level = |x: usize, y: usize| f64::from(samples[(y * SIZE.width as usize + x) * channels + channel].to_f32());
        let expected = reference(kernel, at, level).clamp(0.0, f64::from(T::TOP));
        // The same after rounding, but for what stands at a half.
        let off = (f64::from(found.to_f32()) - expected).abs();
        assert!(off < 0.5 + 1e-6 * f64::from(T::TOP), "{kernel}, {channels} channels, at {i}: {} {expected}", found.to_f32());
    }
    assert!(some > found.len() / 2);
}

#[test]
fn fast_loops_are_the_plain_sum() {
    let map = bent();
    for kernel in [Kernel::Linear, Kernel::Cubic, Kernel::Lanczos3, Kernel::Lanczos4] {
        for channels in [1, 3] {
            let count = (SIZE.width * SIZE.height) as usize * channels;
            let bytes: Vec<u8> = (0..count).map(|i| chance(i) as u8).collect();
            let words: Vec<u16> = (0..count).map(|i| chance(i) as u16).collect();
            is_level(&map, kernel, channels, &bytes);
            is_level(&map, kernel, channels, &words);
        }
    }
}

/// A polynomial of the degree that a kernel is exact for, at the places of the map, away from the border.
#[test]
fn polynomials_are_exact() {
    let map = bent();
    for (kernel, degree) in [(Kernel::Linear, 1), (Kernel::Cubic, 2), (Kernel::Spline, 5)] {
        let value = |x: f64, y: f64| {
            let (u, v) = ((x - 48.0) / 48.0, (y - 41.0) / 41.0);
            0.4 + 0.2 * u.powi(degree) + 0.1 * v.powi(degree) - 0.1 * u * v + 0.05 * (v - u)
        };
        let level = |i: usize| value((i % SIZE.width as usize) as f64, (i / SIZE.width as usize) as f64) as f32;
        let samples: Vec<f32> = (0..(SIZE.width * SIZE.height) as usize).map(level).collect();
        let found = all(&map, kernel, 1, &samples);
        let mut some = 0;
        for (i, found) in found.iter().enumerate() {
            let Some(at) = map.place(i % 70, i / 70) else { continue };
            let margin = if kernel == Kernel::Spline { 16.0 } else { 2.0 };
            if at.x < margin || at.y < margin || at.x > 96.0 - margin || at.y > 82.0 - margin {
                continue;
            }
            some += 1;
            assert!((f64::from(*found) - value(at.x, at.y)).abs() < 3e-6, "{kernel} at {at:?}: {found} {}", value(at.x, at.y));
        }
        assert!(some > 1000, "{some}");
    }
}

#[test]
fn rows_of_the_source_are_enough() {
    let map = bent();
    for kernel in Kernel::ALL {
        for channels in 1..=4 {
            let count = (SIZE.width * SIZE.height) as usize * channels;
            let samples: Vec<u16> = (0..count).map(|i| chance(i) as u16).collect();
            let whole = all(&map, kernel, channels, &samples);
            let mut bands = vec![0_u16; whole.len()];
            for first in (0..75).step_by(Map::BAND) {
                let rows = first..(first + Map::BAND).min(75);
                let needed = map.rows_for(rows.clone(), reach(kernel, &map));
                let stride = SIZE.width as usize * channels;
                let picture = Picture::new(SIZE, channels, needed.start, &samples[needed.start * stride..needed.end * stride]).unwrap();
                let part = &mut bands[rows.start * 70 * channels..rows.end * 70 * channels];
                resample(&map, kernel, &picture, rows, part).unwrap();
            }
            // Blocks of a band hold less than those of all, by which splines begin elsewhere: nothing that rounding shows but at a half.
            let most = whole.iter().zip(&bands).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
            assert!(most <= u16::from(kernel == Kernel::Spline || channels % 2 == 0), "{kernel} {channels}: {most}");
        }
    }
}

#[test]
fn threads_change_no_byte() {
    let map = bent();
    let samples: Vec<u8> = (0..(SIZE.width * SIZE.height) as usize * 4).map(|i| chance(i) as u8).collect();
    for kernel in Kernel::ALL {
        let on = |threads: usize| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| all(&map, kernel, 4, &samples))
        };
        assert!(on(1) == on(3), "{kernel}");
    }
}

/// Green that nothing is seen of beside red: no green, and no dark, in what lies between.
#[test]
fn colours_count_by_their_alpha() {
    let samples: Vec<u8> = (0..(SIZE.width * SIZE.height) as usize)
        .flat_map(|i| if i % SIZE.width as usize >= 48 { [0, 255, 0, 0] } else { [200, 0, 0, 255] })
        .collect();
    for kernel in [Kernel::Linear, Kernel::Cubic, Kernel::Area] {
        let found = all(&bent(), kernel, 4, &samples);
        let seen: Vec<&[u8]> = found.chunks_exact(4).filter(|pixel| pixel[3] > 0).collect();
        assert!(seen.iter().any(|pixel| pixel[3] < 255) && seen.len() > 1000);
        assert!(seen.iter().all(|pixel| pixel[0].abs_diff(200) <= 1 && pixel[1] <= 1), "{kernel}");
        assert!(found.chunks_exact(4).all(|pixel| pixel[3] > 0 || pixel == [0; 4]));
    }
}

/// A fine pattern at a fifth of its size: grey by the area, anything by a kernel of few pixels.
#[test]
fn area_takes_means_where_the_picture_shrinks() {
    let source = ImageSize { width: 400, height: 300 };
    let size = ImageSize { width: 80, height: 60 };
    let samples: Vec<u8> = (0..400 * 300).map(|i| if (i % 400 + i / 400) % 2 == 0 { 200 } else { 100 }).collect();
    let map = Map::new(size, source, |at| Some(PixelPoint::new(5.0 * at.x + 2.0, 5.0 * at.y + 2.0)));
    assert!((map.shrinks() - 5.0).abs() < 1e-4);
    let spread = |kernel| {
        let found = all(&map, kernel, 1, &samples);
        (found.iter().max().unwrap() - found.iter().min().unwrap(), found.iter().map(|level| f64::from(*level)).sum::<f64>() / 4800.0)
    };
    let (by_area, mean) = spread(Kernel::Area);
    assert!(by_area <= 2 && (mean - 150.0).abs() < 1.0, "{by_area} {mean}");
    // Every fifth pixel is one or the other.
    assert_eq!(spread(Kernel::Linear).0, 100);
    // Where nothing shrinks both are one.
    let same = Map::new(size, source, |at| Some(PixelPoint::new(0.7 * at.x + 10.2, 0.7 * at.y + 2.0)));
    assert!(all(&same, Kernel::Area, 1, &samples) == all(&same, Kernel::Linear, 1, &samples));
}

/// A ramp to the very edge: by the mean of a pixel's area it stays one.
#[test]
fn area_moves_nothing() {
    let source = ImageSize { width: 400, height: 300 };
    let size = ImageSize { width: 130, height: 100 };
    let samples: Vec<u16> = (0..400 * 300).map(|i| (i % 400 * 100 + i / 400 * 50) as u16).collect();
    let map = Map::new(size, source, |at| Some(PixelPoint::new(3.0 * at.x + 1.3, 2.9 * at.y + 2.2)));
    for (i, found) in all(&map, Kernel::Area, 1, &samples).iter().enumerate() {
        let Some(at) = map.place(i % 130, i / 130).filter(|at| at.x > 3.0 && at.x < 395.0 && at.y > 3.0 && at.y < 295.0) else { continue };
        let expected = 100.0 * at.x + 50.0 * at.y;
        assert!((f64::from(*found) - expected).abs() < 1.0, "{at:?}: {found} {expected}");
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let map = bent();
    let samples = vec![0_u8; (SIZE.width * SIZE.height) as usize];
    let picture = Picture::new(SIZE, 1, 0, &samples).unwrap();
    let mut into = vec![0; 70 * 75];
    assert!(resample(&map, Kernel::Linear, &picture, 0..75, &mut into[1..]).is_err());
    assert!(resample(&map, Kernel::Linear, &picture, 5..75, &mut into[..70 * 70]).is_err());
    let few = Picture::new(SIZE, 1, 0, &samples[..97 * 20]).unwrap();
    assert!(matches!(resample(&map, Kernel::Linear, &few, 0..75, &mut into), Err(PictureError::Size { .. })));
    let other = Picture::new(ImageSize { width: 83, height: 97 }, 1, 0, &samples).unwrap();
    assert!(resample(&map, Kernel::Linear, &other, 0..75, &mut into).unwrap_err().to_string().contains("97 x 83"));
    assert!(Picture::new(SIZE, 5, 0, &samples).is_err() && Picture::new(SIZE, 1, 0, &samples[1..]).is_err());
}
