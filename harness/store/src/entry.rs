//! One entry: a head with its key, what was put there, and the digest of both.

use std::collections::HashSet;
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Take, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::Key;

/// The first bytes of every entry; the number is raised when entries are written otherwise.
const HEAD: &[u8; 8] = b"calib 1\n";
/// Bytes before what was put there: head and key.
const BEFORE: u64 = 8 + 32;
/// Bytes after it: the digest.
const AFTER: u64 = 32;

/// The keys of what a store has put there itself.
pub(crate) type Own = Arc<Mutex<HashSet<Key>>>;

/// What was put there under a key, whole: reads it from its beginning.
#[derive(Debug)]
pub struct Found(Take<BufReader<File>>);

impl Read for Found {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.read(buffer)
    }
}

impl Found {
    /// How many bytes are left to be read.
    pub fn left(&self) -> u64 {
        self.0.limit()
    }
}

/// Why there is no entry to be read.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Lack {
    /// There is none.
    Absent,
    /// What is there is cut off, was changed, or is another's.
    Broken,
}

/// The entry of `key` at `path`, once its digest was found right.
pub(crate) fn open(path: &Path, key: Key) -> Result<Found, Lack> {
    let mut file = File::open(path).map_err(|_| Lack::Absent)?;
    let body = file.metadata().ok().and_then(|metadata| metadata.len().checked_sub(BEFORE + AFTER)).ok_or(Lack::Broken)?;
    check(&mut file, key, body).filter(|whole| *whole).ok_or(Lack::Broken)?;
    file.seek(SeekFrom::Start(BEFORE)).map_err(|_| Lack::Broken)?;
    Ok(Found(BufReader::with_capacity(1 << 16, file).take(body)))
}

/// Whether head, key and digest are right; `None` where the file cannot be read.
fn check(file: &mut File, key: Key, body: u64) -> Option<bool> {
    let mut hasher = blake3::Hasher::new();
    let mut head = [0; BEFORE as usize];
    file.read_exact(&mut head).ok()?;
    hasher.update(&head);
    hasher.update_reader(Read::by_ref(file).take(body)).ok()?;
    let mut digest = [0; AFTER as usize];
    file.read_exact(&mut digest).ok()?;
    Some(head[..8] == *HEAD && head[8..] == key.0 && *hasher.finalize().as_bytes() == digest)
}

/// An entry that is being written. Nobody finds it before [`Self::finish`]; dropped before, it was never there.
#[derive(Debug)]
pub struct NewEntry {
    file: BufWriter<File>,
    hasher: blake3::Hasher,
    beside: PathBuf,
    path: PathBuf,
    key: Key,
    own: Own,
    done: bool,
}

impl NewEntry {
    pub(crate) fn create(beside: PathBuf, path: PathBuf, key: Key, own: Own) -> io::Result<Self> {
        let file = BufWriter::with_capacity(1 << 16, File::create_new(&beside)?);
        let mut entry = Self { file, hasher: blake3::Hasher::new(), beside, path, key, own, done: false };
        entry.write_all(HEAD)?;
        entry.write_all(&key.0)?;
        Ok(entry)
    }

    /// Puts it into its place, over one that may be there.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn finish(mut self) -> io::Result<()> {
        let digest = *self.hasher.finalize().as_bytes();
        self.file.write_all(&digest)?;
        self.file.flush()?;
        fs::rename(&self.beside, &self.path)?;
        self.own.lock().unwrap_or_else(PoisonError::into_inner).insert(self.key);
        self.done = true;
        Ok(())
    }
}

impl Write for NewEntry {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for NewEntry {
    fn drop(&mut self) {
        if !self.done {
            fs::remove_file(&self.beside).ok();
        }
    }
}
