//! Networks that are none.

use calibench_model::camera::CameraModel;

use super::error::NetworkError;
use super::{Attitude, Centre, Datum, Network, Precision, Status};

impl Network {
    /// The first of the mistakes that leave nothing to adjust.
    pub(crate) fn check(&self) -> Result<(), NetworkError> {
        self.cameras.iter().try_for_each(check_camera)?;
        self.images.iter().try_for_each(|image| {
            within(|| format!("image {}", image.name), "camera", image.camera, self.cameras.len())?;
            check_pose(image)
        })?;
        self.points.iter().try_for_each(|point| {
            let of = || format!("point {}", point.name);
            finite(of, point.position.iter().copied())?;
            point.coordinates.iter().try_for_each(|status| check_status(of, *status))
        })?;
        self.surfaces.iter().try_for_each(|surface| {
            let of = || format!("surface {}", surface.name);
            finite(of, surface.coefficients)?;
            surface.statuses.iter().try_for_each(|status| check_status(of, *status))
        })?;
        self.check_surfaces()?;
        self.check_observations()?;
        self.check_distances()?;
        self.check_per_image()?;
        self.check_datum()
    }

    fn check_observations(&self) -> Result<(), NetworkError> {
        let mut last = vec![usize::MAX; self.points.len()];
        let mut order: Vec<u32> = (0..self.observations.len() as u32).collect();
        order.sort_unstable_by_key(|&i| (self.observations[i as usize].image, i));
        for i in order {
            let o = &self.observations[i as usize];
            let of = || format!("observation {i}");
            within(of, "image", o.image, self.images.len())?;
            within(of, "point", o.point, self.points.len())?;
            finite(of, [o.position.x, o.position.y])?;
            check_precision(of, o.precision)?;
            if std::mem::replace(&mut last[o.point], o.image) == o.image {
                let (image, point) = (self.images[o.image].name.clone(), self.points[o.point].name.clone());
                return Err(NetworkError::Twice { image, point });
            }
        }
        Ok(())
    }

    fn check_datum(&self) -> Result<(), NetworkError> {
        if let Datum::InnerOver(points) = &self.datum {
            points.iter().try_for_each(|&index| within(|| "the datum".into(), "point", index, self.points.len()))?;
        }
        if let Datum::Minimal { horizontal, vertical } = &self.datum {
            if !self.distances.is_empty() {
                return Err(NetworkError::Datum("seven coordinates that are held fix the scale, and so do the distances".into()));
            }
            for &index in horizontal.iter().chain(vertical) {
                within(|| "the datum".into(), "point", index, self.points.len())?;
            }
            if horizontal[0] == horizontal[1] || (0..3).any(|i| vertical[i] == vertical[(i + 1) % 3]) {
                return Err(NetworkError::Datum("a control point is named twice".into()));
            }
        }
        Ok(())
    }
}

pub(super) fn within(of: impl Fn() -> String, what: &'static str, index: usize, count: usize) -> Result<(), NetworkError> {
    if index < count { Ok(()) } else { Err(NetworkError::NoSuch { of: of(), what, index, count }) }
}

pub(super) fn finite(of: impl Fn() -> String, values: impl IntoIterator<Item = f64>) -> Result<(), NetworkError> {
    let all = values.into_iter().all(f64::is_finite);
    if all { Ok(()) } else { Err(NetworkError::NotANumber { of: of(), what: "a number is not finite" }) }
}

pub(super) fn positive(of: impl Fn() -> String, sigmas: impl IntoIterator<Item = f64>) -> Result<(), NetworkError> {
    let all = sigmas.into_iter().all(|sigma| sigma > 0.0 && (1.0 / (sigma * sigma)).is_normal());
    if all { Ok(()) } else { Err(NetworkError::NotANumber { of: of(), what: "a standard deviation is not a positive number" }) }
}

fn check_status(of: impl Fn() -> String + Copy, status: Status) -> Result<(), NetworkError> {
    match status {
        Status::Free | Status::Fixed => Ok(()),
        Status::Observed { value, sigma } => finite(of, [value]).and_then(|()| positive(of, [sigma])),
    }
}

fn check_camera(interior: &super::Interior) -> Result<(), NetworkError> {
    let of = || format!("camera {}", interior.name);
    let parameters = interior.camera.parameters();
    if parameters.len() != interior.parameters.len() {
        let (camera, given) = (interior.name.clone(), interior.parameters.len());
        return Err(NetworkError::ParameterCount { camera, parameters: parameters.len(), given });
    }
    finite(of, parameters.iter().map(|parameter| parameter.value))?;
    interior.parameters.iter().try_for_each(|status| check_status(of, *status))
}

fn check_pose(image: &super::Exterior) -> Result<(), NetworkError> {
    let of = || format!("image {}", image.name);
    let rotation = |m: &nalgebra::Matrix3<f64>| {
        finite(of, m.iter().copied())?;
        let off = (m * m.transpose() - nalgebra::Matrix3::identity()).amax();
        let proper = off < 1e-6 && m.determinant() > 0.0;
        if proper { Ok(()) } else { Err(NetworkError::NotANumber { of: of(), what: "its rotation is none" }) }
    };
    rotation(&image.pose.rotation)?;
    finite(of, image.pose.centre.iter().copied())?;
    if let Centre::Observed { value, sigma } = image.centre {
        finite(of, value.iter().copied())?;
        positive(of, sigma)?;
    }
    if let Attitude::Observed { value, sigma } = image.attitude {
        rotation(&value)?;
        positive(of, sigma)?;
    }
    Ok(())
}

fn check_precision(of: impl Fn() -> String + Copy, precision: Precision) -> Result<(), NetworkError> {
    match precision {
        Precision::Sigma(sigma) => positive(of, [sigma]),
        Precision::Covariance(c) => {
            positive(of, [c.sxx.sqrt(), c.syy.sqrt()])?;
            let regular = c.is_valid() && c.sxx * c.syy - c.sxy * c.sxy > 1e-12 * c.sxx * c.syy;
            if regular { Ok(()) } else { Err(NetworkError::NotANumber { of: of(), what: "its covariance is singular or none" }) }
        }
    }
}
