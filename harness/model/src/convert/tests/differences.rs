//! Differences between cameras.

use super::super::fit::{Problem, State};
use super::super::grid::{Sight, sights};
use super::super::rotation::between;
use super::super::{ConvertError, DifferenceOptions, Region, Rotation, Vector, difference, difference_at};
use super::{SIZE, mild, opencv, photogrammetric};
use crate::camera::{Camera, CameraModel, ImageSize, OpenCv, Photogrammetric};

const PLAIN: DifferenceOptions = DifferenceOptions { region: Region::Frame, rotation: false, compensation: false, columns: 41, finer: 1 };

#[test]
fn a_camera_does_not_differ_from_itself() {
    let options = DifferenceOptions { compensation: true, ..DifferenceOptions::default() };
    for camera in [mild(), photogrammetric().into()] {
        let found = difference(&camera, &camera, &options).unwrap();
        assert!(found.spread.max_px < 1e-8 && found.rotation.angle() < 1e-10, "{:?}", found.spread);
        assert!(found.compensated.unwrap().scale.abs() < 1e-10);
        assert_eq!(found.not_comparable, 0.0);
    }
}

#[test]
fn nor_from_its_rotated_twin() {
    // Half a turn about the axis: the scales and the terms of even degree change their signs.
    let twin = OpenCv { fx: -1500.0, fy: -1500.0, ..opencv(5, &[-0.06, 0.02, -4e-4, 1.5e-3, -0.004]) };
    let found = difference(&mild(), &twin.into(), &DifferenceOptions::default()).unwrap();
    assert!(found.spread.max_px < 1e-8 && (found.rotation.angle() - std::f64::consts::PI).abs() < 1e-10, "{:?}", found.spread);
    // Any turn: the start by absolute orientation of the rays is at the solution already.
    let camera = mild();
    let turn = Rotation::from_vector([0.3, -0.2, 0.9]);
    let turned: Vec<Sight> =
        sights(&camera, Region::Frame, 21).unwrap().into_iter().map(|s| Sight { ray: turn.apply(s.ray), ..s }).collect();
    let problem = Problem { sights: &turned, free: &[], rotation: true };
    let found = problem.solve(State { camera, rotation: between(&turned, &camera) }).unwrap();
    assert!(problem.cost(&found).unwrap().sqrt() < 1e-9);
}

#[test]
fn a_shift_is_a_rotation_and_little_more() {
    let (a, b) = (mild(), Camera::from(OpenCv { cx: 692.0, ..opencv(5, &[-0.06, 0.02, 4e-4, -1.5e-3, -0.004]) }));
    let plain = difference(&a, &b, &PLAIN).unwrap();
    assert!((plain.spread.rms_px - 2.0).abs() < 1e-9 && (plain.spread.max_px - 2.0).abs() < 1e-9);
    assert!((plain.on_object(2.0, 3000.0) - 4.0).abs() < 1e-3, "{}", plain.focal_px);
    let options = DifferenceOptions { compensation: true, ..DifferenceOptions::default() };
    let turned = difference(&a, &b, &options).unwrap();
    assert!(turned.spread.rms_px < 0.2 && turned.rotation.angle() > 1e-3, "{:?}", turned.spread);
    let compensated = turned.compensated.unwrap();
    assert!(compensated.spread.max_px < 1e-8 && (compensated.shift[0] + 2.0).abs() < 1e-6, "{compensated:?}");
}

/// A pose makes up for a camera where points were measured, and shows elsewhere what it is off.
#[test]
fn the_rotation_may_be_that_of_measured_places() {
    let other = OpenCv { cx: 694.0, cy: 455.0, ..opencv(5, &[-0.09, 0.02, 4e-4, -1.5e-3, -0.004]) };
    let (a, b, options) = (mild(), Camera::from(other), DifferenceOptions::default());
    let over_frame = difference(&a, &b, &options).unwrap();
    let near = |vector: &&Vector| vector.at.distance(crate::PixelPoint::new(400.0, 300.0)) < 150.0;
    let places: Vec<_> = over_frame.vectors.iter().filter(near).map(|vector| vector.at).collect();
    assert!(places.len() > 20);
    let at_places = difference_at(&a, &b, &places, &options).unwrap();
    let rms = |vectors: &[Vector], inside: bool| {
        let squares: Vec<f64> = vectors.iter().filter(|vector| near(vector) == inside).map(|vector| vector.length().powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let [there, frame] = [&at_places, &over_frame].map(|found| [true, false].map(|inside| rms(&found.vectors, inside)));
    assert!(there[0] < 0.5 * frame[0] && there[1] > 1.1 * frame[1], "{there:?} {frame:?}");
    assert!(at_places.spread.rms_px > over_frame.spread.rms_px && at_places.compensated.is_none());
    // No rotation does better at these places.
    for axis in 0..3 {
        for step in [-1e-5, 1e-5] {
            let mut vector = at_places.rotation.vector();
            vector[axis] += step;
            let turned = Rotation::from_vector(vector);
            let squares = |rotation: &Rotation| -> f64 {
                let off = |at: &crate::PixelPoint| b.project(rotation.apply(a.unproject(*at).unwrap())).unwrap().distance(*at).powi(2);
                places.iter().map(off).sum()
            };
            assert!(squares(&turned) > squares(&at_places.rotation), "axis {axis}");
        }
    }
    // All places of the frame are the frame, but for the weight of its border.
    let all: Vec<_> = over_frame.vectors.iter().map(|vector| vector.at).collect();
    let found = difference_at(&a, &b, &all, &options).unwrap();
    assert!((found.spread.rms_px / over_frame.spread.rms_px - 1.0).abs() < 0.05, "{:?} {:?}", found.spread, over_frame.spread);
    assert!(matches!(difference_at(&a, &b, &places[..4], &options), Err(ConvertError::NotPictured { .. })));
}

#[test]
fn roles_can_be_exchanged() {
    let near = opencv(5, &[-0.059, 0.021, 5e-4, -1.4e-3, -0.003]).into();
    let there = difference(&mild(), &near, &DifferenceOptions::default()).unwrap();
    let back = difference(&near, &mild(), &DifferenceOptions::default()).unwrap();
    assert!((there.spread.rms_px / back.spread.rms_px - 1.0).abs() < 0.01, "{:?} {:?}", there.spread, back.spread);
    let together = there.rotation.vector().iter().zip(back.rotation.vector()).map(|(a, b)| (a + b).abs()).fold(0.0, f64::max);
    assert!(together < 0.01 * there.rotation.angle());
}

#[test]
fn what_folds_is_not_compared() {
    let folded = opencv(5, &[-1.5]).into();
    for (a, b) in [(mild(), folded), (folded, mild())] {
        let found = difference(&a, &b, &PLAIN).unwrap();
        assert!((0.02..0.6).contains(&found.not_comparable), "{}", found.not_comparable);
    }
    let inside = DifferenceOptions { region: Region::Radius { px: 300.0 }, ..PLAIN };
    assert_eq!(difference(&mild(), &folded, &inside).unwrap().not_comparable, 0.0);
}

#[test]
fn images_must_have_one_size() {
    let other = Photogrammetric { size: ImageSize { width: SIZE.width + 1, ..SIZE }, ..photogrammetric() };
    assert!(difference(&mild(), &other.into(), &PLAIN).is_err());
}

/// Beside nearly every pixel, after the same rotation: over the frame, within a radius, and where a part is not pictured.
#[test]
fn sizes_on_the_finer_grid_are_right_to_a_hundredth() {
    let steep = opencv(5, &[-0.06, 0.02, 5e-4, -1.4e-3, 0.2]).into();
    let folded = opencv(5, &[-0.9]).into();
    let mut coarse_is_off = 0;
    for (second, region) in
        [(steep, Region::Frame), (steep, Region::Radius { px: 450.0 }), (folded, Region::Frame), (folded, Region::Radius { px: 500.0 })]
    {
        let of = |finer| difference(&mild(), &second, &DifferenceOptions { region, finer, ..PLAIN }).unwrap();
        let (found, coarse) = (of(DifferenceOptions::FINE), of(1));
        let all = difference(&mild(), &second, &DifferenceOptions { region, columns: 641, rotation: false, ..PLAIN });
        let all = all.unwrap().spread;
        assert!(
            (found.spread.rms_px / all.rms_px - 1.0).abs() < 0.01 && (found.spread.max_px / all.max_px - 1.0).abs() < 0.02,
            "{:?} {all:?}",
            found.spread
        );
        coarse_is_off += usize::from((coarse.spread.rms_px / all.rms_px - 1.0).abs() > 0.01);
        assert_eq!(found.vectors, coarse.vectors);
    }
    assert!(coarse_is_off > 0);
}
