//! Views against rays that are followed one by one, and truth against geometry.

mod local;
mod rays;

use std::f64::consts::PI;

use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, OpenCvFisheye, Photogrammetric};
use calibench_model::testfield::axes;
use calibench_model::{Area, Bend, ObjectTarget, Outline, Plate, Pose, TargetKind, Testfield};
use nalgebra::{Point3, Vector3};

use super::{View, ViewError, Visibility};
use crate::optics::Optics;
use crate::raster::Renderer;

const SIZE: ImageSize = ImageSize { width: 120, height: 90 };

fn camera(k: [f64; 3]) -> Camera {
    // 5 um, 120 px wide: 0.6 mm; c = 0.5 mm is a wide angle.
    Photogrammetric { size: SIZE, pitch_um: 5.0, c: 0.5, x0: 0.011, y0: -0.007, k, p: [0.02, -0.01], b: [1e-3, 2e-3] }.into()
}

/// A plate in the plane z = `z` whose (0, 0) is at (`x`, `y`), with a disc, a slanted quadrilateral and a frame of two nested squares.
fn plate(id: &str, [x, y, z]: [f64; 3], half: f64, bend: Option<Bend>) -> Plate {
    let area = |outline, level, ground| Area { outline, level, ground };
    let areas = vec![
        area(Outline::disc([-0.4 * half, 0.3 * half], 0.25 * half), 0.1, 0.8),
        area(
            Outline::polygon(&[[0.1 * half, -0.5 * half], [0.7 * half, -0.3 * half], [0.5 * half, 0.4 * half], [0.0, 0.3 * half]]),
            0.3,
            0.8,
        ),
        area(Outline::rectangle([-0.9 * half, -0.9 * half], [-0.3 * half, -0.3 * half]), 0.2, 0.8),
        area(Outline::rectangle([-0.7 * half, -0.7 * half], [-0.5 * half, -0.5 * half]), 0.9, 0.2),
    ];
    let origin = Point3::new(x, y, z);
    Plate { id: id.into(), origin, u: Vector3::x(), v: Vector3::y(), bend, corners: [[-half, -half], [half, half]], level: 0.8, areas }
}

fn disc_target(plate: usize, half: f64) -> ObjectTarget {
    let at = [-0.4 * half, 0.3 * half];
    ObjectTarget {
        id: "d".into(),
        kind: TargetKind::Disc,
        plate,
        at,
        size: 0.5 * half,
        axes: axes(0.3),
        surveyed: Point3::origin(),
        room: None,
    }
}

fn field(plates: Vec<Plate>) -> Testfield {
    Testfield { plates, targets: Vec::new(), background: 0.5 }
}

fn pose(x: f64, y: f64, z: f64, roll: f64) -> Pose {
    Pose::looking_at(Point3::new(x, y, z), Point3::origin(), Vector3::y(), roll).unwrap()
}

/// The largest difference between the image and the mean of 16 x 16 rays a pixel.
fn difference(view: &View<'_>) -> f64 {
    let picture = view.picture(Optics::default().reach()).unwrap();
    let image = Renderer::new(&Optics::default(), picture.width, picture.height).unwrap().render(&picture, &[]);
    let expected = rays::image(view, 16);
    image.grey().iter().zip(&expected).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max)
}

/// An edge along a row of rays moves the mean by up to 1/16 of the contrast, twice that in a corner; contrasts are 0.7 at most.
const RAYS_ERROR: f64 = 0.088;

#[test]
fn views_agree_with_rays() {
    let front = field(vec![plate("a", [0.0, 0.0, 0.0], 1.0, None)]);
    for (name, camera) in [("pinhole", camera([0.0; 3])), ("barrel", camera([-0.9, 0.4, 0.0])), ("pincushion", camera([0.7, 0.0, 0.0]))] {
        for pose in [pose(0.1, 0.2, 2.5, 0.4), pose(2.0, -0.9, 1.6, -1.3), pose(0.05, 0.1, 0.8, 2.0)] {
            let view = View { field: &front, camera: &camera, local: None, pose: &pose };
            let difference = difference(&view);
            assert!(difference < RAYS_ERROR, "{name} {pose:?}: {difference}");
        }
    }
}

#[test]
fn plates_hide_what_is_behind_them() {
    let plates = vec![
        plate("wall", [0.0, 0.0, 0.0], 1.2, None),
        plate("near", [0.3, -0.1, 0.6], 0.4, None),
        plate("nearer", [0.55, 0.1, 0.9], 0.25, None),
        plate("turned away", [-0.6, 0.5, 0.5], 0.3, None),
    ];
    let mut field = field(plates);
    field.plates[3].v = -field.plates[3].v;
    let camera = camera([-0.9, 0.4, 0.0]);
    for pose in [pose(0.3, 0.2, 2.6, 0.1), pose(1.4, -0.9, 2.0, -0.7), pose(-0.6, 0.3, 1.8, 2.0)] {
        let view = View { field: &field, camera: &camera, local: None, pose: &pose };
        let difference = difference(&view);
        assert!(difference < RAYS_ERROR, "{pose:?}: {difference}");
    }
}

#[test]
fn a_wall_that_runs_past_the_camera_is_cut() {
    // The camera stands close to a long wall and looks along it: part of the wall is behind it.
    let mut wall = plate("wall", [0.0, 0.0, 0.0], 30.0, None);
    wall.areas.push(Area { outline: Outline::disc([6.0, 1.0], 0.8), level: 0.0, ground: 0.8 });
    let field = field(vec![wall]);
    let camera = camera([-0.9, 0.4, 0.0]);
    let pose = Pose::looking_at(Point3::new(2.0, 0.5, 1.0), Point3::new(6.0, 0.7, 0.2), Vector3::y(), 0.0).unwrap();
    let difference = difference(&View { field: &field, camera: &camera, local: None, pose: &pose });
    assert!(difference < RAYS_ERROR, "{difference}");
}

#[test]
fn curves_are_followed_to_a_hundred_thousandth_of_a_pixel() {
    let bend = Bend { peak: 0.2, middle: [0.1, 0.0], across: 0.4, reach: 1.0, along: 0.0 };
    let field = field(vec![plate("a", [0.0, 0.0, 0.0], 1.0, Some(bend))]);
    let (camera, pose) = (camera([-0.9, 0.4, 0.0]), pose(0.9, -0.5, 2.2, 0.4));
    let view = View { field: &field, camera: &camera, local: None, pose: &pose };
    let picture = view.picture(5.0).unwrap();
    let plate = &field.plates[0];
    // Every point of every outline lies on some piece.
    let outlines = plate.areas.iter().map(|area| &area.outline).chain([&plate.border()]).cloned().collect::<Vec<_>>();
    let (mut worst, mut inside) = (0.0_f64, 0);
    for curve in outlines.iter().flat_map(|outline| &outline.0) {
        for i in 0..50 {
            let at = camera.project(pose.ray(&plate.point(curve.at((f64::from(i) + 0.37) / 50.0)))).unwrap();
            if at.x < 0.0 || at.y < 0.0 || at.x > 119.0 || at.y > 89.0 {
                continue;
            }
            inside += 1;
            let nearest = picture.pieces.iter().map(|piece| rays::distance(piece, [at.x, at.y])).fold(f64::INFINITY, f64::min);
            worst = worst.max(nearest);
        }
    }
    assert!(worst < 1.5e-5 && inside > 500, "{worst:e} of {inside}");
    assert!(picture.pieces.len() < 1000, "and not with too many pieces: {}", picture.pieces.len());
}

#[test]
fn a_disc_has_its_centre_and_its_ellipse() {
    let mut field = field(vec![plate("a", [0.0, 0.0, 0.0], 1.0, None)]);
    field.targets.push(disc_target(0, 1.0));
    let size = ImageSize { width: 1200, height: 900 };
    let camera = OpenCv { size, fx: 1000.0, fy: 990.0, cx: 590.0, cy: 460.0, distortion: [0.0; 14], coefficients: 5 }.into();
    let pose = pose(1.6, -0.9, 1.9, 0.4);
    let view = View { field: &field, camera: &camera, local: None, pose: &pose };
    let truth = &view.seen(5.0).unwrap().truth()[0];
    let at = camera.project(pose.ray(&field.position(&field.targets[0]))).unwrap();
    assert_eq!((truth.at, truth.visibility), (Some(at), Visibility::Visible));
    let ellipse = truth.ellipse.unwrap();
    assert!(ellipse.centre.distance(at) > 0.5, "the eccentricity: {}", ellipse.centre.distance(at));
    let (sine, cosine) = ellipse.angle.sin_cos();
    for i in 0..100 {
        let (s, c) = (2.0 * PI * f64::from(i) / 100.0).sin_cos();
        let rim = field.plates[0].point([-0.4 + 0.25 * c, 0.3 + 0.25 * s]);
        let p = camera.project(pose.ray(&rim)).unwrap();
        let (dx, dy) = (p.x - ellipse.centre.x, p.y - ellipse.centre.y);
        let form = ((dx * cosine + dy * sine) / ellipse.axes[0]).powi(2) + ((dy * cosine - dx * sine) / ellipse.axes[1]).powi(2);
        assert!((form - 1.0).abs() < 1e-9, "{form}");
    }
    // The affine part: a step of a thousandth of the size to the target's own right and down.
    let (affine, (sine, cosine)) = (truth.affine.unwrap(), 0.3_f64.sin_cos());
    let (h, [u, v]) = (1e-4, field.targets[0].at);
    let step = |du: f64, dv: f64| camera.project(pose.ray(&field.plates[0].point([u + 0.5 * h * du, v + 0.5 * h * dv]))).unwrap();
    let (right, down) = (step(cosine, sine), step(sine, -cosine));
    for (value, expected) in [
        (affine.axx, (right.x - at.x) / h),
        (affine.ayx, (right.y - at.y) / h),
        (affine.axy, (down.x - at.x) / h),
        (affine.ayy, (down.y - at.y) / h),
    ] {
        assert!((value - expected).abs() < 1e-3 * 200.0, "{value} {expected}");
    }
}

/// Where distortion bends the outline, and where the plate does, the ellipse has the centroid and second moments of the picture: of a polygon of ten thousand
/// places of the outline.
#[test]
fn a_disc_under_distortion_has_the_moments_of_its_picture() {
    let bend = Bend { peak: 0.2, middle: [0.1, 0.0], across: 0.4, reach: 1.0, along: 0.0 };
    for bend in [None, Some(bend)] {
        let mut field = field(vec![plate("a", [0.0, 0.0, 0.0], 1.0, bend)]);
        field.targets.push(disc_target(0, 1.0));
        let size = ImageSize { width: 1200, height: 900 };
        let mut distortion = [0.0; 14];
        distortion[..2].copy_from_slice(&[-0.4, 0.1]);
        let camera: Camera = OpenCv { size, fx: 700.0, fy: 690.0, cx: 390.0, cy: 460.0, distortion, coefficients: 5 }.into();
        let pose = pose(1.2, -0.9, 1.9, 0.4);
        let view = View { field: &field, camera: &camera, local: None, pose: &pose };
        let ellipse = view.seen(5.0).unwrap().truth()[0].ellipse.unwrap();
        let places: Vec<[f64; 2]> = (0..10_000)
            .map(|i| {
                let (s, c) = (2.0 * PI * f64::from(i) / 10_000.0).sin_cos();
                let at = camera.project(pose.ray(&field.plates[0].point([-0.4 + 0.25 * c, 0.3 + 0.25 * s]))).unwrap();
                [at.x - ellipse.centre.x, at.y - ellipse.centre.y]
            })
            .collect();
        let (mut area, mut first, mut second) = (0.0, [0.0; 2], [0.0; 3]);
        for (a, b) in places.iter().zip(places.iter().cycle().skip(1)) {
            let cross = a[0] * b[1] - b[0] * a[1];
            area += cross / 2.0;
            first = [0, 1].map(|i| first[i] + cross * (a[i] + b[i]) / 6.0);
            let product = |i: usize, j: usize| cross * (2.0 * (a[i] * a[j] + b[i] * b[j]) + a[i] * b[j] + b[i] * a[j]) / 24.0;
            second = [second[0] + product(0, 0), second[1] + product(0, 1), second[2] + product(1, 1)];
        }
        let [a2, b2] = ellipse.axes.map(|axis| axis * axis / 4.0);
        let (sine, cosine) = ellipse.angle.sin_cos();
        let expected = [a2 * cosine * cosine + b2 * sine * sine, (a2 - b2) * sine * cosine, a2 * sine * sine + b2 * cosine * cosine];
        assert!(first.iter().all(|moment| (moment / area).abs() < 1e-5), "{:?} px off", first.map(|moment| moment / area));
        assert!(second.iter().zip(expected).all(|(found, told)| (found / area - told).abs() < 1e-5 * a2), "{second:?} {area} {expected:?}");
        assert!(ellipse.axes[0] > 60.0, "a large one: {:?}", ellipse.axes);
    }
}

#[test]
fn what_is_not_seen_is_said() {
    let mut field = field(vec![plate("wall", [0.0, 0.0, 0.0], 1.0, None), plate("near", [-0.3, 0.3, 0.5], 0.3, None)]);
    field.plates[1].areas.clear();
    field.targets.push(disc_target(0, 1.0));
    let camera = camera([0.0; 3]);
    let seen = |pose: Pose| View { field: &field, camera: &camera, local: None, pose: &pose }.seen(3.0).unwrap().truth()[0].visibility;
    assert_eq!(seen(pose(-0.4, 0.3, 2.0, 0.0)), Visibility::Hidden);
    assert_eq!(seen(pose(1.5, -1.5, 2.0, 0.0)), Visibility::Visible);
    assert_eq!(seen(pose(1.4, 0.3, 2.0, 0.0)), Visibility::Clipped, "the near plate hides a part");
    assert_eq!(seen(Pose::from_angles(Point3::new(3.0, 0.0, 2.0), [0.0; 3])), Visibility::Outside);
    assert_eq!(seen(pose(0.0, 0.0, -2.0, 0.0)), Visibility::Hidden, "from behind");
}

#[test]
fn views_that_cannot_be_pictured_are_named() {
    let wall = field(vec![plate("wall", [0.0, 0.0, 0.0], 1.0, None)]);
    let (plain, ahead) = (camera([0.0; 3]), pose(0.0, 0.1, 2.0, 0.0));
    let picture = |field: &Testfield, camera: &Camera, pose: &Pose| View { field, camera, local: None, pose }.picture(4.0).unwrap_err();
    let away = Pose::from_angles(Point3::new(0.0, 0.0, -2.0), [0.0; 3]);
    assert_eq!(picture(&wall, &plain, &away), ViewError::Behind);
    let folded = camera([9.0, 0.0, 0.0]);
    assert!(matches!(picture(&wall, &folded, &ahead), ViewError::Fold { .. }));
    // Equidistant: the corner of 800 px and what lies 6 px beyond it.
    let size = ImageSize { width: 1280, height: 960 };
    let fisheye = |f: f64| Camera::from(OpenCvFisheye { size, fx: f, fy: f, cx: 639.5, cy: 479.5, skew: 0.0, k: [0.0; 4] });
    let ViewError::Wide { angle, .. } = picture(&wall, &fisheye(480.0), &ahead) else { panic!("95 degrees") };
    assert!((angle - 96.5).abs() < 0.5, "{angle}");
    assert!(View { field: &wall, camera: &fisheye(560.0), local: None, pose: &ahead }.picture(4.0).is_ok());
    let bend = Bend { peak: 0.05, middle: [0.0, 0.0], across: 0.0, reach: 0.4, along: 0.0 };
    let bent = field(vec![plate("wall", [0.0, 0.0, 0.0], 1.0, None), plate("paper", [0.0, 0.0, 0.5], 0.4, Some(bend))]);
    assert_eq!(picture(&bent, &plain, &ahead), ViewError::BentBefore { front: "paper".into(), back: "wall".into() });
    let mut crossing = field(vec![plate("wall", [0.0, 0.0, 0.0], 1.0, None), plate("across", [0.0, 0.0, 0.0], 0.5, None)]);
    crossing.plates[1].u = Vector3::new(0.8, 0.0, 0.6);
    assert!(matches!(picture(&crossing, &plain, &ahead), ViewError::Cut(..)));
    let edge_on = Pose::looking_at(Point3::new(3.0, 0.0, 0.0), Point3::origin(), Vector3::y(), 0.0).unwrap();
    let seen =
        picture(&field(vec![plate("wall", [0.0, 0.0, 0.0], 1.0, None), plate("back", [0.0, 0.0, -0.5], 1.0, None)]), &plain, &edge_on);
    assert_eq!(seen, ViewError::EdgeOn("wall".into()));
}
