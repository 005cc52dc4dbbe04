//! What OpenCV makes of the same cameras, camera files and photographs.

mod camera_files;
mod cameras;
mod optimum;
