//! Scenes to images whose truth is known exactly.
//!
//! [`testfield`] makes what a camera is pointed at, [`stations`] where it stands, [`view`] brings the one before the other; [`raster`] integrates outlines over each
//! photosite under the blur of [`optics`], [`sensor`] reads the light out. [`local`] distorts beyond what camera models hold. [`render()`] pictures a flat
//! scene, [`noise`] spoils an image, [`pointing`] makes the approximate positions that a person would click. Every random number comes from [`calibench_random::stream`].

pub mod bound;
pub mod local;
pub mod noise;
pub mod optics;
pub mod overlap;
mod pixel_centres;
pub mod pointing;
pub mod raster;
pub mod render;
pub mod sensor;
pub mod stations;
pub mod testfield;
pub mod view;

pub use render::{draw, render};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
