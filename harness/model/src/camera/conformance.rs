//! What every camera model must do: one check for all.

use std::fmt::Debug;

use super::{CameraModel, ImageSize, Ray, Reframe, Resampling, Slopes, Turn};
use crate::PixelPoint;

/// Places along each side of the frame.
const PLACES: (u32, u32) = (24, 18);

/// How the image of a straight line bends, at the corners: what tells a correction from a distortion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// The corners are drawn towards the axis.
    Barrel,
    /// The corners are pushed away from it.
    Pincushion,
    /// There is no distortion.
    Straight,
}

/// Checks `camera`, which has no fold inside its frame and whose corners are distorted as `shape` says.
///
/// Parameters come back through `with_parameters`; every pixel of a grid over the frame, with its corners, comes back from its ray to 1e-9 px; rays of any
/// length give the same pixel; derivatives by the ray and by every parameter agree with differences; no fold is reported; places that are none are refused; the
/// same camera in resampled and turned images pictures every ray where the image of it has come to, to 1e-9 px.
///
/// # Panics
/// With what the model did wrong.
pub fn check<C: CameraModel + Reframe + Debug + PartialEq>(camera: &C, shape: Shape) {
    let values: Vec<f64> = camera.parameters().iter().map(|parameter| parameter.value).collect();
    assert_eq!(&camera.with_parameters(&values), camera, "with_parameters of its own parameters");
    assert_eq!(super::fold(camera), None, "a fold in the frame of {camera:?}");
    for point in places(camera) {
        round_trip(camera, point);
    }
    for point in corners(camera) {
        direction(camera, point, shape);
    }
    for (column, row) in [(0.02, 0.03), (0.5, 0.4), (0.97, 0.1), (0.3, 0.99), (0.81, 0.77)] {
        let (width, height) = extent(camera);
        let ray = unproject(camera, PixelPoint::new(column * width, row * height));
        by_ray(camera, Ray { x: 1.7 * ray.x, y: 1.7 * ray.y, z: 1.7 * ray.z });
        by_parameters(camera, ray, &values);
    }
    refusals(camera);
    reframed(camera);
}

/// Of images of a frame: smaller and larger ones, by factors that leave a remainder too, parts of them, and columns and rows by factors of their own.
fn resamplings(from: ImageSize) -> [Resampling; 5] {
    let ImageSize { width, height } = from;
    let by = |offset, scale, [width, height]: [u32; 2]| Resampling { from, offset, scale, size: ImageSize { width, height } };
    [
        by([0.0; 2], [0.5; 2], [width / 2, height / 2]),
        by([0.0; 2], [2.5; 2], [5 * width / 2, 5 * height / 2]),
        by([37.0, 11.0], [1.0; 2], [width - 100, height - 60]),
        by([0.0, 64.0], [2.0 / 3.0; 2], [2 * width / 3, 2 * (height - 128) / 3]),
        by([5.0, 0.0], [0.8, 1.3], [4 * (width - 5) / 5, 13 * height / 10]),
    ]
}

/// Resampled and turned images, where the model says that it holds them.
fn reframed(camera: &(impl CameraModel + Reframe + Debug)) {
    let size = camera.size();
    let images = |made: &dyn CameraModel, ray: &dyn Fn(Ray) -> Ray, at: &dyn Fn(PixelPoint) -> PixelPoint, what: &dyn Debug| {
        for point in places(camera) {
            let found = made.project(ray(unproject(camera, point))).unwrap_or_else(|error| panic!("{what:?}, {point:?}: {error}"));
            let off = found.distance(at(point));
            assert!(off < 1e-9, "{what:?}: {point:?} of {camera:?} is {off:e} px off");
        }
    };
    for by in resamplings(size).iter().filter(|by| by.is_isotropic() || camera.has_two_scales()) {
        let made = camera.resampled(by);
        assert_eq!(made.size(), by.size, "{by:?}");
        images(&made, &|ray| ray, &|point| by.point(point), by);
    }
    for turn in Turn::ALL.into_iter().filter(|turn| camera.without_place(*turn).is_none()) {
        let made = camera.turned(turn);
        assert_eq!(made.size(), turn.size(size), "{turn:?}");
        images(&made, &|ray| turn.ray(ray), &|point| turn.point(size, point), &turn);
    }
}

/// Position of the last pixel's centre.
fn extent(camera: &impl CameraModel) -> (f64, f64) {
    (f64::from(camera.size().width - 1), f64::from(camera.size().height - 1))
}

fn places(camera: &impl CameraModel) -> Vec<PixelPoint> {
    let (width, height) = extent(camera);
    let (columns, rows) = PLACES;
    let along = |index: u32, count: u32, length: f64| length * f64::from(index) / f64::from(count - 1);
    (0..columns * rows).map(|i| PixelPoint::new(along(i % columns, columns, width), along(i / columns, rows, height))).collect()
}

fn corners(camera: &impl CameraModel) -> [PixelPoint; 4] {
    let (width, height) = extent(camera);
    [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)].map(|(x, y)| PixelPoint::new(x, y))
}

fn unproject(camera: &(impl CameraModel + Debug), point: PixelPoint) -> Ray {
    camera.unproject(point).unwrap_or_else(|error| panic!("{point:?} of {camera:?}: {error}"))
}

fn project(camera: &(impl CameraModel + Debug), ray: Ray) -> PixelPoint {
    camera.project(ray).unwrap_or_else(|error| panic!("{ray:?} of {camera:?}: {error}"))
}

fn round_trip(camera: &(impl CameraModel + Debug), point: PixelPoint) {
    let ray = unproject(camera, point);
    let off = project(camera, ray).distance(point);
    assert!(off < 1e-9, "{point:?} comes back {off:e} px off");
    let longer = project(camera, Ray { x: 3.0 * ray.x, y: 3.0 * ray.y, z: 3.0 * ray.z });
    assert!(longer.distance(point) < 1e-9, "a longer ray leads elsewhere: {longer:?} for {point:?}");
    let neighbour = PixelPoint::new(point.x + 0.02 * extent(camera).0, point.y - 0.01 * extent(camera).1);
    let near = camera.project_near(ray, neighbour).unwrap_or_else(|error| panic!("{ray:?} near {neighbour:?}: {error}"));
    assert!(near.distance(point) < 1e-9, "from nearby {point:?} is found elsewhere: {near:?}");
    // Right stays right and up stays up: no axis is swapped or mirrored.
    let axis = project(camera, Ray::from_tangent(0.0, 0.0));
    let (dx, dy) = (point.x - axis.x, axis.y - point.y);
    let forward = ray.x * dx + ray.y * dy;
    assert!(forward > 0.9 * dx.hypot(dy) * ray.x.hypot(ray.y) - 1.0, "{point:?} is seen in another direction: {ray:?}");
}

/// Compares a corner with what the camera would picture without distortion, by its derivatives on the axis.
fn direction(camera: &(impl CameraModel + Debug), corner: PixelPoint, shape: Shape) {
    let Some((right, up)) = unproject(camera, corner).tangent() else {
        return assert_eq!(shape, Shape::Barrel, "{corner:?} looks backwards");
    };
    let on_axis = camera.derivatives(Ray::from_tangent(0.0, 0.0)).unwrap_or_else(|error| panic!("the axis: {error}"));
    let straight = |row: usize| on_axis.by_ray[row][0] * right + on_axis.by_ray[row][1] * up;
    let distance = corner.distance(on_axis.point);
    let outwards = distance - straight(0).hypot(straight(1));
    let holds = match shape {
        Shape::Barrel => outwards < 0.0,
        Shape::Pincushion => outwards > 0.0,
        Shape::Straight => outwards.abs() < 1e-9,
    };
    assert!(holds, "{corner:?} lies {outwards} px outwards, expected {shape:?}");
}

fn agree(found: [f64; 2], difference: [f64; 2], tolerance: f64, what: &str) {
    let scale = found[0].hypot(found[1]).max(1.0);
    let off = (found[0] - difference[0]).hypot(found[1] - difference[1]);
    assert!(off <= tolerance * scale, "{what}: {found:?}, by differences {difference:?}");
}

/// Differences of fourth order: their error is far below that of a wrong term.
fn difference(at: impl Fn(f64) -> PixelPoint, h: f64) -> [f64; 2] {
    let (a, b, c, d) = (at(2.0 * h), at(h), at(-h), at(-2.0 * h));
    let of = |a: f64, b: f64, c: f64, d: f64| (8.0 * (b - c) - (a - d)) / (12.0 * h);
    [of(a.x, b.x, c.x, d.x), of(a.y, b.y, c.y, d.y)]
}

fn by_ray(camera: &(impl CameraModel + Debug), ray: Ray) {
    let found = camera.derivatives(ray).unwrap_or_else(|error| panic!("{ray:?}: {error}"));
    assert_eq!(camera.slopes(ray), Ok(Slopes { point: found.point, by_ray: found.by_ray }));
    assert!(found.point.distance(project(camera, ray)) < 1e-9, "derivatives and project disagree on {ray:?}");
    for axis in 0..3 {
        let at = |h: f64| {
            let step = |i: usize| if i == axis { h } else { 0.0 };
            project(camera, Ray { x: ray.x + step(0), y: ray.y + step(1), z: ray.z + step(2) })
        };
        agree([found.by_ray[0][axis], found.by_ray[1][axis]], difference(at, 1e-4), 1e-8, &format!("by axis {axis} of {ray:?}"));
    }
}

fn by_parameters<C: CameraModel + Debug>(camera: &C, ray: Ray, values: &[f64]) {
    let found = camera.derivatives(ray).unwrap_or_else(|error| panic!("{ray:?}: {error}"));
    assert_eq!(found.by_parameters.len(), values.len(), "derivatives of {camera:?}");
    for (i, (by, parameter)) in found.by_parameters.iter().zip(camera.parameters()).enumerate() {
        // A step that moves the point by a hundredth of a pixel at most.
        let h = 0.01 / by[0].hypot(by[1]).max(1.0);
        let at = |step: f64| {
            let mut changed = values.to_vec();
            changed[i] += step;
            project(&camera.with_parameters(&changed), ray)
        };
        agree(*by, difference(at, h), 1e-7, &format!("by {} of {ray:?}", parameter.name));
    }
}

fn refusals(camera: &impl CameraModel) {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(camera.unproject(PixelPoint::new(bad, 1.0)).is_err(), "a pixel at {bad}");
        assert!(camera.unproject(PixelPoint::new(1.0, bad)).is_err(), "a pixel at {bad}");
        assert!(camera.project(Ray { x: bad, y: 0.0, z: -1.0 }).is_err(), "a ray with x = {bad}");
        assert!(camera.project(Ray { x: 0.0, y: 0.0, z: f64::NAN }).is_err(), "a ray that is none");
    }
    for (z, what) in [(1.0, "a ray straight backwards"), (0.0, "a ray of no length")] {
        let ray = Ray { x: 0.0, y: 0.0, z };
        assert!(camera.project(ray).is_err() && camera.slopes(ray).is_err(), "{what}");
    }
}
