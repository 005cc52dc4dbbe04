//! The folder.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::PoisonError;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, SystemTime};

use crate::entry::{Found, Lack, NewEntry, Own, open};
use crate::key::Key;

/// What names of entries that are being written begin with.
const BESIDE: &str = "new-";
/// An entry that nobody has finished for so long nobody will.
const GIVEN_UP: Duration = Duration::from_hours(24);

/// A folder of results.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    most: u64,
    fresh: bool,
    /// What this store has put there.
    own: Own,
    broken: AtomicU64,
    written: AtomicU64,
}

impl Store {
    /// The one in `folder`, which is made when the first entry is; after [`Self::trim`] it holds `most` bytes at most. `fresh`: it finds only what it has put there
    /// itself since it was opened.
    pub fn open(folder: &Path, most: u64, fresh: bool) -> Self {
        let (broken, written) = (AtomicU64::new(0), AtomicU64::new(0));
        Self { folder: folder.to_owned(), most, fresh, own: Own::default(), broken, written }
    }

    /// Its folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// What was put there under `key`, if it is there and whole. One that is not is counted among the [broken](Self::broken).
    pub fn find(&self, key: Key) -> Option<Found> {
        if self.fresh && !self.own.lock().unwrap_or_else(PoisonError::into_inner).contains(&key) {
            return None;
        }
        let path = self.place(key);
        match open(&path, key) {
            Ok(found) => {
                // What was used last goes last; a folder that may only be read serves all the same.
                File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now())).ok();
                Some(found)
            }
            Err(Lack::Absent) => None,
            Err(Lack::Broken) => {
                self.broken.fetch_add(1, Ordering::Relaxed);
                None
            }
        }
    }

    /// A new entry under `key`.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn create(&self, key: Key) -> io::Result<NewEntry> {
        let path = self.place(key);
        let folder = path.parent().unwrap_or(&self.folder);
        if !self.folder.exists() {
            fs::create_dir_all(&self.folder)?;
            // What is in it belongs into no repository.
            fs::write(self.folder.join(".gitignore"), "*\n")?;
        }
        fs::create_dir_all(folder)?;
        // Of this process and no other, of this entry and no other.
        let number = self.written.fetch_add(1, Ordering::Relaxed);
        let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_nanos();
        let beside = folder.join(format!("{BESIDE}{}-{number}-{since}", std::process::id()));
        NewEntry::create(beside, path, key, self.own.clone())
    }

    /// How many entries were there and not whole.
    pub fn broken(&self) -> u64 {
        self.broken.load(Ordering::Relaxed)
    }

    /// Removes what was used longest ago until no more is left than the store may hold, and what was begun a day ago and never finished.
    ///
    /// # Errors
    /// A folder that cannot be listed. What another command removes meanwhile is no error.
    pub fn trim(&self) -> io::Result<()> {
        let mut entries = Vec::new();
        for file in self.files()? {
            let Ok(metadata) = file.metadata() else { continue };
            let used = metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            let unfinished = file.file_name().is_some_and(|name| name.to_string_lossy().starts_with(BESIDE));
            if unfinished && used.elapsed().is_ok_and(|age| age > GIVEN_UP) {
                fs::remove_file(&file).ok();
            } else if !unfinished {
                entries.push((used, metadata.len(), file));
            }
        }
        let mut held: u64 = entries.iter().map(|(_, size, _)| size).sum();
        entries.sort();
        for (_, size, file) in entries {
            if held <= self.most {
                break;
            }
            fs::remove_file(&file).ok();
            held -= size;
        }
        Ok(())
    }

    /// Every file in the store.
    pub(crate) fn files(&self) -> io::Result<Vec<PathBuf>> {
        let list = |folder: &Path| match fs::read_dir(folder) {
            Ok(entries) => entries.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
            Err(error) => Err(error),
        };
        let folders = list(&self.folder)?.into_iter().filter(|path| path.is_dir()).map(|path| list(&path));
        Ok(folders.collect::<io::Result<Vec<_>>>()?.into_iter().flatten().collect())
    }

    /// Where the entry of `key` lies: in one of 256 folders.
    fn place(&self, key: Key) -> PathBuf {
        let name = key.to_string();
        self.folder.join(&name[..2]).join(&name[2..])
    }
}
