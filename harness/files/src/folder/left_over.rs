//! What killed processes left beside the folders that they were to replace.
//!
//! Such a folder is found by its name in a folder that others may write into, or that came from elsewhere with all that is in it. Only one that a run of this user
//! made in this place is touched: it is no link, it belongs to the user, nobody else can write into it, and its lock names the very files that they are (copies have
//! other numbers). All others stay as they are, without a word.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use super::at;
use super::scratch::{LOCK, OLD, PREFIX, remove};
use crate::atomic::sync_folder;

/// A lock holds no more than this, bytes: a few numbers and the name of a folder.
const LONGEST: u64 = 4096;

/// Removes from `parent` what killed processes of this user left half written, and puts back an old folder that they left aside.
///
/// # Errors
/// What the file system refuses, with the path.
pub fn clear(parent: &Path) -> io::Result<()> {
    let named = |error: io::Error| at(parent, &error);
    for entry in fs::read_dir(parent).map_err(named)? {
        let entry = entry.map_err(named)?;
        if entry.file_name().to_string_lossy().starts_with(PREFIX) {
            clear_one(parent, &entry.path()).map_err(|error| at(&entry.path(), &error))?;
        }
    }
    Ok(())
}

fn clear_one(parent: &Path, folder: &Path) -> io::Result<()> {
    let Some((anchor, lock, name)) = ours(folder) else { return Ok(()) };
    // Its process lives, or nothing tells whether it does.
    if lock.try_lock().is_err() {
        return Ok(());
    }
    let (old, place) = (anchor.path().join(OLD), parent.join(&name));
    if is_folder(&old) && fs::symlink_metadata(&place).is_err_and(|error| error.kind() == io::ErrorKind::NotFound) {
        fs::rename(&old, &place)?;
        sync_folder(parent)?;
    }
    remove(&anchor, folder)
}

/// The folder at `folder`, its lock, and what it was to replace, if a run of this user made it there.
fn ours(folder: &Path) -> Option<(Anchor, File, String)> {
    let anchor = Anchor::at(folder).ok().filter(Anchor::is_own)?;
    let mut options = OpenOptions::new();
    no_link(options.read(true));
    let lock = options.open(anchor.path().join(LOCK)).ok()?;
    let about = lock.metadata().ok().filter(fs::Metadata::is_file)?;
    let mut text = String::new();
    (&lock).take(LONGEST).read_to_string(&mut text).ok()?;
    let name = text.strip_prefix(&seal(&anchor, &about)?)?;
    let mut parts = Path::new(name).components();
    let is_name = matches!((parts.next(), parts.next()), (Some(Component::Normal(part)), None) if part == name);
    is_name.then(|| (anchor, lock, name.to_owned()))
}

/// Whether a folder is there, and no link to one.
pub fn is_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|about| about.is_dir())
}

/// A folder that is held open: whatever is put in its place, it is still the same.
#[derive(Debug)]
pub struct Anchor {
    path: PathBuf,
    folder: Option<File>,
}

impl Anchor {
    /// The folder `path`.
    ///
    /// # Errors
    /// A link, what is no folder, and what the file system refuses.
    #[cfg(unix)]
    pub fn at(path: &Path) -> io::Result<Self> {
        use std::os::unix::fs::OpenOptionsExt;
        let flags = rustix::fs::OFlags::DIRECTORY | rustix::fs::OFlags::NOFOLLOW;
        let folder = OpenOptions::new().read(true).custom_flags(flags.bits().cast_signed()).open(path)?;
        Ok(Self { path: path.to_owned(), folder: Some(folder) })
    }

    /// The folder `path`, by its name: where folders cannot be opened.
    #[cfg(not(unix))]
    pub fn at(path: &Path) -> io::Result<Self> {
        Ok(Self { path: path.to_owned(), folder: None })
    }

    /// A path that leads to this very folder where the system has such paths, elsewhere its name.
    pub fn path(&self) -> PathBuf {
        #[cfg(target_os = "linux")]
        if let Some(folder) = &self.folder {
            use std::os::fd::AsRawFd;
            let open = PathBuf::from(format!("/proc/self/fd/{}", folder.as_raw_fd()));
            if open.exists() {
                return open;
            }
        }
        self.path.clone()
    }

    /// Whether it is this user's, and nobody else can write into it.
    #[cfg(unix)]
    fn is_own(&self) -> bool {
        use std::os::unix::fs::MetadataExt;
        let about = self.folder.as_ref().and_then(|folder| folder.metadata().ok());
        about.is_some_and(|about| about.uid() == rustix::process::geteuid().as_raw() && about.mode() & 0o022 == 0)
    }

    /// Nothing tells whose it is.
    #[cfg(not(unix))]
    fn is_own(&self) -> bool {
        false
    }
}

/// How a lock begins: with what no copy of it has.
#[cfg(unix)]
pub fn seal(folder: &Anchor, lock: &fs::Metadata) -> Option<String> {
    use std::os::unix::fs::MetadataExt;
    use std::time::UNIX_EPOCH;
    let folder = folder.folder.as_ref()?.metadata().ok()?;
    let made = lock.created().ok().and_then(|made| made.duration_since(UNIX_EPOCH).ok()).map_or(0, |made| made.as_nanos());
    Some(format!("{} {} {made}\n", folder.ino(), lock.ino()))
}

#[cfg(not(unix))]
pub fn seal(_: &Anchor, _: &fs::Metadata) -> Option<String> {
    None
}

/// Opens no link, and waits for nobody.
#[cfg(unix)]
fn no_link(options: &mut OpenOptions) {
    use rustix::fs::OFlags;
    use std::os::unix::fs::OpenOptionsExt;
    options.custom_flags((OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed());
}

#[cfg(not(unix))]
fn no_link(_: &mut OpenOptions) {}

#[cfg(test)]
mod tests {
    use super::super::manifest::Manifest;
    use super::super::scratch::{NEW, Scratch};
    use super::*;

    /// A left-over as a killed process leaves it: its new folder has a page, and the old one of `name` waits.
    fn left(parent: &Path, name: &str) -> PathBuf {
        let scratch = Scratch::new(parent, name, Path::new(name)).unwrap();
        fs::write(scratch.new_folder().join("page"), "new").unwrap();
        let old = scratch.folder().join(OLD);
        fs::create_dir(&old).unwrap();
        fs::write(old.join("page"), "old").unwrap();
        Manifest::of(&old).unwrap().write(&old).unwrap();
        scratch.abandon()
    }

    fn copied(from: &Path, to: &Path) {
        fs::create_dir(to).unwrap();
        for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
            let there = to.join(entry.file_name());
            if entry.path().is_dir() {
                copied(&entry.path(), &there);
            } else {
                fs::copy(entry.path(), there).unwrap();
            }
        }
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn what_a_run_of_ours_left_is_put_back_and_removed() {
        let parent = tempfile::tempdir().unwrap();
        left(parent.path(), "a");
        clear(parent.path()).unwrap();
        assert_eq!((names(parent.path()), fs::read_to_string(parent.path().join("a/page")).unwrap()), (vec!["a".into()], "old".into()));
    }

    /// What was done to a left-over, after which nobody can say that a run of ours made it.
    #[cfg(unix)]
    type Change<'a> = (&'a str, &'a dyn Fn(&Path));

    #[cfg(unix)]
    #[test]
    fn what_no_run_of_ours_made_there_is_not_touched() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let own = |lock: &Path| fs::read_to_string(lock).unwrap();
        let name = |folder: &Path, name: &str| {
            let lock = folder.join(LOCK);
            let (seal, _) = own(&lock).rsplit_once('\n').map(|(seal, old)| (seal.to_owned(), old.to_owned())).unwrap();
            fs::write(lock, format!("{seal}\n{name}")).unwrap();
        };
        let changes: &[Change<'_>] = &[
            ("copied", &|folder| {
                let beside = folder.with_file_name("beside");
                fs::rename(folder, &beside).unwrap();
                copied(&beside, folder);
                fs::remove_dir_all(beside).unwrap();
            }),
            ("a link", &|folder| {
                fs::rename(folder, folder.with_file_name("beside")).unwrap();
                symlink("beside", folder).unwrap();
            }),
            ("others may write", &|folder| fs::set_permissions(folder, fs::Permissions::from_mode(0o777)).unwrap()),
            ("a lock of few words", &|folder| fs::write(folder.join(LOCK), "a").unwrap()),
            ("a lock that is none", &|folder| {
                fs::remove_file(folder.join(LOCK)).unwrap();
                fs::create_dir(folder.join(LOCK)).unwrap();
            }),
            ("a lock that is a pipe", &|folder| {
                fs::remove_file(folder.join(LOCK)).unwrap();
                rustix::fs::mknodat(rustix::fs::CWD, folder.join(LOCK), rustix::fs::FileType::Fifo, 0o600.into(), 0).unwrap();
            }),
            ("a lock that is a link", &|folder| {
                fs::rename(folder.join(LOCK), folder.join("other")).unwrap();
                symlink("other", folder.join(LOCK)).unwrap();
            }),
            ("no lock", &|folder| fs::remove_file(folder.join(LOCK)).unwrap()),
            ("a name elsewhere", &|folder| name(folder, "../elsewhere")),
            ("a name of no folder", &|folder| name(folder, "..")),
            ("a name with an end", &|folder| name(folder, "a/")),
        ];
        for (what, change) in changes {
            let parent = tempfile::tempdir().unwrap();
            let folder = left(parent.path(), "a");
            change(&folder);
            let before = names(parent.path());
            clear(parent.path()).unwrap();
            assert_eq!(names(parent.path()), before, "{what}");
            assert_eq!(fs::read_to_string(folder.join(NEW).join("page")).unwrap(), "new", "{what}");
            assert_eq!(fs::read_to_string(folder.join(OLD).join("page")).unwrap(), "old", "{what}");
        }
    }

    /// Links within a left-over of ours lead nowhere: what they lead to keeps all that is in it.
    #[cfg(unix)]
    #[test]
    fn links_in_it_are_not_followed() {
        use std::os::unix::fs::symlink;
        for part in [NEW, OLD] {
            let parent = tempfile::tempdir().unwrap();
            let (precious, folder) = (parent.path().join("precious"), left(parent.path(), "a"));
            fs::create_dir(&precious).unwrap();
            fs::write(precious.join("page"), "mine").unwrap();
            Manifest::of(&precious).unwrap().write(&precious).unwrap();
            fs::remove_dir_all(folder.join(part)).unwrap();
            symlink(&precious, folder.join(part)).unwrap();
            // What stands there is said, or stays without a word.
            clear(parent.path()).ok();
            assert_eq!(fs::read_to_string(precious.join("page")).unwrap(), "mine", "{part}");
            assert!(fs::symlink_metadata(parent.path().join("a")).is_ok_and(|about| about.is_dir()) == (part == NEW));
        }
    }

    #[test]
    fn a_place_that_is_taken_keeps_what_is_there() {
        let parent = tempfile::tempdir().unwrap();
        left(parent.path(), "a");
        fs::create_dir(parent.path().join("a")).unwrap();
        fs::write(parent.path().join("a/page"), "third").unwrap();
        clear(parent.path()).unwrap();
        assert_eq!(fs::read_to_string(parent.path().join("a/page")).unwrap(), "third");
    }
}
