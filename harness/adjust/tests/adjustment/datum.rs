//! Minimal constraints, inner constraints, and the way between them.

use calibench_adjust::{AdjustError, Covariances, Datum, Network, Options, Solution, Variance, adjust};
use calibench_model::camera::CameraModel;

use crate::networks;

fn network() -> Network {
    let mut network = networks::ring(networks::photogrammetric(), 8, 30, 6);
    networks::free(&mut network, &["c", "x0", "y0", "k1"]);
    networks::shake_pixels(&mut network, 0.3, &mut networks::random(9));
    network
}

const A: Datum = Datum::Minimal { horizontal: [0, 7], vertical: [3, 11, 20] };
const B: Datum = Datum::Minimal { horizontal: [13, 2], vertical: [25, 4, 17] };

fn in_datum(network: &Network, datum: Datum) -> Network {
    Network { datum, ..network.clone() }
}

/// Interior orientation, its covariance, residuals and ratios of distances do not depend on the datum.
fn estimable_quantities_agree(a: &Solution, b: &Solution) {
    for (a, b) in a.cameras()[0].parameters().iter().zip(b.cameras()[0].parameters()) {
        assert!((a.value - b.value).abs() < 1e-9 * a.value.abs().max(1e-3), "{}: {} {}", a.name, a.value, b.value);
    }
    let interior = |solution: &Solution| solution.covariances(Variance::Apriori).unwrap().interior;
    let (qa, qb) = (interior(a), interior(b));
    assert!(qa.iter().zip(&qb).all(|(a, b)| (a - b).abs() < 1e-6 * qa.amax()), "{qa} {qb}");
    for (a, b) in a.residuals().iter().zip(b.residuals()) {
        let (a, b) = (a.v.unwrap(), b.v.unwrap());
        assert!((a[0] - b[0]).abs() < 1e-7 && (a[1] - b[1]).abs() < 1e-7, "{a:?} {b:?}");
    }
    let scale = |solution: &Solution| (solution.points()[1] - solution.points()[9]).norm();
    for (i, j) in [(0, 5), (12, 28), (3, 19)] {
        let ratio = |solution: &Solution| (solution.points()[i] - solution.points()[j]).norm() / scale(solution);
        assert!((ratio(a) / ratio(b) - 1.0).abs() < 1e-9);
    }
}

fn covariances_agree(a: &Covariances, b: &Covariances) {
    for (a, b) in a.poses.iter().zip(&b.poses) {
        assert!((a - b).amax() < 1e-6 * a.amax(), "{a} {b}");
    }
    for (a, b) in a.points.iter().zip(&b.points) {
        assert!((a - b).amax() < 1e-6 * a.amax().max(1e-9), "{a} {b}");
    }
}

#[test]
fn an_s_transformation_leads_where_an_adjustment_in_the_other_datum_does() {
    let network = network();
    let (in_a, in_b, inner) = (in_datum(&network, A), in_datum(&network, B), in_datum(&network, Datum::Inner));
    let options = Options::default();
    let (a, b, inner) = (adjust(&in_a, &options).unwrap(), adjust(&in_b, &options).unwrap(), adjust(&inner, &options).unwrap());
    estimable_quantities_agree(&a, &b);
    estimable_quantities_agree(&a, &inner);
    for target in [&b, &inner] {
        let transformed = a.in_datum(target.datum()).unwrap();
        estimable_quantities_agree(&a, &transformed);
        covariances_agree(&transformed.covariances(Variance::Apriori).unwrap(), &target.covariances(Variance::Apriori).unwrap());
        let off = transformed.points().iter().zip(target.points()).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(off < 1e-8, "{off}");
    }
    covariances_agree(&inner.in_datum(&A).unwrap().covariances(Variance::Apriori).unwrap(), &a.covariances(Variance::Apriori).unwrap());
}

#[test]
fn inner_constraints_have_the_smallest_trace_and_leave_the_middle() {
    let network = network();
    let inner = in_datum(&network, Datum::Inner);
    let inner = adjust(&inner, &Options::default()).unwrap();
    let trace =
        |solution: &Solution| solution.covariances(Variance::Apriori).unwrap().points.iter().map(nalgebra::Matrix3::trace).sum::<f64>();
    for datum in [A, B] {
        assert!(trace(&inner) < trace(&inner.in_datum(&datum).unwrap()));
    }
    let middle =
        |points: &mut dyn Iterator<Item = nalgebra::Point3<f64>>| points.fold(nalgebra::Vector3::zeros(), |sum, point| sum + point.coords);
    let off = middle(&mut inner.points().iter().copied()) - middle(&mut network.points.iter().map(|point| point.position));
    assert!(off.norm() < 1e-9, "{off}");
    assert_eq!(inner.counts().constraints, 7);
}

#[test]
fn held_coordinates_keep_their_values_and_have_no_variance() {
    let network = in_datum(&network(), A);
    let solution = adjust(&network, &Options::default()).unwrap();
    let covariances = solution.covariances(Variance::Apriori).unwrap();
    for (point, axis) in [(0, 0), (0, 1), (7, 0), (7, 1), (3, 2), (11, 2), (20, 2)] {
        assert_eq!(solution.points()[point][axis], network.points[point].position[axis]);
        assert_eq!(covariances.points[point][(axis, axis)], 0.0);
    }
}

#[test]
fn a_datum_that_does_not_fit_is_refused() {
    let network = network();
    let mut fixed = in_datum(&network, A);
    fixed.points[0] = calibench_adjust::ObjectPoint::fixed("0", fixed.points[0].position);
    assert!(matches!(adjust(&fixed, &Options::default()), Err(AdjustError::Network(_))));
    fixed.datum = Datum::Inner;
    assert!(matches!(adjust(&fixed, &Options::default()), Err(AdjustError::Network(_))));
    let twice = in_datum(&network, Datum::Minimal { horizontal: [0, 0], vertical: [1, 2, 3] });
    assert!(matches!(adjust(&twice, &Options::default()), Err(AdjustError::Network(_))));
    let nothing = in_datum(&network, Datum::Control);
    let error = adjust(&nothing, &Options::default()).unwrap_err().to_string();
    assert!(error.contains("frame of the object") && error.contains("scale"), "{error}");
}
