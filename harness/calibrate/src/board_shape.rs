//! What is asked of the shape of a board, in a word.

use std::str::FromStr;

use thiserror::Error;

/// What is asked of the shape of a board.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BoardShape {
    /// Flat or [`Self::Bent`]: what the observations say.
    Tested,
    /// As its coordinates say.
    #[default]
    Flat,
    /// Shifted along its normal by `a (1 - u^2) + b (1 - v^2) + c u v` with u and v from -1 to 1 over its extent: the general surface of second order,
    /// since pose makes up for height and tilt.
    Bent,
    /// The same without `c`, as mrcal has it.
    BentAxes,
    /// Every control point is free: [`crate::DatumChoice::Free`].
    Free,
}

/// Text that is no shape of a board.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("`{0}` is no shape of a board: expected tested, flat, bent, bent-axes or free")]
pub struct NoShape(String);

impl FromStr for BoardShape {
    type Err = NoShape;

    fn from_str(text: &str) -> Result<Self, NoShape> {
        match text {
            "tested" => Ok(Self::Tested),
            "flat" => Ok(Self::Flat),
            "bent" => Ok(Self::Bent),
            "bent-axes" => Ok(Self::BentAxes),
            "free" => Ok(Self::Free),
            _ => Err(NoShape(text.to_owned())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_is_a_word() {
        let shapes = ["tested", "flat", "bent", "bent-axes", "free"].map(str::parse);
        assert_eq!(shapes, [BoardShape::Tested, BoardShape::Flat, BoardShape::Bent, BoardShape::BentAxes, BoardShape::Free].map(Ok));
        assert!("round".parse::<BoardShape>().unwrap_err().to_string().contains("expected tested, flat, bent, bent-axes or free"));
    }
}
