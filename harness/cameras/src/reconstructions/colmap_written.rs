//! A reconstruction as COLMAP's text model, which COLMAP and most viewers open.

use std::fmt::Write;

use calibench_model::Reconstruction;
use calibench_model::camera::CameraModel;
use calibench_model::named_camera::Pose;
use calibench_model::pose;

use crate::CameraFileError;
use crate::colmap_models::written;
use crate::formats::colmap::FORMAT;
use crate::number::shortest;
use crate::pose::quaternion;

/// cameras.txt, images.txt and points3D.txt of a reconstruction. Images and cameras are numbered from 1, points as they are named if all names are whole numbers; colours are black.
/// `error_px` is, of each point, the mean length of its residuals, px.
///
/// # Errors
/// A camera that no model of COLMAP holds.
pub fn write_colmap(reconstruction: &Reconstruction, error_px: &[f64]) -> Result<[(&'static str, String); 3], CameraFileError> {
    let Reconstruction { cameras, images, points, sights, .. } = reconstruction;
    let mut list = String::from("# Camera list with one line of data per camera:\n#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n");
    for (index, camera) in cameras.iter().enumerate() {
        let (model, values) = written(&camera.named.camera, &FORMAT).map_err(|error| error.of(format!("camera {}", camera.named.name)))?;
        let (size, values) = (camera.named.camera.size(), values.into_iter().map(shortest).collect::<Vec<_>>().join(" "));
        let _ = writeln!(list, "{} {model} {} {} {values}", index + 1, size.width, size.height);
    }
    let ids = point_ids(reconstruction);
    let (mut of_image, mut of_point) = (vec![Vec::new(); images.len()], vec![Vec::new(); points.len()]);
    for sight in sights {
        of_point[sight.point].push((sight.image + 1, of_image[sight.image].len()));
        of_image[sight.image].push(sight);
    }
    let mut taken =
        String::from("# Image list with two lines of data per image:\n#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n");
    taken.push_str("#   POINTS2D[] as (X, Y, POINT3D_ID)\n");
    for (index, image) in images.iter().enumerate() {
        let pose = forward(&image.pose);
        let [x, y, z, w] = quaternion(pose.camera_from_world);
        let numbers = [w, x, y, z].into_iter().chain(pose.t()).map(shortest).collect::<Vec<_>>().join(" ");
        let _ = writeln!(taken, "{} {numbers} {} {}", index + 1, image.camera + 1, image.name);
        let seen = of_image[index].iter().map(|sight| {
            let corner = sight.position.to_corner();
            format!("{} {} {}", shortest(corner.x), shortest(corner.y), ids[sight.point])
        });
        let _ = writeln!(taken, "{}", seen.collect::<Vec<_>>().join(" "));
    }
    let mut cloud = String::from(
        "# 3D point list with one line of data per point:\n#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n",
    );
    for (index, point) in points.iter().enumerate() {
        let [x, y, z] = [point.position.x, point.position.y, point.position.z].map(shortest);
        let track = of_point[index].iter().map(|(image, place)| format!(" {image} {place}")).collect::<String>();
        let error = error_px.get(index).copied().filter(|error| error.is_finite()).map_or("-1".into(), shortest);
        let _ = writeln!(cloud, "{} {x} {y} {z} 0 0 0 {error}{track}", ids[index]);
    }
    Ok([("cameras.txt", list), ("images.txt", taken), ("points3D.txt", cloud)])
}

/// Their own numbers if they have such, else 1, 2, ...
fn point_ids(reconstruction: &Reconstruction) -> Vec<u64> {
    let own: Option<Vec<u64>> = reconstruction.points.iter().map(|point| point.name.parse().ok()).collect();
    let differ = |ids: &Vec<u64>| ids.iter().collect::<std::collections::HashSet<_>>().len() == ids.len();
    own.filter(differ).unwrap_or_else(|| (1..=reconstruction.points.len() as u64).collect())
}

/// With axes x right, y down, z forward.
fn forward(pose: &pose::Pose) -> Pose {
    let m = &pose.rotation;
    let up = Pose { camera_from_world: std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)])), position: pose.centre.coords.into() };
    up.with_y_and_z_reversed()
}
