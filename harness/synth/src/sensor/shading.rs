//! Light that is not even over the frame: the lens's fall-off and the illumination's gradient.

use calibench_model::PixelPoint;

use super::{Frame, SensorError, check};

/// How the image darkens towards its corners, as a factor of each pixel, taken at the pixel's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vignetting {
    /// Where it is brightest, the principal point; `None` is the centre of the frame.
    pub centre: Option<PixelPoint>,
    /// How it falls off.
    pub fall_off: FallOff,
}

/// Fall-off with the radius from the vignetting's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FallOff {
    /// cos^4 of the ray's angle at principal distance `c` px, the natural fall-off of a thin lens: (1 + r^2 / c^2)^-2.
    Cos4 {
        /// Principal distance, px.
        c: f64,
    },
    /// 1 + a1 t + a2 t^2 + a3 t^3, t the square of the radius in half diagonals of the frame (pixel centre to pixel centre); below zero is dark.
    Polynomial([f64; 3]),
}

/// A linear gain over the frame, 1 at its centre: light from one side. Taken at the pixel's centre; below zero is dark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    /// Gain along the row, to the right: fraction of the light at the frame's centre.
    pub x: f64,
    /// Gain along the column, downwards: fraction of the light at the frame's centre.
    pub y: f64,
    /// What `x` and `y` are fractions of light per.
    pub per: Per,
}

/// A length that a gradient is stated for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// One pixel.
    Pixel,
    /// The frame, from the centre of its first pixel to that of its last.
    Frame,
}

impl Vignetting {
    pub(super) fn check(&self) -> Result<(), SensorError> {
        if let Some(centre) = self.centre {
            check("the vignetting's centre", centre.x, -1e6, 1e6)?;
            check("the vignetting's centre", centre.y, -1e6, 1e6)?;
        }
        match self.fall_off {
            FallOff::Cos4 { c } => check("the principal distance of cos^4", c, 1e-3, 1e9),
            FallOff::Polynomial(a) => a.iter().try_for_each(|&a| check("a coefficient of the vignetting", a, -100.0, 100.0)),
        }
    }

    fn apply(&self, row: &mut [f32], y: usize, frame: Frame) {
        let middle = frame.centre();
        let centre = self.centre.unwrap_or(middle);
        let dy2 = (y as f64 - centre.y).powi(2);
        let each = |row: &mut [f32], factor: &dyn Fn(f64) -> f64| {
            row.iter_mut().enumerate().for_each(|(x, grey)| {
                let dx = x as f64 - centre.x;
                *grey *= factor(dx * dx + dy2) as f32;
            });
        };
        match self.fall_off {
            FallOff::Cos4 { c } => {
                let scale = 1.0 / (c * c);
                each(row, &|r2| (1.0 + r2 * scale).powi(-2));
            }
            FallOff::Polynomial([a1, a2, a3]) => {
                let half_diagonal2 = middle.x * middle.x + middle.y * middle.y;
                let scale = if half_diagonal2 > 0.0 { 1.0 / half_diagonal2 } else { 0.0 };
                each(row, &|r2| {
                    let t = r2 * scale;
                    (1.0 + t * (a1 + t * (a2 + t * a3))).max(0.0)
                });
            }
        }
    }
}

impl Gradient {
    pub(super) fn check(&self) -> Result<(), SensorError> {
        [self.x, self.y].into_iter().try_for_each(|gain| check("the illumination's gradient", gain, -2.0, 2.0))
    }

    fn apply(&self, row: &mut [f32], y: usize, frame: Frame) {
        let middle = frame.centre();
        let per_pixel = |gain: f64, length: usize| match self.per {
            Per::Pixel => gain,
            Per::Frame => gain / (length.max(2) - 1) as f64,
        };
        let (gx, gy) = (per_pixel(self.x, frame.width), per_pixel(self.y, frame.height));
        let left = 1.0 + (y as f64 - middle.y) * gy - middle.x * gx;
        for (x, grey) in row.iter_mut().enumerate() {
            *grey *= (left + x as f64 * gx).max(0.0) as f32;
        }
    }
}

/// The light that reaches row `y` when an even one would be 1.
pub(super) fn shade(vignetting: Option<Vignetting>, gradient: Option<Gradient>, row: &mut [f32], y: usize, frame: Frame) {
    if let Some(vignetting) = vignetting {
        vignetting.apply(row, y, frame);
    }
    if let Some(gradient) = gradient {
        gradient.apply(row, y, frame);
    }
}
