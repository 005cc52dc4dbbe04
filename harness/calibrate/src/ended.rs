//! The network of a calibration, from where its adjustment ended.

use std::collections::HashSet;

use calibench_adjust::{Exterior, Interior, Network, ObjectPoint, Options, Solution, Status, Surface};

use crate::Calibration;
use crate::calibration::ITERATIONS;

/// The network of a solution, with its end as the start.
pub(crate) fn ended(solution: &Solution<'_>) -> Network {
    let whole = solution.network();
    let cameras = whole.cameras.iter().zip(solution.cameras()).map(|(interior, camera)| Interior { camera: *camera, ..interior.clone() });
    let images = whole.images.iter().zip(solution.poses()).map(|(image, pose)| Exterior { pose: *pose, ..image.clone() });
    let surfaces =
        whole.surfaces.iter().zip(solution.surfaces()).map(|(surface, coefficients)| Surface { coefficients, ..surface.clone() });
    let points = whole.points.iter().zip(solution.points()).map(|(point, position)| match point.coordinates {
        [Status::Fixed, Status::Fixed, Status::Fixed] => point.clone(),
        _ => ObjectPoint { position: *position, ..point.clone() },
    });
    Network {
        cameras: cameras.collect(),
        images: images.collect(),
        points: points.collect(),
        surfaces: surfaces.collect(),
        observations: whole.observations.clone(),
        datum: whole.datum.clone(),
    }
}

impl Calibration<'_> {
    /// The same network with the end of the adjustment as its start.
    pub(crate) fn ended(&self) -> Network {
        ended(&self.solution)
    }

    /// How it was adjusted, without what was rejected.
    pub(crate) fn options(&self) -> Options {
        let rejected: HashSet<usize> = self.found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
        let mut left_out: Vec<usize> = rejected.into_iter().collect();
        left_out.sort_unstable();
        Options { huber: self.prepared.settings.huber, most_iterations: ITERATIONS, left_out }
    }
}
