//! Which coordinates hold the frame, and whether anything does.

use nalgebra::{DMatrix, Point3, SymmetricEigen, Vector3};

use super::similarity::{COUNT, NAMES, Similarity, free};
use crate::network::{Attitude, Centre, Datum, Network, NetworkError, Status};

/// Share of the largest below which a singular value is none.
const NONE: f64 = 1e-9;

/// Place among seven that stand in for inner constraints of the one that holds the scale.
const SCALE: usize = 5;

/// Coordinates (point, axis) that are held while the network is solved.
pub(crate) type Held = Vec<(usize, usize)>;

/// The coordinates that define `datum`; those of inner constraints stand in for them until the result is transformed.
pub(crate) fn hold(network: &Network, datum: &Datum) -> Result<Held, NetworkError> {
    match datum {
        Datum::Control => Ok(Vec::new()),
        Datum::Minimal { horizontal, vertical } => {
            let held = horizontal.iter().flat_map(|&point| [(point, 0), (point, 1)]);
            Ok(held.chain(vertical.iter().map(|&point| (point, 2))).collect())
        }
        Datum::Inner | Datum::InnerOver(_) => {
            if !known(network, &[]).is_empty() {
                return Err(NetworkError::Datum("inner constraints need a network of which nothing else fixes the frame".into()));
            }
            let points: Vec<(usize, Point3<f64>)> = free_points(network, datum).map(|i| (i, network.points[i].position)).collect();
            let mut held = stand_in(&points)
                .ok_or_else(|| NetworkError::Datum("inner constraints need three free points that are not on a line".into()))?;
            if free(network) < COUNT {
                held.remove(SCALE);
            }
            Ok(held)
        }
    }
}

/// The free points that inner constraints look at, without those that no image measured.
fn free_points(network: &Network, datum: &Datum) -> impl Iterator<Item = usize> {
    let mut takes_part = vec![!matches!(datum, Datum::InnerOver(_)); network.points.len()];
    if let Datum::InnerOver(points) = datum {
        points.iter().for_each(|&point| takes_part[point] = true);
    }
    let is_free = |i: usize| network.points[i].coordinates == [Status::Free; 3];
    (0..network.points.len()).filter(move |&i| takes_part[i] && is_free(i))
}

/// Seven coordinates of three points far from each other.
fn stand_in(points: &[(usize, Point3<f64>)]) -> Option<Held> {
    let farthest = |distance: &dyn Fn(&Point3<f64>) -> f64| {
        points.iter().map(|(i, point)| (distance(point), *i, *point)).max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let middle = Point3::from(points.iter().map(|(_, point)| point.coords).sum::<Vector3<f64>>() / points.len().max(1) as f64);
    let (_, a, at_a) = farthest(&|point| (point - middle).norm())?;
    let (length, b, at_b) = farthest(&|point| (point - at_a).norm())?;
    let along = (at_b - at_a).try_normalize(0.0)?;
    let (across, c, at_c) = farthest(&|point| (point - at_a).cross(&along).norm())?;
    if across < 1e-6 * length {
        return None;
    }
    // The second point holds all its coordinates (two rotations; that along the line, at `SCALE`, the scale), the third the one that the rotation about
    // their line moves most.
    let (lengthwise, axis) = (along.iamax(), (at_c - at_a).cross(&along).iamax());
    let second = (0..3).filter(|&axis| axis != lengthwise).map(|axis| (b, axis));
    Some((0..3).map(|axis| (a, axis)).chain(second).chain([(b, lengthwise), (c, axis)]).collect())
}

/// Every coordinate or orientation that is fixed, observed or held, and every distance, as what the seven generators do to it.
fn rows(network: &Network, held: &[(usize, usize)]) -> Vec<[f64; COUNT]> {
    let mut rows = known(network, held);
    let similarity = Similarity::about(network.points.iter().map(|point| &point.position));
    rows.extend(network.distances.iter().map(|distance| {
        let [from, to] = distance.points.map(|point| network.points[point].position);
        let (along, [at_from, at_to]) = ((to - from).normalize(), [from, to].map(|point| similarity.of_point(&point)));
        std::array::from_fn(|k| (0..3).map(|axis| along[axis] * (at_to[k][axis] - at_from[k][axis])).sum())
    }));
    rows
}

/// The same without the distances.
fn known(network: &Network, held: &[(usize, usize)]) -> Vec<[f64; COUNT]> {
    let measured = measured(network);
    let known: Vec<(usize, usize)> = (0..network.points.len())
        .filter(|&point| measured[point])
        .flat_map(|point| (0..3).map(move |axis| (point, axis)))
        .filter(|&(point, axis)| network.points[point].coordinates[axis] != Status::Free)
        .chain(held.iter().copied())
        .collect();
    let images = network.images.iter().filter(|image| image.centre != Centre::Free || image.attitude != Attitude::Free);
    let centres = images.clone().filter(|image| image.centre != Centre::Free).map(|image| &image.pose.centre);
    let similarity = Similarity::about(known.iter().map(|&(point, _)| &network.points[point].position).chain(centres));
    let mut rows: Vec<[f64; COUNT]> = Vec::new();
    for (point, axis) in known {
        rows.push(similarity.of_point(&network.points[point].position).map(|change| change[axis]));
    }
    for image in images {
        let changes = similarity.of_pose(&image.pose);
        let kinds = [(0..3, image.attitude != Attitude::Free), (3..6, image.centre != Centre::Free)];
        kinds.into_iter().filter(|(_, known)| *known).for_each(|(kind, _)| rows.extend(kind.map(|i| changes.map(|change| change[i]))));
    }
    rows
}

fn measured(network: &Network) -> Vec<bool> {
    let mut measured = vec![false; network.points.len()];
    network.observations.iter().for_each(|o| measured[o.point] = true);
    measured
}

/// What of the frame nothing fixes, in words; empty if all is fixed.
pub(crate) fn undetermined(network: &Network, held: &[(usize, usize)]) -> Vec<&'static str> {
    let rows = rows(network, held);
    let a = DMatrix::from_fn(rows.len(), COUNT, |i, k| rows[i][k]);
    let eigen = SymmetricEigen::new(a.tr_mul(&a));
    let largest = eigen.eigenvalues.max().max(f64::MIN_POSITIVE);
    let free: Vec<usize> = (0..COUNT).filter(|&i| eigen.eigenvalues[i] <= NONE * largest).collect();
    let share = |k: usize| free.iter().map(|&i| eigen.eigenvectors[(k, i)].powi(2)).sum::<f64>();
    (0..COUNT).filter(|&k| share(k) > 0.05).map(|k| NAMES[k]).collect()
}

/// What the datum's constraints look at: for each a linear form of the points, `(point, axis, factor)`.
pub(crate) fn constraints(
    network: &Network,
    datum: &Datum,
    similarity: &Similarity,
    points: &[Point3<f64>],
) -> Vec<Vec<(usize, usize, f64)>> {
    match datum {
        Datum::Control => Vec::new(),
        Datum::Minimal { .. } => {
            hold(network, datum).unwrap_or_default().into_iter().map(|(point, axis)| vec![(point, axis, 1.0)]).collect()
        }
        Datum::Inner | Datum::InnerOver(_) => (0..free(network))
            .map(|k| {
                let of = |i: usize| similarity.of_point(&points[i])[k];
                free_points(network, datum).flat_map(|i| (0..3).map(move |axis| (i, axis, of(i)[axis]))).collect()
            })
            .collect(),
    }
}
