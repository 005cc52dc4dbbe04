//! The list of the files that calibench wrote into a folder.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io;
use std::path::Path;

use rayon::prelude::*;

use super::at;
use super::owner::Owner;
use crate::bounded;

/// The list's name in its folder.
pub const MANIFEST: &str = ".calibench-manifest";
const HEAD: &str = "# calibench wrote these files and replaces no others here: blake3 digest and name";

/// Files below a folder: their names, with `/` between folders, and their digests, of which each may have one of several.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Manifest {
    files: BTreeMap<String, BTreeSet<String>>,
    /// Whose folder it is, where that is known.
    pub owner: Option<Owner>,
}

/// What an entry of a folder is; links are not followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    File,
    Folder,
    Other,
}

/// An entry below a folder.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    /// The path below the folder, with `/` between folders; `None` if it is no text.
    pub name: Option<String>,
    pub path: std::path::PathBuf,
    pub kind: Kind,
}

/// Everything below `folder`, sorted, each folder before what it holds.
pub(super) fn entries(folder: &Path) -> io::Result<Vec<Entry>> {
    fn walk(folder: &Path, above: Option<&str>, found: &mut Vec<Entry>) -> io::Result<()> {
        let read = || fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>();
        let mut here = read().map_err(|error| at(folder, &error))?;
        here.sort_by_key(fs::DirEntry::file_name);
        for entry in here {
            let name = entry.file_name().to_str().and_then(|name| above.map(|above| format!("{above}{name}")));
            let kind = entry.file_type().map_err(|error| at(&entry.path(), &error))?;
            let kind = if kind.is_dir() {
                Kind::Folder
            } else if kind.is_file() {
                Kind::File
            } else {
                Kind::Other
            };
            found.push(Entry { name: name.clone(), path: entry.path(), kind });
            if kind == Kind::Folder {
                walk(&entry.path(), name.map(|name| name + "/").as_deref(), found)?;
            }
        }
        Ok(())
    }
    let mut found = Vec::new();
    walk(folder, Some(""), &mut found)?;
    Ok(found)
}

/// The BLAKE3 digest of a file's content, in hexadecimal.
///
/// # Errors
/// A file that cannot be read, with its path.
pub fn digest(path: &Path) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    File::open(path).and_then(|file| hasher.update_reader(file).map(drop)).map_err(|error| at(path, &error))?;
    Ok(hasher.finalize().to_hex().to_string())
}

impl Manifest {
    /// That of a folder that calibench has just filled.
    ///
    /// # Errors
    /// A file whose name is no text, and what the file system refuses.
    pub fn of(folder: &Path) -> io::Result<Self> {
        let one = |entry: Entry| {
            let name = entry.name.filter(|name| !name.contains(char::is_control));
            let name = name.ok_or_else(|| io::Error::other(format!("{}: no name for a file", entry.path.display())))?;
            Ok((name, digest(&entry.path)?))
        };
        let files = entries(folder)?.into_par_iter().filter(|entry| entry.kind == Kind::File).map(one).collect::<io::Result<Vec<_>>>()?;
        let mut manifest = Self::default();
        files.iter().for_each(|(name, digest)| manifest.add(name, digest));
        Ok(manifest)
    }

    /// That of `folder`, if it has one.
    ///
    /// # Errors
    /// One that is not as calibench writes it.
    pub fn read(folder: &Path) -> io::Result<Option<Self>> {
        let path = folder.join(MANIFEST);
        match fs::symlink_metadata(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(at(&path, &error)),
            Ok(found) if !found.is_file() => return Err(wrong(&path, "is no file")),
            Ok(_) => {}
        }
        let text = bounded::text(&path).map_err(|error| at(&path, &error))?;
        Self::parse(&text)
            .map(Some)
            .map_err(|line| wrong(&path, &format!("line {line}: expected a digest, two spaces and the name of a file")))
    }

    /// # Errors
    /// The number of the first line that is wrong.
    fn parse(text: &str) -> Result<Self, usize> {
        let mut manifest = Self { owner: Owner::read(text), ..Self::default() };
        for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.starts_with('#')) {
            let is_digest = |digest: &str| digest.len() == 64 && digest.bytes().all(|byte| byte.is_ascii_hexdigit());
            let (digest, name) = line.split_once("  ").filter(|(digest, name)| is_digest(digest) && !name.is_empty()).ok_or(index + 1)?;
            manifest.add(name, digest);
        }
        Ok(manifest)
    }

    pub fn text(&self) -> String {
        let one =
            |(name, digests): (&String, &BTreeSet<String>)| digests.iter().map(|digest| format!("{digest}  {name}\n")).collect::<String>();
        let lines = self.files.iter().map(one);
        let owner = self.owner.as_ref().map(Owner::text).unwrap_or_default();
        format!("{HEAD}\n{owner}{}", lines.collect::<String>())
    }

    /// Writes it into `folder`.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        let path = folder.join(MANIFEST);
        fs::write(&path, self.text()).map_err(|error| at(&path, &error))
    }

    /// Lists a file, beside what it may be already.
    pub fn add(&mut self, name: &str, digest: &str) {
        self.files.entry(name.to_owned()).or_default().insert(digest.to_owned());
    }

    /// Lists a file as this alone.
    pub fn set(&mut self, name: &str, digest: &str) {
        self.files.insert(name.to_owned(), [digest.to_owned()].into());
    }

    /// The names that are listed.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// Whether a file of this name is listed.
    pub fn lists(&self, name: &str) -> bool {
        self.files.contains_key(name)
    }

    /// Whether it is listed with this digest.
    pub fn has(&self, name: &str, digest: &str) -> bool {
        self.files.get(name).is_some_and(|digests| digests.contains(digest))
    }

    /// Whether a listed file lies below this folder.
    pub fn has_folder(&self, name: &str) -> bool {
        let below = format!("{name}/");
        self.files.range(below.clone()..).next().is_some_and(|(file, _)| file.starts_with(&below))
    }
}

fn wrong(path: &Path, why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, format!("{}: {why}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("cell")).unwrap();
        for name in ["README.md", "cell/two  spaces.csv", "#1.png"] {
            fs::write(folder.path().join(name), name).unwrap();
        }
        // Of more than is read at once, to the last byte.
        let mut large = vec![7; 200_000];
        large.push(8);
        fs::write(folder.path().join("large.png"), &large).unwrap();
        let manifest = Manifest::of(folder.path()).unwrap();
        assert!(manifest.has("large.png", blake3::hash(&large).to_hex().as_str()));
        manifest.write(folder.path()).unwrap();
        assert_eq!(Manifest::read(folder.path()).unwrap(), Some(manifest.clone()));
        assert!(manifest.has("README.md", blake3::hash(b"README.md").to_hex().as_str()) && !manifest.has("README.md", ""));
        assert!(manifest.has_folder("cell") && !manifest.has_folder("cel") && !manifest.has_folder("README.md"));
    }

    #[test]
    fn a_broken_one_is_named_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        for text in ["# head\nREADME.md\n", "# head\nabc  README.md\n", &format!("# head\n{}  \n", "0".repeat(64))] {
            fs::write(folder.path().join(MANIFEST), text).unwrap();
            let error = Manifest::read(folder.path()).unwrap_err().to_string();
            assert!(error.contains(MANIFEST) && error.contains("line 2"), "{error}");
        }
    }
}
