//! Says whether the photographs that some tests need are there: `cfg(photographs)`.

#[path = "../test_data.rs"]
mod test_data;

fn main() {
    test_data::announce(&[("photographs", "opencv-left")]);
}
