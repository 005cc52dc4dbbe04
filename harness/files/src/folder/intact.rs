//! Whether a folder that came from elsewhere is whole.

use std::io;
use std::path::Path;

use rayon::prelude::*;

use super::manifest::{MANIFEST, Manifest, digest};

/// The files that calibench wrote into `folder`, by their names, with `/` between folders: all are there, as they were written. What else lies in it is not
/// looked at.
///
/// # Errors
/// A folder without the list of its files, and the first file that is missing or was changed, or cannot be read.
pub fn intact(folder: &Path) -> io::Result<Vec<String>> {
    let wrong = |path: &Path, why: &str| io::Error::new(io::ErrorKind::InvalidData, format!("{}: {why}", path.display()));
    let manifest = Manifest::read(folder)?;
    let manifest = manifest.ok_or_else(|| wrong(&folder.join(MANIFEST), "is not there; expected the folder as calibench wrote it"))?;
    let names: Vec<String> = manifest.names().map(str::to_owned).collect();
    let look = |name: &String| -> io::Result<()> {
        let path = folder.join(name);
        match digest(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Err(wrong(&path, "is missing; calibench wrote it there")),
            Err(error) => Err(error),
            Ok(found) if manifest.has(name, &found) => Ok(()),
            Ok(_) => Err(wrong(&path, "is not as it was written, cut off or changed since")),
        }
    };
    let looked: Vec<io::Result<()>> = names.par_iter().map(look).collect();
    looked.into_iter().collect::<io::Result<()>>()?;
    Ok(names)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn what_is_missing_cut_off_or_changed_is_named() {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("out");
        assert!(intact(&folder).unwrap_err().to_string().contains("is not there"));
        let output = super::super::OutputFolder::open(&folder).unwrap();
        let fill = || {
            fs::remove_dir_all(&folder).ok();
            let written: io::Result<()> = output.replace(|new| {
                new.write("a.csv", |file| file.write_all(b"1,2\n"))?;
                new.write("cell/b.csv", |file| file.write_all(b"3,4\n"))
            });
            written.unwrap();
        };
        fill();
        fs::write(folder.join("note"), "mine").unwrap();
        assert_eq!(intact(&folder).unwrap(), ["a.csv", "cell/b.csv"]);
        fs::write(folder.join("cell/b.csv"), "3,").unwrap();
        let error = intact(&folder).unwrap_err().to_string();
        assert!(error.contains("b.csv: is not as it was written"), "{error}");
        fill();
        fs::remove_file(folder.join("a.csv")).unwrap();
        let error = intact(&folder).unwrap_err().to_string();
        assert!(error.contains("a.csv: is missing"), "{error}");
        fs::remove_file(folder.join(MANIFEST)).unwrap();
        assert!(intact(&folder).unwrap_err().to_string().contains(MANIFEST));
    }
}
