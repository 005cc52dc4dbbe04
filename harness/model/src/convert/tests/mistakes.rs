//! What mistakes cost, against formulas of first order.

use super::super::{
    ConvertError, ConvertOptions, Difference, DifferenceOptions, Mistake, Tangential, Target, convert, difference, from_naive, mistaken,
    naive,
};
use super::{mild, photogrammetric, values};
use crate::camera::{AgisoftVersion, Camera, OpenCv, Photogrammetric, TangentialOrder};
use crate::{Frame, PixelPoint};

/// Little distortion, p1 far from p2, no affinity.
fn right() -> Photogrammetric {
    Photogrammetric { k: [-2e-4, 1e-6, 0.0], p: [2e-4, -3e-5], b: [0.0; 2], ..photogrammetric() }
}

fn cost(mistake: Mistake, rotation: bool) -> Difference {
    let wrong = mistake.of(&right()).unwrap();
    difference(&right().into(), &wrong.into(), &DifferenceOptions { rotation, ..DifferenceOptions::default() }).unwrap()
}

/// Checks every vector against a first-order one in mm (y up), within 5 % of the largest.
fn assert_first_order(found: &Difference, formula: impl Fn(f64, f64) -> [f64; 2]) {
    let camera = right();
    let frame = Frame::new(camera.size.width, camera.size.height, camera.pitch_um).unwrap();
    let per_mm = 1e3 / camera.pitch_um;
    for vector in &found.vectors {
        let at = frame.to_sensor(vector.at);
        let [x, y] = formula(at.x - camera.x0, at.y - camera.y0);
        let off = (vector.dx - x * per_mm).hypot(vector.dy + y * per_mm);
        assert!(off < 0.05 * found.spread.max_px, "{vector:?} {x} {y}");
    }
}

#[test]
fn half_a_pixel_is_half_a_pixel() {
    let plain = cost(Mistake::HalfPixel, false);
    assert!((plain.spread.rms_px - 0.5 * 2.0_f64.sqrt()).abs() < 1e-9 && (plain.spread.max_px - 0.5 * 2.0_f64.sqrt()).abs() < 1e-9);
    assert!(plain.vectors.iter().all(|v| (v.dx - 0.5).abs() < 1e-9 && (v.dy - 0.5).abs() < 1e-9));
    let turned = cost(Mistake::HalfPixel, true);
    assert!(turned.spread.rms_px < 0.1 * plain.spread.rms_px, "{:?}", turned.spread);
}

#[test]
fn swapped_p_cost_their_difference() {
    // The wrong correction grows by d p1 (r^2 + 2 x^2) + 2 d p2 x y, and so does the measured coordinate that it leads to one ideal point.
    let d = right().p[1] - right().p[0];
    let found = cost(Mistake::TangentialSwapped, false);
    assert!(found.spread.max_px > 1.0);
    assert_first_order(&found, |x, y| {
        let r2 = x * x + y * y;
        [d * (r2 + 2.0 * x * x) - 2.0 * d * x * y, 2.0 * d * x * y - d * (r2 + 2.0 * y * y)]
    });
}

#[test]
fn y_not_flipped_costs_twice_the_terms_of_y() {
    let (y0, p2) = (right().y0, right().p[1]);
    assert_first_order(&cost(Mistake::VerticalNotFlipped, false), |x, y| {
        let r2 = x * x + y * y;
        [-4.0 * p2 * x * y, -2.0 * y0 - 2.0 * p2 * (r2 + 2.0 * y * y)]
    });
    let found = cost(Mistake::SignOfY0, false);
    assert!((found.spread.rms_px - 2.0 * 0.03 / 0.0047).abs() < 1e-9);
    let found = cost(Mistake::SignOfX0, false);
    assert!((found.spread.rms_px - 2.0 * 0.0411 / 0.0047).abs() < 1e-9);
}

#[test]
fn the_sign_costs_twice_the_correction() {
    let Photogrammetric { k: [k1, k2, _], p: [p1, p2], .. } = right();
    assert_first_order(&cost(Mistake::SignOfCorrection, false), |x, y| {
        let r2 = x * x + y * y;
        let radial = k1 * r2 + k2 * r2 * r2;
        let dx = x * radial + p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y;
        let dy = y * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * y * y);
        [-2.0 * dx, -2.0 * dy]
    });
}

#[test]
fn a_wrong_pitch_scales() {
    let share = 0.01;
    let found = cost(Mistake::WrongPitchOfC { pitch_um: 4.7 * (1.0 + share) }, false);
    assert_first_order(&found, |x, y| [share * x, share * y]);
    let found = cost(Mistake::WrongPitch { pitch_um: 4.7 * (1.0 + share) }, false);
    let (x0, y0) = (right().x0, right().y0);
    assert_first_order(&found, |x, y| [share * (x + x0), share * (y + y0)]);
    assert!(Mistake::WrongPitch { pitch_um: -1.0 }.of(&right()).is_err());
}

#[test]
fn the_corner_is_far_from_the_centre() {
    let wrong = Mistake::PrincipalPointFromCorner.of(&right()).unwrap();
    assert!((wrong.x0 - (681.0 * 0.0047 + 0.0411)).abs() < 1e-12 && (wrong.y0 + 510.5 * 0.0047 + 0.03).abs() < 1e-2, "{wrong:?}");
}

#[test]
fn naive_costs_the_second_order() {
    let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let converted = convert(&mild(), Target::photogrammetric(4.7), &options).unwrap();
    let Camera::Photogrammetric(right_camera) = converted.camera else { panic!("{:?}", converted.camera) };
    let found = mistaken(&mild(), &right_camera, Mistake::Naive).unwrap();
    // With one coefficient the inverse of r (1 + K r^2) is r (1 - K r^2 + 3 K^2 r^4): 3 K^2 r^5 f is neglected.
    let source = Camera::from(OpenCv { cx: 680.5, cy: 510.0, ..super::opencv(4, &[-0.02]) });
    let wrong = naive(&source, 4.7, Tangential::Converted).unwrap();
    let options = DifferenceOptions { rotation: false, ..DifferenceOptions::default() };
    let lost = difference(&source, &wrong.into(), &options).unwrap();
    let r = 680.5_f64.hypot(510.0) / 1500.0;
    let expected = 3.0 * 0.02_f64.powi(2) * r.powi(5) * 1500.0;
    assert!((lost.spread.max_px / expected - 1.0).abs() < 0.1, "{:?} {expected}", lost.spread);
    let cost = difference(&converted.camera, &found.into(), &options).unwrap().spread.max_px;
    assert!(cost > 10.0 * converted.residual.max_px, "{cost} {:?}", converted.residual);
    assert_eq!(mistaken(&right().into(), &right(), Mistake::Naive), Err(ConvertError::NotInTable));
    assert_eq!(mistaken(&mild(), &right(), Mistake::SignOfX0), Mistake::SignOfX0.of(&right()));
}

#[test]
fn table_2_is_read_in_both_directions() {
    let agisoft = |version| Target::Agisoft { version, radial: 3, tangential: 2, affinity: true };
    let pix4d = Target::Pix4d { sensor_width_mm: 6.4, order: TangentialOrder::OpenCv };
    let tools = [Target::OpenCv { coefficients: 5 }, Target::metashape(), agisoft(AgisoftVersion::Lens), pix4d];
    for tangential in [Tangential::AsPrinted, Tangential::Converted] {
        for tool in tools {
            let there = from_naive(&right(), tool, tangential).unwrap();
            let back = naive(&there, 4.7, tangential).unwrap();
            for (a, b) in values(&right().into()).iter().zip(values(&back.into())) {
                assert!((a - b).abs() <= 1e-12 * a.abs().max(1e-3), "{a} {b}");
            }
        }
    }
    // OpenCV: p1 = kc4 / c, p2 = -kc3 / c; printed kc3 / c, kc4 / c.
    let Camera::OpenCv(camera) = mild() else { panic!() };
    let (c, [_, _, kc3, kc4, ..]) = (1500.0 * 0.0047, camera.distortion);
    for (tangential, expected) in [(Tangential::Converted, [kc4 / c, -kc3 / c]), (Tangential::AsPrinted, [kc3 / c, kc4 / c])] {
        let found = naive(&mild(), 4.7, tangential).unwrap().p;
        assert!((found[0] - expected[0]).abs() < 1e-15 && (found[1] - expected[1]).abs() < 1e-15, "{found:?} {expected:?}");
    }
    assert!(from_naive(&right(), Target::OpenCvFisheye, Tangential::Converted).is_err());
    assert!(PixelPoint::new(camera.cx, camera.cy).is_finite());
}
