use calibench_model::camera::{Camera, CameraModel, OpenCv, OpenCvFisheye, Splined};

use super::*;
use crate::Map;

fn barrel(k1: f64) -> Camera {
    let size = ImageSize { width: 640, height: 480 };
    let mut distortion = [0.0; 14];
    distortion[0] = k1;
    OpenCv { size, fx: 500.0, fy: 500.0, cx: 310.0, cy: 245.0, distortion, coefficients: 5 }.into()
}

fn fisheye(focal: f64) -> Camera {
    let size = ImageSize { width: 600, height: 400 };
    OpenCvFisheye { size, fx: focal, fy: focal, cx: 299.5, cy: 199.5, skew: 0.0, k: [0.0; 4] }.into()
}

#[test]
fn frames_hold_what_they_say() {
    for (camera, target) in [
        (barrel(-0.3), Target::Pinhole),
        (barrel(0.2), Target::Pinhole),
        (barrel(-0.3), Target::Equirectangular),
        (fisheye(300.0), Target::Pinhole),
        (fisheye(130.0), Target::Equirectangular),
    ] {
        let from = View::Camera(camera);
        let view = |frame| framed(&View::Camera(camera), target, frame, 1.0).unwrap();
        let [keep, all, crop] = [Frame::Keep, Frame::All, Frame::Crop].map(view);
        assert_eq!(keep.size(), camera.size());
        // All is in the largest, and the smallest has no empty pixel; a larger one would.
        assert!(kept(&from, &all).shown == kept(&from, &all).with_ray, "{camera:?}");
        let map = Map::between(&from, &crop);
        assert!(map.covered() == u64::from(crop.size().width) * u64::from(crop.size().height), "{camera:?} {}", map.coverage());
        let shown = [kept(&from, &crop).shown, kept(&from, &all).shown];
        assert!(shown[0] > 0.5 && shown[0] < shown[1], "{shown:?}");
        // One scale on the axis in all of them, along rows to the right and along columns downwards.
        let step = |view: &View| {
            let axis = view.image(Ray::from_tangent(0.0, 0.0)).unwrap();
            let down = axis.y - view.image(Ray::from_tangent(0.0, 1e-4)).unwrap().y;
            assert!(down > 0.0 && (down / (view.image(Ray::from_tangent(1e-4, 0.0)).unwrap().x - axis.x) - 1.0).abs() < 1e-6, "{view:?}");
            view.image(Ray::from_tangent(1e-4, 0.0)).unwrap().x - axis.x
        };
        assert!((step(&keep) / step(&crop) - 1.0).abs() < 1e-9 && (step(&keep) / step(&from) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn the_crop_cannot_grow() {
    let (camera, from) = (barrel(-0.3), View::Camera(barrel(-0.3)));
    let View::Camera(Camera::OpenCv(crop)) = framed(&View::Camera(camera), Target::Pinhole, Frame::Crop, 1.0).unwrap() else { panic!() };
    for (x, y) in [(1.0, 0.0), (0.0, 1.0), (0.0, 0.0)] {
        let (mut more, grown) = (crop, u32::from(x == 0.0 && y == 0.0));
        (more.cx, more.cy) = (crop.cx + x, crop.cy + y);
        more.size.width += u32::from(x > 0.0) + grown;
        more.size.height += u32::from(y > 0.0) + grown;
        assert!(Map::between(&from, &View::Camera(more.into())).coverage() < 1.0, "{x} {y}");
    }
}

#[test]
fn scale_is_of_outer_edges() {
    let camera = barrel(-0.1);
    let half = framed(&View::Camera(camera), Target::Pinhole, Frame::Keep, 0.5).unwrap();
    assert_eq!(half.size(), ImageSize { width: 320, height: 240 });
    let axis = half.image(Ray::from_tangent(0.0, 0.0)).unwrap();
    assert!(axis.distance(PixelPoint::new(154.75, 122.25)) < 1e-9, "{axis:?}");
}

#[test]
fn fields_are_angles() {
    let pinhole = View::pinhole(ImageSize { width: 640, height: 480 }, [320.0, 320.0], PixelPoint::new(319.5, 239.5));
    let found = fields(&pinhole).unwrap();
    assert!((found.horizontal.to_degrees() - 90.0).abs() < 1e-9 && (found.diagonal.to_degrees() - 102.6804).abs() < 1e-3, "{found:?}");
    // Beyond 180 degrees angles go on: 600 px of 130 px a radian.
    let found = fields(&View::Camera(fisheye(130.0))).unwrap();
    assert!((found.horizontal - 600.0 / 130.0).abs() < 1e-6, "{found:?}");
}

#[test]
fn what_cannot_be_is_refused() {
    let wide = framed(&View::Camera(fisheye(130.0)), Target::Pinhole, Frame::All, 1.0).unwrap_err().to_string();
    assert!(wide.contains("158.") || wide.contains("off its axis"), "{wide}");
    assert!(matches!(framed(&View::Camera(barrel(0.0)), Target::Pinhole, Frame::Keep, 1e-4), Err(FrameError::Size { .. })));
    assert!(matches!(framed(&View::Camera(barrel(0.0)), Target::Pinhole, Frame::Keep, 200.0), Err(FrameError::Size { .. })));
}

#[test]
fn the_largest_rectangle_is_found() {
    let picture = ["..##.", ".####", ".####", "#####", "..#.."];
    let filled: Vec<bool> = picture.iter().flat_map(|line| line.chars().map(|c| c == '#')).collect();
    assert_eq!(largest(&filled, 5), Some([1, 1, 4, 3]));
    assert_eq!(largest(&[false; 6], 3), None);
}

/// Splines whose control points are zero are a stereographic fisheye: on the axis a radian has f px, and beside it r = 2 f tan(angle / 2).
#[test]
fn splines_are_taken_as_they_are() {
    let size = ImageSize { width: 600, height: 400 };
    let mut splined = Splined::flat(size, [250.0, 250.0, 299.5, 199.5], 3, [16, 12], 150.0);
    let flat = View::Splined(splined.clone().into());
    let sphere = framed(&flat, Target::Equirectangular, Frame::Keep, 1.0).unwrap();
    for degrees in [-50.0_f64, -20.0, 0.0, 35.0] {
        let angle = degrees.to_radians();
        let at = sphere.place_in(&flat, PixelPoint::new(299.5 + 250.0 * angle, 199.5)).unwrap();
        assert!((at.x - (299.5 + 500.0 * (0.5 * angle).tan())).abs() < 1e-9 && (at.y - 199.5).abs() < 1e-9, "{at:?}");
    }
    // A dent: the map has what the splines have, pixel by pixel.
    splined.control[5 * 16 + 9] = [0.03, -0.02];
    let dented = View::Splined(splined.clone().into());
    let plane = framed(&dented, Target::Pinhole, Frame::Crop, 1.0).unwrap();
    let map = Map::between(&dented, &plane);
    assert_eq!(map.covered(), u64::from(plane.size().width) * u64::from(plane.size().height));
    let mut dent = 0.0_f64;
    for (column, row) in
        (0..plane.size().width as usize).step_by(17).flat_map(|x| (0..plane.size().height as usize).step_by(13).map(move |y| (x, y)))
    {
        let ray = plane.ray(PixelPoint::new(column as f64, row as f64)).unwrap();
        let (found, truth) = (map.place(column, row).unwrap(), splined.project(ray).unwrap());
        assert!(found.distance(truth) < 1e-3, "{column} {row}: {found:?} {truth:?}");
        dent = dent.max(truth.distance(flat.image(ray).unwrap()));
    }
    assert!(dent > 2.0, "{dent}");
}
