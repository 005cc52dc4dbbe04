//! The modules of a crate and which of them name which, read from the text of their files.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs;
use std::path::{Path, PathBuf};

use syn::visit::Visit;
use syn::{Attribute, ItemMod, ItemUse, UseTree, Visibility};

/// A module: its names from the crate's root.
type Module = Vec<String>;

/// Which modules each names.
type Arrows = BTreeMap<Module, BTreeSet<Module>>;

/// The modules of a crate but for those of tests.
pub struct Modules {
    files: BTreeMap<Module, PathBuf>,
    /// What each names, besides itself and what it hands on.
    needs: Arrows,
}

impl Modules {
    /// Those of the crate whose sources lie in `folder`.
    pub fn of(folder: &Path) -> Self {
        let files: BTreeMap<Module, PathBuf> = super::sources(folder)
            .into_iter()
            .map(|path| (module(path.strip_prefix(folder).unwrap()), path))
            .filter(|(module, _)| !module.iter().any(|name| name == "tests"))
            .collect();
        let named: BTreeMap<Module, Named> = files.iter().map(|(module, path)| (module.clone(), Named::of(path))).collect();
        let resolver = Resolver { files: &files, named: &named };
        let of = |(module, named): (&Module, &Named)| {
            let found = named.needed.iter().filter_map(|path| resolver.target(module, path));
            (module.clone(), found.filter(|other| other != module).collect())
        };
        let needs = named.iter().map(of).collect();
        Self { files, needs }
    }

    /// The circles with files of more than one folder, and those that close when a folder counts as one; each from an arrow that leaves a folder on
    /// and back to where it begins.
    pub fn circles(&self) -> Vec<String> {
        let of_files = circles(&self.needs, |from, to| self.files[from].parent() != self.files[to].parent());
        let is_folder = |module: &Module| self.files.keys().any(|file| file.len() > module.len() && file.starts_with(module));
        let of_folders = circles(&self.between_siblings(), |from, to| is_folder(from) || is_folder(to));
        [of_files, of_folders].concat()
    }

    /// The files and folders side by side in one folder that need each other, be it through others between them: each such set once, its names sorted.
    pub fn knots(&self) -> Vec<String> {
        let arrows = self.between_siblings();
        let reached: BTreeMap<&Module, BTreeSet<&Module>> = arrows.keys().map(|from| (from, reached(&arrows, from))).collect();
        let knot = |module: &Module| {
            let others = reached[module].iter().filter(|other| reached.get(*other).is_some_and(|back| back.contains(module)));
            others.map(|module| module.join("/")).collect::<Vec<_>>()
        };
        let knots: BTreeSet<Vec<String>> = arrows.keys().map(knot).filter(|knot| knot.len() > 1).collect();
        knots.into_iter().map(|knot| knot.join(", ")).collect()
    }

    /// The arrows between files and folders of one folder: what a folder holds counts as the folder.
    fn between_siblings(&self) -> Arrows {
        let mut siblings = Arrows::new();
        for (from, to) in self.needs.iter().flat_map(|(from, others)| others.iter().map(move |to| (from, to))) {
            let common = from.iter().zip(to).take_while(|(a, b)| a == b).count();
            // Nothing of a folder leaves it by naming its `mod.rs`, nor that by naming what it holds.
            if let (Some(a), Some(b)) = (from.get(..=common), to.get(..=common)) {
                siblings.entry(a.to_vec()).or_default().insert(b.to_vec());
            }
        }
        siblings
    }
}

/// Every circle that goes through an arrow for which `counts`.
fn circles(arrows: &Arrows, counts: impl Fn(&Module, &Module) -> bool) -> Vec<String> {
    let all = arrows.iter().flat_map(|(from, others)| others.iter().map(move |to| (from, to)));
    let circle = |(from, to): (&Module, &Module)| {
        let back = way(arrows, to, from)?;
        Some([from].into_iter().chain(&back).map(|module| module.join("/")).collect::<Vec<_>>().join(" -> "))
    };
    all.filter(|(from, to)| counts(from, to)).filter_map(circle).collect()
}

/// Where the arrows lead from `from`, itself included.
fn reached<'a>(arrows: &'a Arrows, from: &'a Module) -> BTreeSet<&'a Module> {
    let (mut reached, mut waiting) = (BTreeSet::from([from]), vec![from]);
    while let Some(last) = waiting.pop() {
        waiting.extend(arrows.get(last).into_iter().flatten().filter(|next| reached.insert(next)));
    }
    reached
}

/// The shortest way along the arrows.
fn way(arrows: &Arrows, from: &Module, to: &Module) -> Option<Vec<Module>> {
    let mut waiting = VecDeque::from([vec![from.clone()]]);
    let mut seen = BTreeSet::from([from.clone()]);
    while let Some(way) = waiting.pop_front() {
        let last = way.last()?;
        if last == to {
            return Some(way);
        }
        for next in arrows.get(last).into_iter().flatten() {
            if seen.insert(next.clone()) {
                waiting.push_back([&way[..], std::slice::from_ref(next)].concat());
            }
        }
    }
    None
}

/// The module of a file below `src`.
fn module(path: &Path) -> Module {
    let stem = path.with_extension("");
    let mut names: Module = stem.components().map(|part| part.as_os_str().to_str().unwrap().to_owned()).collect();
    names.pop_if(|last| ["lib", "main", "mod"].contains(&last.as_str()));
    names
}

/// The paths that a file names.
#[derive(Default)]
struct Named {
    /// In its code.
    needed: Vec<Vec<String>>,
    /// Handed on under a name of its own: `pub use`.
    handed_on: BTreeMap<String, Vec<String>>,
}

impl Named {
    fn of(path: &Path) -> Self {
        let mut named = Self::default();
        let text = fs::read_to_string(path).unwrap();
        named.visit_file(&syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display())));
        named
    }

    fn tree(&mut self, tree: &UseTree, before: &[String], hands_on: bool) {
        let below = |name: &syn::Ident| [before, &[name.to_string()]].concat();
        let (path, name) = match tree {
            UseTree::Path(path) => return self.tree(&path.tree, &below(&path.ident), hands_on),
            UseTree::Group(group) => return group.items.iter().for_each(|item| self.tree(item, before, hands_on)),
            UseTree::Name(name) => (below(&name.ident), name.ident.to_string()),
            UseTree::Rename(renamed) => (below(&renamed.ident), renamed.rename.to_string()),
            UseTree::Glob(_) => (before.to_vec(), "*".to_owned()),
        };
        if hands_on {
            self.handed_on.insert(name, path);
        } else {
            self.needed.push(path);
        }
    }
}

/// Whether these attributes keep what follows for tests.
fn for_tests(attributes: &[Attribute]) -> bool {
    attributes
        .iter()
        .any(|attribute| attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Ident>().is_ok_and(|name| name == "test"))
}

impl Visit<'_> for Named {
    fn visit_item_mod(&mut self, item: &ItemMod) {
        if !for_tests(&item.attrs) {
            syn::visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &ItemUse) {
        if !for_tests(&item.attrs) {
            self.tree(&item.tree, &[], !matches!(item.vis, Visibility::Inherited));
        }
    }

    fn visit_path(&mut self, path: &syn::Path) {
        if path.segments.len() > 1 {
            self.needed.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        }
        syn::visit::visit_path(self, path);
    }
}

/// Finds the module in which a path ends.
struct Resolver<'a> {
    files: &'a BTreeMap<Module, PathBuf>,
    named: &'a BTreeMap<Module, Named>,
}

impl Resolver<'_> {
    /// The module that `path`, written in `module`, leads to; `None` for what is of another crate.
    fn target(&self, module: &Module, path: &[String]) -> Option<Module> {
        let (mut at, mut rest) = self.start(module, path)?;
        // What is handed on may be handed on again.
        for _ in 0..10 {
            while let Some((first, after)) = rest.split_first()
                && self.files.contains_key(&[&at[..], std::slice::from_ref(first)].concat())
            {
                (at, rest) = ([&at[..], std::slice::from_ref(first)].concat(), after.to_vec());
            }
            let Some((first, after)) = rest.split_first() else { break };
            let Some(handed) = self.named.get(&at).and_then(|named| named.handed_on.get(first)) else { break };
            let Some((next, more)) = self.start(&at, handed) else { break };
            (at, rest) = (next, [more, after.to_vec()].concat());
        }
        self.files.contains_key(&at).then_some(at)
    }

    /// Where a path begins, and what is left of it.
    fn start(&self, module: &Module, path: &[String]) -> Option<(Module, Vec<String>)> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => Some((Module::new(), rest.to_vec())),
            "self" => Some((module.clone(), rest.to_vec())),
            "super" => {
                let up = rest.iter().take_while(|name| *name == "super").count();
                let kept = module.len().checked_sub(1 + up)?;
                Some((module[..kept].to_vec(), rest[up..].to_vec()))
            }
            child => self.files.contains_key(&[&module[..], &[child.to_owned()]].concat()).then(|| (module.clone(), path.to_vec())),
        }
    }
}
