//! Outlines that cannot be followed curve by curve: flattened, cut at the camera's plane and brought into the plane of tangents.

use calibench_model::{Curve, Outline, Plate, Pose};
use nalgebra::Vector3;

use super::polygon::Tangent;

/// Chords that stand for a curve: of a quarter of a circle 1.2e-6 of its radius off.
const CHORDS: usize = 512;
/// What is nearer than this share of the outline's own distance is cut off: its tangents would be without bounds.
const NEAREST: f64 = 1e-6;

/// `outline` on `plate` in tangents, without what lies behind the camera.
pub(super) fn tangents(pose: &Pose, plate: &Plate, outline: &Outline) -> Vec<Tangent> {
    let mut points: Vec<Vector3<f64>> = Vec::new();
    for curve in &outline.0 {
        let n = if plate.bend.is_none() && matches!(curve, Curve::Line { .. }) { 1 } else { CHORDS };
        points.extend((0..n).map(|i| pose.camera_from_world(&plate.point(curve.at(i as f64 / n as f64)))));
    }
    let depth = points.iter().map(Vector3::norm).fold(0.0, f64::max) * NEAREST;
    before(&points, depth).iter().map(|p| [p.x / -p.z, p.y / -p.z]).collect()
}

/// The part of a polygon that lies at least `depth` before the camera.
fn before(points: &[Vector3<f64>], depth: f64) -> Vec<Vector3<f64>> {
    let mut kept = Vec::with_capacity(points.len() + 1);
    for (i, p) in points.iter().enumerate() {
        let next = &points[(i + 1) % points.len()];
        let (here, there) = (-p.z - depth, -next.z - depth);
        if here >= 0.0 {
            kept.push(*p);
        }
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            kept.push(p + (next - p) * (here / (here - there)));
        }
    }
    kept
}
