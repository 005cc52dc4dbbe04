//! Folders that a command writes and replaces as a whole.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use calibench_exchange::FolderWriter;

use crate::failure::Failure;

/// The file that tells a folder of ours: no other one is ever replaced.
const MARK: &str = ".calibench-output";

/// A folder that a user named.
pub struct OutputFolder {
    writer: FolderWriter,
    name: String,
}

impl OutputFolder {
    /// The folder `path`, which is new, empty, or one that calibench wrote.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let wrong = |why: &str| Failure::input(format!("-o {}: {why}", path.display()));
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
            return Err(wrong("expected the name of a folder"));
        };
        if path.exists() && !path.is_dir() {
            return Err(wrong("is a file; expected a folder"));
        }
        if path.is_dir() && !path.join(MARK).is_file() && fs::read_dir(path)?.next().is_some() {
            return Err(wrong("holds files that calibench did not write, and would be replaced as a whole; expected a new folder"));
        }
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).map_or_else(|| PathBuf::from("."), Path::to_owned);
        Ok(Self { writer: FolderWriter::new(&parent)?, name: name.to_owned() })
    }

    /// Puts what `fill` writes in the place of what is there, or leaves it as it is.
    ///
    /// # Errors
    /// What `fill` returns, and what the file system refuses.
    pub fn replace<E: From<io::Error>>(&self, fill: impl FnOnce(&Path) -> Result<(), E>) -> Result<(), E> {
        self.writer.replace(&self.name, |folder| {
            fs::write(folder.join(MARK), "calibench replaces this folder as a whole\n")?;
            fill(folder)
        })
    }
}
