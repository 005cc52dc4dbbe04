//! What the report on Zhu, Wu & Wan 2007 has beside its tables: the strength surface, the eight corners close up, theoretical against actual precision,
//! and the bias along the bisector.

mod bias;
mod close;
mod part;
mod surface;
mod theoretical_precision;

use super::canvas::Canvas;
use super::load::{LoadError, Loaded};
use super::sweep::LoadedSweep;

/// The family of the report.
pub const FAMILY: &str = "zhu-2007";

/// Its sections and pictures, as far as the records of the scenarios are there.
///
/// # Errors
/// Records that cannot be read.
pub fn section(plain: &[&Loaded], swept: &[&LoadedSweep]) -> Result<(String, Vec<(String, Canvas)>), LoadError> {
    let scene = |name: &str| plain.iter().find(|loaded| loaded.name == format!("{FAMILY}/{name}")).copied();
    let sweep = |name: &str| swept.iter().find(|loaded| loaded.name == format!("{FAMILY}/{name}")).copied();
    let peak = scene("table-1-rendered").map(surface::section).transpose()?;
    let precise =
        scene("table-1").zip(sweep("table-2")).map(|(images, noisy)| theoretical_precision::section(images, noisy)).transpose()?;
    let parts = [peak.flatten(), scene("table-1").and_then(close::section), sweep("bias").and_then(bias::section), precise.flatten()];
    let (mut text, mut pictures) = (String::new(), Vec::new());
    for (part, picture) in parts.into_iter().flatten() {
        text.push_str(&part);
        pictures.extend(picture);
    }
    Ok((text, pictures))
}
