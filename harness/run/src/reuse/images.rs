//! The images of the first trial that a run keeps.

use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use calibench_files::{NewFolder, at};
use calibench_store::{Key, Store};

/// Puts the stored images into `folder`; whether there are any.
///
/// # Errors
/// What the file system refuses.
pub fn put(store: &Store, key: Key, folder: &NewFolder) -> io::Result<bool> {
    let Some(mut found) = store.find(key) else { return Ok(false) };
    while found.left() > 0 {
        let [name, content] = [part(&mut found)?, part(&mut found)?];
        let name = String::from_utf8(name).map_err(io::Error::other)?;
        folder.write(&name, |file| file.write_all(&content))?;
    }
    Ok(true)
}

fn part(from: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut size = [0; 8];
    from.read_exact(&mut size)?;
    let mut content = Vec::new();
    from.take(u64::from_le_bytes(size)).read_to_end(&mut content)?;
    Ok(content)
}

/// Stores the images that a run has put into `folder`.
///
/// # Errors
/// What the file system refuses.
pub fn keep(store: &Store, key: Key, folder: &NewFolder) -> io::Result<()> {
    let mut images = Vec::new();
    list(folder.path(), &mut images)?;
    images.sort();
    let mut entry = store.create(key)?;
    for path in images {
        let Some(name) = path.strip_prefix(folder.path()).ok().and_then(Path::to_str) else { continue };
        for part in [name.as_bytes(), &fs::read(&path).map_err(|error| at(&path, &error))?] {
            entry.write_all(&(part.len() as u64).to_le_bytes())?;
            entry.write_all(part)?;
        }
    }
    entry.finish()
}

/// The images below `folder`.
fn list(folder: &Path, found: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder).map_err(|error| at(folder, &error))? {
        let path = entry.map_err(|error| at(folder, &error))?.path();
        if path.is_dir() {
            list(&path, found)?;
        } else if path.extension().is_some_and(|extension| extension == "png") {
            found.push(path);
        }
    }
    Ok(())
}
