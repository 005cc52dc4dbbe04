//! Discs: the centre of their picture is not the picture of their centre, and the adjustment is told so.

mod centred;
mod pictured;
mod plane;
mod which;

use std::str::FromStr;

use thiserror::Error;

pub use centred::Eccentricity;
pub use pictured::{Offset, offsets};
pub(crate) use which::Known;

/// Which targets are discs, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Discs {
    /// Those whose radius the control file states.
    Control,
    /// Those too whose radius it does not state: all have this one, object units.
    Radius(f64),
}

/// Text that says nothing of discs.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "`{0}` is no radius of discs: expected a positive number in object units, or `control` for the columns radius and nX,nY,nZ of the control file"
)]
pub struct NoDiscs(String);

impl FromStr for Discs {
    type Err = NoDiscs;

    fn from_str(text: &str) -> Result<Self, NoDiscs> {
        if text == "control" {
            return Ok(Self::Control);
        }
        let radius = text.parse().ok().filter(|radius: &f64| *radius > 0.0 && radius.is_finite());
        radius.map(Self::Radius).ok_or_else(|| NoDiscs(text.into()))
    }
}

#[cfg(test)]
mod tests;
