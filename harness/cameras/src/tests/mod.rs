//! Camera files, read and written.

mod anipose;
mod any_model;
mod asked_for;
mod colmap_files;
mod encodings;
mod files;
mod malformed;
mod numpy;
mod other_names;
mod own_format;
mod panorama;
mod reality_scan;
mod recognised;
mod reconstructions;
mod renderers;
mod round_trip;
mod same_camera;
mod splines;
mod spreads;
mod tool_formats;
mod tool_formats_malformed;
mod unknown;
mod unknown_keys;

use calibench_model::camera::{Camera, CameraModel, ImageSize};

use super::{CameraFile, NamedCamera, ReadOptions, parse_camera};

/// For files that do not state a size.
fn of_size() -> ReadOptions {
    ReadOptions { size: Some(ImageSize { width: 640, height: 480 }), ..ReadOptions::default() }
}

/// A text, read.
fn read(text: &str) -> Result<CameraFile, String> {
    read_with(text, ReadOptions::default())
}

#[expect(clippy::needless_pass_by_value, reason = "options are made where they are given")]
fn read_with(text: &str, options: ReadOptions) -> Result<CameraFile, String> {
    parse_camera("f", text.as_bytes(), &options).map_err(|error| error.to_string())
}

/// A file from which the readers' mistakes are tried.
fn seed(name: &str) -> String {
    let path = format!("{}/../../tests/calibench/fuzz/seeds/cameras/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Options of a size alone.
fn sized_options(size: ImageSize) -> ReadOptions {
    ReadOptions { size: Some(size), ..ReadOptions::default() }
}

/// The largest difference of two cameras' parameters, relative to the parameter, or to the focal length for lengths of the same unit.
fn difference(a: &Camera, b: &Camera) -> f64 {
    assert_eq!(a.size(), b.size());
    let (a, b) = (a.parameters(), b.parameters());
    assert!(a.iter().map(|p| p.name).eq(b.iter().map(|p| p.name)));
    let lengths = ["px", "mm"];
    let relative = |(a, b): (&calibench_model::camera::CameraParameter, &calibench_model::camera::CameraParameter)| {
        let scale = if lengths.contains(&a.unit) { a.value.abs().max(1000.0) } else { a.value.abs() };
        if a.value == b.value { 0.0 } else { (a.value - b.value).abs() / scale }
    };
    a.iter().zip(&b).map(relative).fold(0.0, f64::max)
}

/// Asserts that two lists of cameras are the same, parameters to `tolerance` and all else exactly, but for notes.
fn assert_same(a: &[NamedCamera], b: &[NamedCamera], tolerance: f64) {
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert!(difference(&a.camera, &b.camera) <= tolerance, "{:?}\n{:?}", a.camera, b.camera);
        assert_eq!((&a.name, &a.pose, &a.covariance), (&b.name, &b.pose, &b.covariance));
        match (a.pitch_um, b.pitch_um) {
            (Some(a), Some(b)) => assert!((a - b).abs() <= 1e-12 * a),
            (a, b) => assert_eq!(a, b),
        }
    }
}
