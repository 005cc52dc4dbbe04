//! Takes digests of the code on which results depend, where it lies beside this crate: `CALIBENCH_CODE`, of which `reuse::code` says what it is.

use std::path::{Path, PathBuf};
use std::{env, fs};

#[path = "../code.rs"]
mod code;

#[path = "operators.rs"]
mod operators;

use code::{compiler, digest, sources};
use operators::{OPERATORS, Sources, of_modules, parted};

/// Crates on which points depend.
const POINTS: [&str; 13] = [
    "model",
    "random",
    "synth",
    "measure",
    "recognise",
    "detect",
    "files",
    "images",
    "cameras",
    "exchange",
    "photographs",
    "scenario",
    "run",
];
/// Crates on which adjustments depend beside them. Records define what is handed on.
const ADJUSTED: [&str; 3] = ["adjust", "calibrate", "records"];
/// Crates on which what is written beside them depends.
const WRITTEN: [&str; 2] = ["diagnostics", "judge"];

fn main() {
    let manifest = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo"));
    let Some(harness) = manifest.parent().filter(|harness| harness.join(OPERATORS).is_dir()) else { return };
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=operators.rs");
    // Versions of what is called, and with which of their features.
    let locked = ["../Cargo.lock", "../Cargo.toml"].map(|file| harness.join(file));
    for place in POINTS.iter().chain(&ADJUSTED).chain(&WRITTEN).flat_map(|name| folders(harness, name)).chain(locked.clone()) {
        println!("cargo::rerun-if-changed={}", place.display());
    }
    let [versions, features] = locked.map(|file| fs::read_to_string(file).unwrap_or_default());
    let common = [compiler(), versions, features];
    let of = |crates: &[&str]| {
        crates.iter().flat_map(|name| folders(harness, name)).flat_map(|folder| sources(harness, &folder)).collect::<Sources>()
    };
    let points = of(&POINTS);
    let adjusted = of(&ADJUSTED);
    let parted = parted(points);
    let mut code = vec![
        format!("points={}", digest(&common, &[&parted.shared])),
        format!("adjusted={}", digest(&common, &[&adjusted])),
        format!("all={}", digest(&common, &[&parted.shared, &parted.operators, &adjusted, &of(&WRITTEN)])),
    ];
    for (method, modules) in &parted.methods {
        code.push(format!("{method}={}", digest(&common, &[&of_modules(&parted.operators, modules)])));
    }
    println!("cargo::rustc-env=CALIBENCH_CODE={}", code.join(";"));
}

/// Where the code of a crate lies, and the tables that are compiled in.
fn folders(harness: &Path, name: &str) -> impl Iterator<Item = PathBuf> {
    ["src", "data"].map(|part| harness.join(name).join(part)).into_iter().filter(|folder| folder.is_dir())
}
