//! The files that declare methods: what one declares, and all of a folder.

use std::path::{Path, PathBuf};

use calibench_diagnostics::{Problem, Problems};
use calibench_measure::Registry;
use serde::Deserialize;
use toml::Spanned;

use crate::calibrator::{self, CalibratorDeclaration, CalibratorProgram};
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
    #[serde(default)]
    calibrator: Vec<Spanned<calibrator::Wire>>,
}

/// What a file declares.
#[derive(Clone, Debug)]
pub enum Declared {
    /// A program.
    Program(Declaration),
    /// A file of positions.
    Recording(Recording),
    /// A program that calibrates.
    Calibrator(Box<CalibratorDeclaration>),
}

impl Declared {
    /// Its name among the methods.
    pub fn name(&self) -> &str {
        match self {
            Self::Program(program) => &program.name,
            Self::Recording(recording) => &recording.name,
            Self::Calibrator(calibrator) => &calibrator.program.name,
        }
    }
}

/// What `text` declares, which is that of `file`: programs, then files of positions, then calibrators.
///
/// # Errors
/// Every mistake with line and column.
pub fn parse(file: &str, text: &str) -> Result<Vec<Declared>, Problems> {
    let all = |problems| Problems { file: file.to_owned(), text: text.to_owned(), problems };
    let wire: File =
        toml::from_str(text).map_err(|error| all(vec![Problem::new(error.span().unwrap_or(0..0), error.message().to_owned())]))?;
    if wire.plugin.is_empty() && wire.method.is_empty() && wire.calibrator.is_empty() {
        let expected = "[[plugin]] or [[calibrator]] with `name` and `command`, or [[method]] with `name`, `file` and `images`";
        return Err(all(vec![Problem::new(0..0, format!("declares no plug-in: expected {expected}"))]));
    }
    let mut problems = Vec::new();
    let programs = wire.plugin.into_iter().filter_map(|plugin| declaration::checked(plugin.into_inner(), file, &mut problems));
    let mut found: Vec<Declared> = programs.map(Declared::Program).collect();
    let recordings = wire.method.into_iter().filter_map(|method| recorded::checked(method.into_inner(), file, &mut problems));
    found.extend(recordings.map(Declared::Recording));
    let calibrators = wire.calibrator.into_iter().filter_map(|wire| calibrator::checked(wire.into_inner(), file, &mut problems));
    found.extend(calibrators.map(|calibrator| Declared::Calibrator(Box::new(calibrator))));
    if problems.is_empty() { Ok(found) } else { Err(all(problems)) }
}

/// `registry` with the plug-ins that the TOML files of `folder` declare, in the order of their names.
///
/// # Errors
/// A folder or file that cannot be read, mistakes with line and column, a name that is taken.
pub fn load(folder: &Path, mut registry: Registry, launcher: &Launcher) -> Result<Registry, PluginError> {
    for (path, declared) in all(folder)? {
        let name = declared.name().to_owned();
        if registry.methods().iter().any(|method| method.name == name) {
            return Err(PluginError::Taken { path, name });
        }
        registry = match declared {
            Declared::Program(declaration) => registry.with(method(declaration, folder, launcher)),
            Declared::Recording(recording) => registry.with(recording.method(folder)),
            Declared::Calibrator(_) => registry,
        };
    }
    Ok(registry)
}

/// The calibrators that the TOML files of `folder` declare, in the order of their names.
///
/// # Errors
/// As of [`load`].
pub fn calibrators(folder: &Path, launcher: &Launcher) -> Result<Vec<CalibratorProgram>, PluginError> {
    let of = |declared| match declared {
        Declared::Calibrator(declaration) => Some(CalibratorProgram::new(*declaration, folder, launcher)),
        Declared::Program(_) | Declared::Recording(_) => None,
    };
    Ok(all(folder)?.into_iter().filter_map(|(_, declared)| of(declared)).collect())
}

/// What the TOML files of `folder` declare, each name once, with the files.
fn all(folder: &Path) -> Result<Vec<(PathBuf, Declared)>, PluginError> {
    let file_error = |path: &Path, source| PluginError::File { path: path.to_owned(), source };
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let mut files: Vec<PathBuf> = entries.map_err(|error| file_error(folder, error))?.into_iter().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    let mut found: Vec<(PathBuf, Declared)> = Vec::new();
    for path in files {
        let text = calibench_files::bounded::text(&path).map_err(|error| file_error(&path, error))?;
        for declared in parse(&path.display().to_string(), &text)? {
            if let Some((earlier, _)) = found.iter().find(|(_, other)| other.name() == declared.name()) {
                return Err(PluginError::Twice { path, earlier: earlier.clone(), name: declared.name().to_owned() });
            }
            found.push((path.clone(), declared));
        }
    }
    Ok(found)
}
