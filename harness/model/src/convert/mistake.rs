//! The common mistakes, each alone.

use super::brown::frame;
use super::{ConvertError, Tangential, Target, naive};
use crate::camera::{Camera, Photogrammetric};
use crate::{PixelPoint, SensorPoint};

/// A mistake that people make on the way to a photogrammetric camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mistake {
    /// `k_i = K_i / c^(2i)`, `p = P / c`: the direction is ignored, and nothing else ([`naive()`] with [`Tangential::Converted`]).
    Naive,
    /// p1 and p2 in the other order.
    TangentialSwapped,
    /// The tool's y points down, and y0, p2 and b2 are taken as they are.
    VerticalNotFlipped,
    /// The correction is added instead of subtracted.
    SignOfCorrection,
    /// The principal point counts from the corner of the first pixel and is taken as from its centre.
    HalfPixel,
    /// Focal length, principal point and coefficients go through a wrong pixel pitch, and the image through the right one.
    WrongPitch {
        /// The wrong pitch, um.
        pitch_um: f64,
    },
    /// The focal length alone goes through a wrong pixel pitch.
    WrongPitchOfC {
        /// The wrong pitch, um.
        pitch_um: f64,
    },
    /// The principal point from the corner of the frame is taken as from its centre: x right, y up.
    PrincipalPointFromCorner,
    /// The sign of x0.
    SignOfX0,
    /// The sign of y0.
    SignOfY0,
}

/// What a mistake makes of `source`, whose right conversion is `right`.
///
/// # Errors
/// As [`naive()`] and [`Mistake::of`].
pub fn mistaken(source: &Camera, right: &Photogrammetric, mistake: Mistake) -> Result<Photogrammetric, ConvertError> {
    match mistake {
        Mistake::Naive => naive(source, right.pitch_um, Tangential::Converted),
        _ => mistake.of(right),
    }
}

impl Mistake {
    /// What the mistake makes of a right camera.
    ///
    /// # Errors
    /// [`ConvertError::NotInTable`] for [`Mistake::Naive`], which starts from the tool's camera: see [`mistaken`]; a pitch that is not positive.
    pub fn of(self, right: &Photogrammetric) -> Result<Photogrammetric, ConvertError> {
        let frame = frame(right.size, right.pitch_um)?;
        let point = frame.to_pixel(SensorPoint { x: right.x0, y: right.y0 });
        let at = |point: PixelPoint| {
            let SensorPoint { x, y } = frame.to_sensor(point);
            Photogrammetric { x0: x, y0: y, ..*right }
        };
        let corner = point.to_corner();
        let mm = right.pitch_um * 1e-3;
        let ([p1, p2], [b1, b2]) = (right.p, right.b);
        Ok(match self {
            Self::Naive => return Err(ConvertError::NotInTable),
            Self::TangentialSwapped => Photogrammetric { p: [p2, p1], ..*right },
            Self::VerticalNotFlipped => Photogrammetric { y0: -right.y0, p: [p1, -p2], b: [b1, -b2], ..*right },
            Self::SignOfCorrection => Photogrammetric { k: right.k.map(|k| -k), p: [-p1, -p2], b: [-b1, -b2], ..*right },
            Self::HalfPixel => at(PixelPoint::new(corner.x, corner.y)),
            Self::WrongPitch { pitch_um } => wrong_pitch(right, pitch_um)?,
            Self::WrongPitchOfC { pitch_um } => Photogrammetric { c: wrong_pitch(right, pitch_um)?.c, ..*right },
            Self::PrincipalPointFromCorner => Photogrammetric { x0: corner.x * mm, y0: -corner.y * mm, ..*right },
            Self::SignOfX0 => Photogrammetric { x0: -right.x0, ..*right },
            Self::SignOfY0 => Photogrammetric { y0: -right.y0, ..*right },
        })
    }
}

fn wrong_pitch(right: &Photogrammetric, pitch_um: f64) -> Result<Photogrammetric, ConvertError> {
    let target = Target::photogrammetric(pitch_um);
    target.check()?;
    match super::closed_form::exact(&(*right).into(), &target) {
        Some(Camera::Photogrammetric(camera)) => Ok(Photogrammetric { pitch_um: right.pitch_um, ..camera }),
        _ => Err(ConvertError::NotInTable),
    }
}
