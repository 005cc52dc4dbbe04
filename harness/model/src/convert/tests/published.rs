//! The Canon paper's Table 3.

use super::super::grid::nodes;
use super::super::{
    ConvertError, ConvertOptions, DifferenceOptions, Region, Spread, Tangential, Target, Verdict, convert, difference, from_naive,
};
use crate::camera::{Camera, CameraModel, ImageSize, Photogrammetric, fold};

/// Name, c, x0, y0 (mm), k1 (mm^-2), k2 (mm^-4), k3 (mm^-6), p1, p2 (mm^-1): published/canon-t3-table3.csv.
type Row = (&'static str, [f64; 3], [f64; 3], [f64; 2]);
const TABLE_3: [Row; 4] = [
    ("photoscan", [19.213, 0.042, -0.134], [-4.61e-4, 1.20e-6, -0.04e-8], [0.86e-4, 0.89e-4]),
    ("pix4d", [19.214, -0.054, -0.078], [-4.61e-4, 1.12e-6, -0.01e-8], [0.81e-4, 0.86e-4]),
    ("opencv", [18.525, 0.041, -0.698], [-6.57e-4, 4.17e-6, -1.73e-8], [2.26e-4, 0.39e-4]),
    ("lens", [19.005, -0.048, -0.267], [-6.75e-4, 4.77e-6, -1.90e-8], [2.74e-4, 0.71e-4]),
];
const SIZE: ImageSize = ImageSize { width: 4272, height: 2848 };

fn printed((_, [c, x0, y0], k, p): Row, pitch_um: f64) -> Photogrammetric {
    Photogrammetric { size: SIZE, pitch_um, c, x0, y0, k, p, b: [0.0; 2] }
}

fn tool(row: Row, pitch_um: f64) -> Camera {
    from_naive(&printed(row, pitch_um), Target::metashape(), Tangential::Converted).unwrap()
}

/// Ideal coordinates by the right camera and by the naive one, at the same pixels: RMS over the area and maximum of the differences, px.
fn cost_of_naive(row: Row, pitch_um: f64) -> (f64, f64) {
    let (truth, naive) = (tool(row, pitch_um), printed(row, pitch_um));
    let focal = naive.c * 1e3 / pitch_um;
    let ideal = |camera: &dyn CameraModel, point| camera.unproject(point).unwrap().tangent().unwrap();
    let (mut sum, mut max) = (0.0, 0.0_f64);
    for node in nodes(SIZE, 81) {
        let (a, b) = (ideal(&truth, node.point), ideal(&naive, node.point));
        let cost = focal * (a.0 - b.0).hypot(a.1 - b.1);
        sum += node.weight * cost * cost;
        max = max.max(cost);
    }
    (sum.sqrt(), max)
}

#[test]
fn naive_costs_ten_pixels_at_the_corner() {
    // 4.3 and 10.8 px, 4.0 and 11.3 px: differences of ideal coordinates at given pixels, without rotation. The mean over the area is 4.20 where
    // 4.3 was found; a plain mean over a grid, which counts the edges double, lies above it.
    let (rms, max) = cost_of_naive(TABLE_3[0], 5.38085);
    assert!((rms - 4.20).abs() < 0.01 && (max - 10.8).abs() < 0.05, "{rms} {max}");
    let (rms, max) = cost_of_naive(TABLE_3[0], 5.15);
    assert!((rms - 3.98).abs() < 0.01 && (max - 11.3).abs() < 0.05, "{rms} {max}");
    // 1.6 cm and 3.9 cm on the wall, at about 13 m.
    let metres = |px: f64| px * 5.38085e-3 / 19.213 * 13.0;
    assert!((metres(4.3) - 0.016).abs() < 0.0005 && (metres(10.8) - 0.039).abs() < 0.001);
}

#[test]
fn in_the_image_it_costs_less_and_rotation_or_c_do_not_save_it() {
    // Rays to pixels: barrel distortion makes the image of a difference smaller than the difference of ideal coordinates.
    let (truth, naive) = (tool(TABLE_3[0], 5.38085), Camera::from(printed(TABLE_3[0], 5.38085)));
    let cost = |rotation| {
        let options = DifferenceOptions { rotation, compensation: true, ..DifferenceOptions::default() };
        difference(&truth, &naive, &options).unwrap()
    };
    let near =
        |found: Spread, rms: f64, max: f64| assert!((found.rms_px - rms).abs() < 0.01 && (found.max_px - max).abs() < 0.02, "{found:?}");
    near(cost(false).spread, 3.88, 9.95);
    near(cost(true).spread, 3.86, 9.46);
    let refitted = cost(true).compensated.unwrap();
    near(refitted.spread, 1.58, 2.88);
    assert!((refitted.scale * 19.213 + 0.0455).abs() < 1e-3, "c changes by {} mm", refitted.scale * 19.213);
}

#[test]
fn no_polynomial_of_seventh_order_holds_the_inverse() {
    let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let found = convert(&tool(TABLE_3[0], 5.38085), Target::photogrammetric(5.38085), &options).unwrap();
    assert_eq!(found.verdict, Verdict::Accepted);
    assert!((found.residual.rms_px - 0.091).abs() < 0.002 && (found.residual.max_px - 0.979).abs() < 0.01, "{:?}", found.residual);
}

#[test]
fn opencv_and_lens_fold_over_at_13_mm() {
    let radius = |row: Row, pitch_um: f64| fold(&tool(row, pitch_um)).map(|fold| fold.radius_px * pitch_um * 1e-3);
    for (row, without_p, with_p) in [(TABLE_3[2], 13.07, 12.91), (TABLE_3[3], 13.17, 12.97)] {
        let radial = Row::from((row.0, row.1, row.2, [0.0; 2]));
        assert!((radius(radial, 5.38085).unwrap() - without_p).abs() < 0.01);
        assert!((radius(row, 5.38085).unwrap() - with_p).abs() < 0.01);
        let refused = convert(&tool(row, 5.38085), Target::photogrammetric(5.38085), &ConvertOptions::default());
        assert!(matches!(refused, Err(ConvertError::Fold { share, .. }) if share < 0.02), "{refused:?}");
        let region = Region::Radius { px: 8.0e3 / 5.38085 };
        let options = ConvertOptions { region, ..ConvertOptions::default() };
        assert_eq!(convert(&tool(row, 5.38085), Target::photogrammetric(5.38085), &options).unwrap().verdict, Verdict::Warning);
    }
    assert_eq!(radius(TABLE_3[0], 5.38085), None);
    assert_eq!(radius(TABLE_3[1], 5.38085), None);
}
