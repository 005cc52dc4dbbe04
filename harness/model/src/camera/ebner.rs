//! The canonical orientation with Ebner's twelve additional parameters.

use super::Photogrammetric;

/// [`Photogrammetric`] with Ebner's twelve additional parameters. Direction: **measured to ideal**; mm; y points up.
///
/// On measured coordinates `x`, `y` from the principal point, with the spacing `b` of a 3 x 3 grid, `B = 2 b^2 / 3`, `X = x^2 - B`, `Y = y^2 - B`:
/// `dx = b1 x + b2 y - 2 b3 X + b4 x y + b5 Y + b7 x Y + b9 y X + b11 X Y`,
/// `dy = -b1 y + b2 x + b3 x y - 2 b4 Y + b6 X + b8 y X + b10 x Y + b12 X Y`,
/// subtracted from the measured coordinates beside the base's own terms.
///
/// On the grid, and there only, they are orthogonal to each other and to the effects of the exterior orientation.
///
/// Source: Ebner 1976; Vosselman and Förstner 1988. Whether the origin is the principal point or the centre of the frame is not settled by them; the
/// principal point is assumed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ebner {
    /// Principal distance, principal point and, usually zero, distortion.
    pub base: Photogrammetric,
    /// Spacing of the grid, mm.
    pub b_mm: f64,
    /// b1 to b12: b1, b2 are numbers; b3 to b6 in mm^-1; b7 to b10 in mm^-2; b11, b12 in mm^-3.
    pub parameters: [f64; 12],
}
