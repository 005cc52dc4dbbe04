//! Files that are whole or not there.

use std::fs::{self, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::photograph::is_photograph;

/// What stands at the path of an output.
enum Target {
    /// Nothing or a regular file: replaced at once. The path of the file itself, where it was given by a link.
    File(PathBuf),
    /// A device, a pipe or an open descriptor: written through.
    Stream,
}

/// A file that a command writes.
#[derive(Clone, Debug)]
pub struct OutputFile {
    path: PathBuf,
    /// The regular file, if it is or will be one.
    place: Option<PathBuf>,
}

impl OutputFile {
    /// The file `path`, which is not there yet, or may be replaced; nothing is changed by this.
    ///
    /// # Errors
    /// A folder, a write-protected file, a photograph (an image that this program did not draw), and what the file system refuses; each names the path.
    pub fn open(path: &Path) -> io::Result<Self> {
        let place = match target(path)? {
            Target::File(place) => {
                may_be_replaced(path, &place)?;
                Some(folder_of(&place).canonicalize().map_err(|error| at(path, &error))?.join(place.file_name().unwrap_or_default()))
            }
            Target::Stream => None,
        };
        Ok(Self { path: path.to_owned(), place })
    }

    /// Whether its name, or that of the file to which it is a link, has one of these endings, in small letters without dot; a device or a pipe has any.
    pub fn has_ending(&self, known: &[&str]) -> bool {
        let has = |path: &Path| path.extension().is_some_and(|ending| known.iter().any(|known| ending.eq_ignore_ascii_case(known)));
        self.place.as_ref().is_none_or(|place| has(&self.path) || has(place))
    }

    /// Whether it is, or will be, a regular file.
    pub fn is_file(&self) -> bool {
        self.place.is_some()
    }

    /// Whether both are one regular file.
    pub fn is_same(&self, other: &Self) -> bool {
        self.place.is_some() && self.place == other.place
    }

    /// Its path, as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes it through `write`. A regular file is made beside the old one, whose permissions it gets, and renamed when all is written; a link to it
    /// stays a link. What is no regular file (a device, a pipe) is opened and written to.
    ///
    /// # Errors
    /// As [`Self::open`], what `write` returns, and what the file system refuses, with the path; a regular file is then as it was.
    pub fn write<E: From<io::Error>>(&self, write: impl FnOnce(&mut dyn Write) -> Result<(), E>) -> Result<(), E> {
        match target(&self.path)? {
            Target::File(place) => {
                may_be_replaced(&self.path, &place)?;
                replace(&self.path, &place, write)
            }
            Target::Stream => {
                // A descriptor may stand in the middle of a file: nothing of that is cut off or written over.
                let file = OpenOptions::new().append(true).open(&self.path).map_err(|error| at(&self.path, &error))?;
                let mut file = Named { inner: BufWriter::new(file), path: &self.path };
                write(&mut file)?;
                Ok(file.flush()?)
            }
        }
    }
}

/// Writes the file `path`: [`OutputFile::open`], then [`OutputFile::write`].
///
/// # Errors
/// As those.
pub fn write_atomically<E: From<io::Error>>(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<(), E>) -> Result<(), E> {
    OutputFile::open(path)?.write(write)
}

fn wrong(path: &Path, why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, format!("{}: {why}", path.display()))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn target(path: &Path) -> io::Result<Target> {
    match fs::metadata(path) {
        Ok(about) if about.is_dir() => Err(wrong(path, "is a folder; expected the name of a file")),
        Ok(about) if !about.is_file() || is_descriptor(path) => Ok(Target::Stream),
        Ok(_) => path.canonicalize().map(Target::File).map_err(|error| at(path, &error)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Target::File(absent(path)?)),
        Err(error) => Err(at(path, &error)),
    }
}

/// Where a file will be made: at the end of links to nothing.
fn absent(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    while let Ok(next) = fs::read_link(&path) {
        path = folder_of(&path).join(next);
    }
    if path.file_name().is_none() {
        return Err(wrong(&path, "expected the name of a file"));
    }
    match fs::metadata(folder_of(&path)) {
        Ok(about) if about.is_dir() => Ok(path),
        Ok(_) => Err(wrong(&path, "lies in what is no folder")),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Err(io::Error::new(
            error.kind(),
            format!("{}: there is no folder {}; make it first", path.display(), folder_of(&path).display()),
        )),
        Err(error) => Err(at(&path, &error)),
    }
}

/// Whether a path, by links, is that of an open descriptor, as `/dev/stdout` is: the file behind it is not ours to replace.
fn is_descriptor(path: &Path) -> bool {
    let mut path = path.to_owned();
    loop {
        let folder = folder_of(&path).canonicalize().unwrap_or_default();
        if folder.starts_with("/proc") && folder.ends_with("fd") {
            return true;
        }
        let Ok(next) = fs::read_link(&path) else { return false };
        path = folder_of(&path).join(next);
    }
}

fn may_be_replaced(path: &Path, place: &Path) -> io::Result<()> {
    let about = match fs::metadata(place) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        other => other.map_err(|error| at(path, &error))?,
    };
    if about.permissions().readonly() || !is_writable(place) {
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, format!("{}: is write-protected", path.display())));
    }
    // What cannot be read may be anything.
    if is_photograph(place).map_err(|error| at(path, &error))? {
        return Err(wrong(path, "is an image that calibench did not write, and is not replaced; name another file or remove it"));
    }
    Ok(())
}

#[cfg(unix)]
fn is_writable(path: &Path) -> bool {
    use rustix::fs::{Access, AtFlags, CWD, accessat};
    accessat(CWD, path, Access::WRITE_OK, AtFlags::EACCESS).is_ok()
}

#[cfg(not(unix))]
fn is_writable(_: &Path) -> bool {
    true
}

fn replace<E: From<io::Error>>(path: &Path, place: &Path, write: impl FnOnce(&mut dyn Write) -> Result<(), E>) -> Result<(), E> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".calibench-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any other new file; the user's umask still applies.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder_of(place)).map_err(|error| at(path, &without_path(error)))?;
    {
        // To the file itself: what tempfile says of errors names its own file, not the user's.
        let mut buffered = Named { inner: BufWriter::new(file.as_file_mut()), path };
        write(&mut buffered)?;
        buffered.flush()?;
    }
    let rights = fs::metadata(place).map_or(Ok(()), |old| keep_rights(file.as_file(), &old));
    rights.and_then(|()| file.as_file().sync_data()).map_err(|error| at(path, &error))?;
    file.persist(place).map_err(|error| at(path, &error.error))?;
    Ok(sync_folder(folder_of(place))?)
}

/// Puts the names of a folder's entries on the disk: before that, a power cut may undo a rename. Nothing is done where folders cannot be opened or synced.
///
/// # Errors
/// What the disk refuses, with the folder's path.
pub(crate) fn sync_folder(folder: &Path) -> io::Result<()> {
    use io::ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
    #[cfg(test)]
    tests::SYNCED.with_borrow_mut(|synced| synced.push(folder.to_owned()));
    match fs::File::open(folder).and_then(|open| open.sync_all()) {
        Err(error) if !cfg!(unix) || matches!(error.kind(), InvalidInput | PermissionDenied | Unsupported) => Ok(()),
        synced => synced.map_err(|error| at(folder, &error)),
    }
}

/// What the system says of a temporary file, without the name of that file.
fn without_path(error: io::Error) -> io::Error {
    let said = error.get_ref().and_then(|inner| inner.source()).map(ToString::to_string);
    said.map_or(error, io::Error::other)
}

/// Gives a file the permissions of the one that it replaces, and its owner where that is allowed.
fn keep_rights(new: &fs::File, old: &fs::Metadata) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let about = new.metadata()?;
        if (about.uid(), about.gid()) != (old.uid(), old.gid()) {
            std::os::unix::fs::fchown(new, Some(old.uid()), Some(old.gid())).ok();
        }
    }
    new.set_permissions(old.permissions())
}

/// A writer whose errors name the file.
struct Named<'p, W> {
    inner: W,
    path: &'p Path,
}

impl<W: Write> Write for Named<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.inner.write(bytes).map_err(|error| named(self.path, error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush().map_err(|error| named(self.path, error))
    }
}

/// An error of the file system with the path that it is about, which the system does not say.
pub fn at(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// The same while a file is written, which tries again after an interrupt.
pub(crate) fn named(path: &Path, error: io::Error) -> io::Error {
    if error.kind() == io::ErrorKind::Interrupted { error } else { at(path, &error) }
}

#[cfg(test)]
mod tests;
