//! Says whether the photographs and camera files that some tests need are there: `cfg(photographs)`, `cfg(camera_files)`.

use std::env;
use std::path::PathBuf;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(photographs, camera_files)");
    println!("cargo::rerun-if-env-changed=CALIBENCH_DATA");
    println!("cargo::rerun-if-changed=build.rs");
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let data = env::var_os("CALIBENCH_DATA").map_or_else(beside, PathBuf::from);
    for (cfg, folder) in [("photographs", "opencv-left"), ("camera_files", "cameras")] {
        let folder = data.join(folder);
        // A path that does not exist would count as changed at every build.
        if folder.is_dir() {
            println!("cargo::rerun-if-changed={}", folder.display());
            println!("cargo::rustc-cfg={cfg}");
        }
    }
}
