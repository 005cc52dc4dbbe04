//! Folders that are whole or as they were.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

const PARTIAL: &str = ".calibench-partial-";
const LOCK: &str = ".calibench-lock";

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
        fs::create_dir_all(parent)?;
        let lock = File::create(parent.join(LOCK))?;
        lock.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => io::Error::other(format!("another calibench writes to {}; wait until it ends", parent.display())),
            TryLockError::Error(error) => error,
        })?;
        for entry in fs::read_dir(parent)? {
            let entry = entry?;
            if entry.file_name().to_string_lossy().starts_with(PARTIAL) {
                fs::remove_dir_all(entry.path())?;
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
            exchange(partial.path(), &place)?;
        } else {
            fs::rename(partial.keep(), &place)?;
        }
        Ok(())
    }
}

/// Swaps two folders. The old one, now at `new`, is removed when its `TempDir` is dropped.
fn exchange(new: &Path, old: &Path) -> io::Result<()> {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{CWD, RenameFlags, renameat_with};
        match renameat_with(CWD, new, CWD, old, RenameFlags::EXCHANGE) {
            // Some file systems cannot exchange.
            Err(rustix::io::Errno::INVAL | rustix::io::Errno::NOSYS | rustix::io::Errno::NOTSUP) => {}
            result => return Ok(result?),
        }
    }
    let aside = new.with_extension("old");
    fs::rename(old, &aside)?;
    fs::rename(new, old)?;
    fs::rename(&aside, new)
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
