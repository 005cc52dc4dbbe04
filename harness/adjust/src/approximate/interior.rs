//! Interior orientations to start from without an observation.

use calibench_model::camera::{Camera, ImageSize, OpenCv, Photogrammetric};
use calibench_model::{Frame, PixelPoint, SensorPoint};

use super::ApproximateError;

/// The focal length of a camera of which nothing is known, in widths of its longer side: a field of view of 45 degrees.
const USUAL_FOCAL: f64 = 1.2;

/// The camera of a data sheet: `c` is the focal length, the principal point the centre of the frame, and nothing is distorted.
///
/// `pitch_um` in um per px, `focal_mm` in mm (not the 35 mm equivalent).
///
/// # Errors
/// [`ApproximateError::DataSheet`] for a number that is not positive and finite.
pub fn interior_from_data_sheet(size: ImageSize, pitch_um: f64, focal_mm: f64) -> Result<Photogrammetric, ApproximateError> {
    Frame::new(size.width, size.height, pitch_um).map_err(|_| ApproximateError::DataSheet)?;
    if !focal_mm.is_finite() || focal_mm <= 0.0 {
        return Err(ApproximateError::DataSheet);
    }
    Ok(Photogrammetric { size, pitch_um, c: focal_mm, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] })
}

/// A camera from the size of its images alone: a focal length of 1.2 times the longer side, the principal point in the centre, and no distortion.
///
/// # Errors
/// [`ApproximateError::DataSheet`] for a size of zero.
pub fn interior_from_size(size: ImageSize) -> Result<Camera, ApproximateError> {
    let focal = USUAL_FOCAL * f64::from(size.width.max(size.height));
    Ok(pinhole(size, [focal; 2], centre(size)?).into())
}

/// The centre of the frame.
pub(super) fn centre(size: ImageSize) -> Result<PixelPoint, ApproximateError> {
    let frame = Frame::new(size.width, size.height, 1.0).map_err(|_| ApproximateError::DataSheet)?;
    Ok(frame.to_pixel(SensorPoint { x: 0.0, y: 0.0 }))
}

/// A camera without distortion.
pub(super) fn pinhole(size: ImageSize, [fx, fy]: [f64; 2], PixelPoint { x: cx, y: cy }: PixelPoint) -> OpenCv {
    OpenCv { size, fx, fy, cx, cy, distortion: [0.0; 14], coefficients: 5 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::camera::{CameraModel, Ray};

    const SIZE: ImageSize = ImageSize { width: 4272, height: 2848 };

    #[test]
    fn a_data_sheet_is_a_camera() {
        let camera = interior_from_data_sheet(SIZE, 5.15, 20.0).unwrap();
        let point = camera.project(Ray::from_tangent(0.1, 0.2)).unwrap();
        assert!(point.distance(PixelPoint::new(2135.5 + 2.0 / 5.15e-3, 1423.5 - 4.0 / 5.15e-3)) < 1e-9, "{point:?}");
        let wrong = [(0.0, 20.0), (5.15, 0.0), (f64::NAN, 20.0), (5.15, f64::INFINITY), (5.15, -1.0)];
        for (pitch, focal) in wrong {
            assert_eq!(interior_from_data_sheet(SIZE, pitch, focal), Err(ApproximateError::DataSheet));
        }
    }

    #[test]
    fn nothing_but_a_size_is_a_camera_too() {
        let camera = interior_from_size(SIZE).unwrap();
        let half_width = camera.unproject(PixelPoint::new(4271.0, 1423.5)).unwrap().tangent().unwrap().0;
        assert!((half_width - 2135.5 / (1.2 * 4272.0)).abs() < 1e-12);
        assert_eq!(interior_from_size(ImageSize { width: 0, height: 9 }), Err(ApproximateError::DataSheet));
    }
}
