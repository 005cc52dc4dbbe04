//! Says whether the photographs that some tests need are there: `cfg(photographs)`, and where.

use std::env;
use std::path::PathBuf;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(photographs)");
    println!("cargo::rerun-if-env-changed=CALIBENCH_DATA");
    println!("cargo::rerun-if-changed=build.rs");
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let photographs = env::var_os("CALIBENCH_DATA").map_or_else(beside, PathBuf::from).join("opencv-left");
    // A path that does not exist would count as changed at every build.
    if photographs.is_dir() {
        println!("cargo::rerun-if-changed={}", photographs.display());
        println!("cargo::rustc-cfg=photographs");
    }
}
