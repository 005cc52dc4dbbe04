//! The list of what is blessed, `blessed.toml` beside the baselines: without it, a deleted baseline would look like one that never was.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use calibench_files::atomic::write_atomically;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The file's name in the folder of baselines.
pub const INDEX: &str = "blessed.toml";
const FIRST: &str = "# The files that are blessed, each with its checksum: written by `calibench bless`, never by hand.";

/// The list of blessed files.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Index {
    /// Checksums by file name.
    pub files: BTreeMap<String, String>,
}

/// A list that is none.
#[derive(Debug, Error)]
pub enum IndexError {
    /// It is not there.
    #[error("{}: there is no such file, so nothing is known to be blessed; restore it, or `calibench bless`", .0.display())]
    Missing(PathBuf),
    /// It cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Its text means nothing.
    #[error("{}: {problem}; restore it, or bless anew", path.display())]
    Text {
        /// The file.
        path: PathBuf,
        /// The fault.
        problem: String,
    },
}

impl Index {
    /// Reads the list of `folder`.
    ///
    /// # Errors
    /// A list that is not there or means nothing.
    pub fn read(folder: &Path) -> Result<Self, IndexError> {
        let path = folder.join(INDEX);
        match calibench_files::bounded::text(&path) {
            Ok(text) => {
                toml::from_str(&text).map_err(|error: toml::de::Error| IndexError::Text { path, problem: error.message().to_owned() })
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => Err(IndexError::Missing(path)),
            Err(source) => Err(IndexError::File { path, source }),
        }
    }

    /// Writes the list into `folder`, whole or not at all.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn write(&self, folder: &Path) -> Result<(), IndexError> {
        let path = folder.join(INDEX);
        let failed = |source| IndexError::File { path: path.clone(), source };
        let text = toml::to_string(self).map_err(|error| failed(io::Error::other(error)))?;
        write_atomically(&path, |file| write!(file, "{FIRST}\n\n{text}")).map_err(failed)
    }

    /// Whether the file at `path` is listed, by its name.
    pub fn lists(&self, path: &Path) -> bool {
        self.files.contains_key(&name(path))
    }

    /// Notes the file at `path` as blessed.
    pub fn bless(&mut self, path: &Path, checksum: String) {
        self.files.insert(name(path), checksum);
    }

    /// Notes that the file at `path` is blessed no more.
    pub fn forget(&mut self, path: &Path) {
        self.files.remove(&name(path));
    }

    /// Whether the file at `path`, whose checksum is `found`, is the one that was blessed; in words if not. `None` stands for no file.
    pub fn mistake(&self, path: &Path, found: Option<&str>) -> Option<String> {
        let file = name(path);
        match (self.files.get(&file), found) {
            (Some(_), None) => Some(format!("the baseline is missing: {file} is blessed and not there; restore it, or bless anew")),
            (Some(blessed), Some(found)) if blessed != found => {
                Some(format!("{file} is not the file that was blessed: its checksum is {found}, blessed is {blessed}; bless anew"))
            }
            (None, Some(_)) => Some(format!("{file} is there and not in {INDEX}: it was not blessed here; bless anew")),
            _ => None,
        }
    }
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_list_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Index::read(folder.path()).unwrap_err().to_string().contains("nothing is known to be blessed"));
        let index = Index { files: BTreeMap::from([("a--b.csv".to_owned(), "12".to_owned())]) };
        index.write(folder.path()).unwrap();
        assert_eq!(Index::read(folder.path()).unwrap(), index);
        fs::write(folder.path().join(INDEX), "[files]\na = 1\n").unwrap();
        assert!(Index::read(folder.path()).unwrap_err().to_string().contains("blessed.toml"));
    }

    #[test]
    fn what_is_not_as_listed_is_said() {
        let index = Index { files: BTreeMap::from([("a.csv".to_owned(), "12".to_owned())]) };
        assert_eq!(index.mistake(Path::new("a.csv"), Some("12")), None);
        assert_eq!(index.mistake(Path::new("b.csv"), None), None);
        assert!(index.mistake(Path::new("a.csv"), None).unwrap().contains("missing"));
        assert!(index.mistake(Path::new("a.csv"), Some("13")).unwrap().contains("not the file that was blessed"));
        assert!(index.mistake(Path::new("b.csv"), Some("13")).unwrap().contains("not in blessed.toml"));
    }
}
