//! Says what of the things that some tests need is there: photographs and camera files as `cfg(photographs)`, `cfg(camera_files)`, `cfg(webcam)`, `cfg(wide_photographs)`, rigs and free networks as `cfg(rigs)`,
//! packages of other tools as `cfg(peer_...)`, Python as `cfg(python)`, our own package for it as `cfg(python_package)`, Chromium with what drives it as `cfg(browser)`, ffmpeg as
//! `cfg(ffmpeg)`.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

#[path = "../harness/test_data.rs"]
mod test_data;

/// Packages by the name of their cfg; the last two are Debian's.
const PEERS: [(&str, &str); 10] = [
    ("peer_pycolmap", "pycolmap"),
    ("peer_kapture", "kapture"),
    ("peer_opencv", "cv2"),
    ("peer_theia", "pytheia"),
    ("peer_anipose", "aniposelib"),
    ("peer_caliscope", "caliscope"),
    ("peer_lensfun", "lensfunpy"),
    ("peer_usd", "pxr"),
    ("peer_mrcal", "mrcal"),
    ("peer_ros", "camera_calibration_parsers"),
];
/// Where Debian's are.
const SYSTEM: &str = "/usr/lib/python3/dist-packages";

fn main() {
    test_data::announce(&[
        ("photographs", "opencv-left"),
        ("camera_files", "cameras"),
        ("webcam", "webcam"),
        ("wide_photographs", "reports/01-gopro-wide"),
        ("rigs", "rigs"),
    ]);
    println!("cargo::rustc-check-cfg=cfg(python)");
    if Command::new("python3").arg("--version").output().is_ok_and(|output| output.status.success()) {
        println!("cargo::rustc-cfg=python");
    }
    println!("cargo::rustc-check-cfg=cfg(ffmpeg)");
    println!("cargo::rerun-if-env-changed=CALIBENCH_FFMPEG");
    let ffmpeg = env::var_os("CALIBENCH_FFMPEG").unwrap_or_else(|| "ffmpeg".into());
    if Command::new(ffmpeg).arg("-version").output().is_ok_and(|output| output.status.success()) {
        println!("cargo::rustc-cfg=ffmpeg");
    }
    python_package();
    browser();
    println!("cargo::rerun-if-env-changed=CALIBENCH_PEERS");
    let folder = env::var_os("CALIBENCH_PEERS").map(PathBuf::from).filter(|folder| folder.is_dir());
    let own = folder.as_deref().and_then(packages);
    for (index, (name, package)) in PEERS.into_iter().enumerate() {
        println!("cargo::rustc-check-cfg=cfg({name})");
        let place = if index < 8 { own.clone() } else { folder.as_ref().map(|_| PathBuf::from(SYSTEM)) };
        if place.is_some_and(|place| place.join(package).exists()) {
            println!("cargo::rustc-cfg={name}");
        }
    }
    println!("cargo::rustc-check-cfg=cfg(peer_hugin)");
    if folder.is_some() && Path::new("/usr/bin/pano_trafo").exists() {
        println!("cargo::rustc-cfg=peer_hugin");
    }
    if let Some(folder) = &folder {
        // Not the folder: Python writes into it.
        println!("cargo::rerun-if-changed={}", folder.join("pyvenv.cfg").display());
        println!("cargo::rustc-env=CALIBENCH_PEERS={}", folder.display());
    }
}

/// Our own package for Python, where `just python` put it.
fn python_package() {
    println!("cargo::rustc-check-cfg=cfg(python_package)");
    println!("cargo::rerun-if-env-changed=CALIBENCH_PYTHON");
    let Some(folder) = env::var_os("CALIBENCH_PYTHON").map(PathBuf::from).filter(|folder| folder.is_dir()) else { return };
    println!("cargo::rerun-if-changed={}", folder.join("pyvenv.cfg").display());
    if packages(&folder).is_some_and(|packages| packages.join("calibench").is_dir()) {
        println!("cargo::rustc-cfg=python_package");
        println!("cargo::rustc-env=CALIBENCH_PYTHON={}", folder.display());
    }
}

/// Chromium, its driver, and the environment of Python that `./bootstrap browser` made.
fn browser() {
    println!("cargo::rustc-check-cfg=cfg(browser)");
    println!("cargo::rerun-if-env-changed=CALIBENCH_BROWSER");
    let Some(folder) = env::var_os("CALIBENCH_BROWSER").map(PathBuf::from).filter(|folder| folder.is_dir()) else { return };
    println!("cargo::rerun-if-changed={}", folder.join("pyvenv.cfg").display());
    let there = |program: &str| Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success());
    if packages(&folder).is_some_and(|packages| packages.join("selenium").is_dir()) && there("chromium") && there("chromedriver") {
        println!("cargo::rustc-cfg=browser");
        println!("cargo::rustc-env=CALIBENCH_BROWSER={}", folder.display());
    }
}

/// The packages of a virtual environment.
fn packages(folder: &Path) -> Option<PathBuf> {
    let versions = std::fs::read_dir(folder.join("lib")).ok()?;
    versions.filter_map(Result::ok).map(|version| version.path().join("site-packages")).find(|place| place.is_dir())
}
