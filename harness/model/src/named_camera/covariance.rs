//! Covariances of a camera's parameters.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::camera::{Camera, CameraModel};

/// Covariance of a camera's parameters, in their own units. Parameters that are not named were held fixed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterCovariance {
    /// Names, as in `CameraModel::parameters`.
    pub parameters: Vec<String>,
    /// Square and symmetric, row by row, in the order of `parameters` and in their units.
    pub values: Vec<f64>,
}

impl ParameterCovariance {
    /// Checked: square, finite, symmetric, no negative variance.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn new(parameters: Vec<String>, mut values: Vec<f64>) -> Result<Self, String> {
        let n = parameters.len();
        if values.len() != n * n {
            return Err(format!("expected {n} x {n} numbers for {n} parameters, found {}", values.len()));
        }
        if let Some(twice) = parameters.iter().enumerate().find(|(i, name)| parameters[..*i].contains(name)) {
            return Err(format!("parameter `{}` stands twice", twice.1));
        }
        for row in 0..n {
            let variance = values[row * n + row];
            if !(variance >= 0.0 && variance.is_finite()) {
                return Err(format!("variance of `{}` is {variance}; expected zero or more", parameters[row]));
            }
            for column in 0..row {
                let (low, high) = (values[row * n + column], values[column * n + row]);
                let bound = (variance * values[column * n + column]).sqrt() * (1.0 + 1e-6);
                if !((low - high).abs() <= 1e-6 * bound && low.abs() <= bound) {
                    return Err(format!(
                        "covariances of `{}` and `{}` are {low} and {high}: not those of anything",
                        parameters[row], parameters[column]
                    ));
                }
                values[column * n + row] = low;
            }
        }
        Ok(Self { parameters, values })
    }

    /// That of all of a camera's parameters, `q` in their order; what rounding makes unsymmetric is averaged.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of(camera: &Camera, q: &DMatrix<f64>) -> Result<Self, String> {
        Self::named(camera.parameters().iter().map(|p| p.name.to_owned()).collect(), q)
    }

    /// That of the parameters called `names`, `q` in their order; what rounding makes unsymmetric is averaged.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn named(names: Vec<String>, q: &DMatrix<f64>) -> Result<Self, String> {
        let n = names.len();
        let symmetric = |k: usize| f64::midpoint(q[(k / n, k % n)], q[(k % n, k / n)]);
        Self::new(names, (0..n * n).map(symmetric).collect())
    }

    /// The matrix over all parameters of `camera`, in their order and units; those that were held fixed have zeros.
    ///
    /// # Errors
    /// A parameter that the camera does not have, in words.
    pub fn whole(&self, camera: &Camera) -> Result<DMatrix<f64>, String> {
        let parameters = camera.parameters();
        let place = |name: &String| parameters.iter().position(|p| p.name == name);
        let places: Option<Vec<usize>> = self.parameters.iter().map(place).collect();
        let places = places.ok_or("the file's covariance names a parameter that its camera does not have")?;
        let n = self.parameters.len();
        let mut q = DMatrix::zeros(parameters.len(), parameters.len());
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            q[(places[i], places[j])] = self.values[i * n + j];
        }
        Ok(q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{ImageSize, OpenCv};

    #[test]
    fn what_a_file_names_has_its_place_among_all_parameters() {
        let size = ImageSize { width: 640, height: 480 };
        let camera = Camera::from(OpenCv { size, fx: 500.0, fy: 501.0, cx: 320.0, cy: 240.0, distortion: [0.0; 14], coefficients: 4 });
        let names = ["cy", "fx"].map(str::to_owned).to_vec();
        let stated = ParameterCovariance::new(names, vec![4.0, 1.0, 1.0, 9.0]).unwrap();
        let q = stated.whole(&camera).unwrap();
        let place = |name: &str| camera.parameters().iter().position(|p| p.name == name).unwrap();
        let (fx, cy) = (place("fx"), place("cy"));
        assert_eq!((q[(fx, fx)], q[(cy, cy)], q[(fx, cy)], q[(cy, fx)], q.sum()), (9.0, 4.0, 1.0, 1.0, 15.0));
        let all = ParameterCovariance::of(&camera, &q).unwrap();
        assert_eq!((all.parameters.len(), all.whole(&camera).unwrap()), (q.nrows(), q));
        let strange = ParameterCovariance::new(vec!["k9".into()], vec![1.0]).unwrap();
        assert!(strange.whole(&camera).is_err());
    }
}
