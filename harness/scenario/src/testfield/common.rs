//! What several kinds of testfield have in common.

use calibench_synth::testfield::{Levels, SheetBend};

use super::wire::{Degrees, Height};
use crate::wire::Grey;

/// Background where the file gives none, fraction of full scale.
pub const BACKGROUND: f64 = 0.2;

/// Reflectances of paper and ink, fractions of what makes full scale; the usual ones where the file gives none.
pub fn levels(paper: Option<Grey>, ink: Option<Grey>) -> Levels {
    let usual = Levels::default();
    Levels { paper: paper.map_or(usual.paper, |level| level.0), ink: ink.map_or(usual.ink, |level| level.0) }
}

/// The bend of a sheet, if it has one: `peak` in object units, `across` in degrees, which become radians.
pub fn bend(peak: Option<Height>, across: Option<Degrees>) -> Option<SheetBend> {
    let peak = peak.map(|peak| peak.0).filter(|peak| *peak != 0.0)?;
    Some(SheetBend { peak, across: across.map_or(0.0, |angle| angle.0.to_radians()) })
}
