//! Pictures as another camera would have taken them: undistorted, in any model, with exact places and kernels whose error is known.
//!
//! A [`View`] says which ray each pixel of a picture shows; a [`Map`] of two views says where the pixels of one lie in the other, once for all photographs
//! of a camera; [`resample`] makes the picture, band by band, with a [`Kernel`].

#![expect(
    clippy::needless_range_loop,
    clippy::needless_bitwise_bool,
    reason = "lanes side by side: loops over places and tests without branches become vectors"
)]

mod cell;
mod frame;
mod kernel;
mod map;
mod picture;
mod points;
mod resample;
mod view;

pub use frame::{Fields, Frame, FrameError, Kept, Target, fields, framed, kept};
pub use kernel::Kernel;
pub use map::Map;
pub use picture::{Picture, PictureError, Sample};
pub use resample::{Level, reach, resample};
pub use view::{Equirectangular, View};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
