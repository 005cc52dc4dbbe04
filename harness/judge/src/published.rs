//! A calibration that somebody published of the same photographs.

use calibench_model::NamedCamera;
use nalgebra::DMatrix;

use crate::frame::Frame;
use crate::halves::places;

/// The standard deviation (2D) that a camera's file states of it, RMS over the frame, px; `None` if it states none, or the frame is not pictured.
pub fn stated_sigma(named: &NamedCamera) -> Option<f64> {
    let stated = named.covariance.as_ref()?;
    let at = places(&named.camera).ok()?;
    let names: Vec<&str> = stated.parameters.iter().map(String::as_str).collect();
    let frame = Frame::new(&named.camera, &names, &at)?;
    let covariance = DMatrix::from_row_slice(names.len(), names.len(), &stated.values);
    Some(frame.spread(&covariance).0.sqrt())
}
