//! The share of a testfield that a station sees.

use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{ObjectTarget, Pose, Testfield};

use super::{Station, StationError};

/// The fraction (0 to 1) of the field's targets whose reference points are inside the frame and on the side of their sheet that faces the camera.
///
/// Sheets that hide each other are not looked at. Zero for a field without targets.
pub fn sees(camera: &Camera, pose: &Pose, field: &Testfield) -> f64 {
    if field.targets.is_empty() {
        return 0.0;
    }
    count(camera, pose, field) as f64 / field.targets.len() as f64
}

/// Refuses the first station, by name, that sees less than the `least` fraction (0 to 1) of the targets, or none.
///
/// # Errors
/// [`StationError::Unseen`].
pub fn check_sight(camera: &Camera, stations: &[Station], field: &Testfield, least: f64) -> Result<(), StationError> {
    let all = field.targets.len();
    let least = ((least * all as f64).ceil() as usize).clamp(1, all.max(1));
    for station in stations {
        let seen = count(camera, &station.pose, &station.field(field));
        if seen < least {
            return Err(StationError::Unseen { name: station.name.clone(), seen, all, least });
        }
    }
    Ok(())
}

fn count(camera: &Camera, pose: &Pose, field: &Testfield) -> usize {
    field.targets.iter().filter(|target| is_seen(camera, pose, field, target)).count()
}

fn is_seen(camera: &Camera, pose: &Pose, field: &Testfield, target: &ObjectTarget) -> bool {
    let point = field.position(target);
    let faces = field.plates[target.plate].normal().dot(&(pose.centre - point)) > 0.0;
    let size = camera.size();
    faces
        && camera.project(pose.ray(&point)).is_ok_and(|pixel| {
            let corner = pixel.to_corner();
            corner.x >= 0.0 && corner.y >= 0.0 && corner.x <= f64::from(size.width) && corner.y <= f64::from(size.height)
        })
}
