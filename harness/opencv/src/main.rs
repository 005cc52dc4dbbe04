//! The `calibench` command with OpenCV's methods.
fn main() {}
