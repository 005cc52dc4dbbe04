//! A network for viewers of meshes.

use std::fmt::Write;

use calibench_calibrate::Calibration;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use super::html::network::{extent, factor, points, stations};
use crate::html::{ScenePoint, Station};

/// Orange, blue and green of Okabe & Ito 2008: control, other points, stations.
const CONTROL: [u8; 3] = [230, 159, 0];
const POINT: [u8; 3] = [0, 114, 178];
const STATION: [u8; 3] = [0, 158, 115];
/// Size of a point without an ellipsoid and of a station, as shares of the network's extent.
const SHARE: [f64; 2] = [0.002, 0.03];

/// The network as a PLY file (text, `double` coordinates, object units): a mesh with the stations as pyramids whose base is the frame, and the object points as
/// ellipsoids of one standard deviation, enlarged by the factor that a comment states; points that are fixed as small octahedra.
///
/// Source of the format: Turk 1994, "The PLY Polygon File Format".
pub fn scene_ply(calibration: &Calibration<'_>) -> String {
    let (stations, points) = (stations(calibration), points(calibration));
    let size = extent(&stations, &points);
    let factor = factor(&stations, &points);
    let mut mesh = Mesh::default();
    for point in &points {
        mesh.point(point, factor, SHARE[0] * size);
    }
    for station in &stations {
        mesh.station(station, SHARE[1] * size);
    }
    let are_fixed = points.iter().all(|point| point.covariance.is_none());
    mesh.file(&if are_fixed { "points are fixed".into() } else { format!("ellipsoids of one standard deviation {factor} times enlarged") })
}

#[derive(Default)]
struct Mesh {
    vertices: Vec<(Vector3<f64>, [u8; 3])>,
    faces: Vec<[usize; 3]>,
}

impl Mesh {
    /// A ball of eight faces, each cut into four, under a linear map about a place.
    fn ball(&mut self, about: Vector3<f64>, map: &Matrix3<f64>, colour: [u8; 3]) {
        const AXES: [[f64; 3]; 6] =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
        const EDGES: [[usize; 2]; 12] = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4], [0, 5], [1, 5], [2, 5], [3, 5]];
        let first = self.vertices.len();
        let corners = AXES.map(Vector3::from);
        let halves = EDGES.map(|[a, b]| (corners[a] + corners[b]).normalize());
        self.vertices.extend(corners.iter().chain(&halves).map(|corner| (about + map * corner, colour)));
        for i in 0..4 {
            let next = (i + 1) % 4;
            let (side, up, up_next, down, down_next) = (6 + i, 10 + i, 10 + next, 14 + i, 14 + next);
            let upper = [[i, side, up], [next, up_next, side], [4, up, up_next], [side, up_next, up]];
            let lower = [[i, down, side], [next, side, down_next], [5, down_next, down], [side, down, down_next]];
            self.faces.extend(upper.into_iter().chain(lower).map(|face| face.map(|corner| first + corner)));
        }
    }

    fn point(&mut self, point: &ScenePoint, factor: f64, small: f64) {
        let map = match point.covariance {
            Some([xx, xy, xz, yy, yz, zz]) => {
                let eigen = SymmetricEigen::new(Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz));
                let axes = Matrix3::from_diagonal(&eigen.eigenvalues.map(|value| factor * value.max(0.0).sqrt()));
                eigen.eigenvectors * axes * eigen.eigenvectors.transpose()
            }
            None => Matrix3::identity() * small,
        };
        self.ball(point.place.into(), &map, if point.is_control { CONTROL } else { POINT });
    }

    /// A pyramid from the projection centre to the frame, which lies before the camera.
    fn station(&mut self, station: &Station, size: f64) {
        let first = self.vertices.len();
        let to_object = Matrix3::from_row_slice(&station.rotation).transpose();
        let [across, up] = station.half;
        let corners = [[-across, up], [across, up], [across, -up], [-across, -up]].map(|[x, y]| Vector3::new(x, y, -1.0) * size);
        let centre: Vector3<f64> = station.centre.into();
        self.vertices.extend(std::iter::once(Vector3::zeros()).chain(corners).map(|corner| (centre + to_object * corner, STATION)));
        let faces = [[0, 2, 1], [0, 3, 2], [0, 4, 3], [0, 1, 4], [1, 2, 3], [1, 3, 4]];
        self.faces.extend(faces.map(|face| face.map(|corner| first + corner)));
    }

    fn file(&self, about: &str) -> String {
        let mut text = format!(
            "ply\nformat ascii 1.0\ncomment object units; control orange, other points blue, stations green; {about}\n\
             element vertex {}\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
             element face {}\nproperty list uchar int vertex_indices\nend_header\n",
            self.vertices.len(),
            self.faces.len()
        );
        // Writing to a String cannot fail.
        for (place, [r, g, b]) in &self.vertices {
            let _ = writeln!(text, "{} {} {} {r} {g} {b}", place.x, place.y, place.z);
        }
        for [a, b, c] in &self.faces {
            let _ = writeln!(text, "3 {a} {b} {c}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the volume that faces enclose, positive where they are seen from outside with their corners to the left.
    fn volume(mesh: &Mesh) -> f64 {
        let at = |i: usize| mesh.vertices[i].0;
        mesh.faces.iter().map(|&[a, b, c]| at(a).dot(&at(b).cross(&at(c)))).sum()
    }

    #[test]
    fn an_ellipsoid_has_its_axes_and_is_closed() {
        let mut mesh = Mesh::default();
        let covariance = Some([4.0, 0.0, 0.0, 9.0, 0.0, 0.25]);
        mesh.point(&ScenePoint { name: "a".into(), place: [10.0, 20.0, 30.0], covariance, is_control: false }, 10.0, 1.0);
        let reach = |axis: usize| mesh.vertices.iter().map(|(place, _)| place[axis] - [10.0, 20.0, 30.0][axis]).fold(0.0, f64::max);
        assert_eq!([0, 1, 2].map(|axis| reach(axis).round()), [20.0, 30.0, 5.0]);
        assert_eq!((mesh.vertices.len(), mesh.faces.len()), (18, 32));
        // Each edge is one of two faces, once in either direction.
        let edges = |&[a, b, c]: &[usize; 3]| [[a, b], [b, c], [c, a]];
        let all: Vec<[usize; 2]> = mesh.faces.iter().flat_map(edges).collect();
        assert!(all.iter().all(|&[a, b]| all.iter().filter(|edge| **edge == [b, a]).count() == 1));
        assert!(volume(&mesh) > 0.0);
    }

    #[test]
    fn a_pyramid_opens_to_where_its_camera_looks() {
        // Looking along +X, up is +Z.
        let rotation = [0.0, -1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0];
        let mut mesh = Mesh::default();
        mesh.station(&Station { name: "a".into(), group: 0, centre: [1.0, 2.0, 3.0], rotation, half: [0.5, 0.25] }, 2.0);
        assert_eq!(mesh.vertices[0].0, Vector3::new(1.0, 2.0, 3.0));
        assert!(mesh.vertices[1..].iter().all(|(place, _)| (place.x - 3.0).abs() < 1e-12));
        let corner = mesh.vertices[1].0;
        assert!((corner - Vector3::new(3.0, 3.0, 3.5)).norm() < 1e-12, "upper left: {corner}");
        assert!(volume(&mesh) > 0.0);
        let text = mesh.file("points are fixed");
        assert_eq!(text.lines().skip_while(|line| *line != "end_header").count(), 1 + 5 + 6);
    }
}
