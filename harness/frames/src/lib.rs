//! Videos and image sequences to the frames that calibrate a camera.
//!
//! [`watch`] looks at every frame as it comes, on all threads, and keeps of each where the board is and how sharp it is; [`choose`] names the frames to calibrate from.

mod choice;
mod error;
mod information;
mod motion;
mod pgm;
mod sequence;
mod sharpness;
mod video;
mod watch;

pub use choice::{ALIKE, BLURRED, Choice, SHARP_PX, USUAL, choose};
pub use error::{FFMPEG, FramesError};
pub use motion::motion;
pub use pgm::Still;
pub use sequence::{Place, Raw, Sequence, Source, extract};
pub use sharpness::edge_width;
pub use video::{Heard, Video, is_video};
pub use watch::{Frame, Seen, Watched, watch};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
