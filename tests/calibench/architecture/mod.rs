//! The drawing of modules: no circle between folders, files that are read at one go.

mod modules;
mod packages;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::project::root;
use modules::Modules;

/// Files and folders of one folder that need each other and are yet to be parted. This list only gets shorter: what two of them share moves into a third, below both.
const KNOTS: [&str; 17] = [
    "adjust: normal/blocks, normal/observed_unknowns",
    "adjust: quality/robust, quality/snooping",
    "adjust: solve/elimination_order, solve/window",
    "calibrate: calibration, over_frame",
    "detect: chessboard/candidates, chessboard/level, chessboard/side",
    "detect: corners, instead, markers, reasons",
    "files: folder/left_over, folder/scratch",
    "measure: operators/ellipse_edges/conic, operators/ellipse_edges/sectors",
    "measure: operators/lsm/border, operators/lsm/planes, operators/lsm/sweep",
    "measure: operators/parametric_corner/lists, operators/parametric_corner/places, operators/parametric_corner/window",
    "model: camera/measured_to_ideal, camera/photogrammetric",
    "model: convert/brown, convert/closed_form, convert/target, convert/wide_angle",
    "model: target, testfield",
    "recognise: ground, recogniser, square",
    "report: canvas/recorder, canvas/series",
    "synth: raster/sharp, raster/strip",
    "synth: view/disc, view/truth",
];

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
fn no_circle_of_modules_is_added_within_a_folder() {
    let knots =
        |(name, folder): (String, PathBuf)| Modules::of(&folder.join("src")).knots().into_iter().map(move |knot| format!("{name}: {knot}"));
    let found: BTreeSet<String> = crates().into_iter().flat_map(knots).collect();
    let known = BTreeSet::from(KNOTS.map(str::to_owned));
    let added: Vec<&String> = found.difference(&known).collect();
    assert!(added.is_empty(), "files of one folder need each other: move what they share down\n{added:#?}");
    let gone: Vec<&String> = known.difference(&found).collect();
    assert!(gone.is_empty(), "parted, and to be taken off the list\n{gone:#?}");
}

/// Writes a source below `folder`.
fn write(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

#[test]
fn a_circle_between_folders_is_seen_and_one_within_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| write(folder.path(), name, text);
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
fn files_of_one_folder_that_need_each_other_are_seen() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| write(folder.path(), name, text);
    let knots = || Modules::of(folder.path()).knots();
    write("lib.rs", "mod a; mod b; mod c; pub use b::B;");
    write("a.rs", "pub struct A(super::b::B);");
    write("b.rs", "use crate::c::C; pub struct B(C);");
    write("c.rs", "pub struct C; #[cfg(test)] mod tests { use crate::a::A; }");
    assert_eq!(knots(), Vec::<String>::new(), "what tests use is no arrow");
    // By a path in the code, and through what the crate hands on.
    write("c.rs", "pub fn c() -> crate::a::A { todo!() }");
    assert_eq!(knots(), ["a, b, c"]);
    write("c.rs", "use crate::B; pub struct C(Box<B>);");
    assert_eq!(knots(), ["b, c"]);
    // In a folder below, where one is a folder itself.
    write("c.rs", "pub struct C;");
    write("b.rs", "mod one; mod two; pub struct B;");
    write("b/one.rs", "use super::two::three::Three; pub struct One(Three);");
    write("b/two/mod.rs", "pub mod three;");
    write("b/two/three.rs", "use super::super::one::One; pub struct Three(Box<One>);");
    assert_eq!(knots(), ["b/one, b/two"]);
}

#[test]
fn no_file_has_more_than_400_lines() {
    let all = ["harness", "tests", "examples"].map(|name| sources(&root().join(name))).concat();
    let long = all.into_iter().filter(|path| fs::read_to_string(path).unwrap().lines().count() > MOST_LINES);
    assert_eq!(long.collect::<Vec<_>>(), Vec::<PathBuf>::new());
}
