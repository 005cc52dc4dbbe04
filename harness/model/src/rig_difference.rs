//! How far two rigs differ in what they are used for: places of points that two cameras see, and where one camera's points are looked for in the other.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::camera::{Camera, CameraModel};
use crate::frames::PixelPoint;
use crate::named_camera::{NamedCamera, Pose};

/// Columns and rows of the grid over the frame of the first camera.
const GRID: (u32, u32) = (21, 15);

/// How far a pair of cameras of one rig differs from that of another.
#[derive(Clone, Debug, PartialEq)]
pub struct RigDifference {
    /// How far apart the second cameras sit as the first ones see them, units of the rigs.
    pub moved: f64,
    /// The length of the baselines, first and second rig.
    pub baselines: [f64; 2],
    /// By what angle they are turned, degrees.
    pub turned_deg: f64,
    /// Of points at the distance that both cameras of the first rig picture: by how much the second rig has them elsewhere, RMS and at most, in units of the rigs.
    pub at_distance: [f64; 2],
    /// By how much the second rig pictures them elsewhere in its second camera, RMS and at most, px.
    pub px: [f64; 2],
    /// How many points that were.
    pub points: usize,
}

/// The second cameras against the first ones, at `distance` along the axis of the first rig's first camera. Axes are x right, y down, z forward.
///
/// # Errors
/// Cameras without poses, or that picture no common point at that distance, in words.
pub fn rig_difference(first: [&NamedCamera; 2], second: [&NamedCamera; 2], distance: f64) -> Result<RigDifference, String> {
    let (a, b) = (Pair::of(first)?, Pair::of(second)?);
    let (size, mut points) = (first[0].camera.size(), 0);
    let (mut off, mut px) = ([0.0_f64; 2], [0.0_f64; 2]);
    for (column, row) in (0..GRID.1).flat_map(|row| (0..GRID.0).map(move |column| (column, row))) {
        let part = |i: u32, of: u32, side: u32| f64::from(i) / f64::from(of - 1) * f64::from(side - 1);
        let at = PixelPoint::new(part(column, GRID.0, size.width), part(row, GRID.1, size.height));
        let Some((own, elsewhere)) = a.at(at, distance).and_then(|(point, other)| Some((point, b.seen(at, other, distance)?))) else {
            continue;
        };
        let (place, apart) = elsewhere;
        points += 1;
        let length = (place - own).norm();
        (off[0], off[1]) = (off[0] + length * length, off[1].max(length));
        (px[0], px[1]) = (px[0] + apart * apart, px[1].max(apart));
    }
    if points == 0 {
        return Err(format!("no point at a distance of {distance} is in the images of both cameras"));
    }
    let rms = |of: [f64; 2]| [(of[0] / points as f64).sqrt(), of[1]];
    // The angle of a matrix by its trace is lost where it is small.
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(b.rotation * a.rotation.transpose()));
    Ok(RigDifference {
        moved: (b.centre - a.centre).norm(),
        baselines: [a.centre.norm(), b.centre.norm()],
        turned_deg: turn.angle().to_degrees(),
        at_distance: rms(off),
        px: rms(px),
        points,
    })
}

/// Two cameras; the second as the first sees it.
struct Pair {
    cameras: [Camera; 2],
    rotation: Matrix3<f64>,
    centre: Vector3<f64>,
}

impl Pair {
    fn of([first, second]: [&NamedCamera; 2]) -> Result<Self, String> {
        let pose = |named: &NamedCamera| named.pose.ok_or_else(|| format!("camera `{}` has no pose in its rig", named.name));
        let Pose { camera_from_world, position } = pose(second)?.seen_from(&pose(first)?);
        let rotation = Matrix3::from_fn(|i, j| camera_from_world[i][j]);
        Ok(Self { cameras: [first.camera, second.camera], rotation, centre: position.into() })
    }

    /// The direction of what is pictured, axes y down, z forward.
    fn direction(&self, camera: usize, at: PixelPoint) -> Option<Vector3<f64>> {
        let ray = self.cameras[camera].unproject(at).ok()?;
        Some(Vector3::new(ray.x, -ray.y, -ray.z))
    }

    /// Where a point in the axes of the first camera is pictured by the second, inside its frame.
    fn second(&self, point: &Vector3<f64>) -> Option<PixelPoint> {
        let n = self.rotation * (point - self.centre);
        self.cameras[1].project(crate::camera::Ray { x: n.x, y: -n.y, z: -n.z }).ok()
    }

    /// The point at a distance that the first camera pictures at a place, and where the second does, if inside its frame.
    fn at(&self, at: PixelPoint, distance: f64) -> Option<(Vector3<f64>, PixelPoint)> {
        let point = before(self.direction(0, at)?, distance)?;
        let size = self.cameras[1].size();
        let inside = |p: &PixelPoint| p.x >= 0.0 && p.y >= 0.0 && p.x <= f64::from(size.width - 1) && p.y <= f64::from(size.height - 1);
        Some((point, self.second(&point).filter(inside)?))
    }

    /// The point that both picture at two places, midway between the rays, and how far from the second place the point at the distance on the first ray is pictured, px.
    fn seen(&self, first: PixelPoint, second: PixelPoint, distance: f64) -> Option<(Vector3<f64>, f64)> {
        let (a, b) = (self.direction(0, first)?, self.rotation.transpose() * self.direction(1, second)?);
        // a s - b t = centre, by least squares.
        let (aa, ab, bb) = (a.dot(&a), a.dot(&b), b.dot(&b));
        let determinant = aa * bb - ab * ab;
        let (ac, bc) = (a.dot(&self.centre), b.dot(&self.centre));
        let (s, t) = ((bb * ac - ab * bc) / determinant, (ab * ac - aa * bc) / determinant);
        let place = (a * s + self.centre + b * t) * 0.5;
        let there = self.second(&before(a, distance)?)?;
        place.iter().all(|v| v.is_finite()).then(|| (place, there.distance(second)))
    }
}

fn before(direction: Vector3<f64>, distance: f64) -> Option<Vector3<f64>> {
    (direction.z > 0.0).then(|| direction * (distance / direction.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{ImageSize, OpenCv};

    fn camera(f: f64, pose: Pose) -> NamedCamera {
        let size = ImageSize { width: 1001, height: 801 };
        let camera = OpenCv { size, fx: f, fy: f, cx: 500.0, cy: 400.0, distortion: [0.0; 14], coefficients: 5 };
        NamedCamera { pose: Some(pose), ..NamedCamera::new("", camera.into()) }
    }

    /// The normal case: a longer baseline puts points further away in its proportion, and shifts them by c db / D.
    #[test]
    fn a_longer_baseline_is_what_the_normal_case_says() {
        let at = |x: f64| Pose { position: [x, 0.0, 0.0], ..Pose::IDENTITY };
        let (one, two, other) = (camera(1000.0, Pose::IDENTITY), camera(1000.0, at(0.2)), camera(1000.0, at(0.202)));
        let same = rig_difference([&one, &two], [&one, &two], 2.0).unwrap();
        assert!(
            same.moved == 0.0 && same.turned_deg == 0.0 && same.at_distance[1] < 1e-12 && same.px[1] < 1e-9 && same.points > 200,
            "{same:?}"
        );
        let found = rig_difference([&one, &two], [&one, &other], 2.0).unwrap();
        assert!((found.px[0] - 1000.0 * 0.002 / 2.0).abs() < 1e-9 && (found.moved - 0.002).abs() < 1e-15, "{found:?}");
        // On the axis by D db / b; off it a little more.
        assert!((0.02..0.024).contains(&found.at_distance[0]), "{found:?}");
        let alone = NamedCamera { pose: None, ..one.clone() };
        assert!(rig_difference([&one, &two], [&alone, &two], 2.0).is_err());
        assert!(rig_difference([&one, &camera(1000.0, at(50.0))], [&one, &two], 2.0).unwrap_err().contains("no point"));
    }
}
