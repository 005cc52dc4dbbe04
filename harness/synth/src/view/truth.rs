//! What is known about each target in an image.

use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::{Affine, ObjectTarget, PixelPoint, TargetKind};
use nalgebra::{Matrix2, Matrix3, Point3, Vector3};

use super::View;
use super::occlusion::Sheet;

/// How much of a target is in the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// All of it.
    Visible,
    /// Its reference point, and not all of the rest.
    Clipped,
    /// Its reference point is behind another plate, on a side turned away, or behind the camera.
    Hidden,
    /// Its reference point is outside the frame.
    Outside,
}

impl Visibility {
    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Visible => "visible",
            Self::Clipped => "clipped",
            Self::Hidden => "hidden",
            Self::Outside => "outside",
        }
    }
}

/// The picture of a disc: the ellipse of the distortion-free image, carried over by the distortion's affine part at its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// The image of the ellipse's centre, which is not that of the disc's.
    pub centre: PixelPoint,
    /// Semi-axes, the longer first, px.
    pub axes: [f64; 2],
    /// The direction of the longer axis, from x towards y, radians, in (-pi/2, pi/2].
    pub angle: f64,
}

/// A target in an image.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetTruth {
    /// Its reference point through the full camera model; `None` if it has no place in the image plane.
    pub at: Option<PixelPoint>,
    /// How much of it is in the image.
    pub visibility: Visibility,
    /// The affine part of the map from the target's own axes, in units of its size and y down, to the image, px.
    pub affine: Option<Affine>,
    /// For a disc on a flat plate.
    pub ellipse: Option<Ellipse>,
}

/// The truth about `target`, which is on `sheet`, if that is in the image.
pub(super) fn truth(view: &View<'_>, target: &ObjectTarget, sheet: Option<&Sheet<'_>>) -> TargetTruth {
    let point = view.field.position(target);
    let at = view.camera.project(view.pose.ray(&point)).ok();
    let visibility = at.map_or(Visibility::Hidden, |at| visibility(view, target, sheet, &point, at));
    let affine = at.and_then(|_| affine(view, target));
    let ellipse = if target.kind == TargetKind::Disc && at.is_some() { ellipse(view, target) } else { None };
    TargetTruth { at, visibility, affine, ellipse }
}

fn visibility(view: &View<'_>, target: &ObjectTarget, sheet: Option<&Sheet<'_>>, point: &Point3<f64>, at: PixelPoint) -> Visibility {
    // Without a sheet the whole plate is outside the frame.
    let shows = |point: &Point3<f64>| sheet.is_none_or(|sheet| sheet.shows(view, point));
    if !shows(point) {
        Visibility::Hidden
    } else if !inside(view, at) {
        Visibility::Outside
    } else if rim(view, target).all(|p| shows(&p) && is_in_frame(view, &p)) {
        Visibility::Visible
    } else {
        Visibility::Clipped
    }
}

fn inside(view: &View<'_>, at: PixelPoint) -> bool {
    let size = view.camera.size();
    let within = |value: f64, side: u32| value >= -0.5 && value <= f64::from(side) - 0.5;
    within(at.x, size.width) && within(at.y, size.height)
}

fn is_in_frame(view: &View<'_>, point: &Point3<f64>) -> bool {
    view.camera.project(view.pose.ray(point)).is_ok_and(|at| inside(view, at))
}

/// Points around the target, at half its size.
fn rim<'a>(view: &'a View<'_>, target: &'a ObjectTarget) -> impl Iterator<Item = Point3<f64>> + 'a {
    let plate = &view.field.plates[target.plate];
    (0..16).map(move |i| {
        let (sine, cosine) = (f64::from(i) * std::f64::consts::FRAC_PI_8).sin_cos();
        let [u, v] = target.at;
        plate.point([u + 0.5 * target.size * cosine, v + 0.5 * target.size * sine])
    })
}

/// d(pixel) / d(object), px per object unit.
fn by_object(view: &View<'_>, point: &Point3<f64>) -> Option<nalgebra::Matrix2x3<f64>> {
    let derivatives = view.camera.derivatives(view.pose.ray(point)).ok()?;
    let [[a, b, c], [d, e, f]] = derivatives.by_ray;
    Some(nalgebra::Matrix2x3::new(a, b, c, d, e, f) * view.pose.rotation)
}

fn affine(view: &View<'_>, target: &ObjectTarget) -> Option<Affine> {
    let plate = &view.field.plates[target.plate];
    let by_object = by_object(view, &view.field.position(target))?;
    // The tangent plane of a bent plate, by differences that are exact for its parabola.
    let [u, v] = target.at;
    let h = 1e-3 * target.size;
    let along = |du: f64, dv: f64| (plate.point([u + du, v + dv]) - plate.point([u - du, v - dv])) / (2.0 * h);
    let (by_u, by_v) = (along(h, 0.0), along(0.0, h));
    let [own_u, own_v] = target.axes.map(|[u, v]| by_object * (by_u * u + by_v * v) * target.size);
    Some(Affine { axx: own_u.x, axy: own_v.x, ayx: own_u.y, ayy: own_v.y })
}

/// The picture of a disc on a flat plate.
fn ellipse(view: &View<'_>, target: &ObjectTarget) -> Option<Ellipse> {
    let plate = &view.field.plates[target.plate];
    if plate.bend.is_some() {
        return None;
    }
    let centre = view.pose.camera_from_world(&view.field.position(target));
    let radius = target.size / 2.0;
    let (u, v) = (view.pose.rotation * plate.u * radius, view.pose.rotation * plate.v * radius);
    // From the unit circle of the plate to tangents: (a, b, 1) -> (X, Y, -Z).
    let flip = |p: Vector3<f64>| Vector3::new(p.x, p.y, -p.z);
    let to_tangent = Matrix3::from_columns(&[flip(u), flip(v), flip(centre)]);
    let inverse = to_tangent.try_inverse()?;
    let conic = inverse.transpose() * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0)) * inverse;
    let quadratic = Matrix2::new(conic[(0, 0)], conic[(0, 1)], conic[(1, 0)], conic[(1, 1)]);
    let middle = -(quadratic.try_inverse()? * nalgebra::Vector2::new(conic[(0, 2)], conic[(1, 2)]));
    let scale = -(conic[(2, 2)] + middle.x * conic[(0, 2)] + middle.y * conic[(1, 2)]);
    // x^T (quadratic / scale) x = 1 around the middle; its inverse is the ellipse's own matrix.
    let shape = (quadratic / scale).try_inverse()?;
    let at = view.camera.project(Ray::from_tangent(middle.x, middle.y)).ok()?;
    let by = tangent_derivatives(view.camera, middle.x, middle.y)?;
    let shape = (by * shape * by.transpose()).symmetric_eigen();
    let (long, short) = if shape.eigenvalues[0] >= shape.eigenvalues[1] { (0, 1) } else { (1, 0) };
    if shape.eigenvalues[short] <= 0.0 {
        return None;
    }
    let axis = shape.eigenvectors.column(long);
    let angle = (axis[1] / axis[0]).atan();
    Some(Ellipse { centre: at, axes: [shape.eigenvalues[long].sqrt(), shape.eigenvalues[short].sqrt()], angle })
}

/// d(pixel) / d(tangent).
fn tangent_derivatives(camera: &Camera, x: f64, y: f64) -> Option<Matrix2<f64>> {
    let [[a, b, _], [c, d, _]] = camera.derivatives(Ray::from_tangent(x, y)).ok()?.by_ray;
    Some(Matrix2::new(a, b, c, d))
}
