//! Says whether the photographs that some tests need are there, `cfg(photographs)`, and whether OpenCV's markers are where we know them, `cfg(aruco_contrib)`. Takes a digest of
//! the code here, `CALIBENCH_OPENCV_CODE`.

use std::path::Path;
use std::process::Command;

#[path = "../code.rs"]
mod code;

#[path = "../test_data.rs"]
mod test_data;

fn main() {
    test_data::announce(&[("photographs", "opencv-left")]);
    println!("cargo::rerun-if-changed=src");
    let own = code::sources(Path::new(""), Path::new("src"));
    println!("cargo::rustc-env=CALIBENCH_OPENCV_CODE={}", code::digest(&[code::compiler()], &[&own]));
    println!("cargo::rustc-check-cfg=cfg(aruco_contrib)");
    if has_aruco() {
        println!("cargo::rustc-cfg=aruco_contrib");
    }
}

/// Whether OpenCV is one whose contrib has the module `aruco` with ChArUco boards made by `create`; later versions have moved it.
fn has_aruco() -> bool {
    let asked = |what: &str| {
        let answer = Command::new("pkg-config").args([what, "opencv4"]).output().ok().filter(|answer| answer.status.success())?;
        String::from_utf8(answer.stdout).ok()
    };
    let version = asked("--modversion").unwrap_or_default();
    let mut parts = version.trim().split('.').map(str::parse::<u32>);
    let known = matches!((parts.next(), parts.next()), (Some(Ok(4)), Some(Ok(5 | 6))));
    let folders = asked("--cflags-only-I").unwrap_or_default();
    let has = |folder: &str| Path::new(folder).join("opencv2/aruco/charuco.hpp").is_file();
    known && folders.split_whitespace().filter_map(|flag| flag.strip_prefix("-I")).any(has)
}
