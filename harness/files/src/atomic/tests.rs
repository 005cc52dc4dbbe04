use std::cell::RefCell;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::write_atomically;

fn write(path: &Path, text: &str) -> io::Result<()> {
    write_atomically(path, |file| file.write_all(text.as_bytes()))
}

thread_local! {
    /// The folders that this thread has put on the disk.
    pub static SYNCED: RefCell<Vec<PathBuf>> = const { RefCell::new(Vec::new()) };
}

/// A power cut after the file's name was given must not take it away again.
#[test]
fn the_folder_of_a_new_name_is_put_on_the_disk() {
    let folder = tempfile::tempdir().unwrap();
    for place in [folder.path().join("out.csv"), folder.path().join("sub/page")] {
        SYNCED.take();
        match place.parent() {
            Some(parent) if parent == folder.path() => write(&place, "new").unwrap(),
            parent => {
                let folder = crate::OutputFolder::open(parent.unwrap()).unwrap();
                folder.replace::<io::Error>(|folder| folder.write("page", |file| file.write_all(b"new"))).unwrap();
            }
        }
        assert!(SYNCED.take().iter().any(|synced| synced.canonicalize().unwrap() == folder.path().canonicalize().unwrap()), "{place:?}");
    }
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

#[test]
fn a_failure_leaves_the_old_file_and_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.csv");
    write(&path, "old").unwrap();
    let result: io::Result<()> = write_atomically(&path, |file| {
        file.write_all(b"half")?;
        Err(io::Error::other("interrupted"))
    });
    assert!(result.is_err());
    assert_eq!(read(&path), "old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    write(&path, "new").unwrap();
    assert_eq!(read(&path), "new");
}

#[test]
fn what_must_stay_stays_and_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("folder")).unwrap();
    fs::write(at("photo.csv"), b"\xff\xd8\xff\xe0 years of them").unwrap();
    fs::write(at("locked.csv"), "old").unwrap();
    let mut rights = fs::metadata(at("locked.csv")).unwrap().permissions();
    rights.set_readonly(true);
    fs::set_permissions(at("locked.csv"), rights).unwrap();
    for (name, expected) in [
        ("folder", "folder: is a folder"),
        ("photo.csv", "photo.csv: is an image that calibench did not write"),
        ("locked.csv", "locked.csv: is write-protected"),
        ("absent/out.csv", "absent; make it first"),
        ("photo.csv/out.csv", "out.csv: "),
    ] {
        let error = write(&at(name), "new").unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    assert_eq!(fs::read(at("photo.csv")).unwrap(), b"\xff\xd8\xff\xe0 years of them");
    assert_eq!(read(&at("locked.csv")), "old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};

    use super::*;

    #[test]
    fn links_are_written_through() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        fs::write(at("sub/real.csv"), "old").unwrap();
        symlink("sub/real.csv", at("link.csv")).unwrap();
        symlink("link.csv", at("second.csv")).unwrap();
        symlink("sub/later.csv", at("dangling.csv")).unwrap();
        symlink("loop.csv", at("loop.csv")).unwrap();
        write(&at("second.csv"), "new").unwrap();
        write(&at("dangling.csv"), "later").unwrap();
        assert_eq!((read(&at("sub/real.csv")), read(&at("sub/later.csv"))), ("new".into(), "later".into()));
        assert!(["link.csv", "second.csv", "dangling.csv"].iter().all(|name| at(name).is_symlink()));
        assert_eq!(fs::read_dir(at("sub")).unwrap().count(), 2);
        assert!(write(&at("loop.csv"), "").unwrap_err().to_string().contains("loop.csv"));
    }

    #[test]
    fn permissions_are_kept_and_other_names_of_a_file_keep_its_content() {
        let folder = tempfile::tempdir().unwrap();
        let (path, other) = (folder.path().join("out.csv"), folder.path().join("other.csv"));
        write(&path, "old").unwrap();
        fs::hard_link(&path, &other).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        write(&path, "new").unwrap();
        assert_eq!(fs::metadata(&path).unwrap().mode() & 0o777, 0o640);
        assert_eq!((read(&path), read(&other)), ("new".into(), "old".into()));
    }

    #[test]
    fn a_pipe_is_written_to_and_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pipe");
        rustix::fs::mknodat(rustix::fs::CWD, &path, rustix::fs::FileType::Fifo, 0o600.into(), 0).unwrap();
        let reader = std::thread::spawn({
            let path = path.clone();
            move || {
                let mut text = String::new();
                fs::File::open(path).and_then(|mut file| file.read_to_string(&mut text)).map(|_| text)
            }
        });
        write(&path, "through").unwrap();
        assert_eq!(reader.join().unwrap().unwrap(), "through");
        assert!(fs::symlink_metadata(&path).unwrap().file_type().is_fifo());
    }

    #[test]
    fn a_full_device_is_named_and_stays() {
        let full = Path::new("/dev/full");
        if !fs::metadata(full).is_ok_and(|about| about.file_type().is_char_device()) {
            return;
        }
        // By a link, so that not even a mistake could replace the device.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("full");
        symlink(full, &path).unwrap();
        let error = write(&path, "x").unwrap_err();
        assert!(error.kind() == io::ErrorKind::StorageFull && error.to_string().contains("full: "), "{error}");
        assert!(path.is_symlink() && fs::metadata(full).unwrap().file_type().is_char_device());
    }

    #[test]
    fn an_open_descriptor_is_added_to() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        fs::write(&path, "before\n").unwrap();
        let open = fs::File::open(&path).unwrap();
        let descriptor = format!("/proc/self/fd/{}", std::os::fd::AsRawFd::as_raw_fd(&open));
        if !Path::new(&descriptor).exists() {
            return;
        }
        write(Path::new(&descriptor), "after\n").unwrap();
        assert_eq!(read(&path), "before\nafter\n");
    }
}
