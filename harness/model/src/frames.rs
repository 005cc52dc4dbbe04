//! The frames that coordinates live in, stated once.
//!
//! | type | unit | origin | axes |
//! |---|---|---|---|
//! | [`PixelPoint`] | px | the **centre** of the top-left pixel is (0, 0) | x along the row (column), y down (row) |
//! | [`CornerPoint`] | px | the outer **corner** of the top-left pixel is (0, 0) | the same |
//! | [`SensorPoint`] | mm | centre of the frame, pixel ((w-1)/2, (h-1)/2) | x right, y **up**, right-handed |
//!
//! Object space is right-handed, in m or mm as the scenario says. Collinearity, with `N = M (X - X0)` and
//! `M = M_kappa M_phi M_omega` of passive elementary rotations, is `x = -c Nx/Nz`, `y = -c Ny/Nz`: the camera looks along its -z.

use thiserror::Error;

/// The distance from the outer corner of a pixel to its centre. No other half pixel is written in the code.
const HALF_PIXEL: f64 = 0.5;

/// A position in an image: px, the centre of the top-left pixel is (0, 0), x along the row, y down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelPoint {
    /// Column, px.
    pub x: f64,
    /// Row, px, downwards.
    pub y: f64,
}

impl PixelPoint {
    /// The point at column `x` and row `y`.
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// The same point counted from the outer corner of the top-left pixel.
    #[inline]
    pub fn to_corner(self) -> CornerPoint {
        CornerPoint { x: self.x + HALF_PIXEL, y: self.y + HALF_PIXEL }
    }

    /// The pixel whose centre is nearest, as (column, row); a tie goes away from zero. `None` if the point is not finite.
    #[inline]
    pub fn nearest_pixel(self) -> Option<(i64, i64)> {
        (self.x.is_finite() && self.y.is_finite()).then(|| (self.x.round() as i64, self.y.round() as i64))
    }

    /// Euclidean distance to `other`, px.
    #[inline]
    pub fn distance(self, other: Self) -> f64 {
        (self.x - other.x).hypot(self.y - other.y)
    }

    /// The nearest of `others` that is at most `within` px away; the first of several.
    pub fn nearest(self, others: &[Self], within: f64) -> Option<Self> {
        let by_distance = others.iter().map(|other| (self.distance(*other), *other));
        by_distance.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(distance, _)| *distance <= within).map(|(_, other)| other)
    }

    /// Whether both coordinates are finite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

/// A position in an image: px, the outer corner of the top-left pixel is (0, 0), x along the row, y down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CornerPoint {
    /// px from the left edge of the image.
    pub x: f64,
    /// px from the upper edge of the image.
    pub y: f64,
}

impl CornerPoint {
    /// The same point counted from the centre of the top-left pixel.
    pub fn to_pixel(self) -> PixelPoint {
        PixelPoint::new(self.x - HALF_PIXEL, self.y - HALF_PIXEL)
    }
}

/// A position on the sensor: mm, centre of the frame, x right, y up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorPoint {
    /// mm to the right.
    pub x: f64,
    /// mm upwards.
    pub y: f64,
}

/// The image area of a camera: the one place where px become mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    width: u32,
    height: u32,
    pitch_um: f64,
}

/// A frame that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("a frame needs a width and a height of at least 1 px and a positive pitch in um, found {width} x {height} px, {pitch_um} um")]
pub struct FrameError {
    width: u32,
    height: u32,
    pitch_um: f64,
}

impl Frame {
    /// A frame of `width` x `height` px of `pitch_um` micrometres each.
    ///
    /// # Errors
    /// A size of zero, a pitch that is not positive and finite.
    pub fn new(width: u32, height: u32, pitch_um: f64) -> Result<Self, FrameError> {
        if width == 0 || height == 0 || !pitch_um.is_finite() || pitch_um <= 0.0 {
            return Err(FrameError { width, height, pitch_um });
        }
        Ok(Self { width, height, pitch_um })
    }

    /// px to mm: from the centre of the frame, y up.
    pub fn to_sensor(&self, point: PixelPoint) -> SensorPoint {
        let (cx, cy) = self.centre();
        let mm = self.pitch_um * 1e-3;
        SensorPoint { x: (point.x - cx) * mm, y: (cy - point.y) * mm }
    }

    /// mm to px.
    pub fn to_pixel(&self, point: SensorPoint) -> PixelPoint {
        let (cx, cy) = self.centre();
        let mm = self.pitch_um * 1e-3;
        PixelPoint::new(cx + point.x / mm, cy - point.y / mm)
    }

    fn centre(&self) -> (f64, f64) {
        (f64::from(self.width - 1) / 2.0, f64::from(self.height - 1) / 2.0)
    }
}

/// Covariance of a position in an image, px^2, in the axes of [`PixelPoint`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covariance {
    /// Variance of x, px^2.
    pub sxx: f64,
    /// Covariance of x and y, px^2.
    pub sxy: f64,
    /// Variance of y, px^2.
    pub syy: f64,
}

impl Covariance {
    /// Whether this is a covariance: finite, no negative variance, |rho| <= 1 within rounding.
    pub fn is_valid(&self) -> bool {
        let product = self.sxx * self.syy;
        self.sxx >= 0.0 && self.syy >= 0.0 && product.is_finite() && self.sxy * self.sxy <= product * (1.0 + 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_centre_of_the_frame_is_the_middle_of_the_outer_pixel_centres() {
        let frame = Frame::new(1362, 1021, 4.70).unwrap();
        let centre = frame.to_sensor(PixelPoint::new(680.5, 510.0));
        assert_eq!((centre.x, centre.y), (0.0, 0.0));
    }

    #[test]
    fn the_nearest_is_the_first_of_those_within_reach() {
        let at = |x, y| PixelPoint::new(x, y);
        let others = [at(9.0, 0.0), at(3.0, 4.0), at(-3.0, 4.0)];
        assert_eq!(at(0.0, 0.0).nearest(&others, 5.0), Some(others[1]), "as far as it may be");
        assert_eq!(at(0.0, 0.0).nearest(&others, 4.999), None);
        assert_eq!(at(0.0, 0.0).nearest(&[], f64::INFINITY), None);
    }

    #[test]
    fn sensor_y_points_up_and_a_pixel_is_its_pitch() {
        let frame = Frame::new(101, 101, 5.0).unwrap();
        let p = frame.to_sensor(PixelPoint::new(51.0, 51.0));
        assert!((p.x - 0.005).abs() < 1e-15 && (p.y + 0.005).abs() < 1e-15, "{p:?}");
    }

    #[test]
    fn corner_frame_is_half_a_pixel_off() {
        let corner = PixelPoint::new(0.0, 0.0).to_corner();
        assert_eq!((corner.x, corner.y), (0.5, 0.5));
        assert_eq!(corner.to_pixel(), PixelPoint::new(0.0, 0.0));
    }

    #[test]
    fn covariance_knows_impossible_correlations() {
        assert!(Covariance { sxx: 1.0, sxy: 0.5, syy: 1.0 }.is_valid());
        assert!(!Covariance { sxx: 1.0, sxy: 1.5, syy: 1.0 }.is_valid());
        assert!(!Covariance { sxx: f64::NAN, sxy: 0.0, syy: 1.0 }.is_valid());
        assert!(!Covariance { sxx: -1.0, sxy: 0.0, syy: -1.0 }.is_valid());
    }

    proptest::proptest! {
        #[test]
        fn pixel_to_sensor_and_back(x in -1e4..1e4f64, y in -1e4..1e4f64, pitch in 0.5..20.0f64) {
            let frame = Frame::new(4272, 2848, pitch).unwrap();
            let p = PixelPoint::new(x, y);
            proptest::prop_assert!(p.distance(frame.to_pixel(frame.to_sensor(p))) < 1e-9);
        }
    }
}
