//! The same camera in other images: of a part of them, in another size, binned, turned. What was asked for, what that is of images of a size, and what becomes of
//! all that is known of a camera.

mod named;
mod same_camera;
#[cfg(test)]
mod tests;

use std::fmt;

use thiserror::Error;

use crate::PixelPoint;
use crate::camera::{Camera, ImageSize, Ray, Reframe, Resampling, Turn};

pub use same_camera::{OtherImages, OtherSize, same_camera};

/// The largest denominator of a factor that is said as a fraction.
const SIMPLE: u32 = 16;

/// A part of images, whole pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// The first column, from 0.
    pub x: u32,
    /// The first row, from 0.
    pub y: u32,
    /// Columns and rows.
    pub size: ImageSize,
}

/// Another size of images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scaling {
    /// Resampled to so many columns and rows: their edges stay edges.
    Size(ImageSize),
    /// Resampled by a factor; a last column or row that is not whole is rounded, and the factor stays.
    Times(f64),
    /// Squares of so many pixels become one; what is left over on the right and below is cut off.
    Binned(u32),
}

/// What images become: a part of them, of which the size is changed, which is turned; in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameChange {
    /// The part.
    pub crop: Option<Crop>,
    /// The size of the part.
    pub scaling: Option<Scaling>,
    /// The turn, clockwise.
    pub turn: Option<Turn>,
}

/// A [`FrameChange`] of images of a size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reframing {
    /// The part and its size.
    pub resampling: Resampling,
    /// Then turned, clockwise.
    pub turn: Option<Turn>,
}

/// Why a camera is none in other images.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ReframingError {
    /// A part beyond the images.
    #[error(
        "the part of {width} x {height} px from column {x} and row {y} on reaches beyond images of {} x {} px", images.width, images.height,
        x = crop.x, y = crop.y, width = crop.size.width, height = crop.size.height
    )]
    Beyond {
        /// The part.
        crop: Crop,
        /// Size of the images.
        images: ImageSize,
    },
    /// No pixel is left, or more than can be counted.
    #[error("of {} x {} px that makes images of {width} x {height} px; expected one pixel at least, and sides that can be counted", part.width, part.height)]
    NoImage {
        /// The part.
        part: ImageSize,
        /// New columns.
        width: f64,
        /// New rows.
        height: f64,
    },
    /// Columns and rows are scaled differently, and the model has one focal length.
    #[error(
        "columns times {}, rows times {}: `{model}` has one focal length, and no place for two scales; keep the aspect, or convert to a model with fx and fy first",
        factor(scale[0]), factor(scale[1])
    )]
    OneScale {
        /// The convention's name.
        model: &'static str,
        /// Along rows and along columns.
        scale: [f64; 2],
    },
    /// The turned camera is none of the model.
    #[error(
        "turned by {degrees} degrees: `{model}` has no place for what {parameter} becomes; expected zero: convert to a convention without it first (opencv5 has no \
         b2 and no skew), or turn by 180"
    )]
    Turned {
        /// The convention's name.
        model: &'static str,
        /// Clockwise.
        degrees: u16,
        /// What is not zero.
        parameter: &'static str,
    },
    /// The covariance is not that of the camera.
    #[error("{0}")]
    Covariance(String),
}

impl FrameChange {
    /// Whether nothing is asked for.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// What that is of images of `size`.
    ///
    /// # Errors
    /// [`ReframingError::Beyond`], [`ReframingError::NoImage`].
    pub fn of(&self, size: ImageSize) -> Result<Reframing, ReframingError> {
        let Crop { x, y, size: part } = self.crop.unwrap_or(Crop { x: 0, y: 0, size });
        let fits = |first: u32, count: u32, all: u32| count > 0 && first.checked_add(count).is_some_and(|end| end <= all);
        if !(fits(x, part.width, size.width) && fits(y, part.height, size.height)) {
            return Err(ReframingError::Beyond { crop: Crop { x, y, size: part }, images: size });
        }
        let [width, height] = [part.width, part.height].map(f64::from);
        let (scale, [columns, rows]) = match self.scaling {
            None => ([1.0; 2], [width, height]),
            Some(Scaling::Size(to)) => {
                let [columns, rows] = [to.width, to.height].map(f64::from);
                ([columns / width, rows / height], [columns, rows])
            }
            Some(Scaling::Times(times)) => ([times; 2], [width, height].map(|side| (times * side).round())),
            Some(Scaling::Binned(count)) => {
                let count = f64::from(count);
                ([1.0 / count; 2], [width, height].map(|side| (side / count).floor()))
            }
        };
        let side = |side: f64| (side >= 1.0 && side <= f64::from(u32::MAX)).then_some(side as u32);
        let (Some(new_width), Some(new_height)) = (side(columns), side(rows)) else {
            return Err(ReframingError::NoImage { part, width: columns, height: rows });
        };
        let new = ImageSize { width: new_width, height: new_height };
        let resampling = Resampling { from: size, offset: [x, y].map(f64::from), scale, size: new };
        Ok(Reframing { resampling, turn: self.turn })
    }
}

impl Reframing {
    /// Whether the images stay what they are.
    pub fn is_none(&self) -> bool {
        self.turn.is_none() && self.resampling == Resampling::none(self.resampling.from)
    }

    /// Size of the new images.
    pub fn size(&self) -> ImageSize {
        self.turn.map_or(self.resampling.size, |turn| turn.size(self.resampling.size))
    }

    /// Where a place of the images is in the new ones.
    pub fn point(&self, at: PixelPoint) -> PixelPoint {
        let at = self.resampling.point(at);
        self.turn.map_or(at, |turn| turn.point(self.resampling.size, at))
    }

    /// A ray in the axes of the new camera.
    pub fn ray(&self, ray: Ray) -> Ray {
        self.turn.map_or(ray, |turn| turn.ray(ray))
    }

    /// The same camera in the new images: it pictures [`Self::ray`] of a ray at [`Self::point`] of its image.
    ///
    /// # Errors
    /// [`ReframingError::OneScale`], [`ReframingError::Turned`].
    pub fn camera(&self, camera: &Camera) -> Result<Camera, ReframingError> {
        let model = camera.convention().name;
        if !(self.resampling.is_isotropic() || camera.has_two_scales()) {
            return Err(ReframingError::OneScale { model, scale: self.resampling.scale });
        }
        let without_place = self.turn.and_then(|turn| Some((turn.degrees(), camera.without_place(turn)?)));
        if let Some((degrees, parameter)) = without_place {
            return Err(ReframingError::Turned { model, degrees, parameter });
        }
        Ok(self.of_model(camera))
    }

    /// The same, of a model that holds it.
    fn of_model<T: Reframe>(&self, camera: &T) -> T {
        let resampled = camera.resampled(&self.resampling);
        match self.turn {
            Some(turn) => resampled.turned(turn),
            None => resampled,
        }
    }
}

/// What is done, in words: `1600 x 1200 px, rows 150 to 1049, times 4/5: 1280 x 720 px`.
impl fmt::Display for Reframing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Resampling { from, offset, scale, size } = self.resampling;
        write!(f, "{} x {} px", from.width, from.height)?;
        let sides = [("columns", from.width, size.width), ("rows", from.height, size.height)];
        for (axis, (name, before, after)) in sides.into_iter().enumerate() {
            let count = (f64::from(after) / scale[axis] - 1e-6).ceil().min(f64::from(before) - offset[axis]);
            if count < f64::from(before) {
                write!(f, ", {name} {} to {}", offset[axis], offset[axis] + count - 1.0)?;
            }
        }
        match scale {
            [along, down] if along != down => write!(f, ", columns times {}, rows times {}", factor(along), factor(down))?,
            [times, _] if times != 1.0 => write!(f, ", times {}", factor(times))?,
            _ => {}
        }
        if let Some(turn) = self.turn {
            write!(f, ", turned by {} degrees clockwise", turn.degrees())?;
        }
        let ImageSize { width, height } = self.size();
        write!(f, ": {width} x {height} px")
    }
}

/// A factor as it is best read: `2/3`, `4`, `0.158730`.
fn factor(times: f64) -> String {
    let simple = (1..=SIMPLE).find(|q| {
        let whole = times * f64::from(*q);
        whole >= 0.5 && (whole.round() - whole).abs() < 1e-12 * whole
    });
    match simple {
        Some(1) => format!("{times:.0}"),
        Some(q) => format!("{:.0}/{q}", times * f64::from(q)),
        None => format!("{times:.6}"),
    }
}
