//! What a command reads, which it must not write.

use std::fs;
use std::path::{Path, PathBuf};

/// The files and folders that a command reads.
///
/// Compared are real paths and, where the system numbers files, these numbers: a link to a file, hard or symbolic, is that file, and so is one to a file in a
/// folder that is read.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    read: Vec<Input>,
}

#[derive(Clone, Debug)]
struct Input {
    given: PathBuf,
    real: PathBuf,
    number: Option<(u64, u64)>,
}

impl Inputs {
    /// Those of `paths` that are there and are regular files or folders.
    pub fn new<P: AsRef<Path>>(paths: impl IntoIterator<Item = P>) -> Self {
        let input = |given: PathBuf| {
            let about = fs::metadata(&given).ok().filter(|about| about.is_file() || about.is_dir())?;
            let real = given.canonicalize().ok()?;
            Some(Input { given, real, number: number(&about) })
        };
        Self { read: paths.into_iter().map(|path| path.as_ref().to_owned()).filter_map(input).collect() }
    }

    /// The input, as it was given, that would be lost or changed by writing the file `path`: the same file, or a folder that holds it.
    pub fn written_by(&self, path: &Path) -> Option<&Path> {
        let about = fs::metadata(path).ok().filter(fs::Metadata::is_file);
        let (number, linked) = (about.as_ref().and_then(number), about.as_ref().is_some_and(has_other_names));
        let real = real(path);
        let is = |input: &&Input| {
            let same = number.is_some_and(|number| input.number == Some(number) || (linked && holds(&input.real, number)));
            same || real.as_ref().is_some_and(|real| real.starts_with(&input.real))
        };
        self.read.iter().find(is).map(|input| input.given.as_path())
    }

    /// The input, as it was given, that would be lost by replacing the folder `path`: one that lies in it, or holds it.
    pub fn lost_with(&self, path: &Path) -> Option<&Path> {
        let folder = real(path)?;
        let is = |input: &&Input| input.real.starts_with(&folder) || folder.starts_with(&input.real);
        self.read.iter().find(is).map(|input| input.given.as_path())
    }
}

/// Whether the file of this number lies in `folder`, at any depth. What cannot be read holds nothing.
fn holds(folder: &Path, file: (u64, u64)) -> bool {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries
        .filter_map(|entry| Some((entry.path(), entry.metadata().ok()?)))
        .any(|(path, about)| if about.is_dir() { holds(&path, file) } else { number(&about) == Some(file) })
}

/// The real path of what is there or could be made.
fn real(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok().or_else(|| {
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        // The current folder itself may be gone.
        let name = path.file_name().filter(|_| parent != path)?;
        Some(real(parent)?.join(name))
    })
}

#[cfg(unix)]
#[expect(clippy::unnecessary_wraps, reason = "elsewhere there is none")]
fn number(about: &fs::Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((about.dev(), about.ino()))
}

#[cfg(unix)]
fn has_other_names(about: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    about.nlink() > 1
}

#[cfg(not(unix))]
fn has_other_names(_: &fs::Metadata) -> bool {
    false
}

#[cfg(not(unix))]
fn number(_: &fs::Metadata) -> Option<(u64, u64)> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_the_same_by_any_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir_all(at("photos/sub")).unwrap();
        fs::write(at("photos/a.jpg"), "").unwrap();
        fs::hard_link(at("photos/a.jpg"), at("hard.jpg")).unwrap();
        let inputs = Inputs::new([at("photos/a.jpg"), at("absent.csv")]);
        assert_eq!(inputs.written_by(&at("photos/sub/../a.jpg")), Some(at("photos/a.jpg").as_path()));
        assert_eq!(inputs.written_by(&at("hard.jpg")), Some(at("photos/a.jpg").as_path()));
        for other in ["photos/b.jpg", "a.jpg", "absent.csv", "photos"] {
            assert_eq!(inputs.written_by(&at(other)), None, "{other}");
        }
        assert!(inputs.lost_with(&at("photos")).is_some() && inputs.lost_with(folder.path()).is_some());
        assert!(inputs.lost_with(&at("photos/sub")).is_none() && inputs.lost_with(&at("other")).is_none());
        let inputs = Inputs::new([at("photos")]);
        assert_eq!(inputs.written_by(&at("hard.jpg")), Some(at("photos").as_path()), "a file of a folder by another name");
        fs::write(at("other.jpg"), "").unwrap();
        fs::hard_link(at("other.jpg"), at("other-too.jpg")).unwrap();
        assert_eq!(inputs.written_by(&at("other.jpg")), None);
        assert!(inputs.written_by(&at("photos/new.csv")).is_some() && inputs.lost_with(&at("photos/new/er")).is_some());
    }
}
