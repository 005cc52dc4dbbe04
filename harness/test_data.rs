//! Where the data are that some tests need and that are no part of the project: shared by the build scripts.

use std::env;
use std::path::{Path, PathBuf};

/// Sets `cfg(NAME)` for each (name, folder) whose folder is there, and its path in the variable `CALIBENCH_NAME`.
///
/// The data folder is named by `CALIBENCH_DATA`; without it, it is `shared/data` beside the checkout.
pub fn announce(folders: &[(&str, &str)]) {
    println!("cargo::rerun-if-env-changed=CALIBENCH_DATA");
    println!("cargo::rerun-if-changed=build.rs");
    let manifest = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo"));
    let root = manifest.ancestors().find(|folder| folder.join("Cargo.lock").is_file()).unwrap_or(&manifest);
    let beside = || root.parent().unwrap_or(Path::new("..")).join("shared/data");
    let data = env::var_os("CALIBENCH_DATA").map_or_else(beside, PathBuf::from);
    for (name, folder) in folders {
        println!("cargo::rustc-check-cfg=cfg({name})");
        let folder = data.join(folder);
        // A path that does not exist would count as changed at every build.
        if folder.is_dir() {
            println!("cargo::rerun-if-changed={}", folder.display());
            println!("cargo::rustc-cfg={name}");
            println!("cargo::rustc-env=CALIBENCH_{}={}", name.to_uppercase(), folder.display());
        }
    }
}
