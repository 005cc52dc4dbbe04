//! The files that declare methods: what one declares, and all of a folder.

use std::path::{Path, PathBuf};

use calibench_diagnostics::{Problem, Problems};
use calibench_measure::Registry;
use serde::Deserialize;
use toml::Spanned;

use crate::declaration::{self, Declaration};
use crate::error::PluginError;
use crate::method::method;
use crate::program::Launcher;
use crate::recorded::{self, Recording, RecordingWire};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    plugin: Vec<Spanned<declaration::Wire>>,
    #[serde(default)]
    method: Vec<Spanned<RecordingWire>>,
}

/// What a file declares.
#[derive(Clone, Debug)]
pub enum Declared {
    /// A program.
    Program(Declaration),
    /// A file of positions.
    Recording(Recording),
}

impl Declared {
    /// Its name among the methods.
    pub fn name(&self) -> &str {
        match self {
            Self::Program(program) => &program.name,
            Self::Recording(recording) => &recording.name,
        }
    }
}

/// The methods that `text` declares, which is that of `file`: programs, then files of positions.
///
/// # Errors
/// Every mistake with line and column.
pub fn parse(file: &str, text: &str) -> Result<Vec<Declared>, Problems> {
    let all = |problems| Problems { file: file.to_owned(), text: text.to_owned(), problems };
    let wire: File =
        toml::from_str(text).map_err(|error| all(vec![Problem::new(error.span().unwrap_or(0..0), error.message().to_owned())]))?;
    if wire.plugin.is_empty() && wire.method.is_empty() {
        let expected = "[[plugin]] with `name` and `command`, or [[method]] with `name`, `file` and `images`";
        return Err(all(vec![Problem::new(0..0, format!("declares no plug-in: expected {expected}"))]));
    }
    let mut problems = Vec::new();
    let programs = wire.plugin.into_iter().filter_map(|plugin| declaration::checked(plugin.into_inner(), file, &mut problems));
    let mut found: Vec<Declared> = programs.map(Declared::Program).collect();
    let recordings = wire.method.into_iter().filter_map(|method| recorded::checked(method.into_inner(), file, &mut problems));
    found.extend(recordings.map(Declared::Recording));
    if problems.is_empty() { Ok(found) } else { Err(all(problems)) }
}

/// `registry` with the plug-ins that the TOML files of `folder` declare, in the order of their names.
///
/// # Errors
/// A folder or file that cannot be read, mistakes with line and column, a name that is taken.
pub fn load(folder: &Path, mut registry: Registry, launcher: &Launcher) -> Result<Registry, PluginError> {
    let file_error = |path: &Path, source| PluginError::File { path: path.to_owned(), source };
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let mut files: Vec<PathBuf> = entries.map_err(|error| file_error(folder, error))?.into_iter().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    let mut known: Vec<(String, PathBuf)> = Vec::new();
    for path in files {
        let text = calibench_files::bounded::text(&path).map_err(|error| file_error(&path, error))?;
        for declared in parse(&path.display().to_string(), &text)? {
            let name = declared.name().to_owned();
            if let Some((_, earlier)) = known.iter().find(|(other, _)| *other == name) {
                return Err(PluginError::Twice { path, earlier: earlier.clone(), name });
            }
            if registry.methods().iter().any(|method| method.name == name) {
                return Err(PluginError::Taken { path, name });
            }
            known.push((name, path.clone()));
            registry = registry.with(match declared {
                Declared::Program(declaration) => method(declaration, folder, launcher),
                Declared::Recording(recording) => recording.method(folder),
            });
        }
    }
    Ok(registry)
}
