//! Scenes to images whose truth is known exactly.
//!
//! [`view`] brings a testfield before a camera, [`raster`] integrates outlines over each photosite under the blur of [`optics`], [`render()`] does so for a flat
//! scene, [`noise`] spoils an image, [`pointing`] makes the approximate positions that a person would click. Every random number comes from
//! [`random::stream`].

mod centres;
pub mod noise;
pub mod optics;
pub mod overlap;
pub mod pointing;
pub mod random;
pub mod raster;
pub mod render;
pub mod sensor;
pub mod view;

pub use render::{draw, render};
