//! What the report on Zhu, Wu & Wan 2007 has beside its tables: the strength surface, the eight corners close up, theoretical against actual precision,
//! and the bias along the bisector.

mod bias;
mod close;
mod part;
mod precision;
mod surface;

use super::canvas::Canvas;
use super::load::Loaded;
use super::sweep::LoadedSweep;

/// The family of the report.
pub const FAMILY: &str = "zhu-2007";

/// Its sections and pictures, as far as the records of the scenarios are there.
pub fn section(plain: &[&Loaded], swept: &[&LoadedSweep]) -> (String, Vec<(String, Canvas)>) {
    let scene = |name: &str| plain.iter().find(|loaded| loaded.scenario.name == format!("{FAMILY}/{name}")).copied();
    let sweep = |name: &str| swept.iter().find(|loaded| loaded.scenario.name == format!("{FAMILY}/{name}")).copied();
    let parts = [
        scene("table-1-rendered").and_then(surface::section),
        scene("table-1").and_then(close::section),
        sweep("bias").and_then(bias::section),
        scene("table-1").zip(sweep("table-2")).and_then(|(images, noisy)| precision::section(images, noisy)),
    ];
    let (mut text, mut pictures) = (String::new(), Vec::new());
    for (part, picture) in parts.into_iter().flatten() {
        text.push_str(&part);
        pictures.extend(picture);
    }
    (text, pictures)
}
