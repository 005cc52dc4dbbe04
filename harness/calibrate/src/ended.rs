//! A network from where its adjustment ended.

use calibench_adjust::{Exterior, Interior, Network, ObjectPoint, Solution, Status, Surface};

/// Iterations at most: parameters that do nearly the same, as xi and k1 of an omnidirectional camera, approach their minimum slowly.
pub(crate) const ITERATIONS: usize = 1000;

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
        distances: whole.distances.clone(),
        per_image: whole.per_image.clone(),
    }
}
