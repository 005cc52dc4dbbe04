//! What is known about each target in an image.

use calibench_model::camera::CameraModel;
use calibench_model::testfield::PlatePoint;
use calibench_model::{Affine, ObjectTarget, PixelPoint, Plate, TargetKind};
use nalgebra::{Point3, Vector3};

use super::View;
use super::disc::ellipse;
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

/// The picture of a disc through the full camera model: the ellipse of the same area's centroid and second moments. Without distortion, on a flat plate, it is
/// the outline itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// The centroid of the picture, which is not that of the disc's centre.
    pub centre: PixelPoint,
    /// Semi-axes, the longer first, px.
    pub axes: [f64; 2],
    /// The direction of the longer axis, from x towards y, radians, in (-pi/2, pi/2].
    pub angle: f64,
}

/// A target in an image.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetTruth {
    /// Where its reference point is in object space before this camera, object units.
    pub object: Point3<f64>,
    /// Its reference point through the full camera model; `None` if it has no place in the image plane.
    pub at: Option<PixelPoint>,
    /// How much of it is in the image.
    pub visibility: Visibility,
    /// The affine part of the map from the target's own axes, in units of its size and y down, to the image, px.
    pub affine: Option<Affine>,
    /// For a disc.
    pub ellipse: Option<Ellipse>,
    /// The half side of the largest upright square of the image around it that holds nothing of anything else, px; where that is known.
    pub room: Option<f64>,
}

/// The truth about `target`, which is on `sheet`, if that is in the image.
pub(super) fn truth(view: &View<'_>, target: &ObjectTarget, sheet: Option<&Sheet<'_>>) -> TargetTruth {
    let point = view.field.position(target);
    let at = view.project(&point).ok();
    let visibility = at.map_or(Visibility::Hidden, |at| visibility(view, target, sheet, &point, at));
    let affine = at.and_then(|_| affine(view, target));
    let ellipse = if target.kind == TargetKind::Disc && at.is_some() { ellipse(view, target) } else { None };
    let room = affine.and_then(|affine| room(&affine, target));
    TargetTruth { object: point, at, visibility, affine, ellipse, room }
}

/// Of the largest window whose corners lie in the free square around a target.
fn room(affine: &Affine, target: &ObjectTarget) -> Option<f64> {
    let Affine { axx, axy, ayx, ayy } = *affine;
    let determinant = (axx * ayy - axy * ayx).abs();
    // How far a corner of a window of half side 1 px is from the middle along an axis of the target, in units of its size.
    let reach = (ayy.abs() + axy.abs()).max(ayx.abs() + axx.abs()) / determinant;
    target.room.map(|room| room / target.size / reach).filter(|room| room.is_finite())
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
    view.project(point).is_ok_and(|at| inside(view, at))
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

/// The directions along u and v of a plate's tangent plane at a place of it, by differences over `h` that are exact for the parabola of a bent one.
pub(super) fn tangents(plate: &Plate, [u, v]: PlatePoint, h: f64) -> [Vector3<f64>; 2] {
    let along = |du: f64, dv: f64| (plate.point([u + du, v + dv]) - plate.point([u - du, v - dv])) / (2.0 * h);
    [along(h, 0.0), along(0.0, h)]
}

fn affine(view: &View<'_>, target: &ObjectTarget) -> Option<Affine> {
    let plate = &view.field.plates[target.plate];
    let by_object = view.by_object(&view.field.position(target))?;
    let [by_u, by_v] = tangents(plate, target.at, 1e-3 * target.size);
    let [own_u, own_v] = target.axes.map(|[u, v]| by_object * (by_u * u + by_v * v) * target.size);
    Some(Affine { axx: own_u.x, axy: own_v.x, ayx: own_u.y, ayy: own_v.y })
}
