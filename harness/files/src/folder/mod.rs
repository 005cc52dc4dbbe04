//! Folders that are whole or as they were, and in which nothing but calibench's own files is replaced.
//!
//! Each folder holds a manifest: the files that calibench wrote there, with their digests. A folder in which anything else is, or in
//! which a file was changed since, is refused. A new one is filled beside the old one and exchanged with it at once.

mod foreign_folder;
mod intact;
mod left_over;
mod manifest;
mod new;
mod owner;
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
use owner::Owner;
pub use owner::is_project;
use place::Place;
use scratch::Scratch;

/// A folder that a command writes, and replaces when it is run again.
#[derive(Clone, Debug)]
pub struct OutputFolder {
    path: PathBuf,
    owner: Option<Owner>,
}

impl OutputFolder {
    /// The folder `path`, which is not there yet, is empty, or holds nothing but what calibench wrote; nothing is changed by this.
    ///
    /// # Errors
    /// A folder with files that calibench did not write or that were changed since, named in the message; what is no folder; what is write-protected;
    /// the folder that the process is in; what the file system refuses.
    pub fn open(path: &Path) -> io::Result<Self> {
        Place::of(path)?.check()?;
        Ok(Self { path: path.to_owned(), owner: None })
    }

    /// The same as a folder of `command`, for a project if there is one: its manifest says so.
    ///
    /// # Errors
    /// A folder of another command, or of another project.
    pub fn owned_by(self, command: &str, project: Option<&Path>) -> io::Result<Self> {
        let place = Place::of(&self.path)?;
        let owned = Self { owner: Some(Owner::new(command, &place.path(), project)), ..self };
        owned.is_its_own(&place, Manifest::read(&place.path())?.as_ref())?;
        Ok(owned)
    }

    fn is_its_own(&self, place: &Place, there: Option<&Manifest>) -> io::Result<()> {
        let (Some(owner), Some(there)) = (&self.owner, there.and_then(|there| there.owner.as_ref())) else { return Ok(()) };
        let refusal = there.refuses(owner, &place.path());
        refusal.map_or(Ok(()), |why| Err(io::Error::new(io::ErrorKind::AlreadyExists, format!("{}: {why}", self.path.display()))))
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
        Ok(self.filled(fill)?.put()?)
    }

    /// The same but for putting it there: of several folders all can be filled before the first is replaced.
    ///
    /// # Errors
    /// As [`Self::replace`].
    pub fn filled<E: From<io::Error>>(&self, fill: impl FnOnce(&NewFolder) -> Result<(), E>) -> Result<FilledFolder, E> {
        let made = MadeFolders::above(&self.path)?;
        let place = Place::of(&self.path)?;
        self.is_its_own(&place, place.check()?.as_ref())?;
        let scratch = Scratch::new(&place.parent, &place.name, &self.path)?;
        let new = NewFolder::new(scratch.new_folder(), self.path.clone());
        fill(&new)?;
        let mut manifest = Manifest::of(new.path())?;
        manifest.owner.clone_from(&self.owner);
        manifest.write(new.path())?;
        sync(new.path()).map_err(|error| at(&self.path, &error))?;
        Ok(FilledFolder { output: self.clone(), place, scratch, made })
    }
}

/// A new folder that is whole and not yet in its place; dropped, it is gone.
#[derive(Debug)]
pub struct FilledFolder {
    output: OutputFolder,
    place: Place,
    scratch: Scratch,
    made: MadeFolders,
}

impl FilledFolder {
    /// Puts it in the place of the old one.
    ///
    /// # Errors
    /// What came into the old folder while the new one was filled, and what the file system refuses.
    pub fn put(self) -> io::Result<()> {
        let Self { output, place, scratch, made } = self;
        let old = place.check()?;
        output.is_its_own(&place, old.as_ref())?;
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
#[derive(Debug)]
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
