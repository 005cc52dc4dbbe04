//! Says whether the camera files that some tests need are there: `cfg(camera_files)`.

#[path = "../test_data.rs"]
mod test_data;

fn main() {
    test_data::announce(&[("camera_files", "cameras")]);
}
