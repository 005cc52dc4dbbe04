//! Sequences of which no frame can be chosen.

use std::io;
use std::path::{Path, PathBuf};

use calibench_images::{Foreign, PhotoError};
use calibench_model::camera::ImageSize;
use thiserror::Error;

/// The variable of the environment that holds where the program `ffmpeg` is, if it is not on the path.
pub const FFMPEG: &str = "CALIBENCH_FFMPEG";

/// What is wrong with a video or an image sequence.
#[derive(Debug, Error)]
pub enum FramesError {
    /// A photograph of a sequence.
    #[error(transparent)]
    Photo(#[from] PhotoError),
    /// The program that reads videos is not there.
    #[error(
        "{}: is a video, which the program `ffmpeg` reads, and there is none: expected it on the path or under the name that {FFMPEG} holds; `apt-get install ffmpeg` \
         installs it, or make frames where it is: {}", path.display(), conversion(path)
    )]
    Missing {
        /// The video.
        path: PathBuf,
    },
    /// It cannot be started, or its answer cannot be read.
    #[error("{}: ffmpeg: {source}", path.display())]
    Program {
        /// The video.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// It fails.
    #[error("{}: ffmpeg reads {frames} frames and fails: {said}; expected a whole video that it plays: copy it again, or make frames of what is there: {}", path.display(), conversion(path))]
    Failed {
        /// The video.
        path: PathBuf,
        /// Frames that it gave before.
        frames: usize,
        /// What it says.
        said: String,
    },
    /// Sound alone, say.
    #[error("{}: has no video stream; expected a file with pictures", path.display())]
    NoStream {
        /// The file.
        path: PathBuf,
    },
    /// What ffmpeg answers is no picture.
    #[error("{}: frame {frame}: ffmpeg answers {found}; expected a picture of grey levels (PGM)", path.display())]
    Answer {
        /// The video.
        path: PathBuf,
        /// The frame, counted from 0.
        frame: usize,
        /// What is there instead.
        found: String,
    },
    /// Frames of several sizes make no camera.
    #[error(
        "{name} has {} x {} px, the frames before it {} x {} px; expected frames of one size: a video and a camera's photographs are of two cameras, each calibrated by itself",
        size.width, size.height, before.width, before.height
    )]
    Sizes {
        /// The frame.
        name: String,
        /// Its size.
        size: ImageSize,
        /// That of the others.
        before: ImageSize,
    },
}

/// The line of a shell that makes frames of a video.
fn conversion(path: &Path) -> String {
    format!("`{}`", Foreign::Video.conversion(path))
}
