//! Says whether the photographs and camera files that some tests need are there: `cfg(photographs)`, `cfg(camera_files)`, `cfg(webcam)`.

#[path = "../harness/test_data.rs"]
mod test_data;

fn main() {
    test_data::announce(&[("photographs", "opencv-left"), ("camera_files", "cameras"), ("webcam", "webcam")]);
}
