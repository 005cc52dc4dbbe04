//! Where a new folder is filled, beside the old one.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::at;
use super::left_over::{Anchor, clear, is_folder, seal};
use super::manifest::{Kind, MANIFEST, Manifest, entries};
use crate::atomic::sync_folder;

pub(super) const PREFIX: &str = ".calibench-partial-";
/// Held as long as the process that fills the new folder lives; says who made it, and names what is to be replaced.
pub(super) const LOCK: &str = "lock";
pub(super) const NEW: &str = "new";
/// Where the old folder waits between two renames, on file systems that cannot exchange two folders at once.
pub(super) const OLD: &str = "old";

/// A folder beside the one to be replaced: `lock` tells that it is in use, `new` is what is filled.
#[derive(Debug)]
pub(super) struct Scratch {
    folder: PathBuf,
    anchor: Anchor,
    _lock: File,
}

impl Scratch {
    /// Makes one in `parent` for the folder `name` in it, which the user calls `shown`, after removing those that killed processes left there.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn new(parent: &Path, name: &str, shown: &Path) -> io::Result<Self> {
        clear(parent)?;
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // Nobody else puts anything into it.
            builder.permissions(fs::Permissions::from_mode(0o700));
        }
        let made = builder.tempdir_in(parent).map_err(|error| at(shown, &error))?;
        let fill = || {
            let anchor = Anchor::at(made.path())?;
            let lock = lock(&anchor, made.path(), name)?;
            fs::create_dir(made.path().join(NEW))?;
            Ok((anchor, lock))
        };
        let (anchor, lock) = fill().map_err(|error| at(shown, &error))?;
        Ok(Self { folder: made.keep(), anchor, _lock: lock })
    }

    /// What is filled.
    pub fn new_folder(&self) -> PathBuf {
        self.folder.join(NEW)
    }

    /// Puts the new folder to `place`; of the old one, which is as `old` says, the files that are listed are removed.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn put(self, place: &Path, old: Option<&Manifest>) -> io::Result<()> {
        let new = self.new_folder();
        let named = |error: io::Error| at(place, &error);
        let about = match fs::metadata(place) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => match fs::rename(&new, place) {
                Err(error) if is_there(&error) => return self.put(place, None),
                put => return put.map_err(named).and_then(|()| synced(place)),
            },
            about => about.map_err(named)?,
        };
        fs::set_permissions(&new, about.permissions()).map_err(named)?;
        // Where none was seen another process of ours came first: what it wrote is the old folder now.
        let came = if old.is_none() { Manifest::read(place)? } else { None };
        exchange(&new, place, &self.folder.join(OLD)).map_err(named)?;
        synced(place)?;
        remove_listed(&new, old.or(came.as_ref()).unwrap_or(&Manifest::default())).map_err(named)?;
        if new.exists() {
            // It came after the last look at the old folder.
            give_back(&new, place)?;
        }
        Ok(())
    }
}

/// A folder has its new name on the disk, too.
fn synced(place: &Path) -> io::Result<()> {
    place.parent().map_or(Ok(()), sync_folder)
}

/// Whether a folder was not renamed because there is one that holds something.
fn is_there(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::DirectoryNotEmpty | io::ErrorKind::AlreadyExists)
}

impl Drop for Scratch {
    fn drop(&mut self) {
        remove(&self.anchor, &self.folder).ok();
    }
}

/// The lock of a new scratch folder. Until its words stand in it nobody takes the folder for one that was left.
fn lock(anchor: &Anchor, folder: &Path, name: &str) -> io::Result<File> {
    let mut file = File::create_new(folder.join(LOCK))?;
    // Where there are no locks, nothing that was left is ever removed.
    file.try_lock().ok();
    let seal = seal(anchor, &file.metadata()?).unwrap_or_default();
    file.write_all(format!("{seal}{name}").as_bytes())?;
    Ok(file)
}

/// Removes the scratch folder `folder`, held by `anchor`. What has a manifest is whole, old or new: of that the listed files go, and if there are others all stays.
///
/// # Errors
/// What the file system refuses.
pub(super) fn remove(anchor: &Anchor, folder: &Path) -> io::Result<()> {
    let held = anchor.path();
    for part in [NEW, OLD].map(|part| held.join(part)).iter().filter(|part| is_folder(part)) {
        match Manifest::read(part)? {
            Some(manifest) => remove_listed(part, &manifest)?,
            None if part.ends_with(NEW) => fs::remove_dir_all(part)?,
            None => drop(fs::remove_dir(part)),
        }
        if part.exists() {
            return Ok(());
        }
    }
    if_there(fs::remove_file(held.join(LOCK)))?;
    if_there(fs::remove_dir(folder))
}

/// Nothing to remove is no error.
fn if_there(removed: io::Result<()>) -> io::Result<()> {
    removed.or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })
}

/// Removes the files of `manifest`, the manifest, and the folders that are then empty.
fn remove_listed(folder: &Path, manifest: &Manifest) -> io::Result<()> {
    let mut folders = vec![folder.to_owned()];
    for entry in entries(folder)? {
        let Some(name) = &entry.name else { continue };
        match entry.kind {
            Kind::File if manifest.lists(name) => fs::remove_file(&entry.path)?,
            Kind::Folder if manifest.has_folder(name) => folders.push(entry.path),
            _ => {}
        }
    }
    // Last: whoever finds the rest knows what it is.
    if_there(fs::remove_file(folder.join(MANIFEST)))?;
    for folder in folders.iter().rev() {
        fs::remove_dir(folder).ok();
    }
    Ok(())
}

/// Moves what is left in `old` to the same names in `place`, where there are none.
fn give_back(old: &Path, place: &Path) -> io::Result<()> {
    for entry in entries(old)? {
        let Ok(name) = entry.path.strip_prefix(old) else { continue };
        let there = place.join(name);
        if fs::symlink_metadata(&there).is_err() && fs::symlink_metadata(&entry.path).is_ok() {
            fs::rename(&entry.path, &there).map_err(|error| at(&there, &error))?;
        }
    }
    let folders = entries(old)?.into_iter().filter(|entry| entry.kind == Kind::Folder).map(|entry| entry.path);
    folders.collect::<Vec<_>>().iter().rev().for_each(|folder| drop(fs::remove_dir(folder)));
    fs::remove_dir(old).map_err(|error| at(old, &error))
}

/// Swaps two folders; `old` is then at `new`.
fn exchange(new: &Path, old: &Path, aside: &Path) -> io::Result<()> {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{CWD, RenameFlags, renameat_with};
        match renameat_with(CWD, new, CWD, old, RenameFlags::EXCHANGE) {
            // Some file systems cannot exchange.
            Err(rustix::io::Errno::INVAL | rustix::io::Errno::NOSYS | rustix::io::Errno::NOTSUP) => {}
            result => return Ok(result?),
        }
    }
    by_renames(new, old, aside)
}

/// The same by three renames. Killed between them, the old folder is at `aside`, where the next writer finds it.
fn by_renames(new: &Path, old: &Path, aside: &Path) -> io::Result<()> {
    fs::rename(old, aside)?;
    fs::rename(new, old)?;
    fs::rename(aside, new)
}

#[cfg(test)]
impl Scratch {
    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Leaves all as it is, as a process that is killed does.
    pub fn abandon(self) -> PathBuf {
        let scratch = std::mem::ManuallyDrop::new(self);
        let Self { _lock: lock, folder, .. } = &*scratch;
        lock.unlock().unwrap();
        folder.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_exchange_an_old_folder_is_never_lost() {
        let parent = tempfile::tempdir().unwrap();
        let at = |name: &str| parent.path().join(name);
        let page = |folder: &Path| fs::read_to_string(folder.join("page")).unwrap();
        let scratch = Scratch::new(parent.path(), "a", Path::new("a")).unwrap();
        for (folder, text) in [(at("a"), "old"), (scratch.new_folder(), "new")] {
            fs::create_dir_all(&folder).unwrap();
            fs::write(folder.join("page"), text).unwrap();
            Manifest::of(&folder).unwrap().write(&folder).unwrap();
        }
        by_renames(&scratch.new_folder(), &at("a"), &scratch.folder.join(OLD)).unwrap();
        assert_eq!((page(&at("a")), page(&scratch.new_folder())), ("new".into(), "old".into()));
        // Killed after the first rename: the next one puts the old folder back. Nothing is done as long as the process lives.
        fs::rename(at("a"), scratch.folder.join(OLD)).unwrap();
        clear(parent.path()).unwrap();
        assert!(!at("a").exists());
        let left = scratch.abandon();
        clear(parent.path()).unwrap();
        assert_eq!(page(&at("a")), "new");
        assert!(!left.exists());
    }

    #[test]
    fn what_came_at_the_last_moment_is_given_back() {
        let parent = tempfile::tempdir().unwrap();
        let (place, scratch) = (parent.path().join("a"), Scratch::new(parent.path(), "a", Path::new("a")).unwrap());
        fs::create_dir_all(place.join("cell")).unwrap();
        fs::write(place.join("cell/page"), "old").unwrap();
        let old = Manifest::of(&place).unwrap();
        old.write(&place).unwrap();
        for (name, text) in [("note", "mine"), ("cell/note", "mine too")] {
            fs::write(place.join(name), text).unwrap();
        }
        fs::write(scratch.new_folder().join("page"), "new").unwrap();
        scratch.put(&place, Some(&old)).unwrap();
        let mut names: Vec<String> = entries(&place).unwrap().into_iter().filter_map(|entry| entry.name).collect();
        names.sort();
        assert_eq!(names, ["cell", "cell/note", "note", "page"]);
        assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 1);
    }

    /// Two that find nothing there at the same moment: one comes first, and the other replaces it.
    #[test]
    fn who_comes_second_replaces_the_first() {
        for round in 0..300 {
            let parent = tempfile::tempdir().unwrap();
            let place = parent.path().join("a");
            let filled = |text: &str| {
                let scratch = Scratch::new(parent.path(), "a", Path::new("a")).unwrap();
                fs::write(scratch.new_folder().join("page"), text).unwrap();
                Manifest::of(&scratch.new_folder()).unwrap().write(&scratch.new_folder()).unwrap();
                scratch
            };
            let (both, start) = ([filled("one"), filled("two")], std::sync::Barrier::new(2));
            let put = |scratch: Scratch| {
                start.wait();
                scratch.put(&place, None)
            };
            std::thread::scope(|scope| {
                let threads = both.map(|scratch| scope.spawn(|| put(scratch)));
                threads.into_iter().for_each(|thread| thread.join().unwrap().unwrap_or_else(|error| panic!("round {round}: {error}")));
            });
            let page = fs::read_to_string(place.join("page")).unwrap();
            assert!(page == "one" || page == "two");
            assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 1, "nothing is left beside it");
        }
    }
}
