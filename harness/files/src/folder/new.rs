//! A folder while it is filled.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Component, Path, PathBuf};

use super::manifest::MANIFEST;

/// A folder that is being filled, beside the one that it will replace. Errors name files by where they will be.
#[derive(Clone, Debug)]
pub struct NewFolder {
    /// Where it is filled.
    path: PathBuf,
    /// Where it will be, as the user calls it.
    shown: PathBuf,
}

/// A file in it; errors name it.
#[derive(Debug)]
pub struct NewFile {
    inner: BufWriter<File>,
    shown: PathBuf,
}

impl NewFolder {
    pub(super) fn new(path: PathBuf, shown: PathBuf) -> Self {
        Self { path, shown }
    }

    /// Where it is filled: to read what was written.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The folder `name` in it, which is made.
    ///
    /// # Errors
    /// A name that leads out of it, and what the file system refuses.
    pub fn folder(&self, name: &str) -> io::Result<Self> {
        let folder = Self { path: self.inner(name)?, shown: self.shown.join(name) };
        fs::create_dir_all(&folder.path).map_err(|error| super::at(&folder.shown, &error))?;
        Ok(folder)
    }

    /// A new file `name`, with `/` between folders, which are made.
    ///
    /// # Errors
    /// A name that leads out of the folder, that is no text, or that another file has; and what the file system refuses.
    pub fn create(&self, name: &str) -> io::Result<NewFile> {
        let (path, shown) = (self.inner(name)?, self.shown.join(name));
        let made = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| File::create_new(&path));
        let file = made.map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => {
                io::Error::new(error.kind(), format!("{}: two results have this name; rename what they are called after", shown.display()))
            }
            _ => super::at(&shown, &error),
        })?;
        Ok(NewFile { inner: BufWriter::new(file), shown })
    }

    /// Writes a new file `name` through `write`.
    ///
    /// # Errors
    /// As [`Self::create`], and what `write` returns.
    pub fn write<E: From<io::Error>>(&self, name: &str, write: impl FnOnce(&mut dyn Write) -> Result<(), E>) -> Result<(), E> {
        let mut file = self.create(name)?;
        write(&mut file)?;
        Ok(file.flush()?)
    }

    /// The path of `name` where the folder is filled.
    fn inner(&self, name: &str) -> io::Result<PathBuf> {
        let stays = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        let ours = name.split(['/', '\\']).any(|part| part == MANIFEST);
        if name.is_empty() || !stays || ours || name.contains(|c: char| c.is_control() || c == '\\') {
            let why = format!(
                "{}: `{}` cannot be the name of a file in it; rename what it is called after",
                self.shown.display(),
                name.escape_debug()
            );
            return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        }
        Ok(self.path.join(name))
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.inner.write(bytes).map_err(|error| super::named(&self.shown, error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush().map_err(|error| super::named(&self.shown, error))
    }
}
