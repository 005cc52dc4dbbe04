//! `edge_centroid`: where the edges of a window lie in the mean.

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};

use crate::operator::{Operator, window_centre};
use crate::parameter::{Parameter, Settings};
use crate::registry::{Build, Method};

/// Centroid of the window's pixels, weighted by the squared gradient of the grey values.
///
/// `window` is odd, px, and centred on the pixel nearest to the start; gradients are central differences, so the image must reach one pixel past it.
/// Exact only where the window is symmetric about the point. The position has no covariance.
///
/// Source: an example; Trinder's centroid (1989) with gradients in place of grey values.
pub struct EdgeCentroid {
    half: i64,
}

const PARAMETERS: &[Parameter] = &[Parameter::odd("window", "side of the window, px", [3, 31], 21.0).always_shown()];

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "edge_centroid",
        about: "centroid of the window's edges, weighted by the squared gradient",
        source: "an example, after Trinder 1989",
        version: "1".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings: &Settings| Box::new(EdgeCentroid { half: settings.whole("window") as i64 / 2 })),
    }
}

impl Operator for EdgeCentroid {
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`], [`Rejection::NoCorner`] where there is no edge.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let (x, y) = window_centre(image, start, self.half + 1)?;
        let rows: Vec<&[f32]> = image.rows_around(x, y, self.half + 1).ok_or(Rejection::Border)?.collect();
        let grey = |column: usize, row: usize| f64::from(rows[row][column]);
        let (mut sum, mut sum_x, mut sum_y) = (0.0, 0.0, 0.0);
        for row in 1..rows.len() - 1 {
            for column in 1..rows.len() - 1 {
                let gx = grey(column + 1, row) - grey(column - 1, row);
                let gy = grey(column, row + 1) - grey(column, row - 1);
                let weight = gx * gx + gy * gy;
                sum += weight;
                sum_x += weight * (column as i64 - 1 - self.half) as f64;
                sum_y += weight * (row as i64 - 1 - self.half) as f64;
            }
        }
        if !sum.is_finite() || rows.iter().any(|row| row.iter().any(|grey| !grey.is_finite())) {
            return Err(Rejection::NotFinite);
        }
        if sum == 0.0 {
            return Err(Rejection::NoCorner);
        }
        Ok(Measurement { position: PixelPoint::new(x as f64 + sum_x / sum, y as f64 + sum_y / sum), covariance: None })
    }
}

#[cfg(test)]
mod tests {
    use crate::conformance;
    use crate::registry::Registry;

    #[test]
    fn conforms() {
        let registry = Registry::default().with(super::method());
        for spec in ["edge_centroid", "edge_centroid:window=19", "edge_centroid:window=23"] {
            conformance::check_on(&*registry.parse(spec).unwrap().operator.unwrap(), conformance::disc, 1e-9);
        }
    }
}
