//! mrcal's splines, kept as a file has them.

use serde::{Deserialize, Serialize};

use crate::camera::Splined;
use crate::convert::{ERROR_PX, Region};

/// The splines of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Splines {
    /// As the file has them.
    pub model: Splined,
    /// How far the camera that was fitted to them is off at most, px.
    pub residual_px: f64,
    /// Over what it was fitted.
    pub region: Region,
}

impl Splines {
    /// Why the camera that was fitted to them stands for them in nothing that is to be right; `None` where it is near enough.
    pub fn doubt(&self) -> Option<String> {
        let Self { residual_px, region, .. } = self;
        let far =
            (*residual_px > ERROR_PX).then(|| format!("the nearest camera of another model{} is {residual_px:.2} px off", within(*region)));
        far.map(|far| format!("holds a splined model, and {far}; convert it first, with --radius PX where it is good enough or --accept"))
    }
}

/// Over what, in words; nothing for the frame.
pub fn within(region: Region) -> String {
    match region {
        Region::Frame => String::new(),
        Region::Radius { px } => format!(" within {px:.0} px of its axis, as a part of the frame has no ray"),
    }
}
