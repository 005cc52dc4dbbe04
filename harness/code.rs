//! Digests of source code: shared by the build scripts.

use std::collections::BTreeMap;
use std::hash::Hasher;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// Texts by their paths below the folder of crates, tests left out.
pub type Sources = BTreeMap<String, String>;

/// The sources below `folder` and what is compiled in beside them, by their paths below `harness`.
pub fn sources(harness: &Path, folder: &Path) -> Sources {
    let mut found = Sources::new();
    for entry in fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok) {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        if name == "tests" || name == "tests.rs" {
            continue;
        }
        if path.is_dir() {
            found.extend(sources(harness, &path));
        } else {
            let below = path.strip_prefix(harness).unwrap_or(&path).to_string_lossy().replace('\\', "/");
            found.insert(below, String::from_utf8_lossy(&fs::read(&path).unwrap_or_default()).into_owned());
        }
    }
    found
}

/// Which compiler it is.
pub fn compiler() -> String {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let said = Command::new(rustc).arg("-vV").output().map(|output| output.stdout).unwrap_or_default();
    String::from_utf8_lossy(&said).into_owned()
}

/// 128 bits in hexadecimal.
pub fn digest(common: &[String], all: &[&Sources]) -> String {
    let half = |first: u8| {
        let mut hasher = std::hash::DefaultHasher::new();
        hasher.write_u8(first);
        for part in common.iter().chain(all.iter().flat_map(|sources| sources.iter().flat_map(|(path, text)| [path, text]))) {
            hasher.write_usize(part.len());
            hasher.write(part.as_bytes());
        }
        hasher.finish()
    };
    format!("{:016x}{:016x}", half(0), half(1))
}
