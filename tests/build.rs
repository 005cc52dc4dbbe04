//! Tells the tests whether the photographs are there: without them, what needs them is ignored, by name.

use std::path::PathBuf;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(photographs)");
    println!("cargo::rerun-if-env-changed=CALIBENCH_DATA");
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let data = std::env::var_os("CALIBENCH_DATA").map_or_else(|| here.join("../../shared/data"), PathBuf::from);
    let photographs = data.join("opencv-left");
    println!("cargo::rerun-if-changed={}", photographs.display());
    if photographs.join("left01.jpg").is_file() {
        println!("cargo::rustc-cfg=photographs");
    }
}
