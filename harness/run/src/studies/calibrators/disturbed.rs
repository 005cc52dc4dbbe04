//! What is wrong with the points of a trial.

use std::f64::consts::TAU;

use calibench_calibrators::TaskImage;
use calibench_model::camera::{CameraModel, Ray};
use calibench_model::{PixelPoint, Pose};
use calibench_random::{Key, Purpose, stream};
use calibench_scenario::ViewsSubject;
use calibench_scenario::studies::calibrators::Faults;
use calibench_synth::stations::Station;
use rand::RngExt;

/// How often the row of a point is found anew in an image that is read out while the camera moves.
const ROUNDS: usize = 8;

/// Puts `faults` into the image points of the trial of `key`: `images` are those of `stations`, in their order. What is drawn depends on the names of image and target
/// alone.
pub fn disturb(faults: &Faults, subject: &ViewsSubject, stations: &[Station], images: &mut [TaskImage], key: Key<'_>) {
    for (place, (image, station)) in images.iter_mut().zip(stations).enumerate() {
        for (target, at) in &mut image.points {
            let object = subject.field.position(&subject.field.targets[*target]);
            let mut moved = [0.0; 2];
            if faults.shutter != 0.0 {
                add(&mut moved, by_shutter(subject, &station.pose, &object, faults.shutter));
            }
            if faults.other_c != 1.0 && place % 2 == 1 {
                add(&mut moved, by_other(subject, *at, faults.other_c));
            }
            if faults.gross > 0.0 {
                let key = Key { view: &station.name, target: &subject.field.targets[*target].id, ..key };
                add(&mut moved, gross(faults, key));
            }
            *at = PixelPoint::new(at.x + moved[0], at.y + moved[1]);
        }
        if faults.exchanged > 0.0 {
            exchange(faults.exchanged, image, Key { view: &station.name, ..key });
        }
    }
}

fn add(moved: &mut [f64; 2], [x, y]: [f64; 2]) {
    moved[0] += x;
    moved[1] += y;
}

/// How far a point is moved in the image by a camera that moves along its rows while it is read out, from the first row to the last; the middle row is where the pose is.
fn by_shutter(subject: &ViewsSubject, pose: &Pose, object: &nalgebra::Point3<f64>, path: f64) -> [f64; 2] {
    let camera = &subject.camera;
    let height = f64::from(camera.size().height.max(2) - 1);
    let Ok(still) = camera.project(pose.ray(object)) else { return [0.0; 2] };
    let along = pose.rotation.row(0).transpose();
    let mut found = still;
    for _ in 0..ROUNDS {
        let centre = pose.centre + along * (path * (found.y / height - 0.5));
        match camera.project(Pose { centre, ..*pose }.ray(object)) {
            Ok(next) => found = next,
            Err(_) => return [0.0; 2],
        }
    }
    [found.x - still.x, found.y - still.y]
}

/// How far a camera of another principal distance pictures it from there.
fn by_other(subject: &ViewsSubject, at: PixelPoint, factor: f64) -> [f64; 2] {
    let Ok(centre) = subject.camera.project(Ray::from_tangent(0.0, 0.0)) else { return [0.0; 2] };
    [(factor - 1.0) * (at.x - centre.x), (factor - 1.0) * (at.y - centre.y)]
}

fn gross(faults: &Faults, key: Key<'_>) -> [f64; 2] {
    let mut rng = stream(key, Purpose::Gross);
    let [is_gross, direction, size]: [f64; 3] = std::array::from_fn(|_| rng.random());
    if is_gross >= faults.gross {
        return [0.0; 2];
    }
    let [from, to] = faults.gross_px;
    let (sin, cos) = (direction * TAU).sin_cos();
    let length = from + (to - from) * size;
    [length * cos, length * sin]
}

/// Pairs of points take each other's name, until as many as the share says have done so.
fn exchange(share: f64, image: &mut TaskImage, key: Key<'_>) {
    let mut rng = stream(key, Purpose::Gross);
    let count = image.points.len();
    for _ in 0..(share * count as f64 / 2.0).round() as usize {
        let [one, other] = [(); 2].map(|()| rng.random_range(0..count));
        let held = image.points[one].1;
        image.points[one].1 = image.points[other].1;
        image.points[other].1 = held;
    }
}
