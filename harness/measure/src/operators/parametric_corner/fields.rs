//! Grey values of a block of pixels with their derivatives, compiled once for all fits: in each of them it would be the most of its code.

use super::model::{Field, Model};
use crate::lanes::{BLOCK, Block};

/// Both edges are near.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
pub(super) fn corner<const CURVED: bool>(model: &Model<f32>, x: &Block, y: &Block) -> Field<f32, BLOCK> {
    model.corner::<BLOCK, CURVED>(x, y)
}

/// Only edge `which` is near; `side` is the sign of the distance from the other.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
pub(super) fn edge<const CURVED: bool>(model: &Model<f32>, which: usize, side: &Block, x: &Block, y: &Block) -> Field<f32, BLOCK> {
    model.edge::<BLOCK, CURVED>(which, side, x, y)
}
