//! Takes digests of the code on which results depend, where it lies beside this crate: `CALIBENCH_CODE`, of which `reuse::code` says what it is.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::{env, fs};

#[path = "../code.rs"]
mod code;

use code::{Sources, compiler, digest, sources};

/// Crates on which points depend.
const POINTS: [&str; 10] = ["model", "random", "synth", "measure", "recognise", "detect", "exchange", "photographs", "scenario", "run"];
/// Crates on which adjustments depend beside them. Records define what is handed on.
const ADJUSTED: [&str; 3] = ["adjust", "calibrate", "records"];
/// Crates on which what is written beside them depends.
const WRITTEN: [&str; 2] = ["diagnostics", "judge"];
/// The folder of operators, below that of the crates. Each of its files and folders is one, but for the list of them.
const OPERATORS: &str = "measure/src/operators";
const LIST: &str = "mod.rs";
/// Files that name operators and have no part in what they do.
const ASIDE: [&str; 3] = ["measure/src/lib.rs", "measure/src/strength_noise.rs", "run/src/theory.rs"];

fn main() {
    let manifest = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo"));
    let Some(harness) = manifest.parent().filter(|harness| harness.join(OPERATORS).is_dir()) else { return };
    println!("cargo::rerun-if-changed=build.rs");
    let lock = harness.join("../Cargo.lock");
    for place in POINTS.iter().chain(&ADJUSTED).chain(&WRITTEN).flat_map(|name| folders(harness, name)).chain([lock.clone()]) {
        println!("cargo::rerun-if-changed={}", place.display());
    }
    let common = [compiler(), fs::read_to_string(lock).unwrap_or_default()];
    let of = |crates: &[&str]| {
        crates.iter().flat_map(|name| folders(harness, name)).flat_map(|folder| sources(harness, &folder)).collect::<Sources>()
    };
    let points = of(&POINTS);
    let adjusted = of(&ADJUSTED);
    let (operators, shared): (Sources, Sources) = points.into_iter().partition(|(path, _)| operator_of(path).is_some());
    let modules: BTreeSet<&str> = operators.keys().filter_map(|path| operator_of(path)).collect();
    // An operator that the code of all methods calls is part of it.
    let called: BTreeSet<&str> = modules.iter().copied().filter(|module| is_named(&shared, module)).collect();
    let with_called: Sources = shared.iter().map(cloned).chain(of_modules(&operators, &reached(&operators, &called))).collect();
    let mut code = vec![
        format!("points={}", digest(&common, &[&with_called])),
        format!("adjusted={}", digest(&common, &[&adjusted])),
        format!("all={}", digest(&common, &[&shared, &operators, &adjusted, &of(&WRITTEN)])),
    ];
    for (method, modules) in methods(&operators) {
        code.push(format!("{method}={}", digest(&common, &[&of_modules(&operators, &reached(&operators, &modules))])));
    }
    println!("cargo::rustc-env=CALIBENCH_CODE={}", code.join(";"));
}

/// Where the code of a crate lies, and the tables that are compiled in.
fn folders(harness: &Path, name: &str) -> impl Iterator<Item = PathBuf> {
    ["src", "data"].map(|part| harness.join(name).join(part)).into_iter().filter(|folder| folder.is_dir())
}

fn cloned((path, text): (&String, &String)) -> (String, String) {
    (path.clone(), text.clone())
}

/// The operator of whose code a file is.
fn operator_of(path: &str) -> Option<&str> {
    let name = path.strip_prefix(OPERATORS)?.strip_prefix('/')?.split('/').next()?;
    (name != LIST).then(|| name.trim_end_matches(".rs"))
}

/// The code of these operators.
fn of_modules(operators: &Sources, modules: &BTreeSet<&str>) -> Sources {
    operators.iter().filter(|(path, _)| operator_of(path).is_some_and(|module| modules.contains(module))).map(cloned).collect()
}

/// Whether code of `sources` names the module: in a path, or in a line that uses it. Comments do not count.
fn is_named(sources: &Sources, module: &str) -> bool {
    let list = format!("{OPERATORS}/{LIST}");
    let texts = sources.iter().filter(|(path, _)| **path != list && !ASIDE.contains(&path.as_str()));
    texts.map(|(_, text)| text).any(|text| names(text, module))
}

fn names(text: &str, module: &str) -> bool {
    let is_word = |character: char| character.is_alphanumeric() || character == '_';
    text.lines().map(str::trim_start).filter(|line| !line.starts_with("//")).any(|line| {
        line.match_indices(module).any(|(at, _)| {
            let (before, after) = (&line[..at], &line[at + module.len()..]);
            let alone = !before.ends_with(is_word) && !after.starts_with(is_word);
            alone
                && (before.ends_with("::")
                    || after.starts_with("::")
                    || line.starts_with("use ")
                    || line.starts_with("pub use ")
                    || before.trim_end().ends_with(['{', ',']))
        })
    })
}

/// These operators and all that they call.
fn reached<'m>(operators: &'m Sources, modules: &BTreeSet<&'m str>) -> BTreeSet<&'m str> {
    let all: BTreeSet<&str> = operators.keys().filter_map(|path| operator_of(path)).collect();
    let mut reached = modules.clone();
    loop {
        let own = of_modules(operators, &reached);
        let more: Vec<&str> =
            all.iter().copied().filter(|module| !reached.contains(module) && own.values().any(|text| names(text, module))).collect();
        if more.is_empty() {
            return reached;
        }
        reached.extend(more);
    }
}

/// The names that stand in operators as `name: "..."`, those of methods among them, and in which.
fn methods(operators: &Sources) -> BTreeMap<String, BTreeSet<&str>> {
    let mut found: BTreeMap<String, BTreeSet<&str>> = BTreeMap::new();
    for (path, text) in operators {
        let names = text.split("name: \"").skip(1).filter_map(|rest| rest.split('"').next());
        for (name, module) in names.filter_map(|name| Some((name, operator_of(path)?))) {
            found.entry(name.to_owned()).or_default().insert(module);
        }
    }
    found
}
