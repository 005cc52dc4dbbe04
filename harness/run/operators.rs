//! Which code each operator consists of, read from its sources: for the build script, and tried by the tests of `reuse::code`.

use std::collections::{BTreeMap, BTreeSet};

/// Texts by their paths below the folder of crates.
pub type Sources = BTreeMap<String, String>;

/// The folder of operators. Each of its files and folders is one, but for the list of them.
pub const OPERATORS: &str = "measure/src/operators";
const LIST: &str = "mod.rs";
/// Files that name operators and have no part in what they do.
const ASIDE: [&str; 3] = ["measure/src/lib.rs", "measure/src/strength_noise.rs", "run/src/theory.rs"];

/// Code that is parted by what depends on it.
pub struct Parted {
    /// What every method depends on: all that is no operator, and the operators that it calls.
    pub shared: Sources,
    /// All operators.
    pub operators: Sources,
    /// Of each method, by its name, the modules of its code: its own, and those that they call.
    pub methods: BTreeMap<String, BTreeSet<String>>,
}

/// Parts the code on which points depend.
pub fn parted(points: Sources) -> Parted {
    let (operators, mut shared): (Sources, Sources) = points.into_iter().partition(|(path, _)| operator_of(path).is_some());
    let called = modules(&operators).into_iter().filter(|module| is_named(&shared, module)).collect();
    shared.extend(of_modules(&operators, &reached(&operators, called)));
    // A new operator on the list is nothing to the others.
    if let Some(list) = shared.get_mut(&format!("{OPERATORS}/{LIST}")) {
        *list = list.lines().map(str::trim).filter(|line| !line.starts_with("pub mod ") && !line.ends_with("(),")).collect();
    }
    let methods = methods(&operators).into_iter().map(|(name, own)| (name, reached(&operators, own))).collect();
    Parted { shared, operators, methods }
}

/// The operator of whose code a file is.
fn operator_of(path: &str) -> Option<&str> {
    let name = path.strip_prefix(OPERATORS)?.strip_prefix('/')?.split('/').next()?;
    (name != LIST).then(|| name.trim_end_matches(".rs"))
}

fn modules(operators: &Sources) -> BTreeSet<String> {
    operators.keys().filter_map(|path| operator_of(path)).map(str::to_owned).collect()
}

/// The code of these operators.
pub fn of_modules(operators: &Sources, modules: &BTreeSet<String>) -> Sources {
    let theirs = operators.iter().filter(|(path, _)| operator_of(path).is_some_and(|module| modules.contains(module)));
    theirs.map(|(path, text)| (path.clone(), text.clone())).collect()
}

/// Whether code that is no operator names the module: in a path, or in a line that uses it.
fn is_named(shared: &Sources, module: &str) -> bool {
    let list = format!("{OPERATORS}/{LIST}");
    let texts = shared.iter().filter(|(path, _)| **path != list && !ASIDE.contains(&path.as_str()));
    texts.map(|(_, text)| text).any(|text| names(text, module))
}

/// Whether a text names the module in its code; comments do not count.
fn names(text: &str, module: &str) -> bool {
    let is_word = |character: char| character.is_alphanumeric() || character == '_';
    text.lines().map(str::trim_start).filter(|line| !line.starts_with("//")).any(|line| {
        line.match_indices(module).any(|(at, _)| {
            let (before, after) = (&line[..at], &line[at + module.len()..]);
            let alone = !before.ends_with(is_word) && !after.starts_with(is_word);
            let in_path = before.ends_with("::") || after.starts_with("::");
            // Of a list over several lines each name may have its own.
            let in_list = before.is_empty() || before.trim_end().ends_with(['{', ',']);
            let in_use = line.starts_with("use ") || line.starts_with("pub use ") || in_list;
            alone && (in_path || in_use)
        })
    })
}

/// These operators and all that they call.
fn reached(operators: &Sources, mut modules_of: BTreeSet<String>) -> BTreeSet<String> {
    loop {
        let own = of_modules(operators, &modules_of);
        let is_new = |module: &String| !modules_of.contains(module) && own.values().any(|text| names(text, module));
        let more: Vec<String> = modules(operators).into_iter().filter(is_new).collect();
        if more.is_empty() {
            return modules_of;
        }
        modules_of.extend(more);
    }
}

/// The names that stand in operators as `name: "..."`, those of methods among them, and in which.
fn methods(operators: &Sources) -> BTreeMap<String, BTreeSet<String>> {
    let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (path, text) in operators {
        let names = text.split("name: \"").skip(1).filter_map(|rest| rest.split('"').next());
        for (name, module) in names.filter_map(|name| Some((name, operator_of(path)?))) {
            found.entry(name.to_owned()).or_default().insert(module.to_owned());
        }
    }
    found
}
