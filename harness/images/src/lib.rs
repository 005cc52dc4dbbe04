//! Photographs and other pictures in files: grey values, depths and turns as cameras write them, PNG as we do, all channels row by row, and maps from pixel to pixel.

pub mod photo;
pub mod picture;
pub mod st_map;

pub use photo::{
    DeepLevels, Depth, Foreign, Head, Photo, PhotoError, PhotoFolder, Reading, Turn, encode_float_tiff, encode_png, encode_png_densely,
    head_of, natural, parse_photo, read_photo, read_photo_as, read_with_levels, size_of, write_png,
};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
