//! Scenes to images whose truth is known exactly.
//!
//! [`render()`] integrates a scene of polygons over each pixel's area, [`noise`] spoils the image as a sensor would, [`pointing`]
//! makes the approximate positions that a person would click. [`testfield`] makes what a camera is pointed at, [`stations`] where it stands. Every random number comes from [`random::stream`].

pub mod coverage;
pub mod noise;
pub mod overlap;
pub mod pointing;
pub mod random;
pub mod render;
pub mod stations;
pub mod testfield;

pub use render::{draw, render};
