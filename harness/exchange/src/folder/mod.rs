//! Folders that are whole or as they were, and in which nothing but calibench's own files is replaced.
//!
//! Each folder holds a manifest: the files that calibench wrote there, with their digests. A folder in which anything else is, or in
//! which a file was changed since, is refused. A new one is filled beside the old one and exchanged with it at once.

mod foreign_folder;
mod intact;
mod manifest;
mod new;
mod place;
mod scratch;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::atomic::{at, named};
pub use foreign_folder::write_beside;
pub use intact::intact;
use manifest::Manifest;
pub use manifest::{MANIFEST, digest};
pub use new::{NewFile, NewFolder};
use place::Place;
use scratch::Scratch;

/// A folder that a command writes, and replaces when it is run again.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
}

impl OutputFolder {
    /// The folder `path`, which is not there yet, is empty, or holds nothing but what calibench wrote; nothing is changed by this.
    ///
    /// # Errors
    /// A folder with files that calibench did not write or that were changed since, named in the message; what is no folder; what is write-protected;
    /// the folder that the process is in; what the file system refuses.
    pub fn open(path: &Path) -> io::Result<Self> {
        Place::of(path)?.check()?;
        Ok(Self { path: path.to_owned() })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Fills a new folder through `fill` and puts it in the place of the old one at once; if `fill` fails, or the process is killed, the old one
    /// stays as it was. The folder above is made if it is not there.
    ///
    /// # Errors
    /// As [`Self::open`], what `fill` returns, and what the file system refuses.
    pub fn replace<E: From<io::Error>>(&self, fill: impl FnOnce(&NewFolder) -> Result<(), E>) -> Result<(), E> {
        let made = MadeFolders::above(&self.path)?;
        let place = Place::of(&self.path)?;
        place.check()?;
        let scratch = Scratch::new(&place.parent, &place.name, &self.path)?;
        let new = NewFolder::new(scratch.new_folder(), self.path.clone());
        fill(&new)?;
        Manifest::of(new.path())?.write(new.path())?;
        sync(new.path()).map_err(|error| at(&self.path, &error))?;
        // Whatever came into the old folder while the new one was filled is seen here.
        let old = place.check()?;
        scratch.put(&place.path(), old.as_ref())?;
        made.keep();
        Ok(())
    }
}

/// Puts everything below a folder on the disk, at once: a power cut after the old folder has gone must not leave new files without their content.
#[cfg(target_os = "linux")]
fn sync(folder: &Path) -> io::Result<()> {
    Ok(rustix::fs::syncfs(fs::File::open(folder)?)?)
}

/// The same where there is no call for it: file by file.
#[cfg(not(target_os = "linux"))]
fn sync(folder: &Path) -> io::Result<()> {
    let files = manifest::entries(folder)?.into_iter().filter(|entry| entry.kind == manifest::Kind::File);
    files.map(|entry| fs::File::open(&entry.path)?.sync_all()).collect()
}

/// Folders that were made for a result; those that are empty go when there is none.
struct MadeFolders(Vec<PathBuf>);

impl MadeFolders {
    fn above(path: &Path) -> io::Result<Self> {
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let made = parent.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists()).map(Path::to_owned).collect();
        let made = Self(made);
        fs::create_dir_all(parent).map_err(|error| at(parent, &error))?;
        Ok(made)
    }

    fn keep(mut self) {
        self.0.clear();
    }
}

impl Drop for MadeFolders {
    fn drop(&mut self) {
        for folder in &self.0 {
            fs::remove_dir(folder).ok();
        }
    }
}

#[cfg(test)]
mod tests;
