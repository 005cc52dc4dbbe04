//! Where a folder is to be, and what stands in its way.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::at;
use super::manifest::{Entry, Kind, MANIFEST, Manifest, digest, entries};

/// The mark of folders that versions before the manifest wrote.
const OLD_MARK: &str = ".calibench-output";
/// What such versions wrote as records.
const OLD_RECORDS: [&str; 2] = ["records.csv", "scenario.toml"];
/// So many names stand in a message.
const NAMED: usize = 5;

/// The place of a folder: an existing folder above it, and its name there.
#[derive(Debug)]
pub(super) struct Place {
    pub parent: PathBuf,
    pub name: String,
    /// As the user calls it.
    shown: PathBuf,
}

impl Place {
    /// The place that `path` means. A link to a folder means that folder.
    ///
    /// # Errors
    /// A link to nothing, a file, a path without a name or with one that is no text, the folder that the process is in; what the file system refuses.
    pub fn of(path: &Path) -> io::Result<Self> {
        let wrong = |why: &str| io::Error::new(io::ErrorKind::InvalidInput, format!("{}: {why}", path.display()));
        let whole = match path.canonicalize() {
            Ok(whole) => whole,
            Err(_) if path.is_symlink() => return Err(wrong("is a link to nothing; expected a folder")),
            Err(error) if error.kind() == io::ErrorKind::NotFound => absent(path)?,
            Err(error) => return Err(at(path, &error)),
        };
        if whole.exists() && !whole.is_dir() {
            return Err(wrong("is a file; expected a folder"));
        }
        let name = whole.file_name().ok_or_else(|| wrong("expected the name of a folder"))?;
        let name = name.to_str().filter(|name| !name.contains(char::is_control));
        let name = name.ok_or_else(|| wrong("expected a name that is text"))?;
        let here = std::env::current_dir().and_then(|folder| folder.canonicalize());
        if here.is_ok_and(|here| here.starts_with(&whole)) {
            return Err(wrong(
                "this is the folder that you are in, or holds it, and is replaced as a whole: expected the name of a folder in it",
            ));
        }
        let parent = whole.parent().unwrap_or(Path::new("/")).to_owned();
        Ok(Self { parent, name: name.to_owned(), shown: path.to_owned() })
    }

    pub fn path(&self) -> PathBuf {
        self.parent.join(&self.name)
    }

    /// The manifest of what is to be replaced; `None` if nothing is there, or nothing in it.
    ///
    /// # Errors
    /// What must not be replaced.
    pub fn check(&self) -> io::Result<Option<Manifest>> {
        let folder = self.path();
        let about = match fs::metadata(&folder) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            other => other.map_err(|error| at(&self.shown, &error))?,
        };
        if about.permissions().readonly() {
            return Err(self.refused("is write-protected; nothing was written"));
        }
        if is_mounted(&about, &self.parent)? {
            return Err(self.refused("is where another file system begins, and cannot be replaced at once: name a folder in it"));
        }
        let Some(manifest) = Manifest::read(&folder)? else { return self.without_manifest(&folder) };
        let (mut named, mut count) = (Vec::new(), 0);
        let found = entries(&folder)?;
        let obstacles = found.par_iter().map(|entry| obstacle(entry, &manifest)).collect::<io::Result<Vec<_>>>()?;
        for (entry, obstacle) in found.iter().zip(obstacles) {
            if let Some(why) = obstacle {
                count += 1;
                if named.len() < NAMED {
                    let name = entry.path.strip_prefix(&folder).unwrap_or(&entry.path).display().to_string();
                    named.push(format!("{}{why}", plain(&name)));
                }
            }
        }
        if count == 0 {
            return Ok(Some(manifest));
        }
        Err(self.refused(&format!(
            "holds what calibench did not write or what was changed since: {}; nothing was written: move that elsewhere, or name another folder",
            list(&named, count)
        )))
    }

    fn without_manifest(&self, folder: &Path) -> io::Result<Option<Manifest>> {
        let names = fs::read_dir(folder).and_then(|found| found.map(|entry| Ok(entry?.file_name())).collect::<io::Result<Vec<_>>>());
        let mut names: Vec<String> =
            names.map_err(|error| at(&self.shown, &error))?.iter().map(|name| plain(&name.to_string_lossy())).collect();
        if names.is_empty() {
            return Ok(None);
        }
        names.sort();
        let has = |wanted: &str| names.iter().any(|name| name == wanted);
        if has(OLD_MARK) || OLD_RECORDS.iter().all(|name| has(name)) {
            return Err(self.refused(
                "was written by an older calibench, which kept no list of its files; nothing was written: see that nothing of yours is in it and \
                 delete it, or name another folder",
            ));
        }
        let named: Vec<String> = names.iter().take(NAMED).cloned().collect();
        Err(self.refused(&format!(
            "holds files that calibench did not write: {}; nothing was written: name a new or empty folder",
            list(&named, names.len())
        )))
    }

    fn refused(&self, why: &str) -> io::Error {
        io::Error::new(io::ErrorKind::AlreadyExists, format!("{}: {why}", self.shown.display()))
    }
}

/// Where a folder will be that is not there yet.
fn absent(path: &Path) -> io::Result<PathBuf> {
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, format!("{}: expected the name of a folder", path.display())))?;
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let parent = match parent.canonicalize() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => absent(parent)?,
        other => other.map_err(|error| at(parent, &error))?,
    };
    Ok(parent.join(name))
}

/// Why an entry must not be replaced, to be put behind its name.
fn obstacle(entry: &Entry, manifest: &Manifest) -> io::Result<Option<&'static str>> {
    let Some(name) = &entry.name else { return Ok(Some("")) };
    Ok(match entry.kind {
        Kind::File if name == MANIFEST => None,
        Kind::File if !manifest.lists(name) => Some(""),
        Kind::File if fs::metadata(&entry.path).map_err(|error| at(&entry.path, &error))?.permissions().readonly() => {
            Some(" (write-protected)")
        }
        Kind::File if !manifest.has(name, &digest(&entry.path)?) => Some(" (changed)"),
        Kind::File => None,
        Kind::Folder if manifest.has_folder(name) => None,
        Kind::Folder => Some(" (a folder)"),
        Kind::Other => Some(" (no regular file)"),
    })
}

fn list(named: &[String], count: usize) -> String {
    let more = if count > named.len() { format!(" and {} more", count - named.len()) } else { String::new() };
    format!("{}{more}", named.join(", "))
}

/// A name without what would move a terminal's cursor.
fn plain(name: &str) -> String {
    name.chars().flat_map(|c| if c.is_control() { c.escape_default().collect::<Vec<_>>() } else { vec![c] }).collect()
}

#[cfg(unix)]
fn is_mounted(about: &fs::Metadata, parent: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    Ok(fs::metadata(parent).map_err(|error| at(parent, &error))?.dev() != about.dev())
}

#[cfg(not(unix))]
fn is_mounted(_: &fs::Metadata, _: &Path) -> io::Result<bool> {
    Ok(false)
}
