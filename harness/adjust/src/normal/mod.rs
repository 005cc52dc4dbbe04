//! Normal equations by blocks: cameras, exterior orientations, object points, and what couples them.

mod blocks;
mod distances;
mod gram;
mod image_equations;
mod observed_unknowns;
mod own;
mod own_elimination;
mod projection;
mod robust;

#[cfg(test)]
mod tests;

pub(crate) use blocks::{Normals, Rows, Scratch, linearise, residuals};
pub(crate) use distances::Stretch;
pub(crate) use gram::{BLOCK, LANES, Tile, gram};
pub(crate) use image_equations::{Lost, Residual};
pub(crate) use robust::Loss;
