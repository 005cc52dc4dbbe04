//! Folders that are whole or as they were.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

const PARTIAL: &str = ".calibench-partial-";
const LOCK: &str = ".calibench-lock";
/// Where an old folder waits while two renames replace it, on file systems that cannot exchange two folders at once.
const ASIDE: &str = ".calibench-aside-";

/// The right to replace folders below a parent. One process at a time has it; it ends with this value, or with the process.
#[derive(Debug)]
pub struct FolderWriter {
    parent: PathBuf,
    _lock: File,
}

impl FolderWriter {
    /// Takes the right to write below `parent`, which is made if it is not there, and removes what a killed process left half written.
    ///
    /// # Errors
    /// Another process that writes there, or what the file system refuses.
    pub fn new(parent: &Path) -> io::Result<Self> {
        let at = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", parent.display()));
        fs::create_dir_all(parent).map_err(at)?;
        let lock = File::create(parent.join(LOCK)).map_err(at)?;
        lock.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => io::Error::other(format!("another calibench writes to {}; wait until it ends", parent.display())),
            TryLockError::Error(error) => error,
        })?;
        for entry in fs::read_dir(parent)? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with(PARTIAL) {
                if entry.file_type()?.is_dir() { fs::remove_dir_all(entry.path())? } else { fs::remove_file(entry.path())? }
            } else if let Some(place) = name.strip_prefix(ASIDE) {
                recover(&entry.path(), &parent.join(place.replace("--", "/")))?;
            }
        }
        Ok(Self { parent: parent.to_owned(), _lock: lock })
    }

    /// Fills a new folder through `fill` and puts it in the place of `parent/name` at once; if `fill` fails, or the process is
    /// killed, the old one stays as it was.
    ///
    /// # Errors
    /// What `fill` returns, and what the file system refuses.
    pub fn replace<E: From<io::Error>>(&self, name: &str, fill: impl FnOnce(&Path) -> Result<(), E>) -> Result<(), E> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(PARTIAL);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(fs::Permissions::from_mode(0o777));
        }
        let partial = builder.tempdir_in(&self.parent)?;
        fill(partial.path())?;
        let place = self.parent.join(name);
        if let Some(folder) = place.parent() {
            fs::create_dir_all(folder)?;
        }
        if place.exists() {
            let aside = self.parent.join(format!("{ASIDE}{}", name.replace('/', "--")));
            exchange(partial.path(), &place, &aside)?;
        } else {
            fs::rename(partial.keep(), &place)?;
        }
        Ok(())
    }
}

/// Swaps two folders. The old one, now at `new`, is removed when its `TempDir` is dropped.
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

/// Puts back an old folder that waits at `aside` if nothing has taken its place, and removes it otherwise.
fn recover(aside: &Path, place: &Path) -> io::Result<()> {
    if place.exists() { fs::remove_dir_all(aside) } else { fs::rename(aside, place) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(text: &'static str) -> impl FnOnce(&Path) -> io::Result<()> {
        move |folder| fs::write(folder.join("page"), text)
    }

    fn visible(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.filter(|name| name != LOCK).collect()
    }

    #[test]
    fn a_folder_is_replaced_whole_or_not_at_all() {
        let parent = tempfile::tempdir().unwrap();
        let writer = FolderWriter::new(parent.path()).unwrap();
        writer.replace("a/b", write("old")).unwrap();
        let failed = writer.replace("a/b", |folder| {
            fs::write(folder.join("page"), "half")?;
            Err(io::Error::other("interrupted"))
        });
        assert!(failed.is_err());
        assert_eq!(fs::read_to_string(parent.path().join("a/b/page")).unwrap(), "old");
        writer.replace("a/b", write("new")).unwrap();
        assert_eq!(fs::read_to_string(parent.path().join("a/b/page")).unwrap(), "new");
        assert_eq!(visible(parent.path()), ["a"]);
    }

    #[test]
    fn without_exchange_an_old_folder_is_never_lost() {
        let parent = tempfile::tempdir().unwrap();
        let at = |name: &str| parent.path().join(name);
        let page = |folder: &str| fs::read_to_string(at(folder).join("page")).unwrap();
        for (name, text) in [("a", "old"), ("new", "new")] {
            fs::create_dir(at(name)).unwrap();
            fs::write(at(name).join("page"), text).unwrap();
        }
        by_renames(&at("new"), &at("a"), &at(".calibench-aside-a")).unwrap();
        assert_eq!((page("a"), page("new")), ("new".into(), "old".into()));
        // Killed after the first rename: the next writer puts the old folder back.
        fs::rename(at("a"), at(".calibench-aside-a")).unwrap();
        drop(FolderWriter::new(parent.path()).unwrap());
        assert_eq!(page("a"), "new");
        // Killed after the second: the new one stays.
        fs::rename(at("new"), at(".calibench-aside-a")).unwrap();
        drop(FolderWriter::new(parent.path()).unwrap());
        assert_eq!(page("a"), "new");
        assert!(!at(".calibench-aside-a").exists());
    }

    #[test]
    fn what_a_killed_process_left_is_removed_and_two_do_not_write_at_once() {
        let parent = tempfile::tempdir().unwrap();
        fs::create_dir(parent.path().join(format!("{PARTIAL}left"))).unwrap();
        let writer = FolderWriter::new(parent.path()).unwrap();
        assert!(visible(parent.path()).is_empty());
        assert!(FolderWriter::new(parent.path()).unwrap_err().to_string().contains("another calibench"));
        drop(writer);
        assert!(FolderWriter::new(parent.path()).is_ok());
    }
}
