//! Covariances through conversions.

use nalgebra::DMatrix;

use super::super::{ConvertError, ConvertOptions, Region, Target, convert};
use super::{mild, values};
use crate::camera::{Camera, CameraModel};

/// Standard deviations of the source, and a covariance with correlations.
fn covariance() -> DMatrix<f64> {
    let sigma = [0.5, 0.5, 0.3, 0.3, 1e-4, 3e-4, 1e-5, 1e-5, 4e-4];
    DMatrix::from_fn(9, 9, |i, j| sigma[i] * sigma[j] * if i == j { 1.0 } else { 0.3 * f64::powi(-0.8, (i + j) as i32 % 3) })
}

fn options(covariance: Option<DMatrix<f64>>) -> ConvertOptions {
    ConvertOptions { accept: true, covariance, ..ConvertOptions::default() }
}

/// `J Q J^T` with J from conversions of changed cameras.
fn by_differences(source: &Camera, target: Target) -> DMatrix<f64> {
    let q = covariance();
    let values_of = |i: usize, change: f64| {
        let mut changed = values(source);
        changed[i] += change;
        values(&convert(&source.with_parameters(&changed), target, &options(None)).unwrap().camera)
    };
    let columns: Vec<_> = (0..q.nrows())
        .map(|i| {
            let h = 0.1 * q[(i, i)].sqrt();
            let (high, low) = (values_of(i, h), values_of(i, -h));
            nalgebra::DVector::from_iterator(high.len(), high.iter().zip(low).map(|(a, b)| (a - b) / (2.0 * h)))
        })
        .collect();
    let jacobian = DMatrix::from_columns(&columns);
    &jacobian * q * jacobian.transpose()
}

fn assert_close(found: &DMatrix<f64>, expected: &DMatrix<f64>, within: f64) {
    for i in 0..expected.nrows() {
        for j in 0..expected.ncols() {
            let scale = (expected[(i, i)] * expected[(j, j)]).sqrt();
            assert!((found[(i, j)] - expected[(i, j)]).abs() <= within * scale, "({i}, {j}): {} {}", found[(i, j)], expected[(i, j)]);
        }
    }
}

#[test]
fn a_fit_propagates_as_repeated_fits_do() {
    let target = Target::photogrammetric(4.7);
    let found = convert(&mild(), target, &options(Some(covariance()))).unwrap().covariance.unwrap();
    assert_close(&found, &by_differences(&mild(), target), 1e-3);
}

#[test]
fn a_formula_propagates_as_repeated_formulas_do() {
    let target = Target::metashape();
    let found = convert(&mild(), target, &options(Some(covariance()))).unwrap().covariance.unwrap();
    assert_close(&found, &by_differences(&mild(), target), 1e-6);
    // f is fy; b1 is fx - fy, whose variance the correlation decides.
    let q = covariance();
    let names: Vec<_> = convert(&mild(), target, &options(None)).unwrap().camera.parameters().iter().map(|p| p.name).collect();
    let b1 = names.iter().position(|name| *name == "b1").unwrap();
    assert!((found[(0, 0)] - q[(1, 1)]).abs() < 1e-6);
    assert!((found[(b1, b1)] - (q[(0, 0)] + q[(1, 1)] - 2.0 * q[(0, 1)])).abs() < 1e-6);
}

#[test]
fn a_covariance_of_another_camera_is_refused() {
    let wrong = Some(DMatrix::zeros(8, 8));
    let expected = Err(ConvertError::CovarianceShape { expected: 9, rows: 8, columns: 8 });
    for target in [Target::metashape(), Target::photogrammetric(4.7)] {
        assert_eq!(convert(&mild(), target, &options(wrong.clone())).map(|found| found.camera), expected);
    }
}

/// A region so small that its nodes give fewer equations than the target has parameters is refused, with a covariance and without one.
#[test]
fn a_region_of_fewer_nodes_than_parameters_is_refused() {
    let mut refused = 0;
    for px in [1.0, 10.0, 20.0, 30.0, 40.0, 60.0, 80.0, 120.0, 200.0] {
        for q in [None, Some(covariance())] {
            let options = ConvertOptions { region: Region::Radius { px }, ..options(q) };
            match convert(&mild(), Target::photogrammetric(4.7), &options) {
                Err(ConvertError::TooFewNodes { nodes, parameters: 10 }) => {
                    assert!(nodes < 5, "{nodes}");
                    refused += 1;
                }
                Err(ConvertError::NotEstimable { .. } | ConvertError::NotConverged) | Ok(_) => {}
                Err(other) => panic!("{px}: {other}"),
            }
        }
    }
    assert!(refused >= 2 && refused % 2 == 0, "{refused}");
}
