use calibench_model::camera::{Camera, DoubleSphere, OpenCv, OpenCvFisheye};

use super::*;
use crate::{Frame, Target, framed};

fn opencv(distortion: &[f64], size: ImageSize) -> Camera {
    let mut all = [0.0; 14];
    all[..distortion.len()].copy_from_slice(distortion);
    let focal = 0.75 * f64::from(size.width);
    let (cx, cy) = (0.49 * f64::from(size.width), 0.52 * f64::from(size.height));
    OpenCv { size, fx: focal, fy: 1.01 * focal, cx, cy, distortion: all, coefficients: 5 }.into()
}

fn fisheye(size: ImageSize) -> Camera {
    let (cx, cy) = (0.5 * f64::from(size.width), 0.49 * f64::from(size.height));
    OpenCvFisheye { size, fx: 180.0, fy: 181.0, cx, cy, skew: 0.0, k: [-0.01, 0.003, -0.001, 0.0002] }.into()
}

/// Every pixel's place against the exact one: the largest difference, and pixels that only one of them has well within the source.
fn compared(from: &View, to: &View) -> (f64, u64) {
    let (map, size) = (Map::between(from, to), to.size());
    let (mut most, mut exact_covered) = (0.0_f64, 0_u64);
    for row in 0..size.height {
        for column in 0..size.width {
            let exact = to.place_in(from, PixelPoint::new(f64::from(column), f64::from(row))).filter(|at| from.holds(*at));
            exact_covered += u64::from(exact.is_some());
            if let (Some(found), Some(exact)) = (map.place(column as usize, row as usize), exact) {
                most = most.max(found.distance(exact));
            }
        }
    }
    (most, exact_covered.abs_diff(map.covered()))
}

#[test]
fn places_are_exact_to_a_thousandth_of_a_pixel() {
    let size = ImageSize { width: 643, height: 481 };
    let barrel = opencv(&[-0.25, 0.06, 0.001, -0.0007, 0.0], size);
    let pincushion = opencv(&[0.2, 0.05], size);
    let sphere = DoubleSphere { size, fx: 210.0, fy: 210.0, cx: 320.0, cy: 240.0, xi: -0.2, alpha: 0.58 }.into();
    for (name, camera) in [("barrel", barrel), ("pincushion", pincushion), ("fisheye", fisheye(size)), ("sphere", sphere)] {
        let from = View::Camera(camera);
        for target in [Target::Pinhole, Target::Equirectangular] {
            for frame in [Frame::Keep, Frame::All, Frame::Crop] {
                let Ok(to) = framed(&View::Camera(camera), target, frame, 1.0) else {
                    assert!(target == Target::Pinhole && frame == Frame::All, "{name}");
                    continue;
                };
                for (from, to) in [(&from, &to), (&to, &from)] {
                    let (most, more) = compared(from, to);
                    assert!(most < 1e-3, "{name} {target:?} {frame:?}: {most} px");
                    // Pixels at the very border of the source.
                    assert!(more <= 3, "{name} {target:?} {frame:?}: {more} pixels");
                }
            }
        }
    }
}

#[test]
fn a_smooth_map_takes_few_places() {
    let size = ImageSize { width: 4000, height: 3000 };
    let camera = opencv(&[-0.25, 0.06, 0.001, -0.0007, 0.0], size);
    let map = Map::between(&View::Camera(camera), &framed(&View::Camera(camera), Target::Pinhole, Frame::Keep, 1.0).unwrap());
    assert!(map.singles() == 0.0, "{}", map.singles());
}

#[test]
fn what_has_no_ray_comes_from_nowhere() {
    // A camera that folds inside its frame, seen from a sphere; and what lies behind a plane.
    let size = ImageSize { width: 320, height: 240 };
    let folded = View::Camera(opencv(&[-0.9], size));
    let sphere = framed(&View::Camera(fisheye(size)), Target::Equirectangular, Frame::All, 1.0).unwrap();
    let map = Map::between(&folded, &sphere);
    let (most, _) = compared(&folded, &sphere);
    assert!(most < 1e-3 && map.coverage() > 0.05 && map.coverage() < 0.9, "{most} {}", map.coverage());
    let behind = View::Equirectangular(crate::Equirectangular { size, scale: 100.0, axis: PixelPoint::new(-200.0, 120.0) });
    let map = Map::between(&folded, &behind);
    assert_eq!((map.covered(), map.rows_for(0..240, 4)), (0, 0..0));
    assert!(map.mask(0..240).iter().all(|level| *level == 0));
}

#[test]
fn the_mask_is_what_has_places_and_rows_are_enough() {
    let size = ImageSize { width: 333, height: 250 };
    let camera = opencv(&[-0.3, 0.1], size);
    let map = Map::between(&View::Camera(camera), &framed(&View::Camera(camera), Target::Pinhole, Frame::All, 0.8).unwrap());
    let (width, height) = (map.size().width as usize, map.size().height as usize);
    let mask = map.mask(0..height);
    assert_eq!(mask.iter().map(|level| u64::from(*level) / 255).sum::<u64>(), map.covered());
    for band in (0..height).step_by(Map::BAND) {
        let rows = band..(band + Map::BAND).min(height);
        let needed = map.rows_for(rows.clone(), 0);
        for (row, column) in rows.flat_map(|row| (0..width).map(move |column| (row, column))) {
            let place = map.place(column, row);
            assert_eq!(place.is_some(), mask[row * width + column] == 255);
            if let Some(at) = place {
                assert!(
                    at.y.floor() >= needed.start as f64 - 1.0 && at.y.floor() + 1.0 <= needed.end as f64,
                    "{row} {column}: {at:?} {needed:?}"
                );
            }
        }
    }
}
