//! The drawing of modules: no circle between folders, files that are read at one go.

mod modules;
mod packages;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::project::root;
use modules::Modules;

/// More lines than this hold more than one idea.
const MOST_LINES: usize = 400;

/// The folders of the crates in `harness/`, by the crate's short name.
fn crates() -> BTreeMap<String, PathBuf> {
    let folders = fs::read_dir(root().join("harness")).unwrap().map(|entry| entry.unwrap().path());
    let named = |folder: PathBuf| Some((folder.file_name()?.to_str()?.to_owned(), folder));
    folders.filter(|folder| folder.join("Cargo.toml").is_file()).filter_map(named).collect()
}

/// Every Rust file below `folder`.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

#[test]
fn no_circle_of_modules_leaves_a_folder() {
    let circles: Vec<String> = crates()
        .into_iter()
        .flat_map(|(name, folder)| Modules::of(&folder.join("src")).circles().into_iter().map(move |circle| format!("{name}: {circle}")))
        .collect();
    assert!(circles.is_empty(), "files of different folders need each other: move what they share down\n{}", circles.join("\n"));
}

#[test]
fn a_circle_between_folders_is_seen_and_one_within_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    write("lib.rs", "mod a; mod b; pub use a::Thing;");
    write("b.rs", "use crate::Thing;");
    write("a/mod.rs", "mod one; mod two; pub use one::Thing; const X: f64 = two::Y;");
    write("a/one.rs", "use super::two::Y; pub struct Thing;");
    write("a/two.rs", "use super::one::Thing; #[cfg(test)] mod tests { use crate::b::B; }");
    assert_eq!(Modules::of(folder.path()).circles(), Vec::<String>::new());
    write("a/one.rs", "pub struct Thing(crate::b::B);");
    assert_eq!(Modules::of(folder.path()).circles(), ["a/one -> b -> a/one", "b -> a/one -> b", "a -> b -> a", "b -> a -> b"]);
    // No circle of files, but one of a folder and a file beside it.
    write("a/one.rs", "pub struct Thing;");
    write("a/two.rs", "use crate::b::B;");
    assert_eq!(Modules::of(folder.path()).circles(), ["a -> b -> a", "b -> a -> b"]);
}

#[test]
fn no_file_has_more_than_400_lines() {
    let all = ["harness", "tests", "examples"].map(|name| sources(&root().join(name))).concat();
    let long = all.into_iter().filter(|path| fs::read_to_string(path).unwrap().lines().count() > MOST_LINES);
    assert_eq!(long.collect::<Vec<_>>(), Vec::<PathBuf>::new());
}
