//! What `just package` needs of a crate, seen without building one.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use toml::Table;

use super::{crates, sources};
use crate::project::root;

/// The categories that our crates are listed in, of those that a registry knows.
const CATEGORIES: [&str; 17] = [
    "algorithms",
    "caching",
    "command-line-utilities",
    "computer-vision",
    "data-structures",
    "development-tools",
    "development-tools::testing",
    "filesystem",
    "mathematics",
    "multimedia::images",
    "parser-implementations",
    "rendering",
    "science",
    "science::geo",
    "simulation",
    "text-processing",
    "visualization",
];

/// What names a file that is compiled in.
const INCLUDING: [&str; 4] = ["include_str!(", "include_bytes!(", "include!(", "#[path = "];

/// The crates that others may depend on: the Python package is built by other means.
fn packages() -> BTreeMap<String, PathBuf> {
    let mut all = crates();
    all.remove("python").expect("the Python package");
    all
}

fn manifest(folder: &Path) -> Table {
    fs::read_to_string(folder.join("Cargo.toml")).unwrap().parse().unwrap()
}

/// The texts in an array of a manifest.
fn texts<'a>(package: &'a Table, key: &str) -> Vec<&'a str> {
    package.get(key).and_then(|value| value.as_array()).into_iter().flatten().filter_map(|value| value.as_str()).collect()
}

/// What is wrong with what a manifest says of its package.
fn faults(package: &Table) -> Vec<String> {
    let mut faults = Vec::new();
    let mut expect = |holds: bool, what: &str| faults.extend((!holds).then(|| what.to_owned()));
    let shared = |key: &str| package.get(key).and_then(|value| value.get("workspace")).is_some();
    expect(!package.contains_key("publish"), "it may not be packaged for others");
    expect(package.get("readme").and_then(|value| value.as_str()) == Some("README.md"), "readme is not README.md");
    expect(package.contains_key("description"), "no description");
    for key in ["version", "edition", "rust-version", "license", "exclude"] {
        expect(shared(key), &format!("{key} is not the workspace's"));
    }
    let is_keyword = |word: &&str| word.len() <= 20 && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
    let keywords = texts(package, "keywords");
    expect((1..=5).contains(&keywords.len()) && keywords.iter().all(is_keyword), "keywords: one to five words of at most 20 characters");
    let categories = texts(package, "categories");
    let are_known = categories.iter().all(|category| CATEGORIES.contains(category));
    expect((1..=5).contains(&categories.len()) && are_known, "categories: one to five that a registry knows");
    faults
}

/// Where a link or an included file is, without a look at the disk.
fn resolved(folder: &Path, to: &str) -> PathBuf {
    let mut path = PathBuf::new();
    for component in folder.join(to).components() {
        match component {
            Component::ParentDir => drop(path.pop()),
            Component::CurDir => {}
            other => path.push(other),
        }
    }
    path
}

/// The paths that a source includes.
fn included(text: &str) -> Vec<&str> {
    let after = |mark| text.match_indices(mark).filter_map(move |(at, _)| text[at..].split('"').nth(1));
    INCLUDING.into_iter().flat_map(after).collect()
}

/// The files that `folder` compiles into its package and that are not in it.
fn from_outside(folder: &Path) -> Vec<String> {
    // The folders that a package holds; benches stay in the repository.
    let packaged = ["src", "tests", "examples"].map(|name| folder.join(name));
    let files = packaged.iter().filter(|path| path.is_dir()).flat_map(|path| sources(path));
    let mut outside = Vec::new();
    for path in files {
        let text = fs::read_to_string(&path).unwrap();
        let leave = |to: &&str| !resolved(path.parent().unwrap(), to).starts_with(folder);
        outside.extend(included(&text).into_iter().filter(leave).map(|to| format!("{}: {to}", path.display())));
    }
    outside
}

#[test]
fn every_crate_says_what_it_is() {
    for (name, folder) in packages() {
        let manifest = manifest(&folder);
        assert_eq!(faults(manifest["package"].as_table().unwrap()), Vec::<String>::new(), "{name}");
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            // A link to the text of the repository: packaging follows it.
            let text = |folder: &Path| fs::read_to_string(folder.join(licence)).unwrap_or_default();
            assert_eq!(text(&folder), text(&root()), "{name}: {licence}");
        }
    }
}

#[test]
fn every_crate_has_a_readme_whose_example_is_run() {
    for (name, folder) in packages() {
        let readme = fs::read_to_string(folder.join("README.md")).unwrap_or_default();
        assert!(readme.starts_with(&format!("# calibench-{name}\n")), "{name}: README.md");
        assert!(readme.contains("\n```rust\n") && readme.contains("assert"), "{name}: an example that asserts something");
        let library = fs::read_to_string(folder.join("src/lib.rs")).unwrap();
        let run = "#[cfg(doctest)]\n#[doc = include_str!(\"../README.md\")]\n";
        assert!(library.contains(run), "{name}: src/lib.rs does not have the README as a test");
        for link in readme.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
            assert!(folder.join(link).is_file(), "{name}: README.md links to {link}");
        }
    }
}

#[test]
fn dependencies_within_the_workspace_have_its_version() {
    let workspace = manifest(&root());
    let version = &workspace["workspace"]["package"]["version"];
    let mut own = 0;
    for (name, dependency) in workspace["workspace"]["dependencies"].as_table().unwrap() {
        if dependency.get("path").is_some() {
            assert_eq!(dependency.get("version"), Some(version), "{name}");
            own += 1;
        }
    }
    assert_eq!(own, packages().len(), "every package may be depended on");
    for (name, folder) in packages() {
        let manifest = manifest(&folder);
        for kind in ["dependencies", "dev-dependencies", "build-dependencies"] {
            for (other, dependency) in manifest.get(kind).and_then(|all| all.as_table()).into_iter().flatten() {
                assert!(dependency.get("path").is_none(), "{name}: {other} has a path and no version");
            }
        }
    }
}

/// The crates that are built again after a change of one, itself and these tests among them.
fn rebuilt(changed: &str) -> BTreeSet<String> {
    let mut all = crates();
    all.insert("tests".to_owned(), root().join("tests"));
    let needs = |folder: &PathBuf| {
        let manifest = manifest(folder);
        let kinds = ["dependencies", "dev-dependencies"].into_iter().filter_map(|kind| manifest.get(kind)?.as_table());
        let names = kinds.flat_map(|all| all.keys()).filter_map(|name| name.strip_prefix("calibench-"));
        names.map(str::to_owned).collect::<BTreeSet<String>>()
    };
    let needs: BTreeMap<&String, BTreeSet<String>> = all.iter().map(|(name, folder)| (name, needs(folder))).collect();
    let mut found = BTreeSet::from([changed.to_owned()]);
    loop {
        let more = needs.iter().filter(|(_, needed)| needed.iter().any(|name| found.contains(name)));
        let more: Vec<String> = more.map(|(name, _)| (*name).clone()).filter(|name| !found.contains(name)).collect();
        if more.is_empty() {
            return found;
        }
        found.extend(more);
    }
}

#[test]
fn a_new_camera_format_is_built_into_at_most_eight_crates() {
    let found = rebuilt("cameras");
    assert!(found.len() <= 8 && found.contains("cli"), "{found:?}");
    for apart in ["adjust", "calibrate", "gate", "judge", "report"] {
        assert!(!found.contains(apart), "{apart} needs camera formats");
    }
}

#[test]
fn packages_include_nothing_from_outside_their_folder() {
    let outside: Vec<String> = packages().values().flat_map(|folder| from_outside(folder)).collect();
    assert!(outside.is_empty(), "not in the package:\n{}", outside.join("\n"));
}

#[test]
fn a_file_from_outside_is_seen_and_one_from_within_is_not() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder.path().join("src/a")).unwrap();
    let write = |text: &str| fs::write(folder.path().join("src/a/b.rs"), text).unwrap();
    write("const A: &str = include_str!(\"../../data/a.csv\");\n#[path = \"../c.rs\"]\nmod c;");
    assert_eq!(from_outside(folder.path()), Vec::<String>::new());
    write("const A: &str = include_str!(\n    \"../../../a.csv\"\n);\n#[path = \"../../../c.rs\"]\nmod c;");
    let found: Vec<String> = from_outside(folder.path()).iter().map(|one| one.rsplit(": ").next().unwrap().to_owned()).collect();
    assert_eq!(found, ["../../../a.csv", "../../../c.rs"]);
}

#[test]
fn a_manifest_that_says_too_little_is_refused() {
    let bare: Table = "name = \"a\"\npublish = false\nkeywords = [\"a keyword\"]\ncategories = [\"lenses\"]".parse().unwrap();
    let faults = faults(&bare);
    for what in ["packaged", "readme", "description", "license", "keywords", "categories"] {
        assert!(faults.iter().any(|fault| fault.contains(what)), "{what}: {faults:?}");
    }
}
