//! Says whether the camera files that some tests need are there: `cfg(camera_files)`, and where.

use std::env;
use std::path::PathBuf;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(camera_files)");
    println!("cargo::rerun-if-env-changed=CALIBENCH_DATA");
    println!("cargo::rerun-if-changed=build.rs");
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let cameras = env::var_os("CALIBENCH_DATA").map_or_else(beside, PathBuf::from).join("cameras");
    // A path that does not exist would count as changed at every build.
    if cameras.is_dir() {
        println!("cargo::rerun-if-changed={}", cameras.display());
        println!("cargo::rustc-cfg=camera_files");
        println!("cargo::rustc-env=CALIBENCH_CAMERA_FILES={}", cameras.display());
    }
}
